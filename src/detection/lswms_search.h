// The search of LSWMS: a seed slides onto the ridge of an edge by mean shift, and a line grows
// along the edge both ways.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "evolin_ros/detection/lswms.h"
#include "smoothed_gradient.h"

namespace evolin::lswms {

/// A line from `a` to `b`, in pixels of the image.
struct Found {
  cv::Point a;
  cv::Point b;
  float published_error = 0;  ///< what the published code compares, radians; often 0 instead
  float error = 0;  ///< mean angle between gradients and normal when last measured, radians
};

/// Searches one image after the other, in buffers that it keeps.
class Search {
 public:
  explicit Search(const LswmsParameters& parameters);

  /// The lines of `gray` (CV_8UC1) in the order of their seeds, until the next call.
  const std::vector<Found>& run(const cv::Mat& gray);

  /// Pixels around the image in the maps; lines of the published code are shifted by what this is
  /// more than twice the radius.
  int margin() const { return margin_; }

 private:
  /// A point on an edge and its gradient, of length 1 and gx >= 0.
  struct Ridge {
    cv::Point at;
    cv::Point2f gradient;
  };

  struct Growth {
    cv::Point end;
    float published_error = 0;
    float error = 0;
  };

  /// One walk along a line of pixels.
  struct Walk {
    cv::Point end;
    float error = 0;
  };

  void buildMaps(const cv::Mat& gray);
  bool generate(cv::Point seed, Found* found);
  bool meanShift(cv::Point p, cv::Point2f gradient, bool avoid_visited, Ridge* ridge);
  bool shiftOnce(cv::Point p, float angle, cv::Point* offset, float* mean);
  Growth grow(cv::Point from, cv::Point2f gradient, bool other_side);
  Growth refine(cv::Point from, cv::Point2f gradient, Growth grown);
  Walk walk(cv::Point from, cv::Point to, float angle);
  bool agrees(float angle, float pixel_angle, float* difference) const;
  void markLine(cv::Point from, cv::Point to);
  void markVisited(cv::Rect window);

  bool isInside(cv::Point p) const {
    return p.x >= 0 && p.y >= 0 && p.x < maps_.width && p.y < maps_.height;
  }
  float cachedAngle(std::size_t i);

  int radius_;
  float tolerance_;
  float max_error_;
  int margin_ = 0;
  int threshold_ = 0;
  cv::Mat padded_;
  SmoothedGradient gradient_;
  GradientMaps maps_;  // derivatives turned so that dx >= 0
  std::vector<std::uint8_t> strength_;
  std::vector<std::uint8_t> visited_;
  std::vector<float> raw_angles_;
  std::vector<float> angles_;  // as mean shifts left them
  std::vector<cv::Point> centres_;
  std::vector<Found> found_;

  // Of one growth: pixels without a gradient so far, and the error term of its pixel walks.
  int gaps_ = 0;
  int carry_ = 0;
};

}  // namespace evolin::lswms
