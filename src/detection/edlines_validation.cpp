// Counting aligned pixels, and how many there have to be.
#include "edlines_validation.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace evolin::edlines {
namespace {

constexpr std::size_t kNeverByChance = 80;  // pixels of a line that is not looked at
constexpr double kChance = 0.125;           // of a direction within the tolerance
constexpr double kTolerance = 22.5;         // degrees
constexpr double kHalfWidth = 1;            // of the rectangle around a line, pixels
// Squared tangents between which the fast arc tangent decides.
const double kSurelyWithin = std::pow(std::tan(22.0 * CV_PI / 180), 2);
const double kSurelyBeyond = std::pow(std::tan(23.0 * CV_PI / 180), 2);

}  // namespace

void Validation::start(const cv::Mat& gray) {
  gray_ = &gray;
  const double log_tests = 2 * (std::log(gray.cols) + std::log(gray.rows));
  if (log_tests != log_tests_) {
    log_tests_ = log_tests;
    least_.assign(1, 1);
  }
}

bool Validation::isMeaningful(const FittedLine& line) {
  if (line.pixels >= kNeverByChance) {
    return true;
  }
  count(line);
  return aligned_ >= leastAligned(pixels_);
}

int Validation::leastAligned(int pixels) {
  while (static_cast<int>(least_.size()) <= pixels) {
    // The least number does not fall as pixels are added; pixels + 1 says that there is none.
    const int n = static_cast<int>(least_.size());
    int k = least_.back();
    for (; k <= n; ++k) {
      double tail = 0;
      for (int i = n; i >= k; --i) {
        tail +=
            std::exp(log_tests_ + log_factorial_(n) - log_factorial_(i) - log_factorial_(n - i) +
                     i * std::log(kChance) + (n - i) * std::log(1 - kChance));
      }
      if (tail <= 1) {
        break;
      }
    }
    least_.push_back(k);
  }
  return least_[static_cast<std::size_t>(pixels)];
}

bool Validation::isAligned(int x, int y) const {
  const std::uint8_t* above = gray_->ptr<std::uint8_t>(y - 1) + x;
  const std::uint8_t* here = gray_->ptr<std::uint8_t>(y) + x;
  const std::uint8_t* below = gray_->ptr<std::uint8_t>(y + 1) + x;
  const int falling = below[1] - above[-1];
  const int rising = above[1] - below[-1];
  const int dx = falling + rising + here[1] - here[-1];
  const int dy = falling - rising + below[0] - above[0];
  // The edge runs along (-dy, dx).
  const double dot = dx * direction_y_ - dy * direction_x_;
  const double cross = dx * direction_x_ + dy * direction_y_;
  const double squared_dot = dot * dot;
  const double squared_cross = cross * cross;
  if (squared_cross < kSurelyWithin * squared_dot) {
    return true;
  }
  if (squared_cross > kSurelyBeyond * squared_dot) {
    return false;
  }
  double degrees = cv::fastAtan2(static_cast<float>(dx), static_cast<float>(-dy));
  if (degrees > 180) {
    degrees -= 180;
  }
  const double difference = std::abs(degrees - degrees_);
  return difference <= kTolerance || difference >= 180 - kTolerance;
}

void Validation::count(const FittedLine& line) {
  const LineSegment& s = line.segment;
  const double b = line.equation.b;
  const double radians =
      line.equation.steep ? (b == 0 ? CV_PI / 2 : std::atan(1 / b)) : std::atan(b);
  const double angle = radians < 0 ? radians + CV_PI : radians;
  degrees_ = angle * 180 / CV_PI;
  direction_x_ = std::cos(angle);
  direction_y_ = std::sin(angle);
  pixels_ = 0;
  aligned_ = 0;

  const double length = s.length();
  const double wx = -kHalfWidth * (s.y2 - s.y1) / length;
  const double wy = kHalfWidth * (s.x2 - s.x1) / length;
  struct Point {
    double x;
    double y;
  };
  const std::array<Point, 4> corners = {{{s.x1 + wx, s.y1 + wy},
                                         {s.x2 + wx, s.y2 + wy},
                                         {s.x2 - wx, s.y2 - wy},
                                         {s.x1 - wx, s.y1 - wy}}};
  const auto [leftmost, rightmost] = std::minmax_element(
      corners.begin(), corners.end(), [](const Point& p, const Point& q) { return p.x < q.x; });
  const int first = static_cast<int>(std::max(1.0, std::ceil(leftmost->x)));
  const int last = static_cast<int>(std::min(gray_->cols - 2.0, std::floor(rightmost->x)));
  for (int x = first; x <= last; ++x) {
    // The column enters and leaves through the edges that it crosses.
    double top = gray_->rows;
    double bottom = -1;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Point& p = corners[i];
      const Point& q = corners[(i + 1) % corners.size()];
      if (x < std::min(p.x, q.x) || x > std::max(p.x, q.x)) {
        continue;
      }
      const double y = p.x == q.x ? p.y : p.y + (x - p.x) * (q.y - p.y) / (q.x - p.x);
      top = std::min({top, y, p.x == q.x ? q.y : y});
      bottom = std::max({bottom, y, p.x == q.x ? q.y : y});
    }
    const int lowest = static_cast<int>(std::min(gray_->rows - 2.0, std::floor(bottom)));
    for (int y = static_cast<int>(std::max(1.0, std::ceil(top))); y <= lowest; ++y) {
      ++pixels_;
      aligned_ += isAligned(x, y) ? 1 : 0;
    }
  }
}

}  // namespace evolin::edlines
