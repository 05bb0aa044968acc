// Ordinary least squares from running sums, and the joining of collinear lines.
#include "edlines_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

namespace evolin::edlines {
namespace {

constexpr int kMostBadPixels = 4;             // in a row, within a line
constexpr std::size_t kFewestGoodPixels = 2;  // that make a line longer
constexpr double kStraight = 1e-3;            // rise of a line without slope, pixels
constexpr std::size_t kPixelGap = 5;          // between lines whose pixels are counted together

bool isSteep(const PixelSums& s) { return s.n * s.xx - s.x * s.x < s.n * s.yy - s.y * s.y; }

LineEquation equation(const PixelSums& s, bool steep) {
  const double u = steep ? s.y : s.x;
  const double v = steep ? s.x : s.y;
  const double uu = steep ? s.yy : s.xx;
  const double spread = s.n * uu - u * u;
  return {(uu * v - u * s.xy) / spread, (s.n * s.xy - u * v) / spread, steep};
}

/// Mean squared distance of the pixels from their `line`, which is not level.
double squaredError(const PixelSums& s, const LineEquation& line) {
  const double u = line.steep ? s.y : s.x;
  const double v = line.steep ? s.x : s.y;
  const double uv = s.n * s.xy - u * v;
  const double vv = line.steep ? s.n * s.xx - s.x * s.x : s.n * s.yy - s.y * s.y;
  return (vv - line.b * uv) / (s.n * s.n * (1 + line.b * line.b));
}

/// The error of a first fit: root mean square, or the mean distance from a level line.
double fitError(const PixelSums& sums, const LineEquation& line, const EdgePixel* pixels,
                std::size_t size) {
  if (line.b != 0) {
    return std::sqrt(std::max(0.0, squaredError(sums, line)));
  }
  double total = 0;
  for (std::size_t i = 0; i < size; ++i) {
    total += std::abs((line.steep ? pixels[i].x : pixels[i].y) - line.a);
  }
  return total / static_cast<double>(size);
}

std::pair<double, double> project(const LineEquation& line, EdgePixel p) {
  const double u = line.steep ? p.y : p.x;
  const double v = line.steep ? p.x : p.y;
  const double foot = (u + line.b * (v - line.a)) / (1 + line.b * line.b);
  const double across = line.a + line.b * foot;
  return line.steep ? std::make_pair(across, foot) : std::make_pair(foot, across);
}

LineEquation equationOf(const LineSegment& segment) {
  const double dx = segment.x2 - segment.x1;
  const double dy = segment.y2 - segment.y1;
  LineEquation line;
  line.steep = std::abs(dx) < std::abs(dy);
  const double rise = line.steep ? dx : dy;
  const double u = line.steep ? segment.y1 : segment.x1;
  const double v = line.steep ? segment.x1 : segment.y1;
  if (std::abs(rise) < kStraight) {
    line.a = v + rise / 2;
  } else {
    line.b = rise / (line.steep ? dy : dx);
    line.a = v - line.b * u;
  }
  return line;
}

}  // namespace

void LineFitter::fit(const EdgePixel* pixels, std::size_t size, std::size_t window,
                     std::vector<FittedLine>* lines) const {
  const double limit = parameters_.pixel_distance * parameters_.pixel_distance;
  const auto isGood = [limit](const LineEquation& line, EdgePixel p) {
    return line.squaredDistance(p.x, p.y) <= limit;
  };
  std::size_t begin = 0;
  while (size - begin >= window) {
    // The first window of pixels on a line.
    PixelSums sums;
    for (std::size_t k = 0; k < window; ++k) sums.add(pixels[begin + k]);
    LineEquation line = equation(sums, isSteep(sums));
    while (fitError(sums, line, pixels + begin, window) > parameters_.first_fit_error) {
      if (begin + window == size) {
        return;
      }
      sums.remove(pixels[begin]);
      sums.add(pixels[begin + window]);
      ++begin;
      line = equation(sums, isSteep(sums));
    }

    std::size_t fitted = begin + window;  // behind the last pixel of the fit
    std::size_t next = fitted;
    std::size_t end = fitted;  // behind the last pixel that is used up
    while (next < size) {
      std::size_t last_good = next - 1;
      std::size_t good = 0;
      int bad = 0;
      for (; next < size; ++next) {
        if (isGood(line, pixels[next])) {
          last_good = next;
          ++good;
          bad = 0;
        } else if (++bad > kMostBadPixels) {
          break;
        }
      }
      if (good >= kFewestGoodPixels) {
        for (; fitted <= last_good; ++fitted) sums.add(pixels[fitted]);
        line = equation(sums, line.steep);
        next = last_good + 1;
        end = next;
      }
      if (good < kFewestGoodPixels || next >= size) {
        std::size_t first = begin;
        std::size_t last = last_good;
        while (first < last && !isGood(line, pixels[first])) ++first;
        while (last > first && !isGood(line, pixels[last])) --last;
        FittedLine found;
        std::tie(found.segment.x1, found.segment.y1) = project(line, pixels[first]);
        std::tie(found.segment.x2, found.segment.y2) = project(line, pixels[last]);
        if (found.segment.x1 != found.segment.x2 || found.segment.y1 != found.segment.y2) {
          found.equation = line;
          found.first = first;
          found.pixels = last - first + 1;
          lines->push_back(found);
          end = last + 1;
        }
        break;
      }
    }
    begin = end;
  }
}

bool LineFitter::tryToJoin(FittedLine* line, const FittedLine& other) const {
  const LineSegment& a = line->segment;
  const LineSegment& b = other.segment;
  // Start and end of one with start and end of the other.
  const std::array<LineSegment, 4> between = {{{a.x1, a.y1, b.x1, b.y1},
                                               {a.x1, a.y1, b.x2, b.y2},
                                               {a.x2, a.y2, b.x1, b.y1},
                                               {a.x2, a.y2, b.x2, b.y2}}};
  double gap = between[0].length();
  for (const LineSegment& way : between) gap = std::min(gap, way.length());
  if (gap > parameters_.join_distance) {
    return false;
  }
  const bool a_is_longer = a.length() > b.length();
  const LineEquation& longer = a_is_longer ? line->equation : other.equation;
  const LineSegment& shorter = a_is_longer ? b : a;
  const double error = std::sqrt(longer.squaredDistance(shorter.x1, shorter.y1)) +
                       std::sqrt(longer.squaredDistance((shorter.x1 + shorter.x2) / 2,
                                                        (shorter.y1 + shorter.y2) / 2)) +
                       std::sqrt(longer.squaredDistance(shorter.x2, shorter.y2));
  if (error / 3 > parameters_.join_error) {
    return false;
  }
  const auto span = [](const LineSegment& way) {
    return std::abs(way.x1 - way.x2) + std::abs(way.y1 - way.y2);
  };
  LineSegment whole = between[0];
  for (const LineSegment& way : between) {
    if (span(way) > span(whole)) whole = way;
  }
  if (line->first + line->pixels + kPixelGap >= other.first) {
    line->pixels += other.pixels;
  } else if (other.pixels > line->pixels) {
    line->first = other.first;
    line->pixels = other.pixels;
  }
  line->segment = whole;
  line->equation = equationOf(whole);
  return true;
}

void LineFitter::join(std::size_t from, std::vector<FittedLine>* lines) const {
  if (lines->size() - from < 2) {
    return;
  }
  std::size_t last = from;
  for (std::size_t i = from + 1; i < lines->size(); ++i) {
    if (!tryToJoin(&(*lines)[last], (*lines)[i])) {
      (*lines)[++last] = (*lines)[i];
    }
  }
  if (last > from && tryToJoin(&(*lines)[from], (*lines)[last])) {
    --last;
  }
  lines->resize(last + 1);
}

}  // namespace evolin::edlines
