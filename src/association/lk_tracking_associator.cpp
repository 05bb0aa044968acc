// Samples lines, follows the samples, and fits lines to where they went.
#include "evolin_ros/association/lk_tracking_associator.h"

#include <Eigen/Core>
#include <algorithm>
#include <any>
#include <cmath>
#include <opencv2/video/tracking.hpp>
#include <string>
#include <utility>
#include <vector>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/parameters.h"

namespace evolin {

namespace {

const char* const kOwner = "associator lk_tracking";

constexpr int kFewestPoints = 4;
constexpr int kMostPoints = 24;

/// What FrameLines::description holds.
struct LkPyramid {
  std::vector<cv::Mat> levels;
  int window = 0;
  int wanted_levels = 0;
};

std::vector<cv::Mat> pyramidOf(const FrameLines& lines, const LkTrackingParameters& parameters) {
  const auto* known = std::any_cast<LkPyramid>(&lines.description);
  if (known != nullptr && known->window == parameters.window &&
      known->wanted_levels == parameters.levels) {
    return known->levels;
  }
  LkPyramid pyramid;
  pyramid.window = parameters.window;
  pyramid.wanted_levels = parameters.levels;
  // A window into a larger image mirrors its own pixels, not those around it.
  cv::buildOpticalFlowPyramid(toGray(lines.frame.image), pyramid.levels,
                              cv::Size(parameters.window, parameters.window), parameters.levels,
                              true, cv::BORDER_REFLECT_101 | cv::BORDER_ISOLATED,
                              cv::BORDER_CONSTANT, false);
  std::vector<cv::Mat> levels = pyramid.levels;
  lines.description = std::move(pyramid);
  return levels;
}

/// A point that was followed, and its place along its line: 0 at the first endpoint, 1 at the
/// second.
struct Followed {
  Eigen::Vector2d place;
  double along;
};

/// Points of all lines one after the other; line i has those from starts[i] to starts[i + 1].
struct Samples {
  std::vector<cv::Point2f> points;
  std::vector<double> along;
  std::vector<std::size_t> starts;
};

Samples sample(const LineSegments& lines, double spacing) {
  Samples samples;
  for (const LineSegment& line : lines) {
    samples.starts.push_back(samples.points.size());
    if (!line.isFinite() || !(line.length() > 0)) {
      continue;
    }
    const int count =
        static_cast<int>(std::clamp<double>(line.length() / spacing, kFewestPoints, kMostPoints));
    for (int i = 0; i < count; ++i) {
      const double along = (i + 0.5) / count;
      samples.points.emplace_back(static_cast<float>(line.x1 + along * (line.x2 - line.x1)),
                                  static_cast<float>(line.y1 + along * (line.y2 - line.y1)));
      samples.along.push_back(along);
    }
  }
  samples.starts.push_back(samples.points.size());
  return samples;
}

/// Those on the line through two of the points that has the most of them within `tolerance`; the
/// first such two win ties.
std::vector<Followed> largestConsensus(const std::vector<Followed>& points, double tolerance) {
  std::vector<Followed> largest;
  for (std::size_t a = 0; a < points.size(); ++a) {
    for (std::size_t b = a + 1; b < points.size(); ++b) {
      const Eigen::Vector2d span = points[b].place - points[a].place;
      if (!(span.norm() > tolerance)) {
        continue;
      }
      const Eigen::Vector2d normal = Eigen::Vector2d(-span.y(), span.x()).normalized();
      std::vector<Followed> consensus;
      for (const Followed& point : points) {
        if (std::abs(normal.dot(point.place - points[a].place)) <= tolerance) {
          consensus.push_back(point);
        }
      }
      if (consensus.size() > largest.size()) {
        largest = std::move(consensus);
      }
    }
  }
  return largest;
}

/// Least squares of place over the place along the line, so that the endpoints follow, too.
std::optional<LineSegment> fitLine(const std::vector<Followed>& points) {
  const auto count = static_cast<double>(points.size());
  double mean_along = 0;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Followed& point : points) {
    mean_along += point.along / count;
    mean += point.place / count;
  }
  double spread = 0;
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();
  for (const Followed& point : points) {
    spread += (point.along - mean_along) * (point.along - mean_along);
    slope += (point.along - mean_along) * (point.place - mean);
  }
  if (!(spread > 0)) {
    return std::nullopt;
  }
  slope /= spread;
  const Eigen::Vector2d from = mean - mean_along * slope;
  const Eigen::Vector2d to = from + slope;
  LineSegment line;
  line.x1 = from.x();
  line.y1 = from.y();
  line.x2 = to.x();
  line.y2 = to.y();
  return line;
}

}  // namespace

void LkTrackingAssociator::configure(const YAML::Node& parameters) {
  LkTrackingParameters read;
  ParameterReader reader(parameters, kOwner);
  reader.read("spacing", &read.spacing, 1, 1e6);
  reader.read("window", &read.window, 5, 101);
  reader.read("levels", &read.levels, 0, 10);
  reader.read("max_backward", &read.max_backward, 0, 1e6);
  reader.read("tolerance", &read.tolerance, 0.1, 1e6);
  reader.read("min_support", &read.min_support, 0, 1);
  readGates(&reader, &read.gates);
  reader.finish();
  if (read.window % 2 == 0) {
    throw ConfigError(kOwner, "window", std::to_string(read.window) + "; expected an odd number");
  }
  parameters_ = read;
  configured_ = true;
}

void LkTrackingAssociator::describe(const FrameLines& lines) {
  if (!configured_) {
    throw Error(std::string(kOwner) + ": describe() was called before configure()");
  }
  pyramidOf(lines, parameters_);
}

LineMatches LkTrackingAssociator::match(const FrameLines& first, const FrameLines& second) {
  if (!configured_) {
    throw Error(std::string(kOwner) + ": match() was called before configure()");
  }
  requireEqualSizes(first, second, kOwner);
  const Samples samples = sample(first.lines, parameters_.spacing);
  if (samples.points.empty() || second.lines.empty()) {
    return {};
  }
  const std::vector<cv::Mat> before = pyramidOf(first, parameters_);
  const std::vector<cv::Mat> after = pyramidOf(second, parameters_);
  const cv::Size window(parameters_.window, parameters_.window);
  std::vector<cv::Point2f> there;
  std::vector<cv::Point2f> back;
  std::vector<unsigned char> found;
  std::vector<unsigned char> found_back;
  std::vector<float> errors;
  cv::calcOpticalFlowPyrLK(before, after, samples.points, there, found, errors, window,
                           parameters_.levels);
  cv::calcOpticalFlowPyrLK(after, before, there, back, found_back, errors, window,
                           parameters_.levels);
  std::vector<std::optional<LineSegment>> expected(first.lines.size());
  for (std::size_t line = 0; line < first.lines.size(); ++line) {
    std::vector<Followed> followed;
    for (std::size_t i = samples.starts[line]; i < samples.starts[line + 1]; ++i) {
      const cv::Point2f missed = back[i] - samples.points[i];
      if (found[i] != 0 && found_back[i] != 0 &&
          std::hypot(missed.x, missed.y) <= static_cast<float>(parameters_.max_backward)) {
        followed.push_back({{there[i].x, there[i].y}, samples.along[i]});
      }
    }
    const std::vector<Followed> consensus = largestConsensus(followed, parameters_.tolerance);
    const auto points = static_cast<double>(samples.starts[line + 1] - samples.starts[line]);
    if (consensus.size() >= 2 &&
        static_cast<double>(consensus.size()) >= parameters_.min_support * points) {
      expected[line] = fitLine(consensus);
    }
  }
  return matchGeometrically(expected, second.lines, parameters_.gates);
}

}  // namespace evolin
