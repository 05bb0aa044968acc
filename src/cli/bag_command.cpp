// `evolin bag`.
#include "bag_command.h"

#include <boost/program_options/value_semantic.hpp>

#include <iostream>

#include "bag_writer.h"
#include "evolin_ros/base/atomic_file.h"
#include "evolin_ros/dataset/sequence_reader.h"
#include "evolin_ros/dataset/stamps_file.h"
#include "interrupt.h"
#include "options.h"
#include "package_files.h"
#include "progress.h"

namespace evolin::cli {

namespace po = boost::program_options;

namespace {

constexpr const char* kUsage =
    "Writes a dataset folder as a bag with the topics of TUM's own bags (/camera/rgb/image_color, "
    "/camera/rgb/camera_info, /camera/depth/image, /camera/depth/camera_info, /tf) and "
    "/ground_truth/lines, /ground_truth/pose; beside it NAME.stamps.txt, which maps image files to "
    "times.\n\n"
    "Usage: evolin bag --input DIR --output FILE.bag [OPTIONS]";

struct BagOptions {
  std::string input;
  std::string output;
  std::string layout = "auto";
  std::string ground_truth;
  double duration = 0;
  int pose_offset = 0;
  bool force = false;
  SequenceOptions sequence;
};

po::options_description describe(BagOptions* options) {
  SequenceOptions& sequence = options->sequence;
  po::options_description description("Options");
  description.add_options()("input,i", po::value(&options->input)->value_name("DIR")->required(),
                            "dataset folder")(
      "output,o", po::value(&options->output)->value_name("FILE.bag")->required(),
      "the bag to write")(
      "layout,l", po::value(&options->layout)->value_name("NAME")->default_value("auto"),
      "auto, tum, icl or evolin")("camera,c", po::value(&sequence.camera)->value_name("NAME|FILE"),
                                  "camera preset ('evolin list' names them) or YAML file; without "
                                  "it calibration_matrix.txt of the "
                                  "folder, where there is one")(
      "ground-truth,g", po::value(&options->ground_truth)->value_name("DIR"),
      "folder of annotated lines; without it gt_lines of the dataset, where there is one")(
      "start", po::value(&sequence.start)->value_name("S")->default_value(0),
      "seconds to skip from the first image")("duration",
                                              po::value(&options->duration)->value_name("S"),
                                              "seconds to take; without it all")(
      "pose-offset", po::value(&options->pose_offset)->value_name("N"),
      "image i takes pose row i + N; without it the layout's own rule")(
      "allow-missing", po::bool_switch(&sequence.allow_missing),
      "skip and count listed images that are absent")(
      "same-rows", po::bool_switch(&sequence.same_rows),
      "equal rows of the annotations are the same physical line")(
      "force,f", po::bool_switch(&options->force), "replace an existing bag");
  return description;
}

void check(BagOptions* options, const po::variables_map& given) {
  SequenceOptions& sequence = options->sequence;
  if (!(sequence.start >= 0)) {
    throw UsageError("--start: expected seconds of at least 0");
  }
  if (given.count("duration") != 0) {
    if (!(options->duration > 0)) {
      throw UsageError("--duration: expected seconds greater than 0");
    }
    sequence.duration = options->duration;
  }
  if (given.count("pose-offset") != 0) {
    sequence.pose_offset = options->pose_offset;
  }
  try {
    sequence.layout = parseLayout(options->layout);
  } catch (const Error& error) {
    throw UsageError(std::string("--layout: ") + error.what());
  }
  sequence.ground_truth = options->ground_truth;
  if (!sequence.camera.empty()) {
    sequence.camera_folder = cameraFolder();
  }
}

std::filesystem::path stampsFileOf(std::filesystem::path bag) {
  return bag.replace_extension(".stamps.txt");
}

void tell(const SequenceReader& reader, const std::filesystem::path& bag) {
  const SequenceCounts& counts = reader.counts();
  std::cout << bag.string() << ": " << counts.frames << " frames, layout "
            << toString(reader.layout()) << "; poses " << reader.poseRule() << "\n";
  const std::pair<const char*, std::size_t> lacks[] = {
      {"listed images are missing", counts.missing_images},
      {"frames have no depth", counts.missing_depths},
      {"frames have no pose", counts.missing_poses},
      {"frames have no ground-truth lines", counts.missing_ground_truth}};
  for (const auto& [what, count] : lacks) {
    if (count > 0) {
      std::cout << "  " << count << " " << what << "\n";
    }
  }
}

int runBag(const std::vector<std::string>& arguments) {
  BagOptions options;
  po::variables_map given;
  if (!parseOptions(kUsage, describe(&options), arguments, &given)) {
    return kExitDone;
  }
  check(&options, given);
  const std::filesystem::path bag = options.output;
  const std::filesystem::path stamps = stampsFileOf(bag);
  for (const std::filesystem::path& file : {bag, stamps}) {
    if (std::filesystem::exists(file) && !options.force) {
      throw Error(file.string() + ": exists; --force replaces it");
    }
  }
  const std::unique_ptr<SequenceReader> reader = openSequence(options.input, options.sequence);
  if (bag.has_parent_path()) {
    std::filesystem::create_directories(bag.parent_path());
  }
  const InterruptGuard guard;
  TemporaryFile temporary(bag);
  BagWriter writer(temporary.path());
  Progress progress("frames", reader->size());
  std::vector<StampedFile> entries;
  while (const std::optional<SequenceFrame> frame = reader->next()) {
    writer.add(*frame);
    entries.push_back({frame->frame.stamp, frame->image_file});
    progress.update(entries.size());
    if (guard.interrupted()) {
      throw Interrupted("stopped after " + std::to_string(entries.size()) +
                        " frames; a bag is written as a whole or not at all: none was");
    }
  }
  writer.close();
  progress.finish(entries.size());
  if (entries.empty()) {
    throw Error(options.input + ": no frame is in the chosen part of the sequence");
  }
  writeStampsFile(stamps, entries);
  temporary.commit();
  tell(*reader, bag);
  return kExitDone;
}

}  // namespace

Command bagCommand() { return {"bag", "dataset folder to bag", runBag}; }

}  // namespace evolin::cli
