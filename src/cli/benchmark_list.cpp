// Columns as wide as their longest entry.
#include "benchmark_list.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

namespace evolin::cli {

using Json = nlohmann::ordered_json;

std::string cellTable(const std::vector<CellRecord>& records) {
  std::size_t width = 0;
  for (const CellRecord& record : records) {
    width = std::max(width, record.id.size());
  }
  std::string text;
  for (const CellRecord& record : records) {
    text += record.id + std::string(width - record.id.size() + 2, ' ') + toString(record.state) +
            (record.error.empty() ? "" : ": " + record.error) + "\n";
  }
  return text;
}

std::string cellsJson(const BenchmarkContext& context, const std::vector<CellRecord>& records) {
  Json json = Json::parse(matrixJson(context.matrix, records));
  const std::vector<PlannedDetection>& detections = context.plan.detections;
  for (std::size_t i = 0; i < records.size(); ++i) {
    const PlannedCell& cell = context.plan.cells[i];
    json["cells"][i]["detection"] =
        cell.detection ? Json(detections[*cell.detection].id) : Json(nullptr);
  }
  json["detections"] = Json::array();
  for (std::size_t i = 0; i < detections.size(); ++i) {
    json["detections"].push_back(
        {{"id", detections[i].id},
         {"sequence", context.matrix.sequences[detections[i].sequence].name},
         {"detector", context.matrix.detectors[detections[i].detector].name},
         {"content_hash", detections[i].content_hash},
         {"made", isDetectionMade(context, i)}});
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string summaryOf(const std::vector<CellRecord>& records) {
  std::map<CellState, std::size_t> counts;
  std::map<std::string, std::size_t> missing;
  std::string failures;
  for (const CellRecord& record : records) {
    ++counts[record.state];
    if (record.state == CellState::kFailed) {
      failures += "failed  " + record.id + ": " + record.error + "\n";
    } else if (record.state == CellState::kUnavailable) {
      ++missing[record.error];
    }
  }
  std::string text = std::to_string(records.size()) + " cells:";
  const char* separator = " ";
  for (const CellState state :
       {CellState::kFinished, CellState::kFailed, CellState::kUnavailable, CellState::kPending}) {
    if (counts[state] > 0) {
      text += separator + std::to_string(counts[state]) + " " + toString(state);
      separator = ", ";
    }
  }
  text += "\n" + failures;
  for (const auto& [reason, cells] : missing) {
    text += "unavailable (" + std::to_string(cells) + (cells == 1 ? " cell): " : " cells): ") +
            reason + "\n";
  }
  return text;
}

}  // namespace evolin::cli
