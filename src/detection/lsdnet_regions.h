// Line support regions of LSDNet: pixels of the mask that agree in angle and probability
// (Teplyakov, Erlygin, Shvets: LSDNet, IEEE Access 10, 2022).
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

namespace evolin::lsdnet {

/// A region's pixels as indices row * columns + column, in the order in which they came to it.
struct Region {
  std::vector<int> pixels;
  float mean_x = 0;  ///< mean of the doubled angle's vectors, a unit vector
  float mean_y = 0;
};

using Regions = std::vector<Region>;

/// The mask of one image, the direction at each of its pixels, and the growing.
class RegionGrowing {
 public:
  /// Reads a contiguous float array [rows, columns, 2] of probability and angle / pi, which must
  /// outlive the growing. Values that are not finite are off the mask.
  void setMaps(const float* maps, int rows, int columns);

  /// The regions of more than 10 pixels in a part of the image, in the order in which they were
  /// begun: by falling probability of their first pixel. Pixels of one part are used once.
  Regions grow(const cv::Rect& part);

  int rows() const { return rows_; }
  int columns() const { return columns_; }
  float probability(int pixel) const { return maps_[2 * static_cast<std::size_t>(pixel)]; }

 private:
  void makeMask();
  void growFrom(int seed, const cv::Rect& part, Region* region);

  const float* maps_ = nullptr;
  int rows_ = 0;
  int columns_ = 0;
  cv::Mat bytes_;  ///< the probabilities in 256 steps
  cv::Mat mask_;
  std::vector<float> direction_x_;
  std::vector<float> direction_y_;
  std::vector<std::uint8_t> free_;  ///< on the mask and in no region yet
  std::vector<int> seeds_;
};

/// Squared distance of two means below which regions, or a pixel and its region, agree.
constexpr float kDirectionTolerance = 0.05F;

}  // namespace evolin::lsdnet
