// Number of false alarms, and the search for a better rectangle.
#include "lsd_validation.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace evolin::lsd {
namespace {

constexpr int kVariants = 11;  // rectangles that improve() may try
constexpr int kSteps = 5;      // of each kind
constexpr double kStep = 0.5;  // pixels of width
const double kLn10 = std::log(10.0);

}  // namespace

void Validation::start(const Field& field) {
  field_ = &field;
  log_tests_ = 5 * (std::log10(field.width) + std::log10(field.height)) / 2 +
               std::log10(static_cast<double>(kVariants));
}

double Validation::logNfa(int pixels, int aligned, double chance) {
  if (pixels == 0 || aligned == 0) {
    return -log_tests_;
  }
  if (pixels == aligned) {
    return -log_tests_ - pixels * std::log10(chance);
  }
  // The binomial tail from its first term on; each term follows from the one before.
  const double log_first = (compatible_ ? pixels + 1 : log_factorial_(pixels)) -
                           log_factorial_(aligned) - log_factorial_(pixels - aligned) +
                           aligned * std::log(chance) + (pixels - aligned) * std::log1p(-chance);
  double term = std::exp(log_first);
  if (term < 1e-300) {
    return aligned > pixels * chance ? -log_first / kLn10 - log_tests_ : -log_tests_;
  }
  constexpr double kTolerance = 0.1;  // relative, of the result
  const double odds = chance / (1 - chance);
  double tail = term;
  for (int i = aligned + 1; i <= pixels; ++i) {
    const double ratio = static_cast<double>(pixels - i + 1) / i;
    const double factor = ratio * odds;
    term *= factor;
    tail += term;
    if (ratio < 1) {
      // What is left is less than a geometric series.
      const double rest = term * ((1 - std::pow(factor, pixels - i + 1)) / (1 - factor) - 1);
      if (rest < kTolerance * std::abs(-std::log10(tail) - log_tests_) * tail) {
        break;
      }
    }
  }
  return -std::log10(tail) - log_tests_;
}

void Validation::count(const Rectangle& r, int y, double left, double right) {
  if (y < 0 || y >= field_->height) {
    return;
  }
  const int first = static_cast<int>(std::clamp(left, 0.0, static_cast<double>(field_->width)));
  const int last = static_cast<int>(std::clamp(right, -1.0, field_->width - 1.0));
  const float* angles = field_->angles.data() + static_cast<std::ptrdiff_t>(y) * field_->width;
  for (int x = first; x <= last; ++x) {
    ++pixels_;
    if (angles[x] != kNoAngle && angleBetween(angles[x], r.angle) <= r.tolerance) {
      ++aligned_;
    }
  }
}

Validation::Corners Validation::cornersOf(const Rectangle& r) {
  const double wx = r.dy * r.width / 2;
  const double wy = r.dx * r.width / 2;
  return {{{r.x1 - wx, r.y1 + wy},
           {r.x2 - wx, r.y2 + wy},
           {r.x2 + wx, r.y2 - wy},
           {r.x1 + wx, r.y1 - wy}}};
}

void Validation::scan(const Rectangle& r) {
  const Corners corners = cornersOf(r);
  double top = corners[0].y;
  double bottom = corners[0].y;
  for (const Point& corner : corners) {
    top = std::min(top, corner.y);
    bottom = std::max(bottom, corner.y);
  }
  const int last = static_cast<int>(std::min(std::floor(bottom), field_->height - 1.0));
  for (int y = static_cast<int>(std::max(std::ceil(top), 0.0)); y <= last; ++y) {
    // Each row enters and leaves through the edges that it crosses.
    double left = field_->width;
    double right = -1;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Point& a = corners[i];
      const Point& b = corners[(i + 1) % corners.size()];
      if (y < std::min(a.y, b.y) || y > std::max(a.y, b.y)) {
        continue;
      }
      const double share = a.y == b.y ? 0 : (y - a.y) / (b.y - a.y);
      const double x = a.x + share * (b.x - a.x);
      left = std::min({left, x, a.y == b.y ? b.x : x});
      right = std::max({right, x, a.y == b.y ? b.x : x});
    }
    count(r, y, std::ceil(left), std::floor(right));
  }
}

void Validation::scanInWholePixels(const Rectangle& r) {
  struct Whole {
    int x;
    int y;
  };
  std::array<Whole, 4> corners{};
  const Corners exact = cornersOf(r);
  std::transform(exact.begin(), exact.end(), corners.begin(), [](const Point& p) {
    return Whole{static_cast<int>(p.x), static_cast<int>(p.y)};
  });
  std::sort(corners.begin(), corners.end(),
            [](const Whole& a, const Whole& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  // From left to right; the highest goes first, the others keep their order, but of two that are
  // rightmost the upper one counts as right.
  const auto by_y = [](const Whole& a, const Whole& b) { return a.y < b.y; };
  const auto highest = std::min_element(corners.begin(), corners.end(), by_y);
  const int bottom = std::max_element(corners.begin(), corners.end(), by_y)->y;
  std::rotate(corners.begin(), highest, highest + 1);
  const Whole& top = corners[0];
  const Whole& left = corners[1];
  const bool tie = corners[2].x == corners[3].x;
  const Whole& tail = corners[tie ? 3 : 2];
  const Whole& right = corners[tie ? 2 : 3];

  // The published library divides whole numbers, and below the side corners takes the height of an
  // edge against the tail's x: rectangles lean and spread accordingly.
  const auto upper = [&](const Whole& side) {
    return side.y != top.y ? (top.x - side.x) / (top.y - side.y) : 0;
  };
  const auto lower = [&](const Whole& side) {
    return side.y != tail.x ? (side.x - tail.x) / (side.y - tail.x) : 0;
  };
  double first = top.x;
  double last = top.x;
  int left_slope = upper(left);
  int right_slope = upper(right);
  for (int y = top.y; y <= bottom; ++y) {
    count(r, y, first, last);
    if (y >= left.y) {
      left_slope = lower(left);
    }
    if (y >= right.y) {
      right_slope = lower(right);
    }
    first += left_slope;
    last += right_slope;
  }
}

double Validation::logNfa(const Rectangle& r) {
  pixels_ = 0;
  aligned_ = 0;
  if (compatible_) {
    scanInWholePixels(r);
  } else {
    scan(r);
  }
  return logNfa(pixels_, aligned_, r.chance);
}

double Validation::improve(double log_eps, Rectangle* rectangle) {
  double best = logNfa(*rectangle);
  const auto attempt = [&](auto change) {
    Rectangle tried = *rectangle;
    for (int n = 0; n < kSteps && change(&tried); ++n) {
      const double value = logNfa(tried);
      if (value > best) {
        best = value;
        *rectangle = tried;
      }
    }
    return best > log_eps;
  };
  const auto sharpen = [](Rectangle* r) {
    r->chance /= 2;
    r->tolerance = r->chance * CV_PI;
    return true;
  };
  const auto narrow = [](Rectangle* r) {
    if (r->width - kStep < 0.5) return false;
    r->width -= kStep;
    return true;
  };
  const auto cut = [](double side) {
    return [side](Rectangle* r) {
      if (r->width - kStep < 0.5) return false;
      r->x1 -= side * r->dy * kStep / 2;
      r->y1 += side * r->dx * kStep / 2;
      r->x2 -= side * r->dy * kStep / 2;
      r->y2 += side * r->dx * kStep / 2;
      r->width -= kStep;
      return true;
    };
  };
  if (best > log_eps || attempt(sharpen) || attempt(narrow) || attempt(cut(1)) ||
      attempt(cut(-1))) {
    return best;
  }
  attempt(sharpen);
  return best;
}

}  // namespace evolin::lsd
