// Lists in place of maps: nobody else reads them.
#include "plan_json.h"

#include <nlohmann/json.hpp>

namespace evolin::cli {

using Json = nlohmann::json;

std::string planToJson(const BenchmarkPlan& plan) {
  Json json = {
      {"sequences", Json::array()}, {"detections", Json::array()}, {"cells", Json::array()}};
  for (const PlannedSequence& sequence : plan.sequences) {
    json["sequences"].push_back(Json::array({sequence.unavailable, sequence.digest}));
  }
  for (const PlannedDetection& detection : plan.detections) {
    json["detections"].push_back(Json::array(
        {detection.id, detection.sequence, detection.detector, detection.content_hash}));
  }
  for (const PlannedCell& cell : plan.cells) {
    json["cells"].push_back(Json::array({cell.unavailable, cell.content_hash,
                                         cell.detection ? Json(*cell.detection) : Json(nullptr),
                                         cell.lines_folder, cell.matches_folder}));
  }
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

BenchmarkPlan planFromJson(const std::string& text) {
  const Json json = Json::parse(text);
  BenchmarkPlan plan;
  for (const Json& row : json.at("sequences")) {
    plan.sequences.push_back({row.at(0), row.at(1)});
  }
  for (const Json& row : json.at("detections")) {
    plan.detections.push_back({row.at(0), row.at(1), row.at(2), row.at(3)});
  }
  for (const Json& row : json.at("cells")) {
    PlannedCell cell;
    cell.unavailable = row.at(0);
    cell.content_hash = row.at(1);
    if (!row.at(2).is_null()) {
      cell.detection = row.at(2).get<std::size_t>();
    }
    cell.lines_folder = row.at(3);
    cell.matches_folder = row.at(4);
    plan.cells.push_back(std::move(cell));
  }
  return plan;
}

}  // namespace evolin::cli
