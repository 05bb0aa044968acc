// `evolin render`: the run's front-end once more, with pictures instead of figures.
#include "render_command.h"

#include <algorithm>
#include <boost/program_options/cmdline.hpp>
#include <boost/program_options/value_semantic.hpp>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <opencv2/core/utility.hpp>
#include <optional>

#include "evolin_ros/base/text.h"
#include "evolin_ros/dataset/image_file.h"
#include "frame_pictures.h"
#include "method_choice.h"
#include "options.h"
#include "recorded_folders.h"
#include "recording_input.h"
#include "sequence_job.h"
#include "thread_option.h"
#include "video_file.h"

namespace evolin::cli {

namespace po = boost::program_options;
namespace fs = std::filesystem;
using Json = nlohmann::json;

namespace {

constexpr const char* kUsage =
    "Pictures of a run that 'evolin run' has made: found lines blue, false ones orange, missed "
    "ones white and dashed, with legend and figures in the margin; or matched lines of two frames "
    "side by side. Detector, associator, their parameters and the options of the input are those "
    "of the run's report and work once more on its recording (--input where that has moved).\n\n"
    "Usage: evolin render --run DIR --output DIR|FILE.mp4|FILE.gif [OPTIONS]";

constexpr const char* kMarker = "render.txt";

struct RenderOptions {
  std::string run;
  RecordingInput input;
  std::string picture = "lines";
  double threshold = 5;
  double scale = 1;
  double rate = 10;
  std::string output;
  int threads = 0;
  bool force = false;
  bool quiet = false;
};

po::options_description describe(RenderOptions* options) {
  po::options_description description("Run and pictures");
  auto add = description.add_options();
  add("run,r", po::value(&options->run)->value_name("DIR")->required(),
      "output folder of 'evolin run'");
  add("picture", po::value(&options->picture)->value_name("KIND")->default_value("lines"),
      "lines (judged against the ground truth) or matches (pairs side by side)");
  add("threshold", po::value(&options->threshold)->value_name("X")->default_value(5),
      "largest structural distance of a found line, pixels of 128 x 128");
  add("scale", po::value(&options->scale)->value_name("X")->default_value(1),
      "picture pixels to an image pixel, of lines");
  add("rate", po::value(&options->rate)->value_name("HZ")->default_value(10),
      "pictures a second of a video");
  add("output,o", po::value(&options->output)->value_name("DIR|FILE")->required(),
      "folder of PNG files (one that 'evolin render' made before is replaced), or a video: .mp4 or "
      ".gif, which need the program ffmpeg");
  add("threads", po::value(&options->threads)->value_name("N")->default_value(0), kThreadsHelp);
  add("force,f", po::bool_switch(&options->force), "replace an existing video");
  add("quiet,q", po::bool_switch(&options->quiet), "no progress");
  return description.add(options->input.describe());
}

/// The part of report.json that says how the run was made.
Json readProvenance(const fs::path& run) {
  const fs::path file = run / "report.json";
  std::ifstream stream(file);
  if (!stream) {
    throw Error(file.string() + ": cannot be read, expected the report of an 'evolin run'");
  }
  const Json report = Json::parse(stream, nullptr, false);
  const Json provenance = report.is_object() ? report.value("provenance", Json()) : Json();
  if (!provenance.is_object() || !provenance.value("parameters", Json()).is_object() ||
      !provenance["parameters"].value("detector", Json()).is_string()) {
    throw Error(file.string() +
                ": does not say which detector made it, expected the report of an 'evolin run'");
  }
  return provenance;
}

bool isGiven(const std::string& argument, const std::string& name, const std::string& letter) {
  return argument == name || argument.rfind(name + "=", 0) == 0 ||
         (!letter.empty() && argument.rfind(letter, 0) == 0);
}

/// The first value of an option among arguments that are not read yet.
std::optional<std::string> valueOf(const std::vector<std::string>& arguments,
                                   const std::string& name, const std::string& letter) {
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string& argument = arguments[i];
    if (!isGiven(argument, name, letter)) {
      continue;
    }
    if (argument == name || argument == letter) {
      return i + 1 < arguments.size() ? std::make_optional(arguments[i + 1]) : std::nullopt;
    }
    return argument.substr(argument[1] == '-' ? name.size() + 1 : letter.size());
  }
  return std::nullopt;
}

/// With what the run's report says of the recording and of the options that went with it, each
/// where it is not given anew. Options of a folder are none of a bag, nor the other way round.
std::vector<std::string> withInput(std::vector<std::string> arguments) {
  const std::optional<std::string> run = valueOf(arguments, "--run", "-r");
  if (!run) {
    return arguments;
  }
  const Json provenance = readProvenance(*run);
  std::vector<std::string> more;
  const auto add = [&](const po::option_description& option, const std::string& value) {
    const std::string name = "--" + option.long_name();
    const std::string letter =
        option.canonical_display_name(po::command_line_style::allow_dash_for_short);
    const auto given = [&](const std::string& argument) {
      return isGiven(argument, name, letter.size() == 2 ? letter : "");
    };
    if (std::none_of(arguments.begin(), arguments.end(), given)) {
      more.push_back(value.empty() ? name : name + "=" + value);
    }
  };
  RecordingInput known;
  const po::options_description options = known.describe();
  const Json input = provenance.value("input", Json::object());
  if (input.contains("folder")) {
    add(options.find("input", false), input["folder"].get<std::string>());
  }
  for (const Json& bag : input.value("bags", Json::array())) {
    add(options.find("input", false), bag.at("bag").get<std::string>());
  }
  const std::optional<std::string> anew = valueOf(arguments, "--input", "-i");
  const bool same_kind = !anew || fs::is_directory(*anew) == input.contains("folder");
  const Json more_options =
      same_kind ? provenance.value("input_options", Json::object()) : Json::object();
  for (const auto& [name, value] : more_options.items()) {
    if (const po::option_description* option = options.find_nothrow(name, false)) {
      add(*option, value.get<std::string>());
    }
  }
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

void check(const RenderOptions& options) {
  if (options.picture != "lines" && options.picture != "matches") {
    throw UsageError("--picture: is " + quote(options.picture) + ", expected lines or matches");
  }
  if (!(options.rate > 0) || !(options.threshold > 0)) {
    throw UsageError("--rate and --threshold: expected numbers above 0");
  }
}

MethodChoice choiceOf(const Json& parameters, const std::string& kind) {
  MethodChoice choice;
  choice.name = parameters.at(kind).get<std::string>();
  const Json given = parameters.value(kind + "_parameters", Json::object());
  if (given.is_object() && !given.empty()) {
    choice.parameters = YAML::Load(given.dump());
  }
  return choice;
}

/// The recorded results that a run played; "" where there were none, or they are gone and the
/// method itself has to do it again.
std::string playedFolder(const Json& parameters, const std::string& key) {
  const std::string folder = parameters.value(key, "");
  return fs::is_directory(folder) ? folder : "";
}

/// The run's methods, in the words of its report.
RunRequest requestOf(const Json& parameters, bool with_matches) {
  RunRequest request;
  request.detector = choiceOf(parameters, "detector");
  request.lines_name = parameters.value("source", "");
  request.lines_folder = playedFolder(parameters, "lines_folder");
  LineSelection& selection = request.selection;
  if (const Json score = parameters.value("score_threshold", Json()); score.is_number()) {
    selection.score_threshold = score.get<double>();
  }
  selection.min_length = parameters.value("min_length", selection.min_length);
  selection.max_lines = parameters.value("max_lines", selection.max_lines);
  if (with_matches) {
    if (!parameters.value("associator", Json()).is_string()) {
      throw Error("--picture matches: the run had no associator");
    }
    request.associator = choiceOf(parameters, "associator");
    request.matches_folder = playedFolder(parameters, "matches_folder");
    request.associate_ground_truth = parameters.value("associate", "ground-truth") != "detected";
  }
  return request;
}

ChosenFrontEnd frontEndOf(const Json& parameters, bool with_matches, PluginLoader* loader) {
  const RunRequest request = requestOf(parameters, with_matches);
  try {
    return chooseFrontEnd(request, parameters.value("frame_step", 1), loader);
  } catch (const Error& error) {
    std::string gone;
    for (const char* key : {"lines_folder", "matches_folder"}) {
      const std::string folder = parameters.value(key, "");
      gone += folder.empty() || fs::is_directory(folder)
                  ? ""
                  : "; the run played " + folder + ", which is not there any more";
    }
    if (gone.empty()) {
      throw;
    }
    throw Error(error.what() + gone);
  }
}

/// Where pictures go: a folder or a video.
class Album {
 public:
  Album(const RenderOptions& options) : output_(options.output) {
    if (isVideoName(output_)) {
      video_.emplace(output_, options.rate, options.force);
    } else {
      folder_.emplace(output_, kMarker, true);
    }
  }

  void add(const std::string& name, const cv::Mat& picture) {
    if (video_) {
      video_->add(picture);
      return;
    }
    writeImage(folder_->path() / (name + ".png"), picture);
  }

  void finish(const RenderOptions& options, std::size_t pictures,
              const std::vector<std::string>& notes, bool complete) {
    if (pictures == 0) {
      throw Error(options.run + ": no picture could be made of " + options.input.names() +
                  (notes.empty() ? "" : "; " + notes.front()));
    }
    const std::string summary = std::to_string(pictures) + " pictures of " + options.run;
    if (folder_) {
      conclude(&*folder_,
               {output_, kMarker, "render\nrun " + options.run, summary, notes, complete});
      return;
    }
    video_->finish();
    std::cout << output_ << ": " << summary << "\n";
    if (!complete) {
      throw Interrupted("interrupted; what is done stands in " + output_);
    }
  }

 private:
  std::string output_;
  std::optional<OutputFolder> folder_;
  std::optional<VideoFile> video_;
};

int runRender(const std::vector<std::string>& arguments) {
  RenderOptions options;
  po::variables_map given;
  if (!parseOptions(kUsage, describe(&options), withInput(arguments), &given)) {
    return kExitDone;
  }
  check(options);
  options.input.check(given);
  const int threads = checkedThreads(options.threads);
  const Json parameters = readProvenance(options.run)["parameters"];
  PictureOptions pictures;
  pictures.protocol = parseProtocol(parameters.value("protocol", "evolin"));
  pictures.setting.threshold = options.threshold;
  pictures.view.scale = options.scale;
  try {
    validate(pictures.view);
  } catch (const Error& error) {
    throw UsageError(error.what());
  }
  const bool matches = options.picture == "matches";
  cv::setNumThreads(1);  // images go to threads as wholes
  PluginLoader loader;
  WorkerPool pool(threads);
  const ChosenFrontEnd chosen = frontEndOf(parameters, matches, &loader);
  FrontEnd front_end(chosen.options, &pool);
  const std::unique_ptr<PartReader> reader = options.input.open({false, true}, chosen.needs);

  Album album(options);
  const TakePicture take = [&album](const std::string& name, const cv::Mat& picture) {
    album.add(name, picture);
  };
  if (matches) {
    MatchPictures sink(static_cast<std::size_t>(chosen.options.frame_step), take);
    const bool complete = record(reader.get(), &front_end, &sink, options.quiet);
    album.finish(options, sink.pictures(), sink.notes(), complete);
    return kExitDone;
  }
  FramePictures sink(pictures, take);
  const bool complete = record(reader.get(), &front_end, &sink, options.quiet);
  sink.finish();
  album.finish(options, sink.pictures(), sink.notes(), complete);
  return kExitDone;
}

}  // namespace

Command renderCommand() {
  return {"render", "pictures or a video of a run's lines or matches", runRender};
}

}  // namespace evolin::cli
