// Smoothing, scaling, 2x2 gradients, and a counting sort by their strength.
#include "lsd_field.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace evolin::lsd {
namespace {

constexpr double kDegree = CV_PI / 180;

}  // namespace

void FieldBuilder::build(const cv::Mat& gray, Field* field) {
  const double scale = parameters_.scale;
  if (scale == 1) {
    differentiate(gray, field);
  } else {
    const cv::Size size(cvRound(gray.cols * scale), cvRound(gray.rows * scale));
    if (size.width < 2 || size.height < 2) {
      field->width = field->height = 0;
      field->angles.clear();
      field->seeds.clear();
      return;
    }
    const double sigma = scale < 1 ? parameters_.sigma_scale / scale : parameters_.sigma_scale;
    // Beyond that radius the weights are below a thousandth.
    const int radius = static_cast<int>(std::ceil(sigma * std::sqrt(2 * 3 * std::log(10.0))));
    cv::GaussianBlur(gray, smoothed_, cv::Size(2 * radius + 1, 2 * radius + 1), sigma, sigma,
                     cv::BORDER_REFLECT_101 | cv::BORDER_ISOLATED);
    cv::resize(smoothed_, scaled_, size, 0, 0, cv::INTER_LINEAR_EXACT);
    differentiate(scaled_, field);
  }
  sortSeeds(field);
}

void FieldBuilder::differentiate(const cv::Mat& image, Field* field) {
  field->width = image.cols;
  field->height = image.rows;
  const auto pixels = static_cast<std::size_t>(image.cols) * static_cast<std::size_t>(image.rows);
  field->angles.assign(pixels, kNoAngle);
  field->magnitudes.resize(pixels);
  unsorted_.clear();
  // Rounding may turn weaker gradients by more than the tolerance.
  const double weakest = parameters_.quantization / std::sin(parameters_.angle_tolerance * kDegree);
  greatest_ = 0;
  for (int y = 0; y + 1 < image.rows; ++y) {
    const std::uint8_t* here = image.ptr<std::uint8_t>(y);
    const std::uint8_t* below = image.ptr<std::uint8_t>(y + 1);
    const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(image.cols);
    for (int x = 0; x + 1 < image.cols; ++x) {
      const int falling = below[x + 1] - here[x];
      const int rising = here[x + 1] - below[x];
      const int gx = falling + rising;
      const int gy = falling - rising;
      const double magnitude = std::sqrt((gx * gx + gy * gy) / 4.0);
      greatest_ = std::max(greatest_, static_cast<float>(magnitude));
      if (magnitude <= weakest) {
        continue;
      }
      const std::size_t i = row + static_cast<std::size_t>(x);
      field->angles[i] = static_cast<float>(
          cv::fastAtan2(static_cast<float>(gx), static_cast<float>(-gy)) * kDegree);
      field->magnitudes[i] = static_cast<float>(magnitude);
      unsorted_.push_back(static_cast<std::int32_t>(i));
    }
  }
}

void FieldBuilder::sortSeeds(Field* field) {
  const int bins = parameters_.bins;
  const double steps = greatest_ > 0 ? (bins - 1) / static_cast<double>(greatest_) : 0;
  const auto bin = [&](std::int32_t i) {
    const auto strength = static_cast<int>(field->magnitudes[static_cast<std::size_t>(i)] * steps);
    return static_cast<std::size_t>(bins - 1 - std::clamp(strength, 0, bins - 1));
  };
  bin_begins_.assign(static_cast<std::size_t>(bins) + 1, 0);
  for (const std::int32_t i : unsorted_) {
    ++bin_begins_[bin(i) + 1];
  }
  for (std::size_t b = 1; b < bin_begins_.size(); ++b) {
    bin_begins_[b] += bin_begins_[b - 1];
  }
  field->seeds.resize(unsorted_.size());
  for (const std::int32_t i : unsorted_) {
    field->seeds[bin_begins_[bin(i)]++] = i;
  }
}

}  // namespace evolin::lsd
