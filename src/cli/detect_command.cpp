// `evolin detect`.
#include "detect_command.h"

#include <boost/program_options/value_semantic.hpp>

#include <opencv2/core/utility.hpp>

#include "evolin_ros/evaluation/method_source.h"
#include "method_choice.h"
#include "options.h"
#include "output_folder.h"
#include "recorded_folders.h"
#include "recording_input.h"
#include "selection_options.h"
#include "thread_option.h"

namespace evolin::cli {

namespace po = boost::program_options;

namespace {

constexpr const char* kUsage =
    "Writes the lines that a detector finds in a bag or dataset folder in EVOLIN's layout: "
    "lines/NAME.csv and, where the detector gives scores, scores/NAME.csv for every image, and "
    "stamps.txt. NAME is the stem of the image's file; of a bag, its number. The published scripts "
    "and 'evolin evaluate' read such folders, and the detector 'recorded' plays them back "
    "(--detector recorded:folder=DIR).\n\n"
    "Usage: evolin detect --input BAG|DIR --detector NAME[:key=value,...] --output DIR [OPTIONS]";

constexpr const char* kMarker = "detect.txt";

struct DetectOptions {
  RecordingInput input;
  std::string detector;
  std::string config;
  SelectionOptions selection;
  std::string output;
  int threads = 0;
  bool quiet = false;
};

po::options_description describe(DetectOptions* options) {
  po::options_description description = options->input.describe();
  po::options_description method("Detector and output");
  auto add = method.add_options();
  add("detector,d", po::value(&options->detector)->value_name("NAME[:key=value,...]")->required(),
      "plug-in ('evolin list' names them) with its parameters");
  add("detector-config", po::value(&options->config)->value_name("FILE"),
      "YAML file of its parameters; those of --detector go over it");
  options->selection.describe(&method);
  add("output,o", po::value(&options->output)->value_name("DIR")->required(),
      "folder to write; one that 'evolin detect' made before is replaced");
  add("threads", po::value(&options->threads)->value_name("N")->default_value(0), kThreadsHelp);
  add("quiet,q", po::bool_switch(&options->quiet), "no progress");
  return description.add(method);
}

int runDetect(const std::vector<std::string>& arguments) {
  DetectOptions options;
  po::variables_map given;
  if (!parseOptions(kUsage, describe(&options), arguments, &given)) {
    return kExitDone;
  }
  options.input.check(given);
  options.selection.check();
  const int threads = checkedThreads(options.threads);
  const MethodChoice choice = parseMethod("--detector", options.detector, options.config);
  cv::setNumThreads(1);  // images go to threads as wholes
  PluginLoader loader;
  WorkerPool pool(threads);
  FrontEndOptions front_end_options;
  Needs needs;
  front_end_options.make_detector = detectorMaker(&loader, choice, &needs);
  front_end_options.selection = options.selection.selection;
  front_end_options.lines_source =
      methodSource(choice.name, choice.parameters, options.selection.selection);
  FrontEnd front_end(front_end_options, &pool);
  const std::unique_ptr<PartReader> reader = options.input.open({false, false}, needs);

  OutputFolder folder(options.output, kMarker, true);
  LineRecorder recorder(folder.path(), front_end.givesScores());
  const bool complete = record(reader.get(), &front_end, &recorder, options.quiet);
  if (recorder.images() == 0) {
    throw Error(options.input.names() + ": no image is in the chosen part of the recording");
  }
  recorder.finish();
  const std::string summary =
      std::to_string(recorder.lines()) + " lines of " + front_end_options.lines_source + " in " +
      std::to_string(recorder.frames()) + " of " + std::to_string(recorder.images()) + " images";
  conclude(&folder, {options.output, kMarker, "detect\ninput " + options.input.names(), summary,
                     recorder.notes(), complete});
  return kExitDone;
}

}  // namespace

Command detectCommand() {
  return {"detect", "lines of a sequence to a folder in EVOLIN's layout", runDetect};
}

}  // namespace evolin::cli
