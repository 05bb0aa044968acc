// `evolin run`.
#include "run_command.h"

#include <boost/program_options/value_semantic.hpp>

#include <iostream>
#include <nlohmann/json.hpp>
#include <opencv2/core/utility.hpp>
#include <optional>

#include "evolin_ros/base/atomic_file.h"
#include "evolin_ros/base/text.h"
#include "evolin_ros/base/version.h"
#include "evolin_ros/evaluation/method_source.h"
#include "evolin_ros/evaluation/provenance.h"
#include "evolin_ros/evaluation/sequence_run.h"
#include "interrupt.h"
#include "method_choice.h"
#include "options.h"
#include "output_folder.h"
#include "progress.h"
#include "recording_input.h"
#include "selection_options.h"
#include "thread_option.h"
#include "worst_frames.h"

namespace evolin::cli {

namespace po = boost::program_options;
using Json = nlohmann::ordered_json;

namespace {

constexpr const char* kUsage =
    "Runs a detector and an associator over a bag or dataset folder and scores them, with no topic "
    "between, as fast as the machine allows: the report is that of the evaluator nodelet when "
    "nothing was dropped. DIR gets report.json, summary.md, tables of frames and pairs, and "
    "trajectories.\n\n"
    "Usage: evolin run --input BAG|DIR --detector NAME[:key=value,...] "
    "[--associator NAME[:key=value,...]] --output DIR [OPTIONS]";

constexpr const char* kMarker = "run.txt";

struct RunOptions {
  RecordingInput input;
  std::string detector;
  std::string detector_config;
  std::string detector_source;
  SelectionOptions selection;
  std::string associator;
  std::string associator_config;
  std::string associate = "ground-truth";
  int frame_step = 1;
  std::string metrics;
  std::string protocol = "evolin";
  std::vector<std::string> settings;
  int bootstrap = static_cast<int>(BootstrapOptions().resamples);
  std::string output;
  int threads = 0;
  int worst_frames = 6;
  bool quiet = false;
};

void describeMethods(RunOptions* options, po::options_description* description) {
  auto add = description->add_options();
  add("detector,d", po::value(&options->detector)->value_name("NAME[:key=value,...]")->required(),
      "plug-in ('evolin list' names them) with its parameters");
  add("detector-config", po::value(&options->detector_config)->value_name("FILE"),
      "YAML file of its parameters; those of --detector go over it");
  add("source", po::value(&options->detector_source)->value_name("NAME"),
      "name of the lines in the report; without it the detector's");
  options->selection.describe(description);
  add("associator,a", po::value(&options->associator)->value_name("NAME[:key=value,...]"),
      "plug-in with its parameters; without it nothing is associated");
  add("associator-config", po::value(&options->associator_config)->value_name("FILE"),
      "YAML file of its parameters; those of --associator go over it");
  add("associate",
      po::value(&options->associate)->value_name("LINES")->default_value(options->associate),
      "lines to associate: ground-truth (the article's protocol) or detected");
  add("frame-step", po::value(&options->frame_step)->value_name("N")->default_value(1),
      "frames with lines from the first to the second of a pair");
}

po::options_description describe(RunOptions* options) {
  po::options_description description = options->input.describe();
  po::options_description methods("Methods");
  describeMethods(options, &methods);
  po::options_description evaluation("Evaluation and output");
  auto add = evaluation.add_options();
  add("metrics,m", po::value(&options->metrics)->value_name("FAMILY,..."),
      "detection, heatmap, repeatability, association, pose, tracks; without it all");
  add("protocol",
      po::value(&options->protocol)->value_name("NAME")->default_value(options->protocol),
      "evolin (the published implementation's numbers) or paper (the article's formulas)");
  add("set", po::value(&options->settings)->value_name("KEY=VALUE")->composing(),
      "any parameter of the evaluator nodelet that is the evaluation's own, for example "
      "--set repeatability_steps=[1,5]; again for more");
  add("bootstrap",
      po::value(&options->bootstrap)->value_name("N")->default_value(options->bootstrap),
      "resamples for 95 % intervals, 0: none");
  add("output,o", po::value(&options->output)->value_name("DIR")->required(),
      "folder to write; one that 'evolin run' made before is replaced");
  add("worst-frames", po::value(&options->worst_frames)->value_name("N")->default_value(6),
      "pictures of the frames with the lowest F-score, for 'evolin report --html'; 0: none");
  add("threads", po::value(&options->threads)->value_name("N")->default_value(0), kThreadsHelp);
  add("quiet,q", po::bool_switch(&options->quiet), "no progress");
  return description.add(methods).add(evaluation);
}

YAML::Node evaluationParameters(const RunOptions& options) {
  YAML::Node parameters(YAML::NodeType::Map);
  parameters["protocol"] = options.protocol;
  parameters["frame_step"] = std::to_string(options.frame_step);
  if (!options.metrics.empty()) {
    for (const std::string_view name : split(options.metrics, ',')) {
      parameters["metrics"].push_back(std::string(trim(name)));
    }
  }
  parameters["bootstrap"] = std::to_string(options.bootstrap);
  for (const std::string& text : options.settings) {
    parseAssignments("--set", text, &parameters);
  }
  return parameters;
}

EvaluationSettings readSettings(const YAML::Node& parameters) {
  try {
    ParameterReader reader(parameters, "--set");
    EvaluationSettings settings = readEvaluationSettings(&reader, "--set", 0);
    reader.finish();
    return settings;
  } catch (const ConfigError& error) {
    throw UsageError(error.what());
  }
}

Json toJson(const YAML::Node& node) {
  if (node.IsMap()) {
    Json object = Json::object();
    for (const auto& entry : node) {
      object[entry.first.Scalar()] = toJson(entry.second);
    }
    return object;
  }
  if (node.IsSequence()) {
    Json list = Json::array();
    for (const auto& entry : node) {
      list.push_back(toJson(entry));
    }
    return list;
  }
  if (!node.IsScalar()) {
    return nullptr;
  }
  Json value = Json::parse(node.Scalar(), nullptr, false);
  return value.is_discarded() ? Json(node.Scalar()) : value;
}

/// What was asked for, in the words of the parameters.
std::string parametersText(const RunOptions& options, const MethodChoice& detector,
                           const std::optional<MethodChoice>& associator,
                           const YAML::Node& evaluation) {
  const LineSelection& selection = options.selection.selection;
  Json parameters = {{"detector", detector.name},
                     {"detector_parameters", toJson(detector.parameters)}};
  if (!selection.keepsAll()) {
    parameters["score_threshold"] = selection.score_threshold;
    parameters["min_length"] = selection.min_length;
    parameters["max_lines"] = selection.max_lines;
  }
  parameters["associator"] = associator ? Json(associator->name) : Json(nullptr);
  if (associator) {
    parameters["associator_parameters"] = toJson(associator->parameters);
    parameters["associate"] = options.associate;
  }
  parameters.update(toJson(evaluation));
  return parameters.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// One pass in the folder itself, those before it in pass_N.
void writeReports(std::vector<Report> reports, const std::string& parameters,
                  const std::string& input, const std::string& hashes,
                  const std::filesystem::path& folder) {
  for (Report& report : reports) {
    addMachine(&report);
    report.provenance["parameters"] = parameters;
    report.provenance["input"] = input;
    report.provenance["sha256"] = hashes;
    const bool newest = report.pass == reports.back().pass;
    writeReport(report, newest ? folder : folder / ("pass_" + std::to_string(report.pass)));
  }
}

void check(RunOptions* options, const po::variables_map& given) {
  options->input.check(given);
  options->selection.check();
  options->threads = checkedThreads(options->threads);
  if (options->associate != "ground-truth" && options->associate != "detected") {
    throw UsageError("--associate: is " + quote(options->associate) +
                     ", expected ground-truth or detected");
  }
  if (options->worst_frames < 0) {
    throw UsageError("--worst-frames: is " + std::to_string(options->worst_frames) +
                     ", expected 0 or more");
  }
  if (options->frame_step < 1) {
    throw UsageError("--frame-step: is " + std::to_string(options->frame_step) +
                     ", expected 1 or more");
  }
}

WantedParts wantedParts(const MetricFamilies& families) {
  return {families.count(MetricFamily::kRepeatability) + families.count(MetricFamily::kPose) > 0,
          true};
}

int runRun(const std::vector<std::string>& arguments) {
  RunOptions options;
  po::variables_map given;
  if (!parseOptions(kUsage, describe(&options), arguments, &given)) {
    return kExitDone;
  }
  check(&options, given);
  const YAML::Node evaluation = evaluationParameters(options);
  cv::setNumThreads(1);  // frames go to threads as wholes
  PluginLoader loader;
  SequenceRunOptions run;
  run.threads = options.threads;
  run.evaluation = readSettings(evaluation);
  FrontEndOptions& front_end = run.front_end;
  const MethodChoice detector =
      parseMethod("--detector", options.detector, options.detector_config);
  front_end.make_detector = detectorMaker(&loader, detector);
  front_end.selection = options.selection.selection;
  front_end.lines_source =
      methodSource(options.detector_source.empty() ? detector.name : options.detector_source,
                   detector.parameters, front_end.selection);
  Needs needs = loader.loadDetector(detector.name)->needs();
  std::optional<MethodChoice> associator;
  if (!options.associator.empty()) {
    associator = parseMethod("--associator", options.associator, options.associator_config);
    front_end.make_associator = associatorMaker(&loader, *associator);
    front_end.matches_source = methodSource(associator->name, associator->parameters);
    front_end.associate_ground_truth = options.associate == "ground-truth";
    front_end.frame_step = run.evaluation.pass.frame_step;
    const Needs more = loader.loadAssociator(associator->name)->needs();
    needs.depth = needs.depth || more.depth;
    needs.pose = needs.pose || more.pose;
  }
  const std::unique_ptr<PartReader> reader =
      options.input.open(wantedParts(run.evaluation.pass.families), needs);

  WorstFrames worst_frames(static_cast<std::size_t>(options.worst_frames),
                           run.evaluation.pass.evaluation.vectorized);
  run.observer = &worst_frames;

  const InterruptGuard guard;
  OutputFolder folder(options.output, kMarker, true);
  std::optional<Progress> progress;
  if (!options.quiet) {
    progress.emplace("frames", reader->images());
  }
  std::size_t done = 0;
  SequenceRunResult result = runSequence(
      run, reader.get(),
      [&](std::size_t images) {
        done = images;
        if (progress) {
          progress->update(images);
        }
      },
      [&guard] { return guard.interrupted(); });
  if (progress) {
    progress->finish(done);
  }
  const std::string summary = toMarkdown(result.reports.back());
  writeReports(std::move(result.reports), parametersText(options, detector, associator, evaluation),
               reader->provenance(), options.input.hashes(), folder.path());
  worst_frames.write(folder.path());
  writeFileAtomically(folder.path() / kMarker,
                      programVersion() + " run\ninput " + options.input.names() + "\n" +
                          (result.interrupted ? "incomplete\n" : "complete\n"));
  folder.commit();
  std::cout << summary;
  if (result.interrupted) {
    throw Interrupted("interrupted; the report of what was done stands in " + options.output +
                      ", marked incomplete");
  }
  return kExitDone;
}

}  // namespace

Command runCommand() {
  return {"run", "detector, associator and evaluation over a bag or folder, report out", runRun};
}

}  // namespace evolin::cli
