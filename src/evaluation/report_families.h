// Parts of the report, family by family, for the forms that put them together.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "evolin_ros/evaluation/report.h"

namespace evolin {

/// Objects of the strict JSON report.
nlohmann::ordered_json heatmapJson(const Report& report);
nlohmann::ordered_json repeatabilityJson(const Report& report);
nlohmann::ordered_json detectedAssociationJson(const Report& report);
nlohmann::ordered_json poseJson(const Report& report);
nlohmann::ordered_json tracksJson(const Report& report);

/// Sections of the Markdown summary, heading included.
std::string heatmapSection(const Report& report);
std::string repeatabilitySection(const Report& report);
std::string detectedAssociationSection(const Report& report);
std::string poseSection(const Report& report);
std::string tracksSection(const Report& report);

/// A ratio in percent with one digit, and a number with that many.
std::string percentText(double ratio);
std::string fixedText(double value, int digits);

}  // namespace evolin
