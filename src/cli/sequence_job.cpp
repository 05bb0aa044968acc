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

std::string absolute(const std::string& folder) {
  return folder.empty() ? folder : std::filesystem::absolute(folder).string();
}

}  // namespace

EvaluationSettings readEvaluation(const YAML::Node& evaluation, const std::string& owner) {
  ParameterReader reader(evaluation, owner);
  EvaluationSettings settings = readEvaluationSettings(&reader, owner, 0);
  reader.finish();
  return settings;
}

ChosenFrontEnd chooseFrontEnd(const RunRequest& request, int frame_step, PluginLoader* loader) {
  ChosenFrontEnd chosen;
  FrontEndOptions& options = chosen.options;
  if (request.detector) {
    const MethodChoice& detector = *request.detector;
    options.make_detector =
        detectorMaker(loader, playing(detector, request.lines_folder), &chosen.needs);
    options.selection = request.selection;
    options.lines_source =
        methodSource(request.lines_name.empty() ? detector.name : request.lines_name,
                     detector.parameters, request.selection);
  }
  if (request.associator) {
    const MethodChoice& associator = *request.associator;
    options.make_associator =
        associatorMaker(loader, playing(associator, request.matches_folder), &chosen.needs);
    options.matches_source = methodSource(associator.name, associator.parameters);
    options.associate_ground_truth = request.associate_ground_truth;
    options.frame_step = frame_step;
  }
  return chosen;
}

SequenceJob::SequenceJob(RunRequest request, const RecordingInput& input, PluginLoader* loader)
    : request_(std::move(request)), input_(input) {
  options_.threads = request_.threads;
  options_.evaluation = readEvaluation(request_.evaluation, "evaluation");
  ChosenFrontEnd chosen = chooseFrontEnd(request_, options_.evaluation.pass.frame_step, loader);
  options_.front_end = std::move(chosen.options);
  reader_ = input_.open(wantedParts(options_.evaluation.pass.families), chosen.needs);
}

/// What was asked for, in the words of the parameters.
std::string SequenceJob::parametersText() const {
  Json parameters = {{"detector", nullptr}};
  const auto tell = [&parameters](const char* name, const std::string& value) {
    if (!value.empty()) {
      parameters[name] = value;
    }
  };
  if (request_.detector) {
    parameters["detector"] = request_.detector->name;
    parameters["detector_parameters"] = toJson(request_.detector->parameters);
    tell("source", request_.lines_name);
    tell("lines_folder", absolute(request_.lines_folder));
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
    tell("matches_folder", absolute(request_.matches_folder));
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
  const std::string input_options =
      Json(input_.options()).dump(-1, ' ', false, Json::error_handler_t::replace);
  for (Report& report : result.reports) {
    const bool newest = report.pass == result.reports.back().pass;
    if (newest) {
      report.notes.insert(report.notes.begin(), request_.notes.begin(), request_.notes.end());
    }
    addMachine(&report);
    report.provenance["parameters"] = parameters;
    report.provenance["input"] = reader_->provenance();
    report.provenance["input_options"] = input_options;
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
