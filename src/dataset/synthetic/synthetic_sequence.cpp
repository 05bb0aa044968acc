// Puts room, path, renderer and sensor together.
#include "evolin_ros/dataset/synthetic/synthetic_sequence.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <vector>

#include "counter_random.h"
#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"
#include "evolin_ros/dataset/evolin_writer.h"
#include "evolin_ros/dataset/synthetic/camera_path.h"
#include "part_names.h"
#include "sensor.h"

namespace evolin::synthetic {

namespace {

constexpr int kMostFrames = 100000;
constexpr double kMostRate = 1000;
constexpr int kLeastSide = 32;
constexpr int kMostSide = 4096;
constexpr double kMostNoise = 100;
constexpr double kMostBlur = 20;

void require(const std::string& key, double value, double low, double high,
             const std::string& unit) {
  if (!(value >= low && value <= high)) {  // written so that NaN fails
    throw ConfigError("synthetic sequence", key,
                      "is " + formatDouble(value) + ", expected " + formatDouble(low) + " to " +
                          formatDouble(high) + unit);
  }
}

Camera makeCamera(const SyntheticOptions& options) {
  validate(options);
  Camera camera;
  camera.name = "synthetic";
  camera.width = options.width;
  camera.height = options.height;
  camera.fx = 525.0 * options.width / 640;
  camera.fy = camera.fx;
  camera.cx = (options.width - 1) / 2.0;
  camera.cy = (options.height - 1) / 2.0;
  return camera;
}

}  // namespace

void validate(const SyntheticOptions& options) {
  require("frames", options.frames, 1, kMostFrames, "");
  require("rate", options.rate, 0.01, kMostRate, " Hz");
  require("width", options.width, kLeastSide, kMostSide, " pixels");
  require("height", options.height, kLeastSide, kMostSide, " pixels");
  require("noise", options.noise, 0, kMostNoise, " grey levels");
  require("blur", options.blur, 0, kMostBlur, " pixels");
}

/// The parts' numbers of all frames so far: they depend on the frames before, pictures do not.
class SyntheticSequence::Names {
 public:
  explicit Names(std::size_t edges) : parts_(edges) {}

  /// Of the lines of frame `number`; `lines_of(n)` gives those of any frame.
  template <typename LinesOf>
  std::vector<std::uint32_t> ofFrame(std::size_t number, const LinesOf& lines_of) {
    const std::lock_guard<std::mutex> lock(mutex_);
    while (frames_.size() <= number) {
      frames_.push_back(parts_.nextFrame(lines_of(frames_.size())));
    }
    return frames_[number];
  }

 private:
  std::mutex mutex_;
  PartNames parts_;
  std::vector<std::vector<std::uint32_t>> frames_;
};

SyntheticSequence::SyntheticSequence(const SyntheticOptions& options)
    : options_(options),
      scene_(makeRoom(options.seed)),
      camera_(makeCamera(options)),
      renderer_(scene_, camera_),
      names_(std::make_unique<Names>(scene_.edges.size())) {}

SyntheticSequence::~SyntheticSequence() = default;

Stamp SyntheticSequence::stamp(std::size_t number) const {
  return kNanosecondsPerSecond + fromSeconds(static_cast<double>(number) / options_.rate);
}

Pose SyntheticSequence::pose(std::size_t number) const {
  return cameraPose(options_.seed, static_cast<double>(number) / options_.rate);
}

LineSegments SyntheticSequence::groundTruth(std::size_t number) const {
  const auto lines_of = [this](std::size_t frame) {
    return visibleLines(scene_, camera_, pose(frame));
  };
  const std::vector<VisibleLine> visible = lines_of(number);
  const std::vector<std::uint32_t> parts = names_->ofFrame(
      number, [&](std::size_t frame) { return frame == number ? visible : lines_of(frame); });
  LineSegments lines;
  for (std::size_t i = 0; i < visible.size(); ++i) {
    lines.push_back(visible[i].line);
    lines.back().id = static_cast<std::int64_t>(visible[i].edge + parts[i] * scene_.edges.size());
  }
  std::sort(lines.begin(), lines.end(),
            [](const LineSegment& a, const LineSegment& b) { return a.id < b.id; });
  return lines;
}

std::size_t SyntheticSequence::edgeOf(std::int64_t id) const {
  return static_cast<std::size_t>(id) % scene_.edges.size();
}

SequenceFrame SyntheticSequence::frame(std::size_t number) const {
  SequenceFrame result;
  result.frame.stamp = stamp(number);
  result.frame.name = EvolinWriter::stem(number);
  result.frame.camera = camera_;
  result.frame.pose = pose(number);
  Rendering rendering = renderer_.render(*result.frame.pose);
  blur(options_.blur, &rendering.color);
  result.frame.image = digitise(rendering.color, options_.noise, mixBits(options_.seed, number));
  result.frame.depth = std::move(rendering.depth);
  result.image_file = "images/" + result.frame.name + ".png";
  result.depth_stamp = result.frame.stamp;
  result.ground_truth = groundTruth(number);
  return result;
}

}  // namespace evolin::synthetic
