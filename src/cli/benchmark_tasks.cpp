// Detection by the plug-in, then cells that play its lines.
#include "benchmark_tasks.h"

#include <fstream>
#include <opencv2/core/utility.hpp>
#include <sstream>

#include "command.h"
#include "evolin_ros/base/atomic_file.h"
#include "evolin_ros/base/stop_watch.h"
#include "evolin_ros/base/version.h"
#include "evolin_ros/benchmarking/cell_record.h"
#include "file_lock.h"
#include "interrupt.h"
#include "output_folder.h"
#include "plugin_loader.h"
#include "recorded_folders.h"
#include "sequence_job.h"
#include "synthetic_folder.h"
#include "yaml_json.h"

namespace evolin::cli {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

/// Hidden beside the folder that it guards.
fs::path lockOf(const fs::path& folder) {
  fs::create_directories(folder.parent_path());
  return folder.parent_path() / ("." + folder.filename().string() + ".lock");
}

Json readJson(const fs::path& file) {
  std::ifstream stream(file);
  return Json::parse(stream, nullptr, false);
}

MethodChoice choiceOf(const BenchmarkMethod& method) {
  MethodChoice choice;
  choice.name = method.plugin.empty() ? method.name : method.plugin;
  choice.parameters = YAML::Clone(method.parameters);
  return choice;
}

void writeLines(const BenchmarkContext& context, const PlannedDetection& detection,
                const fs::path& folder) {
  const StopWatch watch;
  RunRequest request;
  request.detector = choiceOf(context.matrix.detectors[detection.detector]);
  const MethodChoice& choice = *request.detector;
  RecordingInput input;
  setInput(context.matrix.sequences[detection.sequence], context.root, &input);
  PluginLoader loader;
  WorkerPool pool(1);
  const ChosenFrontEnd chosen = chooseFrontEnd(request, 1, &loader);
  FrontEnd front_end(chosen.options, &pool);
  const std::unique_ptr<PartReader> reader = input.open({false, false}, chosen.needs);
  LineRecorder recorder(folder, front_end.givesScores());
  if (!record(reader.get(), &front_end, &recorder, true)) {
    throw Interrupted("interrupted");
  }
  if (recorder.frames() == 0) {
    throw Error(input.names() + ": no image has lines of " + chosen.options.lines_source +
                (recorder.notes().empty() ? "" : "; " + recorder.notes().front()));
  }
  recorder.finish();
  const Json record = {{"id", detection.id},
                       {"sequence", context.matrix.sequences[detection.sequence].name},
                       {"detector", context.matrix.detectors[detection.detector].name},
                       {"plugin", choice.name},
                       {"parameters", toJson(choice.parameters)},
                       {"content_hash", detection.content_hash},
                       {"program_version", programVersion()},
                       {"images", recorder.images()},
                       {"frames", recorder.frames()},
                       {"lines", recorder.lines()},
                       {"seconds", watch.seconds()},
                       {"notes", recorder.notes()}};
  writeFileAtomically(folder / kDetectionFile,
                      record.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

RunRequest requestOf(const BenchmarkContext& context, std::size_t place) {
  const BenchmarkCell& cell = context.matrix.cells[place];
  const PlannedCell& planned = context.plan.cells[place];
  const BenchmarkSetting& setting = context.matrix.settings[cell.setting];
  RunRequest request;
  if (cell.detector) {
    request.detector = choiceOf(context.matrix.detectors[*cell.detector]);
    request.lines_name = context.matrix.detectors[*cell.detector].name;
    request.lines_folder = planned.lines_folder;
  }
  if (planned.detection) {
    const fs::path folder =
        detectionFolder(context.root, context.plan.detections[*planned.detection].id);
    request.lines_folder = folder.string();
    const Json made = readJson(folder / kDetectionFile);
    for (const Json& note : made.at("notes")) {
      request.notes.push_back("detection: " + note.get<std::string>());
    }
  }
  if (cell.associator) {
    request.associator = choiceOf(context.matrix.associators[*cell.associator]);
    request.matches_folder = planned.matches_folder;
    request.associate_ground_truth = setting.associate_ground_truth;
  }
  request.selection = cell.selection;
  request.evaluation = YAML::Clone(cell.evaluation);
  request.hashes = Json{{context.matrix.sequences[cell.sequence].name,
                         context.plan.sequences[cell.sequence].digest}}
                       .dump();
  return request;
}

CellRecord recordOf(const BenchmarkContext& context, std::size_t cell) {
  CellRecord record = evolin::recordOf(context.matrix, context.matrix.cells[cell]);
  record.content_hash = context.plan.cells[cell].content_hash;
  return record;
}

}  // namespace

bool isSequenceMade(const BenchmarkContext& context, std::size_t sequence) {
  const BenchmarkSequence& wanted = context.matrix.sequences[sequence];
  if (!wanted.synthetic) {
    return true;
  }
  std::ifstream file(sequenceFolder(context.root, wanted.name) / kSynthMarker);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str() == describeSequence(*wanted.synthetic);
}

bool isDetectionMade(const BenchmarkContext& context, std::size_t detection) {
  const PlannedDetection& wanted = context.plan.detections[detection];
  const Json made = readJson(detectionFolder(context.root, wanted.id) / kDetectionFile);
  return made.is_object() && made.value("content_hash", "") == wanted.content_hash;
}

void makeSequence(const BenchmarkContext& context, std::size_t sequence) {
  const BenchmarkSequence& wanted = context.matrix.sequences[sequence];
  const fs::path folder = sequenceFolder(context.root, wanted.name);
  const FileLock lock(lockOf(folder));
  if (isSequenceMade(context, sequence)) {
    return;
  }
  OutputFolder output(folder, kSynthMarker, true);
  fillSyntheticFolder(*wanted.synthetic, 1, true, output.path());
  output.commit();
}

void makeDetection(const BenchmarkContext& context, std::size_t detection) {
  const PlannedDetection& wanted = context.plan.detections[detection];
  const fs::path folder = detectionFolder(context.root, wanted.id);
  const FileLock lock(lockOf(folder));
  if (isDetectionMade(context, detection)) {
    return;
  }
  cv::setNumThreads(1);  // cells run beside each other
  OutputFolder output(folder, kDetectionFile, true);
  writeLines(context, wanted, output.path());
  output.commit();
}

void runCell(const BenchmarkContext& context, std::size_t cell) {
  const StopWatch watch;
  const InterruptGuard guard;
  cv::setNumThreads(1);
  PluginLoader loader;
  RecordingInput input;
  setInput(context.matrix.sequences[context.matrix.cells[cell].sequence], context.root, &input);
  SequenceJob job(requestOf(context, cell), input, &loader);
  OutputFolder output(cellFolder(context.root, context.matrix.cells[cell].id), kCellFile, true);
  const RunOutcome outcome = job.run(
      output.path(), [](std::size_t /*images*/) {}, [&guard] { return guard.interrupted(); });
  if (outcome.interrupted) {
    throw Interrupted("interrupted");
  }
  CellRecord record = recordOf(context, cell);
  record.state = CellState::kFinished;
  record.seconds = watch.seconds();
  writeCellRecord(record, output.path());
  output.commit();
}

void recordCell(const BenchmarkContext& context, std::size_t cell, CellState state,
                const std::string& error) {
  CellRecord record = recordOf(context, cell);
  record.state = state;
  record.error = error;
  OutputFolder output(cellFolder(context.root, record.id), kCellFile, true);
  writeCellRecord(record, output.path());
  output.commit();
}

}  // namespace evolin::cli
