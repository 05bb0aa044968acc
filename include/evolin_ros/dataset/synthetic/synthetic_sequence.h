// The built-in sequence: a camera moves through a furnished room whose lines are known exactly.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "evolin_ros/dataset/sequence_reader.h"
#include "evolin_ros/dataset/synthetic/renderer.h"
#include "evolin_ros/dataset/synthetic/scene.h"
#include "evolin_ros/dataset/synthetic/visible_edges.h"

namespace evolin::synthetic {

struct SyntheticOptions {
  int frames = 90;
  double rate = 30;  ///< Hz
  int width = 640;   ///< pixels; the focal length is 525 px at 640, in proportion otherwise
  int height = 480;
  std::uint64_t seed = 1;
  double noise = 2;  ///< standard deviation of the sensor's noise, grey levels
  double blur = 0;   ///< standard deviation of the lens' blur, pixels
};

/// Throws ConfigError naming the value and the accepted range.
void validate(const SyntheticOptions& options);

/// The same options give the same frames, bytes included, in any order and on any number of
/// threads. More frames go on along the same path; a higher rate takes it in smaller steps.
class SyntheticSequence {
 public:
  /// Throws as validate().
  explicit SyntheticSequence(const SyntheticOptions& options);
  ~SyntheticSequence();
  SyntheticSequence(const SyntheticSequence&) = delete;
  SyntheticSequence& operator=(const SyntheticSequence&) = delete;

  std::size_t size() const { return static_cast<std::size_t>(options_.frames); }
  const SyntheticOptions& options() const { return options_; }
  const Scene& scene() const { return scene_; }
  const Camera& camera() const { return camera_; }

  /// 1 s + number / rate.
  Stamp stamp(std::size_t number) const;

  /// Camera to world, exact.
  Pose pose(std::size_t number) const;

  /// The lines of visibleLines() by rising id. An id names one visible part of one edge, the same
  /// over the sequence for as long as the part can be followed; edgeOf() gives the edge. Ids are
  /// handed on from frame to frame, so the first call for a frame far ahead takes the time of the
  /// lines of all frames before it. Safe for any number of threads.
  LineSegments groundTruth(std::size_t number) const;

  /// The place in scene().edges of the edge that a ground-truth id is a part of: the id modulo
  /// their number.
  std::size_t edgeOf(std::int64_t id) const;

  /// Image, depth (CV_32FC1), pose, camera and ground truth; the costly one.
  SequenceFrame frame(std::size_t number) const;

 private:
  class Names;

  SyntheticOptions options_;
  Scene scene_;
  Camera camera_;
  Renderer renderer_;
  std::unique_ptr<Names> names_;
};

}  // namespace evolin::synthetic
