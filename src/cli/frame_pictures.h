// Pictures of evaluated frames and of matched pairs, one after the other as a front-end gives them.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "evolin_ros/drawing/evaluation_view.h"
#include "evolin_ros/evaluation/front_end.h"
#include "evolin_ros/metrics/vectorized.h"

namespace evolin::cli {

/// Takes a picture (CV_8UC3); `name` serves as a file's stem.
using TakePicture = std::function<void(const std::string& name, const cv::Mat& picture)>;

struct PictureOptions {
  Protocol protocol = Protocol::kEvolin;
  VectorizedSetting setting{LineDistance::kStructural, 5};  ///< when a line counts as found
  ViewOptions view;
};

/// Joins images, lines and ground truth by stamp and draws them in order of time. An image that
/// waits in vain for one of the others is drawn without.
class FramePictures : public FrontEndSink {
 public:
  FramePictures(PictureOptions options, TakePicture take);

  void takeImage(const ImagePart& image) override;
  void takeGroundTruth(const LineSet& ground_truth) override;
  void takeLines(const LineSet& lines, const ImagePart& image) override;
  void takeNote(const std::string& text) override { notes_.push_back(text); }

  /// Draws what still waits.
  void finish() { flush(0); }

  std::size_t pictures() const { return pictures_; }
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  struct Waiting {
    Frame frame;
    std::optional<LineSet> lines;
    std::optional<LineSet> ground_truth;
  };

  void flush(std::size_t most);
  void draw(const Waiting& waiting);
  void judge(const Waiting& waiting, EvaluatedFrame* frame);

  PictureOptions options_;
  TakePicture take_;
  std::map<Stamp, Waiting> waiting_;
  Classification sums_;
  std::size_t pictures_ = 0;
  std::vector<std::string> notes_;
};

/// Both images of each pair side by side, with the matched lines in a colour of their own.
class MatchPictures : public FrontEndSink {
 public:
  /// Lines are kept until `reach` images have followed.
  MatchPictures(std::size_t reach, TakePicture take);

  void takeGroundTruth(const LineSet& ground_truth) override { keep(ground_truth); }
  void takeLines(const LineSet& lines, const ImagePart& /*image*/) override { keep(lines); }
  void takeMatches(const MatchSet& matches, const Frame& first, const Frame& second) override;
  void takeNote(const std::string& text) override { notes_.push_back(text); }

  std::size_t pictures() const { return pictures_; }
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  void keep(const LineSet& lines);
  const LineSet* find(Stamp stamp, const std::string& source) const;

  std::size_t reach_;
  TakePicture take_;
  std::map<std::string, std::map<Stamp, LineSet>> lines_;  ///< by source
  std::size_t pictures_ = 0;
  std::vector<std::string> notes_;
};

}  // namespace evolin::cli
