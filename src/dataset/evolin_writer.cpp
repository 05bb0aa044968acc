// Images as they come, lists at the end.
#include "evolin_ros/dataset/evolin_writer.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <unordered_map>

#include "evolin_ros/base/atomic_file.h"
#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"
#include "evolin_ros/dataset/csv.h"
#include "evolin_ros/dataset/stamps_file.h"

namespace evolin {

namespace fs = std::filesystem;

namespace {

void makeFolder(const fs::path& folder) {
  std::error_code reason;
  fs::create_directories(folder, reason);
  if (reason) {
    throw Error(folder.string() + ": cannot be made: " + reason.message());
  }
}

void writePng(const fs::path& file, const cv::Mat& image) {
  makeFolder(file.parent_path());
  // Noise does not compress; more effort would cost time and gain nothing.
  constexpr int kEffort = 2;
  bool written = false;
  std::string reason;
  try {
    written = cv::imwrite(file.string(), image, {cv::IMWRITE_PNG_COMPRESSION, kEffort});
  } catch (const cv::Exception& error) {
    reason = ": " + error.err;
  }
  if (!written) {
    throw Error(file.string() + ": cannot be written" + reason);
  }
}

cv::Mat storedDepth(const cv::Mat& depth, double factor) {
  constexpr double kLargest = 65535;
  cv::Mat stored(depth.size(), CV_16UC1);
  for (int y = 0; y < depth.rows; ++y) {
    const auto* metres = depth.ptr<float>(y);
    auto* units = stored.ptr<std::uint16_t>(y);
    for (int x = 0; x < depth.cols; ++x) {
      const double value = std::floor(static_cast<double>(metres[x]) * factor + 0.5);
      // NaN compares false: no depth.
      units[x] = value >= 0 && value <= kLargest ? static_cast<std::uint16_t>(value) : 0;
    }
  }
  return stored;
}

/// By rising id.
std::map<std::int64_t, std::size_t> rowsOf(const std::optional<LineSegments>& lines) {
  std::map<std::int64_t, std::size_t> rows;
  for (std::size_t row = 0; lines && row < lines->size(); ++row) {
    if ((*lines)[row].id >= 0) {
      rows.emplace((*lines)[row].id, row);
    }
  }
  return rows;
}

/// By rising row of the first frame.
std::string pairText(IndexPairs pairs) {
  std::sort(pairs.begin(), pairs.end());
  std::string text;
  for (const auto& [first, second] : pairs) {
    text += std::to_string(first) + "," + std::to_string(second) + "\n";
  }
  return text;
}

}  // namespace

EvolinWriter::EvolinWriter(const fs::path& folder) : folder_(folder) { makeFolder(folder_); }

std::string EvolinWriter::stem(std::size_t number) {
  constexpr std::size_t kDigits = 4;
  const std::string digits = std::to_string(number);
  return std::string(kDigits - std::min(kDigits, digits.size()), '0') + digits;
}

void EvolinWriter::addFrame(std::size_t number, const SequenceFrame& frame) {
  const std::string name = stem(number);
  Entry entry;
  entry.stamp = frame.frame.stamp;
  entry.pose = frame.frame.pose;
  entry.camera = frame.frame.camera;
  entry.depth = !frame.frame.depth.empty();
  entry.lines = frame.ground_truth;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!entries_.emplace(number, std::move(entry)).second) {
      throw Error(folder_.string() + ": frame " + name + " is given twice, expected once");
    }
  }
  writePng(folder_ / "images" / (name + ".png"), frame.frame.image);
  if (!frame.frame.depth.empty()) {
    const double factor = frame.frame.camera.value_or(Camera()).depth_factor;
    writePng(folder_ / "depth" / (name + ".png"), storedDepth(frame.frame.depth, factor));
  }
  if (frame.ground_truth) {
    writeLinesCsv(folder_ / "gt_lines" / (name + ".csv"), *frame.ground_truth);
    const bool identified = std::any_of(frame.ground_truth->begin(), frame.ground_truth->end(),
                                        [](const LineSegment& line) { return line.id != kNoId; });
    if (identified) {
      std::string ids;
      for (const LineSegment& line : *frame.ground_truth) {
        ids += std::to_string(line.id) + "\n";
      }
      writeFileAtomically(folder_ / "gt_ids" / (name + ".csv"), ids);
    }
  }
}

void EvolinWriter::finish() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (entries_.empty()) {
    throw Error(folder_.string() + ": no frames, expected at least one");
  }
  if (entries_.rbegin()->first + 1 != entries_.size()) {
    throw Error(folder_.string() + ": the last of " + std::to_string(entries_.size()) +
                " frames is " + stem(entries_.rbegin()->first) +
                ", expected numbers from 0 without gaps");
  }
  writeLists();
  writePoses();
  writeAssociations();
}

void EvolinWriter::writeLists() const {
  std::vector<StampedFile> images;
  std::vector<StampedFile> annotations;
  std::string depths;
  std::size_t depth_row = 0;
  for (const auto& [number, entry] : entries_) {
    images.push_back({entry.stamp, "images/" + stem(number) + ".png"});
    if (entry.lines) {
      annotations.push_back({entry.stamp, stem(number) + ".csv"});
    }
    if (entry.depth) {
      depths += std::to_string(number) + " " + std::to_string(depth_row++) + "\n";
    }
  }
  writeStampsFile(folder_ / "stamps.txt", images);
  if (!annotations.empty()) {
    writeStampsFile(folder_ / "gt_lines" / "stamps.txt", annotations);
  }
  if (depth_row > 0) {
    writeFileAtomically(folder_ / "depth_associations.txt", depths);
  }
  if (const std::optional<Camera>& camera = entries_.begin()->second.camera) {
    writeFileAtomically(folder_ / "calibration_matrix.txt",
                        formatDouble(camera->fx) + " 0 " + formatDouble(camera->cx) + "\n0 " +
                            formatDouble(camera->fy) + " " + formatDouble(camera->cy) +
                            "\n0 0 1\n");
  }
}

void EvolinWriter::writePoses() const {
  std::string text;
  std::size_t count = 0;
  for (const auto& [number, entry] : entries_) {
    if (!entry.pose) {
      continue;
    }
    ++count;
    const Eigen::Vector3d& t = entry.pose->translation;
    const Eigen::Quaterniond& q = entry.pose->rotation;
    text += formatStamp(entry.stamp);
    for (const double value : {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()}) {
      text += " " + formatDouble(value);
    }
    text += "\n";
  }
  if (count != 0 && count != entries_.size()) {
    throw Error((folder_ / "poses.txt").string() + ": " + std::to_string(count) + " of " +
                std::to_string(entries_.size()) +
                " frames have a pose, expected all or none because poses go by row");
  }
  if (count > 0) {
    writeFileAtomically(folder_ / "poses.txt", text);
  }
}

void EvolinWriter::writeAssociations() const {
  struct Place {
    std::size_t frame;
    std::size_t row;
  };
  std::unordered_map<std::int64_t, Place> last_seen;
  for (const auto& [number, entry] : entries_) {
    IndexPairs neighbours;
    std::map<std::size_t, IndexPairs> gaps;  // by the earlier frame
    for (const auto& [id, row] : rowsOf(entry.lines)) {
      const auto seen = last_seen.find(id);
      if (seen != last_seen.end()) {
        const Place& before = seen->second;
        (before.frame + 1 == number ? neighbours : gaps[before.frame])
            .emplace_back(before.row, row);
      }
      last_seen[id] = {number, row};
    }
    if (number > 0 && entry.lines && entries_.at(number - 1).lines) {
      writeFileAtomically(
          folder_ / "gt_associations_step1" / (stem(number - 1) + "_" + stem(number) + ".csv"),
          pairText(neighbours));
    }
    for (const auto& [earlier, pairs] : gaps) {
      writeFileAtomically(
          folder_ / "gt_associations_gaps" / (stem(earlier) + "_" + stem(number) + ".csv"),
          pairText(pairs));
    }
  }
}

}  // namespace evolin
