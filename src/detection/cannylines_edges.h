// The edges of CannyLines: Canny's filter with thresholds from the image's gradients, and chains of
// edge pixels of a similar direction.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "canny_edges.h"
#include "evolin_ros/detection/cannylines.h"
#include "pixel_chains.h"
#include "smoothed_gradient.h"

namespace evolin::cannylines {

/// Finds the edges of one image after the other, in buffers that it keeps.
class EdgeFinder {
 public:
  explicit EdgeFinder(const CannyLinesParameters& parameters)
      : parameters_(parameters), gradient_(3, parameters.sigma) {}

  /// `gray`: CV_8UC1, any size.
  void find(const cv::Mat& gray);

  /// The least number of aligned pixels that noise would hardly have.
  std::size_t meaningfulLength() const { return meaningful_length_; }

  /// Chains of at least that length, the strongest seeds' first.
  const PixelChains& chains() const { return chains_; }

  const std::vector<EdgePixel>& edgePixels() const { return seeds_; }
  const GradientMaps& maps() const { return maps_; }

  int strength(EdgePixel p) const { return maps_.strength[maps_.at(p.x, p.y)] >> 1; }

  /// The share of pixels with a gradient that have at least that of `strength`.
  double shareFrom(int strength) const {
    return static_cast<double>(from_[static_cast<std::size_t>(strength)]) /
           static_cast<double>(from_[0]);
  }

  /// The logarithm of the number of pairs of pixels of an equal gradient.
  double logPairs() const { return log_pairs_; }

 private:
  bool chooseThresholds(double* low, double* high);
  void sortSeeds();
  void chain();
  void follow(EdgePixel from);
  std::uint8_t sector(EdgePixel p) const;

  CannyLinesParameters parameters_;
  SmoothedGradient gradient_;
  GradientMaps maps_;
  CannyEdges edges_;
  std::size_t meaningful_length_ = 0;
  double log_pairs_ = 0;
  std::vector<std::uint32_t> from_;  // pixels with a gradient of at least the index
  std::vector<std::uint8_t> sectors_;
  std::vector<std::uint32_t> slots_;
  std::vector<EdgePixel> unsorted_seeds_;
  std::vector<EdgePixel> seeds_;
  PixelChains chains_;
};

}  // namespace evolin::cannylines
