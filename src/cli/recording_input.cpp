// What the two kinds of input share has one name.
#include "recording_input.h"

#include <algorithm>
#include <boost/program_options/value_semantic.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "command.h"
#include "evolin_ros/base/sha256.h"
#include "evolin_ros/base/text.h"
#include "evolin_ros/dataset/camera_file.h"
#include "evolin_ros/evaluation/complete_frames.h"
#include "package_files.h"

namespace evolin::cli {

namespace po = boost::program_options;

po::options_description RecordingInput::describe() {
  po::options_description description("Input");
  auto add = description.add_options();
  add("input,i", po::value(&inputs_)->value_name("BAG|DIR")->required()->composing(),
      "bag or dataset folder; several bags (the option again) are pieces of one recording");
  add("layout,l", po::value(&layout_)->value_name("NAME")->default_value("auto"),
      "of a folder: auto, tum, icl or evolin");
  add("camera,c", po::value(&camera_)->value_name("NAME|FILE"),
      "camera preset ('evolin list' names them) or YAML file; without it camera_info of the bag, "
      "or "
      "calibration_matrix.txt of the folder");
  add("ground-truth,g", po::value(&ground_truth_)->value_name("DIR"),
      "folder of annotated lines; without it the lines of the bag, or gt_lines of the folder");
  add("stamps", po::value(&stamps_)->value_name("FILE"),
      "with a bag: stamps.txt of --ground-truth where the folder has none");
  add("start", po::value(&folder_.start)->value_name("S")->default_value(0),
      "seconds to skip from the first image (of a bag: from its first message)");
  add("duration", po::value(&duration_)->value_name("S"), "seconds to take; without it all");
  add("pose-offset", po::value(&pose_offset_)->value_name("N"),
      "of a folder: image i takes pose row i + N; without it the layout's own rule");
  add("allow-missing", po::bool_switch(&folder_.allow_missing),
      "of a folder: skip and count listed images that are absent");
  add("same-rows", po::bool_switch(&folder_.same_rows),
      "equal rows of the annotations are the same physical line");
  add("image-topic", po::value(&bag_.image_topic)->value_name("TOPIC"),
      "of a bag, as the following: sensor_msgs/Image or CompressedImage; found by type where there "
      "is one");
  add("depth-topic", po::value(&bag_.depth_topic)->value_name("TOPIC"),
      "sensor_msgs/Image of encoding 16UC1 or 32FC1, or CompressedImage of the compressedDepth "
      "transport");
  add("camera-info-topic", po::value(&bag_.camera_info_topic)->value_name("TOPIC"),
      "without it the one beside the images");
  add("pose-topic", po::value(&bag_.pose_topic)->value_name("TOPIC"),
      "PoseStamped, PoseWithCovarianceStamped or Odometry; /tf: out of tf, also where the bag has "
      "no "
      "other poses");
  add("ground-truth-topic", po::value(&bag_.ground_truth_topic)->value_name("TOPIC"),
      "evolin_ros/LineArray");
  add("world-frame",
      po::value(&bag_.world_frame)->value_name("NAME")->default_value(bag_.world_frame),
      "frame of tf that poses are in");
  add("depth-factor",
      po::value(&bag_.depth_factor)->value_name("X")->default_value(bag_.depth_factor, "1000"),
      "stored units per metre of a bag's 16-bit depth images");
  return description;
}

bool RecordingInput::isFolder() const { return std::filesystem::is_directory(inputs_.front()); }

void RecordingInput::check(const po::variables_map& given) {
  if (!(folder_.start >= 0)) {
    throw UsageError("--start: expected seconds of at least 0");
  }
  if (given.count("duration") != 0) {
    if (!(duration_ > 0)) {
      throw UsageError("--duration: expected seconds greater than 0");
    }
    folder_.duration = duration_;
  }
  if (given.count("pose-offset") != 0) {
    folder_.pose_offset = pose_offset_;
  }
  if (!(bag_.depth_factor > 0)) {
    throw UsageError("--depth-factor: expected a number greater than 0");
  }
  try {
    folder_.layout = parseLayout(layout_);
  } catch (const Error& error) {
    throw UsageError(std::string("--layout: ") + error.what());
  }
  const bool folder = isFolder();
  if (folder && inputs_.size() > 1) {
    throw UsageError("--input: several inputs must be bags, but " + inputs_.front() +
                     " is a folder");
  }
  const std::vector<const char*> of_folders = {"pose-offset"};
  const std::vector<const char*> of_bags = {
      "stamps",     "image-topic",       "depth-topic",
      "pose-topic", "camera-info-topic", "ground-truth-topic"};
  for (const char* option : folder ? of_bags : of_folders) {
    if (given.count(option) != 0) {
      throw UsageError(std::string("--") + option + " goes with a " + (folder ? "bag" : "folder") +
                       ", but " + inputs_.front() + " is a " + (folder ? "folder" : "bag"));
    }
  }
  folder_.camera = bag_.camera = camera_;
  folder_.ground_truth = bag_.ground_truth = ground_truth_;
  bag_.stamps = stamps_;
  bag_.same_rows = folder_.same_rows;
  bag_.start = folder_.start;
  bag_.duration = folder_.duration;
  if (!camera_.empty()) {
    folder_.camera_folder = bag_.camera_folder = cameraFolder();
  }
  keepGiven(given);
}

void RecordingInput::keepGiven(const po::variables_map& given) {
  const auto textOf = [](const po::variable_value& value) -> std::string {
    if (const auto* number = boost::any_cast<double>(&value.value())) {
      return formatDouble(*number);
    }
    if (const auto* number = boost::any_cast<int>(&value.value())) {
      return std::to_string(*number);
    }
    const auto* text = boost::any_cast<std::string>(&value.value());
    return text == nullptr ? "" : *text;
  };
  const po::options_description description = describe();
  for (const auto& option : description.options()) {
    const std::string& name = option->long_name();
    if (name != "input" && given.count(name) != 0 && !given[name].defaulted()) {
      given_[name] = textOf(given[name]);
    }
  }
}

std::map<std::string, std::string> RecordingInput::options() const {
  std::map<std::string, std::string> options = given_;
  for (auto& [name, value] : options) {
    if (name == "ground-truth" || name == "stamps" ||
        (name == "camera" && cameraFileOf(value, cameraFolder()) == value)) {
      value = std::filesystem::absolute(value).string();
    }
  }
  return options;
}

std::unique_ptr<PartReader> RecordingInput::open(const WantedParts& wanted,
                                                 const Needs& needs) const {
  try {
    return openComplete(wanted, needs);
  } catch (const UnavailableError& error) {
    throw UnavailableError(names() + ": " + error.what());
  }
}

std::unique_ptr<PartReader> RecordingInput::openComplete(const WantedParts& wanted,
                                                         const Needs& needs) const {
  if (isFolder()) {
    SequenceOptions options = folder_;
    options.read_depth = wanted.motion || needs.depth;
    std::unique_ptr<PartReader> reader = openFolderParts(inputs_.front(), options, wanted);
    requireOffered(*reader, needs);
    return reader;
  }
  const bool motion = needs.depth || needs.pose;
  WantedParts read = wanted;
  read.motion = wanted.motion || motion;
  std::unique_ptr<PartReader> reader = openBagParts({inputs_.begin(), inputs_.end()}, bag_, read);
  if (!motion && !needs.camera) {
    return reader;
  }
  return completeFrames(std::move(reader), needs, wanted);
}

std::string RecordingInput::names() const {
  std::string names;
  for (const std::string& input : inputs_) {
    names += (names.empty() ? "" : ", ") + input;
  }
  return names;
}

std::string RecordingInput::hashes() const {
  nlohmann::ordered_json object = nlohmann::ordered_json::object();
  if (!isFolder()) {
    for (const std::string& input : inputs_) {
      object[std::filesystem::path(input).filename().string()] = sha256OfFile(input);
    }
  }
  return object.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace evolin::cli
