// Consensus on courses of inverse depth, nearest surface first.
#include "evolin_ros/geometry/segment_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"
#include "evolin_ros/geometry/clipping.h"

namespace evolin {

namespace {

/// Depth read at one pixel of the band.
struct Sample {
  double along;    ///< share of the way along the segment; that of the pixel itself
  double across;   ///< pixels beside the segment
  double inverse;  ///< of the depth, 1/m
  int position;
};

using Samples = std::vector<Sample>;

/// Inverse depth a + b along + c across, with a slope of its own at each side.
struct Course {
  double start = 0;
  double growth = 0;
  double left = 0;   ///< slope where across < 0
  double right = 0;  ///< slope where across > 0

  double at(double along, double across) const {
    return start + growth * along + (across < 0 ? left : right) * across;
  }
};

struct Band {
  Samples samples;
  int positions = 0;
};

/// Fixed, so that results repeat.
class Trials {
 public:
  std::size_t next(std::size_t count) {
    state_ = state_ * 6364136223846793005U + 1442695040888963407U;
    return static_cast<std::size_t>((state_ >> 33U) % count);
  }

 private:
  std::uint64_t state_ = 88172645463325252U;
};

Band readBand(const LineSegment& line, const DepthMap& depth, const SegmentFitOptions& options) {
  const double length = line.length();
  const double dx = (line.x2 - line.x1) / length;
  const double dy = (line.y2 - line.y1) / length;
  const int rings = static_cast<int>(std::floor(options.reach));
  Band band;
  band.positions = static_cast<int>(
      std::clamp(std::floor(length) + 1, 2.0, static_cast<double>(options.positions)));
  std::vector<cv::Point> pixels;
  for (int position = 0; position < band.positions; ++position) {
    const double along = length * position / (band.positions - 1);
    for (int ring = -rings; ring <= rings; ++ring) {
      const cv::Point pixel = nearestPixel(line.x1 + along * dx - ring * dy,
                                           line.y1 + along * dy + ring * dx, depth.size());
      // The same pixel again would count twice.
      if (pixel.x < 0 ||
          std::find(pixels.end() - std::min<std::ptrdiff_t>(
                                       static_cast<std::ptrdiff_t>(pixels.size()), 4 * rings + 4),
                    pixels.end(), pixel) != pixels.end()) {
        continue;
      }
      pixels.push_back(pixel);
      const double metres = depth.at(pixel.x, pixel.y);
      if (!DepthMap::isDepth(metres)) {
        continue;
      }
      const double x = pixel.x - line.x1;
      const double y = pixel.y - line.y1;
      band.samples.push_back({(x * dx + y * dy) / length, y * dx - x * dy, 1 / metres, position});
    }
  }
  return band;
}

bool agrees(const Course& course, const Sample& sample, double tolerance) {
  const double expected = course.at(sample.along, sample.across);
  return std::abs(sample.inverse - expected) <= tolerance * expected;
}

/// Share of the positions at which a sample agrees.
double support(const Course& course, const Band& band, double tolerance) {
  int seen = 0;
  int last = -1;
  for (const Sample& sample : band.samples) {
    if (sample.position != last && agrees(course, sample, tolerance)) {
      last = sample.position;
      ++seen;
    }
  }
  return static_cast<double>(seen) / band.positions;
}

/// Of the courses through two samples that enough positions show, the nearest in the middle.
std::optional<Course> nearestCourse(const Band& band, const SegmentFitOptions& options) {
  constexpr int kTrials = 200;
  const Samples& samples = band.samples;
  std::optional<Course> nearest;
  Trials trials;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Sample& a = samples[trials.next(samples.size())];
    const Sample& b = samples[trials.next(samples.size())];
    // Too close to each other they tell nothing of the course.
    if (std::abs(a.along - b.along) < 0.2) {
      continue;
    }
    Course course;
    course.growth = (b.inverse - a.inverse) / (b.along - a.along);
    course.start = a.inverse - course.growth * a.along;
    const bool before_camera = course.at(0, 0) > 0 && course.at(1, 0) > 0;
    if (before_camera && (!nearest || course.at(0.5, 0) > nearest->at(0.5, 0)) &&
        support(course, band, options.tolerance) >= options.min_support) {
      nearest = course;
    }
  }
  return nearest;
}

/// Least squares on the samples that agree; a side with few of them stays level, as does one whose
/// slope no surface in sight could have.
Course refined(const Course& course, const Band& band, const Camera& camera,
               const SegmentFitOptions& options) {
  constexpr int kEnough = 6;
  Samples inliers;
  int left = 0;
  int right = 0;
  for (const Sample& sample : band.samples) {
    if (agrees(course, sample, options.tolerance)) {
      inliers.push_back(sample);
      left += sample.across < -0.5 ? 1 : 0;
      right += sample.across > 0.5 ? 1 : 0;
    }
  }
  bool use_left = left >= kEnough;
  bool use_right = right >= kEnough;
  for (;;) {
    Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
    Eigen::Vector4d target = Eigen::Vector4d::Zero();
    for (const Sample& sample : inliers) {
      const Eigen::Vector4d row(1, sample.along, use_left ? std::min(sample.across, 0.0) : 0,
                                use_right ? std::max(sample.across, 0.0) : 0);
      normal += row * row.transpose();
      target += sample.inverse * row;
    }
    // Unused columns are empty: a unit on the diagonal makes their slopes zero.
    normal(2, 2) += use_left ? 0 : 1;
    normal(3, 3) += use_right ? 0 : 1;
    const Eigen::Vector4d solution = normal.ldlt().solve(target);
    if (!solution.allFinite()) {
      return course;
    }
    const Course result{solution(0), solution(1), solution(2), solution(3)};
    // Across a plane seen at an angle, inverse depth changes by about tan(angle) / f a pixel.
    const double steepest = std::tan(options.max_slant * M_PI / 180) /
                            std::min(std::abs(camera.fx), std::abs(camera.fy)) * result.at(0.5, 0);
    const bool left_slants = use_left && std::abs(result.left) > steepest;
    const bool right_slants = use_right && std::abs(result.right) > steepest;
    if (!left_slants && !right_slants) {
      return result;
    }
    use_left = use_left && !left_slants;
    use_right = use_right && !right_slants;
  }
}

void requireRange(const std::string& name, double value, double low, double high) {
  if (!(value >= low && value <= high)) {
    throw Error("segment fit: " + name + " is " + formatDouble(value) + ", expected " +
                formatDouble(low) + " to " + formatDouble(high));
  }
}

}  // namespace

void validate(const SegmentFitOptions& options) {
  requireRange("positions", options.positions, 2, 10000);
  requireRange("reach", options.reach, 0, 50);
  requireRange("tolerance", options.tolerance, 1e-6, 0.5);
  requireRange("min_support", options.min_support, 0.01, 1);
  requireRange("max_slant", options.max_slant, 0, 89.9);
}

std::optional<SegmentFit> fitSegment(const Camera& camera, const LineSegment& segment,
                                     const DepthMap& depth, const SegmentFitOptions& options) {
  if (!segment.isFinite()) {
    throw Error("segment fit: the segment is not finite, expected four numbers of pixels");
  }
  if (camera.fx == 0 || camera.fy == 0) {
    throw Error("segment fit: focal lengths " + formatDouble(camera.fx) + " and " +
                formatDouble(camera.fy) + "; expected numbers of pixels other than 0");
  }
  const std::optional<LineSegment> inside =
      clipToRectangle(segment, {0, 0, depth.size().width - 1.0, depth.size().height - 1.0});
  if (!inside || !(inside->length() >= 1)) {
    return std::nullopt;
  }
  const Band band = readBand(*inside, depth, options);
  if (band.samples.size() < 4) {
    return std::nullopt;
  }
  std::optional<Course> course = nearestCourse(band, options);
  if (!course) {
    return std::nullopt;
  }
  constexpr int kRounds = 6;
  for (int round = 0; round < kRounds; ++round) {
    course = refined(*course, band, camera, options);
  }
  SegmentFit fit;
  fit.support = support(*course, band, options.tolerance);
  const double first = course->at(0, 0);
  const double second = course->at(1, 0);
  if (fit.support < options.min_support || !(first > 0) || !(second > 0)) {
    return std::nullopt;
  }
  fit.segment = backProject(camera, *inside, {1 / first, 1 / second}, false);
  double sum = 0;
  std::size_t agreeing = 0;
  for (const Sample& sample : band.samples) {
    if (agrees(*course, sample, options.tolerance)) {
      const double share = sample.inverse / course->at(sample.along, sample.across) - 1;
      sum += share * share;
      ++agreeing;
    }
  }
  fit.rms = std::sqrt(sum / static_cast<double>(agreeing));
  return fit;
}

}  // namespace evolin
