// Which lines of a frame may be near another line, told in single precision for many of them at
// once.
#pragma once

#include <cstddef>
#include <cstdint>

namespace evolin {

constexpr std::size_t kBlockLines = 8;

/// A line with what distances to it take; all but the endpoints is not a number where the line has
/// no length.
struct NarrowLine {
  float x1, y1, x2, y2;
  float normal_x, normal_y, offset;  ///< of length 1; normal . p + offset = 0 on the line
  float along;  ///< normal_y x - normal_x y + along: how far along the line, from its first end
  float length, inverse_length;
};

/// Neighbouring lines, value by value as in NarrowLine; places without a line hold NaN.
struct alignas(64) LineBlock {
  float x1[kBlockLines];
  float y1[kBlockLines];
  float x2[kBlockLines];
  float y2[kBlockLines];
  float normal_x[kBlockLines];
  float normal_y[kBlockLines];
  float offset[kBlockLines];
  float along[kBlockLines];
  float length[kBlockLines];
  float inverse_length[kBlockLines];
};

/// As many blocks: the boxes that the sums of their lines' endpoints lie in (NaN: no block).
struct alignas(64) BoxGroup {
  float center_x[kBlockLines];
  float center_y[kBlockLines];
  float half_x[kBlockLines];  ///< half of the box's width
  float half_y[kBlockLines];
  float squared_longest[kBlockLines];  ///< of the block's lines
};

struct BlockedLines {
  const LineBlock* blocks;
  const BoxGroup* boxes;
  std::size_t blocks_count;
};

/// Which distances are asked for.
enum class LineBound {
  kStructural,
  kOrthogonal,
  kOverlapping,  ///< orthogonal, of lines that cover enough of each other
  kStructuralAndOrthogonal,
  kStructuralAndOverlapping,
};

struct BoundQuestion {
  NarrowLine line;
  float sum_x, sum_y;  ///< of the endpoints
  float squared_length;
  /// Of sums of endpoints, squared: those of lines that are wanted are not farther apart.
  /// kOverlapping: but for the longer line's squared length.
  float box_reach;
  float squared_reach;  ///< structural: what is farther away is not wanted
  float reach;          ///< orthogonal
  float error;          ///< that a distance may have
  float overlap;  ///< kOverlapping: least sum of the shares that two lines cover of each other
  bool nearest;   ///< whether the lines with the smallest distance alone are wanted
};

/// Of one distance: a number for each place of a block, and the answer, as many places.
struct BoundAnswer {
  float* bounds;
  std::uint32_t* places;
};

/// Room for all blocks; for kBlockLines more numbers of the blocks and places, which may be written
/// to.
struct BoundSpace {
  std::uint32_t* blocks;
  BoundAnswer structural;
  BoundAnswer orthogonal;
};

struct BoundCounts {
  std::size_t structural;
  std::size_t orthogonal;
};

/// To the places where the wanted lines stand (block times kBlockLines and place therein), and
/// where some others do: processors differ in these. Says how many.
BoundCounts findCandidates(LineBound kind, const BlockedLines& lines, const BoundQuestion& question,
                           const BoundSpace& space);

using CandidateFinder = decltype(&findCandidates);

namespace generic {
BoundCounts findCandidates(LineBound kind, const BlockedLines& lines, const BoundQuestion& question,
                           const BoundSpace& space);
}
/// For processors with AVX2 and FMA alone, where there are such.
namespace wide {
BoundCounts findCandidates(LineBound kind, const BlockedLines& lines, const BoundQuestion& question,
                           const BoundSpace& space);
}

}  // namespace evolin
