// From a region of LSDNet to segments: its axis, and cuts along it where it holds several lines.
#pragma once

#include <vector>

#include "evolin_ros/geometry/line_segment.h"
#include "lsdnet_regions.h"

namespace evolin::lsdnet {

/// A segment on the network's maps, whole pixels, and the mean probability of its pixels.
struct MapSegment {
  int x1 = 0;
  int y1 = 0;
  int x2 = 0;
  int y2 = 0;
  float score = 0;
};

/// Keeps its memory from region to region.
class Splitter {
 public:
  /// With `swapped_axes`, a region of one row or one column is measured across instead of along, as
  /// the authors do, which gives segments of no length.
  explicit Splitter(bool swapped_axes) : swapped_axes_(swapped_axes) {}

  /// Appends the region's segments in the order of their places across it.
  void split(const Region& region, const RegionGrowing& maps, std::vector<MapSegment>* segments);

 private:
  /// The region's centre and its axis, a unit vector (along rows, along columns).
  struct Frame {
    float row = 0;
    float column = 0;
    float along_rows = 1;
    float along_columns = 0;
  };

  /// A pixel in the region's own frame.
  struct Sample {
    float along;
    float across;
    float probability;
  };

  bool makeFrame(const Region& region, const RegionGrowing& maps, Frame* frame) const;
  void findCuts();
  static MapSegment segmentOf(const Frame& frame, const Sample* begin, const Sample* end);

  bool swapped_axes_;
  std::vector<Sample> samples_;
  std::vector<float> cuts_;  ///< in rising order
};

}  // namespace evolin::lsdnet
