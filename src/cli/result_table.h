// Results as text for people and for spreadsheets.
#pragma once

#include <string>
#include <vector>

#include "published_json.h"

namespace evolin::cli {

/// An aligned table: one row for each combination of distance and thresholds, one column a name,
/// four decimals, intervals in brackets behind their value. Curves are left out.
std::string toTable(const std::vector<PublishedEntry>& entries);

/// One row an entry, values to the last digit, empty fields for what an entry does not depend on.
/// Curves are left out.
std::string toCsv(const std::vector<PublishedEntry>& entries);

}  // namespace evolin::cli
