// Families that need depth and camera poses: repeatability with its relatives, and relative pose
// from matched lines.
#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "evolin_ros/dataset/trajectory.h"
#include "evolin_ros/evaluation/inputs.h"
#include "evolin_ros/evaluation/pose_task.h"
#include "evolin_ros/evaluation/stamped_depth.h"
#include "evolin_ros/metrics/best_localization.h"
#include "evolin_ros/metrics/one_to_one_repeatability.h"
#include "evolin_ros/metrics/repeatability.h"

namespace evolin {

struct MotionOptions {
  bool repeatability = true;  ///< whether this family is wanted
  bool pose = true;           ///< whether this family is wanted
  RepeatabilityOptions repeatabilities;
  /// Repeatability of the lines with score > t alone, besides that of all lines; empty: none.
  std::vector<double> repeatability_score_thresholds;
  OneToOneOptions one_to_one;
  BestLocalizationOptions best_localization;
  PoseMethodOptions pose_method;
  PoseErrorOptions pose_errors;
  Stamp max_time_difference = kNanosecondsPerSecond / 50;  ///< of a depth image to its image, ns
  std::size_t depth_buffer = 300;  ///< depth images kept for lines that are still to come
  std::size_t buffer = 1000;       ///< frames whose lines are kept for depth, poses and matches
};

/// One pair of frames under every setting of its step.
struct RepeatabilityRecord {
  Stamp first_stamp = 0;
  Stamp stamp = 0;
  int frame_step = 0;
  std::vector<PairRepeatability> pair;  ///< RepeatabilityMetrics::settingsOf(frame_step)
  /// The same by score threshold, MotionEvaluation::repeatabilityByScore(); empty: not asked for,
  /// or a line has no score.
  std::vector<PairRepeatability> by_score;
  double one_to_one_by_count = 0;
  double one_to_one_by_length = 0;
  PairBestLocalization best;
};

/// What became of frames and pairs.
struct MotionCounts {
  std::size_t frames = 0;          ///< with detected lines, depth and a pose
  std::size_t no_depth = 0;        ///< with lines, but no usable depth image belongs to them
  std::size_t no_pose = 0;         ///< with lines, but no pose (and perhaps no depth either)
  std::size_t bad_lines = 0;       ///< with lines that are not finite; a note names the first row
  std::size_t late = 0;            ///< lines came after later frames had been scored
  std::size_t unscored_pairs = 0;  ///< of repeatability, with a line without a score although there
                                   ///< are score thresholds
  std::size_t pose_pairs = 0;      ///< given out as tasks

  // Matches by what one of the two frames, at least, lacks; the first that holds.
  std::size_t pairs_left_buffer = 0;  ///< a frame had to leave the full buffer before all was there
  std::size_t pairs_no_lines = 0;     ///< nothing was heard of the lines that they are between
  std::size_t pairs_bad_lines = 0;    ///< as bad_lines
  std::size_t pairs_no_pose = 0;
  std::size_t pairs_no_depth = 0;
  std::size_t pairs_skipped = 0;  ///< unusable matches; a note says why
};

/// Frames with lines that are neither scored nor given up.
struct MotionWaiting {
  std::size_t depth = 0;  ///< their depth, or the camera, has not come yet
  std::size_t pose = 0;   ///< their pose has not come yet (and perhaps no depth either)
};

struct MotionUpdate {
  std::vector<RepeatabilityRecord> repeatability;
  std::vector<PoseTask> pose_tasks;
  std::vector<std::string> notes;
};

/// Parts may come in any order. The place of a frame in the sequence, from which frame steps count,
/// is its place among all images, lines and ground truth by time, fixed when it is scored: once it
/// has lines, depth, a pose and all frames before it are scored or will never be. Not safe for
/// several threads at once; copies are independent.
class MotionEvaluation {
 public:
  /// Throws Error for options that a metric refuses.
  explicit MotionEvaluation(MotionOptions options = {});

  bool wanted() const { return options_.repeatability || options_.pose; }

  /// Of all frames; the first one counts, a note says when another differs.
  MotionUpdate setCamera(const Camera& camera);
  MotionUpdate addImage(Stamp stamp);
  /// What addImage() told of was no image. One with lines or ground truth stays, and so does the
  /// place of one that frame steps have counted already.
  void removeImage(Stamp stamp);
  /// Whatever was told of frames from this stamp on, that have no lines yet, belongs elsewhere.
  void forgetFrom(Stamp boundary);
  MotionUpdate addLines(const LineSet& lines);
  MotionUpdate addGroundTruth(const LineSet& ground_truth);
  MotionUpdate addDepth(Stamp stamp, DepthMap depth);
  MotionUpdate addPose(const StampedPose& pose);
  MotionUpdate addMatches(const MatchSet& matches);

  /// Nothing more will come: whatever waits is scored or counted by what it lacks.
  MotionUpdate finish();

  const MotionCounts& counts() const { return counts_; }
  /// What finish() would count as frames without depth or pose.
  MotionWaiting waiting() const;
  const RepeatabilityMetrics& repeatability() const { return repeatability_; }
  /// None without score thresholds.
  const std::optional<RepeatabilityMetrics>& repeatabilityByScore() const { return by_score_; }
  const OneToOneRepeatability& oneToOne() const { return one_to_one_; }
  const BestLocalization& bestLocalization() const { return best_localization_; }

  bool hasCamera() const { return camera_.has_value(); }
  bool hasDepth() const { return !depth_.empty(); }
  bool hasPoses() const { return !trajectory_.poses().empty(); }
  /// See StampedDepth::nearestMiss().
  std::optional<Stamp> nearestDepthMiss() const { return depth_.nearestMiss(); }

 private:
  enum class State { kAbsent, kWaiting, kReady, kNever, kBad };

  /// One set of lines of a frame on its way into space.
  struct Lifting {
    State state = State::kAbsent;
    LineSegments lines;  ///< until lifted
    ImageSize size;
    LiftedLines lifted;  ///< for relative pose
  };
  struct Node {
    Lifting detected;
    Lifting truth;
    State pose_state = State::kWaiting;
    Pose pose;
    std::shared_ptr<SpatialFrame> spatial;  ///< detected lines, for repeatability; until scored
  };
  using Nodes = std::map<Stamp, Node>;
  using PairKey = std::pair<Stamp, Stamp>;
  struct Scored {
    std::size_t place;
    Stamp stamp;
    std::shared_ptr<const SpatialFrame> frame;
  };

  Node* nodeAt(Stamp stamp, MotionUpdate* update);
  void resolve(Stamp stamp, bool complete, MotionUpdate* update);
  void resolveAll(bool complete, MotionUpdate* update);
  State lift(Stamp stamp, bool complete, bool detected, Lifting* lifting, Node* node,
             MotionUpdate* update);
  bool mayBeLackedAt(Stamp depth_stamp) const;
  void advance(bool complete, MotionUpdate* update);
  bool isSettled(Nodes::const_iterator node) const;
  void settle(Stamp stamp, Node* node, MotionUpdate* update);
  void scorePairs(Stamp stamp, const std::shared_ptr<const SpatialFrame>& frame,
                  MotionUpdate* update);
  void tryPairs(Stamp stamp, MotionUpdate* update);
  bool tryPair(const PairKey& key, const MatchSet& matches, bool complete, MotionUpdate* update);
  std::size_t* reasonAgainst(const PairKey& key, bool truth);
  void takeLines(const LineSet& lines, bool detected, Lifting* lifting, MotionUpdate* update);
  void makeTask(const MatchSet& matches, const Node& first, const Node& second, bool truth,
                MotionUpdate* update);
  void limitNodes(MotionUpdate* update);

  MotionOptions options_;
  PoseMethod method_;
  RepeatabilityMetrics repeatability_;
  std::optional<RepeatabilityMetrics> by_score_;
  OneToOneRepeatability one_to_one_;
  BestLocalization best_localization_;
  MotionCounts counts_;

  std::optional<Camera> camera_;
  bool camera_differs_ = false;
  bool depth_told_ = false;
  StampedDepth depth_;
  Trajectory trajectory_;
  std::string lines_source_;
  std::string ground_truth_source_;

  Nodes nodes_;
  std::optional<Stamp> gone_;     ///< the newest node that left the full buffer
  std::set<Stamp> unresolved_;    ///< nodes that wait for depth or a pose
  std::optional<Stamp> settled_;  ///< the newest scored frame; all before it are
  std::size_t places_ = 0;        ///< frames scored or passed over
  std::deque<Scored> recent_;     ///< as many places as the largest step
  std::map<PairKey, MatchSet> pending_;
};

}  // namespace evolin
