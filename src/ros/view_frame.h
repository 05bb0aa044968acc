// From the messages of one frame to what a picture or a set of markers shows of it.
#pragma once

#include <string>
#include <vector>

#include "evolin_ros/drawing/evaluation_view.h"
#include "evolin_ros/drawing/line_trails.h"
#include "evolin_ros/metrics/protocol.h"
#include "view_joiner.h"

namespace evolin::ros_shell {

enum class TrailsFrom { kMatches, kIds, kNone };

struct ViewFrameOptions {
  double threshold = 5;  ///< of the structural distance, in pixels of the image scaled to 128 x 128
  Protocol protocol = Protocol::kEvolin;
  TrailsFrom trails_from = TrailsFrom::kMatches;
  int trail_length = 5;  ///< points
};

/// Remembers where lines have been. One thread at a time.
class ViewFrames {
 public:
  /// Matches may reach so many frames back.
  static constexpr std::size_t kReach = 32;

  explicit ViewFrames(const ViewFrameOptions& options);

  /// Takes frames in their order. Figures and counts of unpaired parts are the caller's to fill in.
  /// What is wrong with the lines or the ground truth stands in `no_verdicts` and, with what is
  /// wrong with matches or ids, in problems(). Throws Error for an image that cannot be shown.
  EvaluatedFrame make(const ViewParts& parts);

  /// For the log: of the last frame.
  const std::vector<std::string>& problems() const { return problems_; }

  /// Forgets where lines have been.
  void clear();

 private:
  void judge(const ViewParts& parts, EvaluatedFrame* frame);
  std::vector<LineTrail> follow(const ViewParts& parts, const LineSegments& lines,
                                const LineSegments& ground_truth);

  ViewFrameOptions options_;
  LineTrails detected_;
  LineTrails true_;
  std::vector<std::string> problems_;
};

}  // namespace evolin::ros_shell
