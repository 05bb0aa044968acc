// Nearest line of a fixed set under the distances of geometry/distance.h, found quickly.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "evolin_ros/geometry/distance.h"
#include "evolin_ros/geometry/line_segment.h"

namespace evolin {

/// `distance` is infinite when no line of the set is within reach; `row` means nothing then.
struct NearestLine {
  std::uint32_t row = 0;
  double distance = std::numeric_limits<double>::infinity();
};

/// Holds the lines of one frame for any number of questions. A question goes to the lines whose
/// midpoints are near enough in x, computes a lower bound (or an estimate) of their distances in
/// single precision, in one loop over flat arrays that compilers turn into vector instructions, and
/// then the exact distance of the few candidates left; answers equal those of an exhaustive search
/// to the last bit. One thread at a time.
class NearestLineSearch {
 public:
  explicit NearestLineSearch(const LineSegments& lines);

  /// The line with the smallest distance to `query` among those at most `reach` away; the lowest
  /// row on ties. `reach` is finite; `overlap_gate` matters to the orthogonal distance alone.
  NearestLine find(LineDistance distance, const LineSegment& query, double reach,
                   bool overlap_gate);

 private:
  /// Positions [begin, end) in the flat arrays.
  struct Window {
    std::size_t begin;
    std::size_t end;
  };

  /// A line in single precision with its unit normal: normal . p + offset = 0 on it.
  struct OrthogonalQuery {
    explicit OrthogonalQuery(const LineSegment& line);

    float x1, y1, x2, y2;
    float normal_x, normal_y, offset;
  };

  std::size_t bucketOf(double sum_x) const;
  void fillBuckets(const LineSegments& lines);

  /// Holds all lines whose endpoints' x add up to a number at most `width` from `sum_x`.
  Window windowAround(double sum_x, double width) const;

  // Each fills candidates_ with positions whose bounds_ are at most `limit`, rising, and returns
  // their number.
  std::size_t boundStructural(const LineSegment& query, Window window, float limit);
  std::size_t boundOrthogonal(const LineSegment& query, float limit);
  std::size_t boundGated(const LineSegment& query, double reach, float limit);

  std::size_t collect(Window window, float limit);

  /// The orthogonal distance without the gate and with less care for the last bits.
  float estimate(const OrthogonalQuery& query, std::size_t position) const;

  static constexpr std::size_t kBuckets = 64;

  LineSegments lines_;               ///< by bucket, that is, roughly by rising midpoint
  std::vector<std::uint32_t> rows_;  ///< as the lines were given
  std::array<std::uint32_t, kBuckets + 1> bucket_begin_ = {};  ///< positions
  double bucket_origin_ = 0;
  double bucket_scale_ = 0;
  double largest_ = 0;  ///< absolute value of a coordinate
  double longest_ = 0;
  std::vector<float> x1_, y1_, x2_, y2_;
  std::vector<float> sum_x_, sum_y_;  ///< endpoints added up
  std::vector<float> squared_length_;
  std::vector<float> normal_x_, normal_y_, offset_;  ///< unit normal . p + offset = 0
  std::vector<float> bounds_;                        ///< of the question being answered
  std::vector<std::uint32_t> candidates_;            ///< positions whose bound is within reach
};

}  // namespace evolin
