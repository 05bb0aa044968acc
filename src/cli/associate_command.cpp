// `evolin associate`.
#include "associate_command.h"

#include <boost/program_options/value_semantic.hpp>

#include <opencv2/core/utility.hpp>

#include "evolin_ros/evaluation/method_source.h"
#include "method_choice.h"
#include "options.h"
#include "output_folder.h"
#include "recorded_folders.h"
#include "recording_input.h"
#include "thread_option.h"

namespace evolin::cli {

namespace po = boost::program_options;

namespace {

constexpr const char* kUsage =
    "Writes the matches that an associator finds between frames of a bag or dataset folder as "
    "index "
    "pairs: associations/FIRST_SECOND.csv for every pair of frames, and stamps.txt. FIRST and "
    "SECOND are the stems of the images' files; of a bag, their numbers. The lines are those of "
    "--lines, else the recording's ground truth. The published scripts and 'evolin evaluate' read "
    "such folders, and the associator 'recorded' plays them back (--associator "
    "recorded:folder=DIR).\n\n"
    "Usage: evolin associate --input BAG|DIR --associator NAME[:key=value,...] --output DIR "
    "[OPTIONS]";

constexpr const char* kMarker = "associate.txt";

struct AssociateOptions {
  RecordingInput input;
  std::string lines;
  std::string associator;
  std::string config;
  int frame_step = 1;
  std::string output;
  int threads = 0;
  bool quiet = false;
};

po::options_description describe(AssociateOptions* options) {
  po::options_description description = options->input.describe();
  po::options_description method("Associator and output");
  auto add = method.add_options();
  add("associator,a",
      po::value(&options->associator)->value_name("NAME[:key=value,...]")->required(),
      "plug-in ('evolin list' names them) with its parameters");
  add("associator-config", po::value(&options->config)->value_name("FILE"),
      "YAML file of its parameters; those of --associator go over it");
  add("lines", po::value(&options->lines)->value_name("DIR"),
      "folder of lines with stamps.txt, as 'evolin detect' writes it; without it the ground truth");
  add("frame-step", po::value(&options->frame_step)->value_name("N")->default_value(1),
      "frames with lines from the first to the second of a pair");
  add("output,o", po::value(&options->output)->value_name("DIR")->required(),
      "folder to write; one that 'evolin associate' made before is replaced");
  add("threads", po::value(&options->threads)->value_name("N")->default_value(0), kThreadsHelp);
  add("quiet,q", po::bool_switch(&options->quiet), "no progress");
  return description.add(method);
}

int runAssociate(const std::vector<std::string>& arguments) {
  AssociateOptions options;
  po::variables_map given;
  if (!parseOptions(kUsage, describe(&options), arguments, &given)) {
    return kExitDone;
  }
  options.input.check(given);
  if (options.frame_step < 1) {
    throw UsageError("--frame-step: expected 1 or more");
  }
  const int threads = checkedThreads(options.threads);
  const MethodChoice choice = parseMethod("--associator", options.associator, options.config);
  cv::setNumThreads(1);  // frames go to threads as wholes
  PluginLoader loader;
  WorkerPool pool(threads);
  FrontEndOptions front_end_options;
  Needs needs;
  front_end_options.make_associator = associatorMaker(&loader, choice, &needs);
  front_end_options.matches_source = methodSource(choice.name, choice.parameters);
  front_end_options.frame_step = options.frame_step;
  front_end_options.associate_ground_truth = options.lines.empty();
  if (!options.lines.empty()) {
    MethodChoice recorded;
    recorded.name = "recorded";
    recorded.parameters["folder"] = options.lines;
    front_end_options.make_detector = detectorMaker(&loader, recorded, &needs);
    front_end_options.lines_source = options.lines;
  }
  FrontEnd front_end(front_end_options, &pool);
  const std::unique_ptr<PartReader> reader =
      options.input.open({false, options.lines.empty()}, needs);

  OutputFolder folder(options.output, kMarker, true);
  MatchRecorder recorder(folder.path());
  const bool complete = record(reader.get(), &front_end, &recorder, options.quiet);
  if (recorder.pairs() == 0) {
    std::string why;
    for (const std::string& note : recorder.notes()) {
      why += "; " + note;
    }
    throw Error(
        options.input.names() + ": no pair of frames has lines, expected " +
        (options.lines.empty() ? "ground truth (or --lines)" : "lines of " + options.lines) +
        " for frames " + std::to_string(options.frame_step) + " apart" + why);
  }
  recorder.finish();
  const std::string summary = std::to_string(recorder.matches()) + " matches of " +
                              front_end_options.matches_source + " in " +
                              std::to_string(recorder.pairs()) + " pairs of " +
                              std::to_string(recorder.images()) + " images";
  conclude(&folder, {options.output, kMarker,
                     "associate\ninput " + options.input.names() + "\nframe step " +
                         std::to_string(options.frame_step),
                     summary, recorder.notes(), complete});
  return kExitDone;
}

}  // namespace

Command associateCommand() {
  return {"associate", "index pairs of matched lines to a folder in EVOLIN's layout", runAssociate};
}

}  // namespace evolin::cli
