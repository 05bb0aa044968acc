// A small writer: the JSON library quotes the strings, but has no literals for numbers that are not
// finite and, in its older versions, no order of keys.
#include "published_json.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>

#include "evolin_ros/base/text.h"

namespace evolin::cli {

namespace {

std::string jsonString(const std::string& text) { return nlohmann::json(text).dump(); }

std::string number(double value) {
  if (std::isnan(value)) {
    return "NaN";
  }
  if (std::isinf(value)) {
    return value > 0 ? "Infinity" : "-Infinity";
  }
  std::string text = formatDouble(value);
  if (text.find_first_of(".e") == std::string::npos) {
    text += ".0";  // so that it reads back as a floating-point number
  }
  return text;
}

std::string list(const std::vector<double>& values) {
  std::string text = "[";
  for (const double value : values) {
    text += (text.size() > 1 ? ", " : "") + number(value);
  }
  return text + "]";
}

/// An object under construction: "key": text pairs in the order of addition.
class ObjectText {
 public:
  void add(const std::string& key, const std::string& value) {
    text_ += (text_.empty() ? "" : ", ") + jsonString(key) + ": " + value;
  }

  std::string str() const { return "{" + text_ + "}"; }
  bool empty() const { return text_.empty(); }

 private:
  std::string text_;
};

std::string additionalInformation(const PublishedEntry& entry) {
  ObjectText information;
  if (entry.distance) {
    ObjectText distance;
    distance.add("distance", jsonString(*entry.distance));
    if (entry.distance_threshold) {
      distance.add("distance_threshold", number(*entry.distance_threshold));
    }
    information.add("distance_information", distance.str());
  }
  if (entry.threshold) {
    ObjectText threshold;
    threshold.add("threshold", number(*entry.threshold));
    information.add("threshold_information", threshold.str());
  }
  if (entry.frames_step) {
    ObjectText step;
    step.add("step", std::to_string(*entry.frames_step));
    information.add("frames_step_information", step.str());
  }
  if (entry.score_threshold) {
    ObjectText score;
    score.add("score_threshold", number(*entry.score_threshold));
    information.add("score_information", score.str());
  }
  if (entry.confidence_interval) {
    ObjectText interval;
    interval.add("level", number(entry.confidence_interval->level));
    interval.add("low", number(entry.confidence_interval->low));
    interval.add("high", number(entry.confidence_interval->high));
    information.add("confidence_interval", interval.str());
  }
  return information.empty() ? "null" : information.str();
}

}  // namespace

std::string toPublishedJson(const std::vector<PublishedEntry>& entries) {
  std::string text;
  for (const PublishedEntry& entry : entries) {
    ObjectText object;
    object.add("name", jsonString(entry.name));
    object.add("additional_information", additionalInformation(entry));
    if (const Curve* curve = std::get_if<Curve>(&entry.value)) {
      ObjectText values;
      values.add("x", list(curve->x));
      values.add("y", list(curve->y));
      object.add("values", values.str());
    } else {
      object.add("value", number(std::get<double>(entry.value)));
    }
    text += (text.empty() ? "" : ", ") + object.str();
  }
  return "[" + text + "]";
}

}  // namespace evolin::cli
