// Results in the published scripts' own form: a list of named values and curves.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "evolin_ros/metrics/bootstrap.h"

namespace evolin::cli {

struct Curve {
  std::vector<double> x;
  std::vector<double> y;
};

/// One value or curve with what it depends on; an absent field is not written.
struct PublishedEntry {
  std::string name;
  std::optional<std::string> distance;       ///< "orthogonal" or "structural"
  std::optional<double> distance_threshold;  ///< beside `distance`
  std::optional<double> score_threshold;
  std::optional<std::int64_t> frames_step;
  std::optional<double> threshold;
  std::optional<ConfidenceInterval> confidence_interval;  ///< ours, beyond the published form
  std::variant<double, Curve> value = 0.0;
  /// Why tables show no value, in words without a comma; empty: they do. The published form has the
  /// value anyway.
  std::string undefined;
};

/// A JSON list as Python's json module writes and reads it: Infinity, -Infinity and NaN as
/// literals, floating-point numbers in their shortest exact form, keys in the published order.
std::string toPublishedJson(const std::vector<PublishedEntry>& entries);

}  // namespace evolin::cli
