// Reading of trajectory files and the look-up of a pose by time.
#include "evolin_ros/dataset/trajectory.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <string>
#include <string_view>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"

namespace evolin {

namespace {

// Shorter quaternions carry no usable direction: text files keep four digits or more.
constexpr double kSmallestNorm = 1e-6;

constexpr std::size_t kFields = 8;

Pose parsePose(const std::string& file, int line, const std::vector<std::string_view>& words) {
  std::array<double, kFields - 1> values{};
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::string_view word = words[i + 1];
    const std::optional<double> value = parseDouble(word);
    if (!value || !std::isfinite(*value)) {
      throw ParseError(file, line,
                       "field " + std::to_string(i + 2) + " is " + quote(word) +
                           ", expected a finite number (tx ty tz qx qy qz qw)");
    }
    values[i] = *value;
  }
  Pose pose;
  pose.translation = {values[0], values[1], values[2]};
  pose.rotation = Eigen::Quaterniond(values[6], values[3], values[4], values[5]);
  if (pose.rotation.norm() < kSmallestNorm) {
    throw ParseError(file, line,
                     "the quaternion (qx qy qz qw) is " + formatDouble(values[3]) + " " +
                         formatDouble(values[4]) + " " + formatDouble(values[5]) + " " +
                         formatDouble(values[6]) + ", expected one of non-zero norm");
  }
  pose.rotation.normalize();
  return pose;
}

using RowHandler = std::function<void(int line, std::string_view first, const Pose& pose)>;

// Calls `handle` for every row that is neither blank nor a comment.
void readRows(const std::filesystem::path& path, const std::string& first_column,
              const RowHandler& handle) {
  const std::string file = path.string();
  int number = 0;
  for (const std::string& line : readLines(path)) {
    ++number;
    const std::string_view text = trim(line);
    if (text.empty() || text.front() == '#') {
      continue;
    }
    const std::vector<std::string_view> words = splitWords(text);
    if (words.size() != kFields) {
      throw ParseError(file, number,
                       std::to_string(words.size()) + " fields in " + quote(text) +
                           ", expected 8: " + first_column + " tx ty tz qx qy qz qw");
    }
    handle(number, words.front(), parsePose(file, number, words));
  }
}

}  // namespace

Trajectory::Trajectory(std::vector<StampedPose> poses) : poses_(std::move(poses)) {
  for (std::size_t i = 1; i < poses_.size(); ++i) {
    if (poses_[i].stamp <= poses_[i - 1].stamp) {
      throw Error("trajectory: stamp " + formatStamp(poses_[i].stamp) + " of pose " +
                  std::to_string(i) + " does not come after " + formatStamp(poses_[i - 1].stamp) +
                  ", expected increasing stamps");
    }
  }
}

bool Trajectory::add(const StampedPose& pose) {
  const auto place =
      std::lower_bound(poses_.begin(), poses_.end(), pose.stamp,
                       [](const StampedPose& known, Stamp time) { return known.stamp < time; });
  if (place != poses_.end() && place->stamp == pose.stamp) {
    return false;
  }
  poses_.insert(place, pose);
  return true;
}

void Trajectory::forgetBefore(Stamp stamp) {
  const auto needed =
      std::lower_bound(poses_.begin(), poses_.end(), stamp - kMaxGap,
                       [](const StampedPose& pose, Stamp time) { return pose.stamp < time; });
  // As many are moved as are forgotten, at most; one is always left.
  if (2 * (needed - poses_.begin()) > static_cast<std::ptrdiff_t>(poses_.size())) {
    poses_.erase(poses_.begin(), std::min(needed, std::prev(poses_.end())));
  }
}

std::optional<Pose> Trajectory::at(Stamp stamp) const {
  const auto after =
      std::lower_bound(poses_.begin(), poses_.end(), stamp,
                       [](const StampedPose& pose, Stamp time) { return pose.stamp < time; });
  const bool has_after = after != poses_.end();
  const bool has_before = after != poses_.begin();
  const auto before = has_before ? after - 1 : after;
  const bool same_after = has_after && after->stamp - stamp <= kSameTime;
  const bool same_before = has_before && stamp - before->stamp <= kSameTime;
  if (same_after && (!same_before || after->stamp - stamp <= stamp - before->stamp)) {
    return after->pose;
  }
  if (same_before) {
    return before->pose;
  }
  if (!has_before || !has_after || stamp - before->stamp > kMaxGap ||
      after->stamp - stamp > kMaxGap) {
    return std::nullopt;
  }
  const double fraction = static_cast<double>(stamp - before->stamp) /
                          static_cast<double>(after->stamp - before->stamp);
  return interpolate(before->pose, after->pose, fraction);
}

Trajectory readTrajectory(const std::filesystem::path& file) {
  std::vector<StampedPose> poses;
  readRows(file, "stamp", [&](int line, std::string_view first, const Pose& pose) {
    const std::optional<Stamp> stamp = parseStamp(first);
    if (!stamp) {
      throw ParseError(file.string(), line,
                       "the stamp is " + quote(first) + ", expected decimal seconds");
    }
    if (!poses.empty() && *stamp <= poses.back().stamp) {
      throw ParseError(file.string(), line,
                       "stamp " + quote(first) + " does not come after the one before it (" +
                           formatStamp(poses.back().stamp) + "), expected increasing stamps");
    }
    poses.push_back({*stamp, pose});
  });
  return Trajectory(std::move(poses));
}

std::vector<NumberedPose> readNumberedPoses(const std::filesystem::path& file) {
  std::vector<NumberedPose> poses;
  readRows(file, "number", [&](int line, std::string_view first, const Pose& pose) {
    const std::optional<std::int64_t> number = parseInteger(first);
    if (!number) {
      throw ParseError(file.string(), line,
                       "the frame number is " + quote(first) + ", expected a whole number");
    }
    if (!poses.empty() && *number <= poses.back().number) {
      throw ParseError(file.string(), line,
                       "frame number " + quote(first) + " does not come after the one before it (" +
                           std::to_string(poses.back().number) + "), expected increasing numbers");
    }
    poses.push_back({*number, pose});
  });
  return poses;
}

std::vector<Pose> readPoseRows(const std::filesystem::path& file) {
  std::vector<Pose> poses;
  readRows(file, "row", [&](int /*line*/, std::string_view /*first*/, const Pose& pose) {
    poses.push_back(pose);
  });
  return poses;
}

}  // namespace evolin
