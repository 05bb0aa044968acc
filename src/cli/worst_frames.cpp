// Judging as frames come, drawing at the end.
#include "worst_frames.h"

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <utility>

#include "evolin_ros/base/atomic_file.h"
#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"
#include "evolin_ros/dataset/image_file.h"
#include "evolin_ros/drawing/evaluation_view.h"

namespace evolin::cli {

namespace {

/// Frames whose other half may still come; it comes with the image or a few messages later.
constexpr std::size_t kWaiting = 64;
constexpr double kLargestWidth = 640;
constexpr int kJpegQuality = 85;

double smallest(const std::vector<double>& thresholds) {
  return thresholds.empty() ? 5 : *std::min_element(thresholds.begin(), thresholds.end());
}

}  // namespace

WorstFrames::WorstFrames(std::size_t count, const VectorizedOptions& options)
    : count_(count),
      protocol_(options.protocol),
      setting_{LineDistance::kStructural, smallest(options.distance_thresholds)} {}

void WorstFrames::takeGroundTruth(const LineSet& ground_truth) {
  if (!isWanted()) {
    return;
  }
  const auto lines = waiting_lines_.find(ground_truth.stamp);
  if (lines == waiting_lines_.end()) {
    waiting_truth_.emplace(ground_truth.stamp, ground_truth);
    forgetOld();
    return;
  }
  Kept frame = std::move(lines->second);
  waiting_lines_.erase(lines);
  frame.ground_truth = ground_truth.lines;
  judge(std::move(frame));
}

void WorstFrames::takeLines(const LineSet& lines, const ImagePart& image) {
  if (!isWanted()) {
    return;
  }
  Kept frame;
  frame.frame = image.frame;
  frame.lines = lines;
  const auto truth = waiting_truth_.find(lines.stamp);
  if (truth == waiting_truth_.end()) {
    waiting_lines_.emplace(lines.stamp, std::move(frame));
    forgetOld();
    return;
  }
  frame.ground_truth = std::move(truth->second.lines);
  waiting_truth_.erase(truth);
  judge(std::move(frame));
}

void WorstFrames::judge(Kept frame) {
  const cv::Mat& image = frame.frame.image;
  try {
    frame.verdicts = judgeLines(setting_, protocol_, {image.cols, image.rows}, frame.lines.lines,
                                frame.ground_truth, frame.lines.scored);
  } catch (const Error&) {
    return;  // the evaluation counts it and says why
  }
  frame.f_score = frame.verdicts.counts().fScore();
  const auto place =
      std::upper_bound(worst_.begin(), worst_.end(), frame, [](const Kept& a, const Kept& b) {
        return std::make_pair(a.f_score, a.lines.stamp) < std::make_pair(b.f_score, b.lines.stamp);
      });
  if (worst_.size() == count_ && place == worst_.end()) {
    return;
  }
  worst_.insert(place, std::move(frame));
  if (worst_.size() > count_) {
    worst_.pop_back();
  }
}

void WorstFrames::forgetOld() {
  while (waiting_lines_.size() > kWaiting) {
    waiting_lines_.erase(waiting_lines_.begin());
  }
  while (waiting_truth_.size() > kWaiting) {
    waiting_truth_.erase(waiting_truth_.begin());
  }
}

void WorstFrames::draw(const Kept& kept, const std::filesystem::path& file) const {
  EvaluatedFrame picture;
  picture.image = kept.frame.image;
  picture.lines = kept.lines.lines;
  picture.ground_truth = kept.ground_truth;
  picture.verdicts = kept.verdicts;
  ViewOptions options;
  options.margin = false;
  options.scale = std::clamp(kLargestWidth / std::max(kept.frame.image.cols, 1), 0.25, 1.0);
  writeImage(file, drawEvaluatedFrame(picture, options), {cv::IMWRITE_JPEG_QUALITY, kJpegQuality});
}

void WorstFrames::write(const std::filesystem::path& folder) const {
  if (worst_.empty()) {
    return;
  }
  std::string table =
      "stamp,file,distance,threshold,f_score,true_positives,false_positives,misses\n";
  for (std::size_t i = 0; i < worst_.size(); ++i) {
    const Kept& kept = worst_[i];
    const std::string name = "worst_frames/" + std::to_string(i + 1) + ".jpg";
    draw(kept, folder / name);
    table += formatStamp(kept.lines.stamp) + "," + name + "," + toString(setting_.distance) + "," +
             formatDouble(setting_.threshold) + "," + formatDouble(kept.f_score) + "," +
             std::to_string(kept.verdicts.count(LineVerdict::kTruePositive)) + "," +
             std::to_string(kept.verdicts.count(LineVerdict::kFalsePositive)) + "," +
             std::to_string(kept.verdicts.misses()) + "\n";
  }
  writeFileAtomically(folder / "worst_frames.csv", table);
}

}  // namespace evolin::cli
