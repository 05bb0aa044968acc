// Records as strict JSON.
#include "evolin_ros/benchmarking/cell_record.h"

#include <fstream>
#include <nlohmann/json.hpp>

#include "evolin_ros/base/atomic_file.h"
#include "evolin_ros/base/version.h"

namespace evolin {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

constexpr int kIndent = 2;

std::string text(const Json& json) {
  // Messages may hold bytes of anybody's file names.
  return json.dump(kIndent, ' ', false, Json::error_handler_t::replace) + "\n";
}

Json orNull(const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); }

std::optional<CellState> parseState(const std::string& text) {
  for (const CellState state :
       {CellState::kPending, CellState::kFinished, CellState::kFailed, CellState::kUnavailable}) {
    if (toString(state) == text) {
      return state;
    }
  }
  return std::nullopt;
}

}  // namespace

std::string toString(CellState state) {
  switch (state) {
    case CellState::kFinished:
      return "finished";
    case CellState::kFailed:
      return "failed";
    case CellState::kUnavailable:
      return "unavailable";
    case CellState::kPending:
      break;
  }
  return "pending";
}

CellRecord recordOf(const BenchmarkMatrix& matrix, const BenchmarkCell& cell) {
  CellRecord record;
  record.id = cell.id;
  record.sequence = matrix.sequences[cell.sequence].name;
  record.detector = detectorName(matrix, cell);
  record.associator = associatorName(matrix, cell);
  record.setting = matrix.settings[cell.setting].name;
  record.program_version = programVersion();
  return record;
}

std::optional<CellRecord> readCellRecord(const fs::path& folder) {
  std::ifstream file(folder / kCellFile);
  const Json json = Json::parse(file, nullptr, false);
  if (!json.is_object()) {
    return std::nullopt;
  }
  try {
    CellRecord record;
    record.id = json.at("id");
    record.sequence = json.at("sequence");
    record.detector = json.at("detector");
    record.associator = json.at("associator");
    record.setting = json.at("setting");
    record.content_hash = json.at("content_hash").is_null() ? "" : json.at("content_hash");
    record.program_version = json.at("program_version");
    record.error = json.at("error").is_null() ? "" : json.at("error");
    record.seconds = json.at("seconds");
    const std::optional<CellState> state = parseState(json.at("state"));
    record.state = state.value_or(CellState::kPending);
    return state ? std::make_optional(record) : std::nullopt;
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

void writeCellRecord(const CellRecord& record, const fs::path& folder) {
  writeFileAtomically(folder / kCellFile, text({{"id", record.id},
                                                {"sequence", record.sequence},
                                                {"detector", record.detector},
                                                {"associator", record.associator},
                                                {"setting", record.setting},
                                                {"content_hash", orNull(record.content_hash)},
                                                {"program_version", record.program_version},
                                                {"state", toString(record.state)},
                                                {"error", orNull(record.error)},
                                                {"seconds", record.seconds}}));
}

CellRecord stateOf(CellRecord wanted, const fs::path& folder) {
  const std::optional<CellRecord> found = readCellRecord(folder);
  if (!found || found->id != wanted.id || found->content_hash != wanted.content_hash ||
      wanted.content_hash.empty()) {
    return wanted;
  }
  const bool usable = found->state == CellState::kFailed ||
                      (found->state == CellState::kFinished && fs::exists(folder / "report.json"));
  return usable ? *found : wanted;
}

std::string matrixJson(const BenchmarkMatrix& matrix, const std::vector<CellRecord>& records) {
  Json cells = Json::array();
  for (std::size_t i = 0; i < records.size(); ++i) {
    const CellRecord& record = records[i];
    const BenchmarkCell& cell = matrix.cells[i];
    const std::optional<std::size_t>& detector = cell.detector;
    const std::optional<std::size_t>& associator = cell.associator;
    cells.push_back(
        {{"id", record.id},
         {"sequence", record.sequence},
         {"detector", record.detector},
         {"detector_label", detector ? Json(matrix.detectors[*detector].label) : Json(nullptr)},
         {"associator", record.associator},
         {"associator_label",
          associator ? Json(matrix.associators[*associator].label) : Json(nullptr)},
         {"setting", record.setting},
         {"content_hash", orNull(record.content_hash)},
         {"state", toString(record.state)},
         {"reason", orNull(record.error)}});
  }
  return text({{"program_version", programVersion()}, {"cells", std::move(cells)}});
}

}  // namespace evolin
