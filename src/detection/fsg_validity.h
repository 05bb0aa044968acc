// The a-contrario measure of FSG: how likely segments in noise are as well aligned as a group.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace evolin::fsg {

/// Two endpoints, pixels.
struct Segment {
  cv::Point2f a;
  cv::Point2f b;
  float length = 0;
};

/// The chance that a random segment of `length` pixels whose middle lies in a strip of `width`
/// pixels lies in it altogether; 0 for no width.
double insideStrip(double width, double length);

/// For images of one size and one density of segments.
class Validity {
 public:
  /// `segments` in noise: the image's pixels over the density.
  Validity(cv::Size size, double segment_density);

  /// Natural logarithm of the number of false alarms of the group of `members` and `candidate`,
  /// measured in a rectangle along the candidate; the least double where it has no area.
  double logNfa(const std::vector<Segment>& members, const Segment& candidate);

  cv::Size size() const { return size_; }

 private:
  double logGroups(std::size_t members);

  cv::Size size_;
  double segments_;
  std::vector<double> log_groups_;  // ways of choosing 0, 1, 2, ... segments
};

}  // namespace evolin::fsg
