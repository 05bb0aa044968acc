// Results as text for people and for spreadsheets.
#pragma once

#include <string>
#include <vector>

#include "published_json.h"

namespace evolin::cli {

/// An aligned table: one row for each combination of distance and thresholds, one column a name,
/// four decimals, intervals in brackets behind their value. "-" stands where an entry is undefined
/// or there is none; below, a line for every reason tells which figures have no value. Curves are
/// left out.
std::string toTable(const std::vector<PublishedEntry>& entries);

/// One row an entry, values to the last digit, empty fields for what an entry does not depend on
/// and for the value of an undefined one, whose `reason` stands in the last column. Curves are left
/// out.
std::string toCsv(const std::vector<PublishedEntry>& entries);

}  // namespace evolin::cli
