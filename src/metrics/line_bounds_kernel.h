// The loops of findCandidates(), for files that are compiled for different processors. Everything
// has internal linkage and nothing of the standard library is used: the linker must not take one
// file's copy of a function for the other's.
#pragma once

#include "line_bounds.h"

namespace evolin {

namespace {

/// What the loops need of a processor, in terms of the compiler's own vectors.
struct FourLines {
  using Float __attribute__((vector_size(16))) = float;
  using Int __attribute__((vector_size(16))) = std::int32_t;

  // The second one where either is not a number.
  static Float smaller(const Float& a, const Float& b) { return a < b ? a : b; }
  static Float larger(const Float& a, const Float& b) { return a > b ? a : b; }
  /// One bit a lane.
  static unsigned bits(const Int& mask) {
    const Int bit = mask & Int{1, 2, 4, 8};
    return static_cast<unsigned>((bit[0] | bit[1]) | (bit[2] | bit[3]));
  }
  /// To `numbers` (room for kBlockLines) `first` plus the place of each bit; says how many.
  static std::size_t writePlaces(unsigned bits, std::uint32_t first, std::uint32_t* numbers) {
    std::size_t found = 0;
    for (; bits != 0; bits &= bits - 1) {
      numbers[found++] = first + static_cast<std::uint32_t>(__builtin_ctz(bits));
    }
    return found;
  }
};

constexpr bool isOverlapping(LineBound kind) {
  return kind == LineBound::kOverlapping || kind == LineBound::kStructuralAndOverlapping;
}
constexpr bool isOrthogonal(LineBound kind) { return kind != LineBound::kStructural; }
constexpr bool isStructural(LineBound kind) {
  return kind != LineBound::kOrthogonal && kind != LineBound::kOverlapping;
}

template <class Vectors>
class BoundLoops {
 public:
  /// By value: what is written to the space cannot change the question.
  template <LineBound kind>
  static BoundCounts findCandidates(const BlockedLines lines, const BoundQuestion question,
                                    const BoundSpace space) {
    // The whole line counts without the overlap, so that every block may matter.
    constexpr bool kEvery = isOrthogonal(kind) && !isOverlapping(kind);
    const std::size_t count =
        kEvery ? lines.blocks_count : findBlocks<kind>(lines, question, space.blocks);
    const auto block_at = [&](std::size_t i) { return kEvery ? i : space.blocks[i]; };
    Float lowest_structural = Float{} + __builtin_inff();
    Float lowest_orthogonal = lowest_structural;
    for (std::size_t i = 0; i < count; ++i) {
      const LineBlock& block = lines.blocks[block_at(i)];
      for (std::size_t lane = 0; lane < kBlockLines; lane += kWidth) {
        const std::size_t place = i * kBlockLines + lane;
        if constexpr (isStructural(kind)) {
          const Float bound = structuralBound(block, lane, question.line, &lowest_structural);
          __builtin_memcpy(space.structural.bounds + place, &bound, sizeof(bound));
        }
        if constexpr (isOrthogonal(kind)) {
          const Float bound =
              orthogonalBound<isOverlapping(kind)>(block, lane, question, &lowest_orthogonal);
          __builtin_memcpy(space.orthogonal.bounds + place, &bound, sizeof(bound));
        }
      }
    }
    const auto collect = [&](const BoundAnswer& answer, float reach) {
      const Float limit = Float{} + reach;
      std::size_t found = 0;
      for (std::size_t i = 0; i < count; ++i) {
        const float* const bounds = answer.bounds + i * kBlockLines;
        const unsigned bits =
            bitsOf([&](std::size_t lane) { return load(bounds + lane) <= limit; });
        if (bits != 0) {  // so it is of few blocks
          const auto first = static_cast<std::uint32_t>(block_at(i) * kBlockLines);
          found += Vectors::writePlaces(bits, first, answer.places + found);
        }
      }
      return found;
    };
    BoundCounts counts = {};
    if constexpr (isStructural(kind)) {
      counts.structural =
          collect(space.structural, structuralLimit(question, leastOf(lowest_structural)));
    }
    if constexpr (isOrthogonal(kind)) {
      counts.orthogonal =
          collect(space.orthogonal, orthogonalLimit(question, leastOf(lowest_orthogonal)));
    }
    return counts;
  }

 private:
  using Float = typename Vectors::Float;
  using Int = typename Vectors::Int;

  static constexpr std::size_t kWidth = sizeof(Float) / sizeof(float);
  static_assert(kBlockLines % kWidth == 0, "whole vectors");

  static Float load(const float* values) {
    Float vector;
    __builtin_memcpy(&vector, values, sizeof(vector));
    return vector;
  }

  static Float magnitude(const Float& values) {
    return reinterpret_cast<Float>(reinterpret_cast<Int>(values) & 0x7fffffff);
  }

  /// One bit for each of kBlockLines lanes whose part the mask holds.
  template <class Mask>
  static unsigned bitsOf(const Mask& mask) {
    unsigned bits = 0;
    for (std::size_t lane = 0; lane < kBlockLines; lane += kWidth) {
      bits |= Vectors::bits(mask(lane)) << lane;
    }
    return bits;
  }

  template <LineBound kind>
  static std::size_t findBlocks(const BlockedLines& lines, const BoundQuestion& question,
                                std::uint32_t* blocks) {
    const Float none = {};
    const Float reach = none + question.box_reach;
    const Float squared_length = none + question.squared_length;
    std::size_t found = 0;
    for (std::size_t first = 0; first < lines.blocks_count; first += kBlockLines) {
      const BoxGroup& boxes = lines.boxes[first / kBlockLines];
      const auto is_near = [&](std::size_t lane) {
        const Float dx = Vectors::larger(
            magnitude(load(boxes.center_x + lane) - question.sum_x) - load(boxes.half_x + lane),
            none);
        const Float dy = Vectors::larger(
            magnitude(load(boxes.center_y + lane) - question.sum_y) - load(boxes.half_y + lane),
            none);
        // Not a number where there is no block.
        Float extent = load(boxes.squared_longest + lane);
        if constexpr (isOverlapping(kind)) {
          extent = Vectors::larger(squared_length, extent);
        } else {
          extent *= 0.0F;
        }
        return dx * dx + dy * dy <= extent + reach;
      };
      found +=
          Vectors::writePlaces(bitsOf(is_near), static_cast<std::uint32_t>(first), blocks + found);
    }
    return found;
  }

  /// Squared: the smaller sum of squares, whose root is half of the distance at least. Lowers
  /// `lowest` to it.
  static Float structuralBound(const LineBlock& block, std::size_t lane, const NarrowLine& line,
                               Float* lowest) {
    const Float x1 = load(block.x1 + lane);
    const Float y1 = load(block.y1 + lane);
    const Float x2 = load(block.x2 + lane);
    const Float y2 = load(block.y2 + lane);
    const Float straight = squared(x1 - line.x1) + squared(y1 - line.y1) +
                           (squared(x2 - line.x2) + squared(y2 - line.y2));
    const Float crossed = squared(x1 - line.x2) + squared(y1 - line.y2) +
                          (squared(x2 - line.x1) + squared(y2 - line.y1));
    const Float bound = Vectors::smaller(straight, crossed);
    *lowest = Vectors::smaller(bound, *lowest);
    return bound;
  }

  /// The distance. Lowers `lowest` to that of lines which surely cover enough of each other.
  template <bool overlapping>
  static Float orthogonalBound(const LineBlock& block, std::size_t lane,
                               const BoundQuestion& question, Float* lowest) {
    const NarrowLine& line = question.line;
    const Float x1 = load(block.x1 + lane);
    const Float y1 = load(block.y1 + lane);
    const Float x2 = load(block.x2 + lane);
    const Float y2 = load(block.y2 + lane);
    const Float normal_x = load(block.normal_x + lane);
    const Float normal_y = load(block.normal_y + lane);
    const Float offset = load(block.offset + lane);
    const Float theirs = magnitude(line.normal_x * x1 + (line.normal_y * y1 + line.offset)) +
                         magnitude(line.normal_x * x2 + (line.normal_y * y2 + line.offset));
    const Float ours = magnitude(normal_x * line.x1 + (normal_y * line.y1 + offset)) +
                       magnitude(normal_x * line.x2 + (normal_y * line.y2 + offset));
    const Float distance = 0.5F * (theirs + ours);
    if constexpr (!overlapping) {
      *lowest = Vectors::smaller(distance, *lowest);
      return distance;
    }
    const Float along = load(block.along + lane);
    const Float inverse_length = load(block.inverse_length + lane);
    const Float covered = share(line.normal_y * x1 - line.normal_x * y1 + line.along,
                                line.normal_y * x2 - line.normal_x * y2 + line.along,
                                Float{} + line.length, Float{} + line.inverse_length) +
                          share(normal_y * line.x1 - normal_x * line.y1 + along,
                                normal_y * line.x2 - normal_x * line.y2 + along,
                                load(block.length + lane), inverse_length);
    const Float doubt = question.error * (inverse_length + line.inverse_length) + 1e-5F;
    // What is not a number, as the lines are too short, is neither too little nor enough.
    const Int too_little = covered + doubt < question.overlap;
    const Int enough = covered - doubt >= question.overlap;
    const Float never = Float{} + __builtin_inff();
    *lowest = Vectors::smaller(enough ? distance : never, *lowest);
    return too_little ? never : distance;
  }

  static Float squared(const Float& value) { return value * value; }

  /// Of a line, between two places along it.
  static Float share(const Float& a, const Float& b, const Float& length,
                     const Float& inverse_length) {
    const Float none = {};
    const Float low = Vectors::larger(Vectors::smaller(a, b), none);
    const Float high = Vectors::smaller(Vectors::larger(a, b), length);
    return Vectors::larger(high - low, none) * inverse_length;
  }

  static float leastOf(const Float& values) {
    float least = values[0];
    for (std::size_t lane = 1; lane < kWidth; ++lane) {
      least = values[lane] < least ? values[lane] : least;
    }
    return least;
  }

  // What bounds the nearest line has at most. The smallest distance is one error above what the
  // lowest bound says at most, and its own bound one above it.

  static float orthogonalLimit(const BoundQuestion& question, float lowest) {
    const float limit = 1.0001F * (lowest + 2 * question.error);
    return question.nearest && limit < question.reach ? limit : question.reach;
  }

  /// From the bound b^2 to the distance it is 2^(1/2) b, and (2^(1/2) b + 2 e)^2 <= 1.01 * 2 b^2 +
  /// 101 * 4 e^2.
  static float structuralLimit(const BoundQuestion& question, float lowest) {
    const float limit = 2.03F * lowest + 410 * question.error * question.error;
    return question.nearest && limit < question.squared_reach ? limit : question.squared_reach;
  }
};

template <class Vectors>
BoundCounts findCandidatesWith(LineBound kind, const BlockedLines& lines,
                               const BoundQuestion& question, const BoundSpace& space) {
  using Loops = BoundLoops<Vectors>;
  switch (kind) {
    case LineBound::kStructural:
      return Loops::template findCandidates<LineBound::kStructural>(lines, question, space);
    case LineBound::kOrthogonal:
      return Loops::template findCandidates<LineBound::kOrthogonal>(lines, question, space);
    case LineBound::kOverlapping:
      return Loops::template findCandidates<LineBound::kOverlapping>(lines, question, space);
    case LineBound::kStructuralAndOrthogonal:
      return Loops::template findCandidates<LineBound::kStructuralAndOrthogonal>(lines, question,
                                                                                 space);
    case LineBound::kStructuralAndOverlapping:
      break;
  }
  return Loops::template findCandidates<LineBound::kStructuralAndOverlapping>(lines, question,
                                                                              space);
}

}  // namespace

}  // namespace evolin
