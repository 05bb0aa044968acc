// Pictures of the frames that a detector did worst on.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <vector>

#include "evolin_ros/evaluation/front_end.h"
#include "evolin_ros/metrics/line_verdicts.h"

namespace evolin::cli {

/// Judges every frame with lines and ground truth by the structural distance and keeps the
/// `count` with the lowest F-score (of equals the earlier ones), images included; nothing with a
/// count of 0. A frame that cannot be judged is none of them.
class WorstFrames : public FrontEndSink {
 public:
  /// Under the smallest threshold and the protocol of `options`.
  WorstFrames(std::size_t count, const VectorizedOptions& options);

  void takeGroundTruth(const LineSet& ground_truth) override;
  void takeLines(const LineSet& lines, const ImagePart& image) override;

  /// worst_frames.csv and worst_frames/N.jpg in `folder`, from the worst on; neither when no frame
  /// was judged. Throws Error naming the file.
  void write(const std::filesystem::path& folder) const;

 private:
  struct Kept {
    Frame frame;
    LineSet lines;
    LineSegments ground_truth;
    LineVerdicts verdicts;
    double f_score = 0;
  };

  bool isWanted() const { return count_ > 0; }
  void judge(Kept frame);
  void forgetOld();
  void draw(const Kept& kept, const std::filesystem::path& file) const;

  std::size_t count_;
  Protocol protocol_;
  VectorizedSetting setting_;
  std::map<Stamp, Kept> waiting_lines_;     ///< for their ground truth
  std::map<Stamp, LineSet> waiting_truth_;  ///< for its lines
  std::vector<Kept> worst_;                 ///< by rising F-score, then stamp
};

}  // namespace evolin::cli
