// Methods, evaluation and recording put together, and the report written with how it came about.
#include "sequence_job.h"

#include <utility>

#include "evolin_ros/base/atomic_file.h"
#include "evolin_ros/base/version.h"
#include "evolin_ros/evaluation/method_source.h"
#include "evolin_ros/evaluation/provenance.h"
#include "worst_frames.h"
#include "yaml_json.h"

namespace evolin::cli {

using Json = nlohmann::ordered_json;

namespace {

WantedParts wantedParts(const MetricFamilies& families) {
  return {families.count(MetricFamily::kRepeatability) + families.count(MetricFamily::kPose) > 0,
          true};
}

/// The plug-in that plays the results in `folder`; "": `method` itself.
MethodChoice playing(const MethodChoice& method, const std::string& folder) {
  if (folder.empty()) {
    return method;
  }
  MethodChoice player;
  player.name = "recorded";
  player.parameters["folder"] = folder;
  return player;
}

}  // namespace

EvaluationSettings readEvaluation(const YAML::Node& evaluation, const std::string& owner) {
  ParameterReader reader(evaluation, owner);
  EvaluationSettings settings = readEvaluationSettings(&reader, owner, 0);
  reader.finish();
  return settings;
}

SequenceJob::SequenceJob(RunRequest request, const RecordingInput& input, PluginLoader* loader)
    : request_(std::move(request)), input_(input) {
  options_.threads = request_.threads;
  options_.evaluation = readEvaluation(request_.evaluation, "evaluation");
  Needs needs;
  chooseDetector(loader, &needs);
  chooseAssociator(loader, &needs);
  reader_ = input_.open(wantedParts(options_.evaluation.pass.families), needs);
}

void SequenceJob::chooseDetector(PluginLoader* loader, Needs* needs) {
  if (!request_.detector) {
    return;
  }
  const MethodChoice& detector = *request_.detector;
  FrontEndOptions& front_end = options_.front_end;
  const MethodChoice used = playing(detector, request_.lines_folder);
  front_end.make_detector = detectorMaker(loader, used);
  front_end.selection = request_.selection;
  front_end.lines_source =
      methodSource(request_.lines_name.empty() ? detector.name : request_.lines_name,
                   detector.parameters, front_end.selection);
  *needs = loader->loadDetector(used.name)->needs();
}

void SequenceJob::chooseAssociator(PluginLoader* loader, Needs* needs) {
  if (!request_.associator) {
    return;
  }
  const MethodChoice& associator = *request_.associator;
  FrontEndOptions& front_end = options_.front_end;
  const MethodChoice used = playing(associator, request_.matches_folder);
  front_end.make_associator = associatorMaker(loader, used);
  front_end.matches_source = methodSource(associator.name, associator.parameters);
  front_end.associate_ground_truth = request_.associate_ground_truth;
  front_end.frame_step = options_.evaluation.pass.frame_step;
  const Needs more = front_end.make_associator()->needs();  // configured: they may depend on it
  needs->depth = needs->depth || more.depth;
  needs->pose = needs->pose || more.pose;
}

/// What was asked for, in the words of the parameters.
std::string SequenceJob::parametersText() const {
  Json parameters = {{"detector", nullptr}};
  if (request_.detector) {
    parameters["detector"] = request_.detector->name;
    parameters["detector_parameters"] = toJson(request_.detector->parameters);
  }
  const LineSelection& selection = request_.selection;
  if (!selection.keepsAll()) {
    parameters["score_threshold"] = selection.score_threshold;
    parameters["min_length"] = selection.min_length;
    parameters["max_lines"] = selection.max_lines;
  }
  parameters["associator"] = nullptr;
  if (request_.associator) {
    parameters["associator"] = request_.associator->name;
    parameters["associator_parameters"] = toJson(request_.associator->parameters);
    parameters["associate"] = request_.associate_ground_truth ? "ground-truth" : "detected";
  }
  parameters.update(toJson(request_.evaluation));
  return parameters.dump(-1, ' ', false, Json::error_handler_t::replace);
}

RunOutcome SequenceJob::run(const std::filesystem::path& folder,
                            const std::function<void(std::size_t)>& progress,
                            const std::function<bool()>& interrupted) {
  WorstFrames worst_frames(static_cast<std::size_t>(request_.worst_frames),
                           options_.evaluation.pass.evaluation.vectorized);
  options_.observer = &worst_frames;
  SequenceRunResult result = runSequence(options_, reader_.get(), progress, interrupted);
  const std::string parameters = parametersText();
  for (Report& report : result.reports) {
    const bool newest = report.pass == result.reports.back().pass;
    if (newest) {
      report.notes.insert(report.notes.begin(), request_.notes.begin(), request_.notes.end());
    }
    addMachine(&report);
    report.provenance["parameters"] = parameters;
    report.provenance["input"] = reader_->provenance();
    report.provenance["sha256"] = request_.hashes;
    writeReport(report, newest ? folder : folder / ("pass_" + std::to_string(report.pass)));
  }
  worst_frames.write(folder);
  writeFileAtomically(folder / kRunMarker,
                      programVersion() + " run\ninput " + input_.names() + "\n" +
                          (result.interrupted ? "incomplete\n" : "complete\n"));
  return {toMarkdown(result.reports.back()), result.interrupted};
}

}  // namespace evolin::cli
