// Following edges by their mean direction, and total least squares along them.
#include "fld_lines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "marked_pixels.h"

namespace evolin::fld {
namespace {

constexpr double kBorder = 5;    // pixels at the image's border in which no line lies
constexpr int kFirstCorner = 6;  // pixels of a square at the upper left without edges,
constexpr int kLastCorner = 5;   // and of one at the lower right
constexpr float kSharpTurn = 2;  // eighths of a turn at which an edge ends

/// A neighbour's place, and its direction in eighths of a turn.
struct Neighbour {
  int dx;
  int dy;
  float direction;
};

constexpr std::array<Neighbour, 8> kNeighbours = {{{1, 1, 0},
                                                   {0, 1, 1},
                                                   {-1, 1, 2},
                                                   {-1, 0, 3},
                                                   {-1, -1, 4},
                                                   {0, -1, -3},
                                                   {1, -1, -2},
                                                   {1, 0, -1}}};

/// a x + b y + c = 0 with a^2 + b^2 = 1.
struct Line {
  double a = 0;
  double b = 0;
  double c = 0;

  static Line through(double x, double y, double dx, double dy) {
    const double length = std::hypot(dx, dy);
    const double a = -dy / length;
    const double b = dx / length;
    return {a, b, -a * x - b * y};
  }

  double distance(EdgePixel p) const { return std::abs(a * p.x + b * p.y + c); }
};

/// The line of least squared distances, rounded as OpenCV's: whether a pixel is within a distance
/// may depend on it.
Line fit(const PixelSums& sums) {
  const double x = sums.x / sums.n;
  const double y = sums.y / sums.n;
  const double spread = (sums.xx / sums.n - x * x) - (sums.yy / sums.n - y * y);
  const double angle = static_cast<float>(std::atan2(2 * (sums.xy / sums.n - x * y), spread)) / 2;
  return Line::through(static_cast<float>(x), static_cast<float>(y),
                       static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)));
}

}  // namespace

const LineSegments& LineFinder::find(const cv::Mat& gray) {
  size_ = gray.size();
  lines_.clear();
  findEdges(gray);
  for (int y = 0; y < std::min(kFirstCorner, size_.height); ++y) {
    std::fill_n(edges_.row(y), std::min(kFirstCorner, size_.width), std::uint8_t{0});
  }
  for (int y = std::max(0, size_.height - kLastCorner); y < size_.height; ++y) {
    const int first = std::max(0, size_.width - kLastCorner);
    std::fill_n(edges_.row(y) + first, size_.width - first, std::uint8_t{0});
  }
  for (int y = 0; y < size_.height; ++y) {
    visitMarked(edges_.row(y), 0, size_.width, 1, [&](int x) {
      follow(x, y);
      if (chain_.size() > static_cast<std::size_t>(parameters_.length_threshold)) {
        extractLines();
      }
    });
  }
  return lines_;
}

void LineFinder::findEdges(const cv::Mat& gray) {
  const double low = parameters_.canny_threshold1;
  const double high = parameters_.canny_threshold2;
  if (parameters_.canny_aperture == 3) {
    gradient_.compute(gray, CannyEdges::leastStrength(low, high), &maps_);
    edges_.find(maps_, low, high);
  } else {
    edges_.findByOpenCv(gray, low, high, parameters_.canny_aperture);
  }
}

/// Moves the edge's pixels from (x, y) on, one way, from the map to chain_.
void LineFinder::follow(int x, int y) {
  std::uint8_t* pixel = edges_.row(y) + x;
  const std::ptrdiff_t stride = edges_.stride();
  std::array<std::ptrdiff_t, kNeighbours.size()> offsets{};
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    offsets[i] = kNeighbours[i].dy * stride + kNeighbours[i].dx;
  }
  chain_.clear();
  chain_.push_back({x, y});
  *pixel = 0;
  float direction = 0;  // the mean of all steps
  for (int step = 0;; ++step) {
    std::size_t best = offsets.size();
    float least_turn = kSharpTurn;
    for (std::size_t i = 0; i < offsets.size(); ++i) {
      if (pixel[offsets[i]] == 0) {
        continue;
      }
      if (step == 0) {
        best = i;
        break;
      }
      float turn = std::abs(kNeighbours[i].direction - direction);
      turn = std::min(turn, 8 - turn);
      if (turn < kSharpTurn && turn <= least_turn) {
        least_turn = turn;
        best = i;
      }
    }
    if (best == offsets.size()) {
      return;
    }
    const float steps = static_cast<float>(step);
    direction = (direction * steps + kNeighbours[best].direction) / (steps + 1);
    pixel += offsets[best];
    *pixel = 0;
    x += kNeighbours[best].dx;
    y += kNeighbours[best].dy;
    chain_.push_back({x, y});
  }
}

void LineFinder::extractLines() {
  const auto window = static_cast<std::size_t>(parameters_.length_threshold);
  const auto limit = static_cast<double>(static_cast<float>(parameters_.distance_threshold));
  for (std::size_t begin = 0; begin + window < chain_.size();) {
    const EdgePixel first = chain_[begin];
    const EdgePixel far = chain_[begin + window];
    const Line chord = Line::through(first.x, first.y, far.x - first.x, far.y - first.y);
    bool straight = true;
    for (std::size_t k = begin + 1; straight && k < begin + window; ++k) {
      straight = !(chord.distance(chain_[k]) > limit);
    }
    if (!straight) {
      ++begin;
      continue;
    }
    PixelSums sums;
    for (std::size_t k = begin; k <= begin + window; ++k) sums.add(chain_[k]);
    Line line = fit(sums);
    const auto project = [this](const Line& onto, double x, double y) {
      const double distance = onto.a * x + onto.b * y + onto.c;
      // In single precision, in which a line of ten pixels is not a little shorter.
      return cv::Point2f(
          static_cast<float>(std::clamp(x - onto.a * distance, 0.0, size_.width - 1.0)),
          static_cast<float>(std::clamp(y - onto.b * distance, 0.0, size_.height - 1.0)));
    };
    const cv::Point2f start = project(line, first.x, first.y);
    std::size_t end = begin + window + 1;
    for (; end < chain_.size(); ++end) {
      if (line.distance(chain_[end]) > limit) {
        line = fit(sums);
        if (line.distance(chain_[end]) > limit) {
          break;
        }
      }
      sums.add(chain_[end]);
    }
    line = fit(sums);
    const EdgePixel last = chain_[end - 1];
    // The start was rounded to a pixel after the first fit.
    const cv::Point2f a = project(line, std::nearbyint(start.x), std::nearbyint(start.y));
    const cv::Point2f b = project(line, last.x, last.y);
    LineSegment found;
    found.x1 = a.x;
    found.y1 = a.y;
    found.x2 = b.x;
    found.y2 = b.y;
    keep(found);
    begin = end;
  }
}

/// Keeps lines that are long enough and not along the image's border.
void LineFinder::keep(LineSegment line) {
  if (line.length() < parameters_.length_threshold || std::max(line.x1, line.x2) <= kBorder ||
      std::max(line.y1, line.y2) <= kBorder ||
      std::min(line.x1, line.x2) >= size_.width - kBorder ||
      std::min(line.y1, line.y2) >= size_.height - kBorder) {
    return;
  }
  lines_.push_back(line);
}

}  // namespace evolin::fld
