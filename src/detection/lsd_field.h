// The level-line field of LSD: where an image has a gradient, which way its level lines run there,
// and the order in which pixels become seeds.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "evolin_ros/detection/lsd.h"

namespace evolin::lsd {

/// The level line's angle where there is none.
constexpr float kNoAngle = -1000.0F;

/// Maps of the scaled image, row after row without gaps. A pixel stands for the corner between four
/// pixels of the image, so that the last row and column have no level lines.
struct Field {
  int width = 0;
  int height = 0;
  std::vector<float> angles;        ///< radians from 0 to 2 pi, or kNoAngle
  std::vector<float> magnitudes;    ///< grey levels a pixel; set where there is an angle
  std::vector<std::int32_t> seeds;  ///< indices of pixels with an angle

  std::size_t size() const { return angles.size(); }
};

enum class SeedOrder : std::uint8_t {
  kStrength,   ///< by bins of the gradient's magnitude, rows within a bin: the article
  kIntrosort,  ///< as OpenCV before 4.8 sorts them
  kRows,       ///< row after row
};

/// Where implementations of LSD differ before regions grow.
struct FieldStyle {
  SeedOrder order = SeedOrder::kIntrosort;
  bool exact_scaling = true;  ///< cv::INTER_LINEAR_EXACT, else cv::INTER_LINEAR; they differ by a
                              ///< grey level here and there
};

/// Makes fields of one image after the other in buffers that it keeps.
class FieldBuilder {
 public:
  FieldBuilder(const LsdParameters& parameters, const FieldStyle& style)
      : parameters_(parameters), style_(style) {}

  /// `gray`: CV_8UC1. A field of no size where nothing is left after scaling.
  void build(const cv::Mat& gray, Field* field);

 private:
  void differentiate(const cv::Mat& image, Field* field);
  void sortSeeds(Field* field);

  LsdParameters parameters_;
  FieldStyle style_;
  double weakest_ = 0;                // least gradient with an angle, grey levels a pixel
  std::int32_t greatest_square_ = 0;  // of what squares_ holds
  cv::Mat smoothed_;
  cv::Mat scaled_;
  std::vector<std::int32_t> squares_;  // of twice the gradient
  std::vector<std::uint64_t> bins_of_weak_;
  std::vector<std::uint64_t> keys_;
};

}  // namespace evolin::lsd
