// Sorting of lines into blocks, and what the bounds of a question have to allow for.
#include "near_lines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace evolin {

namespace {

/// Of each axis. Lines are sorted by length first, as a long one widens the reach of its block.
constexpr std::size_t kCells = 8;
constexpr std::size_t kLengths = 3;

float narrow(double value) { return static_cast<float>(value); }

double largestCoordinate(const LineSegment& line) {
  return std::max({std::abs(line.x1), std::abs(line.y1), std::abs(line.x2), std::abs(line.y2)});
}

double squaredLength(const LineSegment& line) {
  const double dx = line.x2 - line.x1;
  const double dy = line.y2 - line.y1;
  return dx * dx + dy * dy;
}

/// Without what the structural distance does not ask for.
NarrowLine narrowedEnds(const LineSegment& line) {
  return {narrow(line.x1), narrow(line.y1), narrow(line.x2), narrow(line.y2), 0, 0, 0, 0, 0, 0};
}

NarrowLine narrowed(const LineSegment& line, double squared_length) {
  const double length = std::sqrt(squared_length);
  const double inverse_length = 1 / length;
  const double unit_x = (line.y1 - line.y2) * inverse_length;
  const double unit_y = (line.x2 - line.x1) * inverse_length;
  NarrowLine result = narrowedEnds(line);
  result.normal_x = narrow(unit_x);
  result.normal_y = narrow(unit_y);
  result.offset = narrow(-(unit_x * line.x1 + unit_y * line.y1));
  result.along = narrow(unit_x * line.y1 - unit_y * line.x1);
  result.length = narrow(length);
  result.inverse_length = narrow(inverse_length);
  return result;
}

void setLine(const NarrowLine& line, std::size_t lane, LineBlock* block) {
  block->x1[lane] = line.x1;
  block->y1[lane] = line.y1;
  block->x2[lane] = line.x2;
  block->y2[lane] = line.y2;
  block->normal_x[lane] = line.normal_x;
  block->normal_y[lane] = line.normal_y;
  block->offset[lane] = line.offset;
  block->along[lane] = line.along;
  block->length[lane] = line.length;
  block->inverse_length[lane] = line.inverse_length;
}

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  double center() const { return (low + high) / 2; }
  double half() const { return (high - low) / 2; }
};

/// Rises with the value; NaN (of an infinite scale times 0) goes to 0.
std::size_t cellOf(double value, const Range& range, double scale) {
  const double cell = (value - range.low) * scale;
  return cell > 0 ? static_cast<std::size_t>(std::min(cell, kCells - 1.0)) : 0;
}

}  // namespace

NearLines::NearLines(const LineSegments& lines, CandidateFinder finder) : finder_(finder) {
  sortRows(lines);
  fillBlocks(lines);
  near_blocks_.resize(blocks_.size() + kBlockLines);
  for (std::vector<float>* bounds : {&structural_bounds_, &orthogonal_bounds_}) {
    bounds->resize(blocks_.size() * kBlockLines);
  }
  for (std::vector<std::uint32_t>* places : {&structural_, &orthogonal_}) {
    places->resize((blocks_.size() + 1) * kBlockLines);
  }
}

void NearLines::sortRows(const LineSegments& lines) {
  Range xs;
  Range ys;
  for (const LineSegment& line : lines) {
    xs.add(line.x1 + line.x2);
    ys.add(line.y1 + line.y2);
  }
  const double x_scale = kCells / (xs.high - xs.low);
  const double y_scale = kCells / (ys.high - ys.low);
  // Twice the side of the square that midpoints are spread over; an eighth and a third of it are
  // long.
  const double side = std::max(xs.high - xs.low, ys.high - ys.low);
  const double medium = side * side / (16 * 16);
  const double long_one = side * side / (6 * 6);

  std::vector<std::uint8_t> keys(lines.size());
  std::array<std::uint32_t, kLengths * kCells * kCells + 1> next{};
  static_assert(kLengths * kCells * kCells <= 256 && (kCells & (kCells - 1)) == 0,
                "keys are bytes, columns are turned bit by bit");
  for (std::size_t row = 0; row < lines.size(); ++row) {
    const LineSegment& line = lines[row];
    const double squared_length = squaredLength(line);
    // Without branches, as they would be taken at random.
    const std::size_t length = static_cast<std::size_t>(squared_length > medium) +
                               static_cast<std::size_t>(squared_length > long_one);
    const std::size_t column = cellOf(line.x1 + line.x2, xs, x_scale);
    const std::size_t cell = cellOf(line.y1 + line.y2, ys, y_scale);
    // Up and down the columns in turn, so that a block between two cells is of neighbours.
    const std::size_t place = cell ^ ((kCells - 1) * (column % 2));
    keys[row] = static_cast<std::uint8_t>((length * kCells + column) * kCells + place);
    ++next[keys[row] + std::size_t{1}];
  }
  std::partial_sum(next.begin(), next.end(), next.begin());
  rows_.resize(lines.size());
  for (std::size_t row = 0; row < lines.size(); ++row) {
    rows_[next[keys[row]]++] = static_cast<std::uint32_t>(row);
  }
}

void NearLines::fillBlocks(const LineSegments& lines) {
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  blocks_.resize((lines.size() + kBlockLines - 1) / kBlockLines);
  boxes_.resize((blocks_.size() + kBlockLines - 1) / kBlockLines);
  for (std::size_t number = 0; number < boxes_.size() * kBlockLines; ++number) {
    Range xs;
    Range ys;
    double squared_longest = 0;
    const std::size_t first = number * kBlockLines;
    const std::size_t count =
        first < lines.size() ? std::min(kBlockLines, lines.size() - first) : 0;
    for (std::size_t lane = 0; lane < count; ++lane) {
      const LineSegment& line = lines[rows_[first + lane]];
      const double squared_length = squaredLength(line);
      xs.add(line.x1 + line.x2);
      ys.add(line.y1 + line.y2);
      squared_longest = std::max(squared_longest, squared_length);
      largest_ = std::max(largest_, largestCoordinate(line));
      setLine(narrowed(line, squared_length), lane, &blocks_[number]);
    }
    for (std::size_t lane = count; number < blocks_.size() && lane < kBlockLines; ++lane) {
      setLine({kNone, kNone, kNone, kNone, kNone, kNone, kNone, kNone, kNone, kNone}, lane,
              &blocks_[number]);
    }
    BoxGroup& group = boxes_[number / kBlockLines];
    const std::size_t lane = number % kBlockLines;
    group.center_x[lane] = count > 0 ? narrow(xs.center()) : kNone;
    group.center_y[lane] = count > 0 ? narrow(ys.center()) : kNone;
    group.half_x[lane] = count > 0 ? narrow(xs.half()) : kNone;
    group.half_y[lane] = count > 0 ? narrow(ys.half()) : kNone;
    group.squared_longest[lane] = count > 0 ? narrow(squared_longest) : kNone;
  }
}

NearLines::Rows NearLines::rowsOf(std::vector<std::uint32_t>* places, std::size_t count) const {
  std::uint32_t* const first = places->data();
  for (std::size_t i = 0; i < count; ++i) {
    first[i] = rows_[first[i]];
  }
  return {first, first + count};
}

NearLines::Answer NearLines::find(const LineSegment& query, const NearQuestion& question) {
  const double squared_length = squaredLength(query);
  const double largest = std::max(largest_, largestCoordinate(query));
  // Single precision keeps 24 bits: distances are good to about 1e-6 of the largest coordinate.
  const double error = 1e-5 * (1 + largest);
  const double reach = (question.reach + error) * (1 + 1e-5);
  BoundQuestion bound;
  bound.line = question.orthogonal ? narrowed(query, squared_length) : narrowedEnds(query);
  bound.sum_x = narrow(query.x1 + query.x2);
  bound.sum_y = narrow(query.y1 + query.y2);
  bound.squared_length = narrow(squared_length);
  bound.squared_reach = narrow(reach * reach);
  bound.reach = narrow(reach);
  bound.error = narrow(error);
  bound.overlap = narrow(2 * question.min_overlap);
  bound.nearest = question.nearest;
  LineBound kind = LineBound::kStructural;
  if (!question.orthogonal) {
    // |p1-q1| + |p2-q2| >= |(p1+p2) - (q1+q2)|, and so for the crossed pairing.
    bound.box_reach = bound.squared_reach;
  } else if (question.min_overlap >= 0.5) {
    // One of two such lines is covered at its midpoint, which the other's has then within half of
    // that one's length along it and within reach across: |mid - mid|^2 <= (longer / 2)^2 +
    // reach^2. Here for sums of endpoints, so four times that: more than for the structural one.
    bound.box_reach =
        narrow(4 * question.reach * question.reach * (1 + 1e-4) + 1e-4 * (1 + largest * largest));
  } else {
    bound.box_reach = std::numeric_limits<float>::infinity();
  }
  if (question.orthogonal && question.min_overlap > 0) {
    kind = question.structural ? LineBound::kStructuralAndOverlapping : LineBound::kOverlapping;
  } else if (question.orthogonal) {
    kind = question.structural ? LineBound::kStructuralAndOrthogonal : LineBound::kOrthogonal;
  }
  const BoundSpace space = {near_blocks_.data(),
                            {structural_bounds_.data(), structural_.data()},
                            {orthogonal_bounds_.data(), orthogonal_.data()}};
  const BoundCounts found =
      finder_(kind, {blocks_.data(), boxes_.data(), blocks_.size()}, bound, space);
  return {rowsOf(&structural_, question.structural ? found.structural : 0),
          rowsOf(&orthogonal_, found.orthogonal)};
}

}  // namespace evolin
