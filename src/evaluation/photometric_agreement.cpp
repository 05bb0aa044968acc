// Direct comparison of images as in visual odometry (Kerl, Sturm, Cremers 2013), without estimating
// anything: the poses are given, and only their reading changes.
#include "photometric_agreement.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <optional>

namespace evolin {

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// One point is taken of each square of this side, the steepest.
constexpr int kCell = 8;
/// Grey levels a pixel.
constexpr float kSteepEnough = 4;
constexpr std::size_t kFewestPoints = 100;
/// Depth within two pixels of a point differs by no more than this share: an edge between near and
/// far moves with neither.
constexpr double kDepthSpread = 0.03;

/// What is called clearly better lowers the mean error to this share at least...
constexpr double kClearShare = 0.8;
/// ... (for a factor of depth, whose minimum is flat where parallax is small) ...
constexpr double kClearShareOfDepth = 0.9;
/// ... and by this much, grey levels, ...
constexpr double kClearGain = 0.3;
/// ... which is this many standard errors of the gains pair by pair, ...
constexpr double kStandardErrors = 3;
/// ... over this many pairs.
constexpr std::size_t kFewestPairs = 4;

Camera flipped(Camera camera) {
  camera.fy = -camera.fy;
  return camera;
}

cv::Mat smoothed(const cv::Mat& gray) {
  cv::Mat levels;
  gray.convertTo(levels, CV_32F);
  cv::GaussianBlur(levels, levels, cv::Size(), 1.0);
  return levels;
}

/// 0 where it is unknown or an edge is near.
double steadyDepth(const DepthMap& depth, int x, int y) {
  const double center = depth.at(x, y);
  for (const int dy : {-2, 0, 2}) {
    for (const int dx : {-2, 0, 2}) {
      const double near = depth.at(x + dx, y + dy);
      if (!DepthMap::isDepth(near) || !(std::abs(near - center) < kDepthSpread * center)) {
        return 0;
      }
    }
  }
  return center;
}

/// Of those that are numbers; NaN where none is.
double meanOf(const std::vector<double>& errors) {
  double sum = 0;
  double count = 0;
  for (const double error : errors) {
    sum += std::isnan(error) ? 0 : error;
    count += std::isnan(error) ? 0 : 1;
  }
  return count > 0 ? sum / count : kNan;
}

/// Whether errors are lower than others of the same pairs by more than chance.
bool isClearlyLess(const std::vector<double>& errors, const std::vector<double>& others,
                   double share) {
  std::vector<double> gains;
  double sum = 0;
  double sum_of_others = 0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (!std::isnan(errors[i]) && !std::isnan(others[i])) {
      gains.push_back(others[i] - errors[i]);
      sum += errors[i];
      sum_of_others += others[i];
    }
  }
  if (gains.size() < kFewestPairs || !(sum < share * sum_of_others)) {
    return false;
  }
  const auto count = static_cast<double>(gains.size());
  const double mean = (sum_of_others - sum) / count;
  double squares = 0;
  for (const double gain : gains) {
    squares += (gain - mean) * (gain - mean);
  }
  return mean > std::max(kClearGain, kStandardErrors * std::sqrt(squares / (count - 1) / count));
}

void addTimes(const Reading& start, std::vector<Reading>* readings) {
  for (const double milliseconds : {-50, -30, -20, -10, -5, 5, 10, 20, 30, 50}) {
    readings->push_back(start);
    readings->back().seconds = milliseconds / 1000;
  }
}

std::optional<double> levelAt(const cv::Mat& image, const Eigen::Vector2d& pixel) {
  const double left = std::floor(pixel.x());
  const double top = std::floor(pixel.y());
  if (!(left >= 0 && top >= 0 && left < image.cols - 1 && top < image.rows - 1)) {
    return std::nullopt;
  }
  const int x = static_cast<int>(left);
  const auto* upper = image.ptr<float>(static_cast<int>(top)) + x;
  const auto* lower = image.ptr<float>(static_cast<int>(top) + 1) + x;
  const double right = pixel.x() - left;
  const double down = pixel.y() - top;
  return (1 - down) *
             ((1 - right) * static_cast<double>(upper[0]) + right * static_cast<double>(upper[1])) +
         down *
             ((1 - right) * static_cast<double>(lower[0]) + right * static_cast<double>(lower[1]));
}

}  // namespace

PhotometricAgreement::PhotometricAgreement(const Camera& camera, const Trajectory& trajectory,
                                           const std::vector<Stamp>& stamps, double worst)
    : view_(ImageView::distorted(camera)),
      flipped_view_(ImageView::distorted(flipped(camera))),
      trajectory_(trajectory),
      stamps_(stamps),
      worst_(worst) {}

void PhotometricAgreement::add(std::pair<std::size_t, std::size_t> numbers, const cv::Mat& first,
                               const DepthMap& depth, const cv::Mat& second) {
  const cv::Mat levels = smoothed(first);
  cv::Mat dx;
  cv::Mat dy;
  cv::Sobel(levels, dx, CV_32F, 1, 0, 3, 1.0 / 8);
  cv::Sobel(levels, dy, CV_32F, 0, 1, 3, 1.0 / 8);
  cv::Mat steepness;
  cv::magnitude(dx, dy, steepness);
  Pair pair = {numbers.first, numbers.second, {}, smoothed(second)};
  for (int top = 0; top + kCell <= first.rows; top += kCell) {
    for (int left = 0; left + kCell <= first.cols; left += kCell) {
      double steepest = 0;
      cv::Point at;
      cv::minMaxLoc(steepness(cv::Rect(left, top, kCell, kCell)), nullptr, &steepest, nullptr, &at);
      at += cv::Point(left, top);
      const double metres = steepest < kSteepEnough ? 0 : steadyDepth(depth, at.x, at.y);
      const auto direction = view_.normalizedOf(Eigen::Vector2d(at.x, at.y));
      const auto other = flipped_view_.normalizedOf(Eigen::Vector2d(at.x, at.y));
      if (metres > 0 && direction && other) {
        pair.points.push_back({metres * direction->homogeneous(), metres * other->homogeneous(),
                               static_cast<double>(levels.at<float>(at))});
      }
    }
  }
  if (pair.points.size() >= kFewestPoints) {
    pairs_.push_back(std::move(pair));
  }
}

std::optional<Pose> PhotometricAgreement::poseOf(std::size_t image, const Reading& reading) const {
  const auto shifted = static_cast<std::ptrdiff_t>(image) + reading.frames;
  if (shifted < 0 || shifted >= static_cast<std::ptrdiff_t>(stamps_.size())) {
    return std::nullopt;
  }
  std::optional<Pose> pose = trajectory_.at(stamps_[static_cast<std::size_t>(shifted)] +
                                            std::llround(reading.seconds * kNanosecondsPerSecond));
  return pose && reading.inverted ? inverse(*pose) : pose;
}

double PhotometricAgreement::errorOf(const Pair& pair, const Reading& reading) const {
  const std::optional<Pose> first = poseOf(pair.first, reading);
  const std::optional<Pose> second = poseOf(pair.second, reading);
  if (!first || !second) {
    return kNan;
  }
  const ImageView& view = reading.flipped ? flipped_view_ : view_;
  const Eigen::Isometry3d motion = motionBetween(*first, *second);
  double sum = 0;
  for (const EdgePoint& point : pair.points) {
    const Eigen::Vector3d moved =
        motion * (reading.depth * (reading.flipped ? point.flipped : point.place));
    const auto pixel = moved.z() > 0 ? view.pixelOf(moved.hnormalized()) : std::nullopt;
    const auto level = pixel ? levelAt(pair.image, *pixel) : std::nullopt;
    sum += level ? std::min(worst_, std::abs(*level - point.level)) : worst_;
  }
  return sum / static_cast<double>(pair.points.size());
}

std::vector<double> PhotometricAgreement::errors(const Reading& reading) const {
  std::vector<double> errors;
  errors.reserve(pairs_.size());
  for (const Pair& pair : pairs_) {
    errors.push_back(errorOf(pair, reading));
  }
  return errors;
}

std::size_t PhotometricAgreement::pairs(const Reading& reading) const {
  const std::vector<double> all = errors(reading);
  return static_cast<std::size_t>(
      std::count_if(all.begin(), all.end(), [](double error) { return !std::isnan(error); }));
}

double PhotometricAgreement::meanError(const Reading& reading) const {
  return meanOf(errors(reading));
}

Reading PhotometricAgreement::bestOf(const Reading& start, const std::vector<Reading>& others,
                                     double share) const {
  const std::vector<double> of_start = errors(start);
  Reading best = start;
  double least = std::numeric_limits<double>::infinity();
  for (const Reading& other : others) {
    const std::vector<double> of_other = errors(other);
    const double error = meanOf(of_other);
    if (error < least && isClearlyLess(of_other, of_start, share)) {
      best = other;
      least = error;
    }
  }
  return best;
}

BestReading PhotometricAgreement::findBest() const {
  const Reading given;
  std::vector<Reading> conventions;
  for (const bool inverted : {false, true}) {
    for (const bool flipped : {false, true}) {
      for (const int frames : {0, -1, 1, -2, 2}) {
        Reading reading;
        reading.frames = frames;
        reading.inverted = inverted;
        reading.flipped = flipped;
        conventions.push_back(reading);
      }
    }
  }
  std::vector<Reading> candidates = conventions;
  addTimes(given, &candidates);
  // With depth in another unit no convention fits, so that both are tried together.
  for (const double unit : {0.001, 0.2, 5.0, 1000.0}) {
    for (Reading reading : conventions) {
      reading.depth = unit;
      candidates.push_back(reading);
    }
  }
  Reading best = bestOf(given, candidates, kClearShare);
  if (!best.isAsGiven() && best.seconds == 0) {
    candidates.clear();
    addTimes(best, &candidates);
    best = bestOf(best, candidates, kClearShare);
  }
  candidates.clear();
  for (const double factor : {0.1, 0.2, 0.5, 0.8, 0.9, 1.1, 1.25, 2.0, 5.0, 10.0}) {
    candidates.push_back(best);
    candidates.back().depth *= factor;
  }
  BestReading found;
  found.reading = bestOf(best, candidates, kClearShareOfDepth);
  if (found.reading.isAsGiven()) {
    const std::vector<double> of_given = errors(given);
    for (const Reading& other : conventions) {
      if (!other.isAsGiven() && pairs(other) >= kFewestPairs &&
          !isClearlyLess(of_given, errors(other), kClearShare)) {
        found.alternatives.push_back(other);
      }
    }
  }
  return found;
}

}  // namespace evolin
