// A line-feature front-end over a recording: detects and associates with plug-ins, spread over
// threads, and gives everything on in the recording's order.
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "evolin_ros/association/line_associator.h"
#include "evolin_ros/base/worker_pool.h"
#include "evolin_ros/detection/line_detector.h"
#include "evolin_ros/evaluation/part_reader.h"
#include "evolin_ros/evaluation/stage_times.h"
#include "evolin_ros/geometry/line_selection.h"

namespace evolin {

struct FrontEndOptions {
  /// Makes a configured instance; none: no lines are detected. Called once a worker.
  std::function<std::shared_ptr<LineDetector>()> make_detector;
  std::string lines_source;  ///< LineSet::source
  LineSelection selection;
  /// As above; none: nothing is associated.
  std::function<std::shared_ptr<LineAssociator>()> make_associator;
  std::string matches_source;
  /// Whether the recording's own lines are associated, else the detected ones.
  bool associate_ground_truth = true;
  int frame_step = 1;  ///< images with lines from the first to the second of a pair
};

/// Takes what a front-end gives on.
class FrontEndSink {
 public:
  FrontEndSink() = default;
  FrontEndSink(const FrontEndSink&) = delete;
  FrontEndSink& operator=(const FrontEndSink&) = delete;
  virtual ~FrontEndSink() = default;

  virtual void takeImage(const ImagePart& /*image*/) {}
  virtual void takeCamera(const Camera& /*camera*/) {}
  virtual void takeDepth(const DepthPart& /*depth*/) {}
  virtual void takePose(const StampedPose& /*pose*/) {}
  virtual void takeGroundTruth(const LineSet& /*ground_truth*/) {}
  /// Detected lines, behind their image.
  virtual void takeLines(const LineSet& /*lines*/, const ImagePart& /*image*/) {}
  /// Behind the lines and images that they are between; the frames are those of the matches.
  virtual void takeMatches(const MatchSet& /*matches*/, const Frame& /*first*/,
                           const Frame& /*second*/) {}
  /// What the reader of the results must know: an image or a pair that a method refused.
  virtual void takeNote(const std::string& /*text*/) {}
};

/// What comes out depends neither on the number of threads nor on how the parts are cut into
/// batches.
class FrontEnd {
 public:
  /// Throws what the two makers throw. `pool` outlives the object.
  FrontEnd(FrontEndOptions options, WorkerPool* pool);

  /// Whether every detected line carries a score.
  bool givesScores() const;

  /// The next parts of the recording.
  void process(std::vector<StreamPart> parts, FrontEndSink* sink);

  /// What the associator counted since the start, over all passes; "" where it counted nothing.
  std::string note() const;

  /// Of detection, description and matching.
  const StageTimes& stageTimes() const { return times_; }

 private:
  struct Pair {
    std::shared_ptr<FrameLines> first;
    std::shared_ptr<FrameLines> second;
    std::size_t phase = 0;
    MatchSet matches;
    std::string problem;
  };
  /// What becomes of one part.
  struct Outcome {
    std::optional<LineSet> lines;
    std::shared_ptr<FrameLines> frame;  ///< to be associated
    std::string problem;
    std::optional<std::size_t> pair;  ///< that this part completes
  };

  void detect(const std::vector<StreamPart>& parts, std::vector<Outcome>* outcomes);
  void detectIn(const ImagePart& image, std::size_t worker, Outcome* outcome);
  void join(const std::vector<StreamPart>& parts, std::vector<Outcome>* outcomes);
  std::shared_ptr<FrameLines> joinTruth(const StreamPart& part);
  std::optional<std::size_t> extend(const std::shared_ptr<FrameLines>& frame);
  void describe(const std::vector<std::shared_ptr<FrameLines>>& frames);
  void match();
  void matchPair(std::size_t worker, Pair* pair);
  void give(const std::vector<StreamPart>& parts, const std::vector<Outcome>& outcomes,
            FrontEndSink* sink);
  void collectTimes();

  FrontEndOptions options_;
  WorkerPool* pool_;
  std::vector<std::shared_ptr<LineDetector>> detectors_;      ///< by worker
  std::vector<std::shared_ptr<LineAssociator>> associators_;  ///< by worker
  StageTimes times_;
  std::vector<StageTimes> worker_times_;

  std::optional<Camera> camera_;            ///< the newest
  std::map<Stamp, Frame> waiting_images_;   ///< for their ground truth
  std::map<Stamp, LineSet> waiting_truth_;  ///< for its image
  std::string truth_source_;
  std::deque<std::shared_ptr<FrameLines>> window_;  ///< the last frame_step frames with lines
  std::size_t pairs_begun_ = 0;                     ///< since the window was empty
  std::vector<Pair> pairs_;                         ///< of this batch
};

}  // namespace evolin
