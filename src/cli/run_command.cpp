// `evolin run`.
#include "run_command.h"

#include <boost/program_options/value_semantic.hpp>

#include <iostream>
#include <opencv2/core/utility.hpp>
#include <optional>

#include "evolin_ros/base/text.h"
#include "interrupt.h"
#include "method_choice.h"
#include "options.h"
#include "output_folder.h"
#include "progress.h"
#include "recording_input.h"
#include "selection_options.h"
#include "sequence_job.h"
#include "thread_option.h"

namespace evolin::cli {

namespace po = boost::program_options;

namespace {

constexpr const char* kUsage =
    "Runs a detector and an associator over a bag or dataset folder and scores them, with no topic "
    "between, as fast as the machine allows: the report is that of the evaluator nodelet when "
    "nothing was dropped. DIR gets report.json, summary.md, tables of frames and pairs, and "
    "trajectories.\n\n"
    "Usage: evolin run --input BAG|DIR --detector NAME[:key=value,...] "
    "[--associator NAME[:key=value,...]] --output DIR [OPTIONS]";

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

RunRequest requestOf(const RunOptions& options) {
  RunRequest request;
  request.detector = parseMethod("--detector", options.detector, options.detector_config);
  request.lines_name = options.detector_source;
  request.selection = options.selection.selection;
  if (!options.associator.empty()) {
    request.associator = parseMethod("--associator", options.associator, options.associator_config);
    request.associate_ground_truth = options.associate == "ground-truth";
  }
  request.evaluation = evaluationParameters(options);
  request.threads = options.threads;
  request.worst_frames = options.worst_frames;
  return request;
}

int runRun(const std::vector<std::string>& arguments) {
  RunOptions options;
  po::variables_map given;
  if (!parseOptions(kUsage, describe(&options), arguments, &given)) {
    return kExitDone;
  }
  check(&options, given);
  RunRequest request = requestOf(options);
  try {
    readEvaluation(request.evaluation, "--set");
  } catch (const ConfigError& error) {
    throw UsageError(error.what());
  }
  cv::setNumThreads(1);  // frames go to threads as wholes
  PluginLoader loader;
  request.hashes = options.input.hashes();
  SequenceJob job(std::move(request), options.input, &loader);

  const InterruptGuard guard;
  OutputFolder folder(options.output, kRunMarker, true);
  std::optional<Progress> progress;
  if (!options.quiet) {
    progress.emplace("frames", job.images());
  }
  std::size_t done = 0;
  const RunOutcome outcome = job.run(
      folder.path(),
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
  folder.commit();
  std::cout << outcome.summary;
  if (outcome.interrupted) {
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
