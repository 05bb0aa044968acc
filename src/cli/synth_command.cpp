// `evolin synth`.
#include "synth_command.h"

#include <algorithm>
#include <boost/program_options/value_semantic.hpp>
#include <iostream>
#include <optional>
#include <thread>
#include <vector>

#include "bag_writer.h"
#include "evolin_ros/base/atomic_file.h"
#include "evolin_ros/base/text.h"
#include "evolin_ros/dataset/stamps_file.h"
#include "evolin_ros/dataset/synthetic/synthetic_sequence.h"
#include "options.h"
#include "output_folder.h"
#include "synthetic_folder.h"

namespace evolin::cli {

namespace fs = std::filesystem;
namespace po = boost::program_options;

namespace {

constexpr const char* kUsage =
    "Makes the built-in synthetic sequence: a furnished room seen by a moving camera, with colour, "
    "depth, exact poses and the visible parts of the room's physical edges as ground-truth lines. "
    "The same options give the same bytes.\n\n"
    "Usage: evolin synth --output DIR|FILE.bag [OPTIONS]\n\n"
    "A folder has the EVOLIN layout and serves wherever a dataset is asked for; a bag has the "
    "topics of 'evolin bag', and NAME.stamps.txt beside it.";

constexpr int kMostThreads = 1024;

struct SynthOptions {
  std::string output;
  std::string size = "640x480";
  std::int64_t seed = 1;
  int threads = 0;
  bool force = false;
  synthetic::SyntheticOptions sequence;
};

po::options_description describe(SynthOptions* options) {
  synthetic::SyntheticOptions& sequence = options->sequence;
  po::options_description description("Options");
  auto add = description.add_options();
  add("output,o", po::value(&options->output)->value_name("DIR|FILE.bag")->required(),
      "folder or bag to write");
  add("frames", po::value(&sequence.frames)->value_name("N")->default_value(sequence.frames),
      "number of frames");
  add("rate", po::value(&sequence.rate)->value_name("HZ")->default_value(sequence.rate),
      "frames a second; the camera's speed does not depend on it");
  add("size", po::value(&options->size)->value_name("WxH")->default_value(options->size),
      "image size in pixels; the focal length is 525 px at a width of 640, in proportion "
      "otherwise");
  add("seed", po::value(&options->seed)->value_name("N")->default_value(options->seed),
      "varies colours, places and the camera's path");
  add("noise", po::value(&sequence.noise)->value_name("S")->default_value(sequence.noise),
      "standard deviation of the sensor's noise in grey levels");
  add("blur", po::value(&sequence.blur)->value_name("S")->default_value(sequence.blur),
      "standard deviation of the lens' blur in pixels");
  add("threads", po::value(&options->threads)->value_name("N")->default_value(options->threads),
      "worker threads, 0: one a core; the result does not depend on it");
  add("force,f", po::bool_switch(&options->force),
      "replace an existing bag, or a folder that an earlier 'evolin synth' made");
  return description;
}

/// "640x480".
void readSize(const std::string& text, synthetic::SyntheticOptions* sequence) {
  const std::vector<std::string_view> sides = split(text, 'x');
  constexpr std::int64_t kLargest = 1000000;  // the sequence has its own, lower bound
  std::vector<int> values;
  for (const std::string_view side : sides) {
    const std::optional<std::int64_t> value = parseInteger(side);
    if (value && *value >= 0 && *value <= kLargest) {
      values.push_back(static_cast<int>(*value));
    }
  }
  if (sides.size() != 2 || values.size() != 2) {
    throw UsageError("--size: is " + quote(text) + ", expected WIDTHxHEIGHT such as 640x480");
  }
  sequence->width = values[0];
  sequence->height = values[1];
}

void check(SynthOptions* options) {
  readSize(options->size, &options->sequence);
  if (options->seed < 0) {
    throw UsageError("--seed: is " + std::to_string(options->seed) + ", expected 0 or more");
  }
  options->sequence.seed = static_cast<std::uint64_t>(options->seed);
  if (options->threads < 0 || options->threads > kMostThreads) {
    throw UsageError("--threads: is " + std::to_string(options->threads) + ", expected 0 to " +
                     std::to_string(kMostThreads));
  }
  try {
    synthetic::validate(options->sequence);
  } catch (const ConfigError& error) {
    throw UsageError(error.what());
  }
}

int workersOf(const SynthOptions& options) {
  return options.threads > 0 ? options.threads
                             : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

/// Number of lines in all frames.
std::size_t writeFolder(const SynthOptions& options) {
  OutputFolder folder(options.output, kSynthMarker, options.force);
  const std::size_t lines =
      fillSyntheticFolder(options.sequence, workersOf(options), false, folder.path());
  folder.commit();
  return lines;
}

std::size_t writeBag(const SynthOptions& options) {
  const fs::path bag = options.output;
  const fs::path stamps = fs::path(bag).replace_extension(".stamps.txt");
  for (const fs::path& file : {bag, stamps}) {
    if (fs::exists(file) && !options.force) {
      throw Error(file.string() + ": exists; --force replaces it");
    }
  }
  TemporaryFile temporary(bag);
  const synthetic::SyntheticSequence sequence(options.sequence);
  // Noise, most of which LZ4 gives back as it was: the bag is little larger without, and is read
  // faster.
  BagWriter writer(temporary.path(), BagCompression::kNone);
  std::vector<std::optional<SequenceFrame>> ready(sequence.size());
  std::vector<StampedFile> entries;
  std::size_t lines = 0;
  forEachFrame(
      sequence.size(), workersOf(options), false,
      [&](std::size_t number) { ready[number] = sequence.frame(number); },
      [&](std::size_t number) {
        const SequenceFrame& frame = *ready[number];
        writer.add(frame);
        entries.push_back({frame.frame.stamp, frame.image_file});
        lines += frame.ground_truth->size();
        ready[number].reset();
      });
  writer.close();
  writeStampsFile(stamps, entries);
  temporary.commit();
  return lines;
}

int runSynth(const std::vector<std::string>& arguments) {
  SynthOptions options;
  if (!parseOptions(kUsage, describe(&options), arguments)) {
    return kExitDone;
  }
  check(&options);
  const bool is_bag = fs::path(options.output).extension() == ".bag";
  const std::size_t lines = is_bag ? writeBag(options) : writeFolder(options);
  const int frames = options.sequence.frames;
  std::cout << options.output << ": " << frames << " frames, " << options.sequence.width << " x "
            << options.sequence.height << ", " << (lines + frames / 2) / frames
            << " ground-truth lines a frame\n";
  return kExitDone;
}

}  // namespace

Command synthCommand() { return {"synth", "built-in synthetic sequence", runSynth}; }

}  // namespace evolin::cli
