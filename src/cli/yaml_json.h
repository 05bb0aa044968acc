// Parameters in YAML as JSON.
#pragma once

#include <yaml-cpp/yaml.h>

#include <nlohmann/json.hpp>

namespace evolin::cli {

/// Scalars that read as JSON (numbers, true, false, null) become that, others text.
nlohmann::ordered_json toJson(const YAML::Node& node);

}  // namespace evolin::cli
