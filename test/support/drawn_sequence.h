// A small sequence drawn with OpenCV: moving quadrilaterals whose edges are the annotated lines,
// the same on every platform up to OpenCV's own drawing.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <string>
#include <vector>

#include "evolin_ros/base/stamp.h"
#include "evolin_ros/base/text.h"
#include "evolin_ros/dataset/csv.h"
#include "evolin_ros/dataset/sequence_reader.h"
#include "evolin_ros/dataset/stamps_file.h"
#include "evolin_ros/metrics/association.h"

namespace evolin::test {

struct DrawnSequence {
  int frames = 12;
  int width = 320;
  int height = 240;
  Stamp first_stamp = 1305031453359684000;
  double rate = 30;  ///< frames a second
};

namespace drawing {

constexpr int kQuads = 4;

inline cv::Scalar quadColour(int quad) {
  // The last one hardly stands out from the ground (90): a detector misses it.
  const std::array<cv::Scalar, kQuads> colours = {cv::Scalar(40, 180, 220), cv::Scalar(200, 60, 30),
                                                  cv::Scalar(230, 230, 230),
                                                  cv::Scalar(92, 93, 94)};
  return colours[static_cast<std::size_t>(quad)];
}

/// Corners of quadrilateral `quad` (one in each quarter of the image), shrunk by `scale`.
inline std::array<cv::Point2d, 4> corners(const DrawnSequence& sequence, int quad, int frame,
                                          double scale) {
  const double time = frame - 0.5 * (sequence.frames - 1);
  const double angle = 0.15 + 0.5 * quad + 0.012 * time * (quad % 2 == 0 ? 1 : -1);
  const cv::Point2d centre(
      sequence.width * (quad % 2 == 0 ? 0.27 : 0.73) + (0.9 - 0.3 * quad) * time,
      sequence.height * (quad < 2 ? 0.28 : 0.72) + (0.2 * quad - 0.4) * time);
  const cv::Point2d half(scale * sequence.width * (0.13 + 0.01 * quad),
                         scale * sequence.height * 0.13);
  std::array<cv::Point2d, 4> points;
  for (int corner = 0; corner < 4; ++corner) {
    const cv::Point2d local(half.x * (corner == 1 || corner == 2 ? 1 : -1),
                            half.y * (corner >= 2 ? 1 : -1));
    points[static_cast<std::size_t>(corner)] =
        centre + cv::Point2d(local.x * std::cos(angle) - local.y * std::sin(angle),
                             local.x * std::sin(angle) + local.y * std::cos(angle));
  }
  return points;
}

inline void fill(cv::Mat* image, const std::array<cv::Point2d, 4>& points,
                 const cv::Scalar& colour) {
  constexpr int kShift = 8;
  std::vector<cv::Point> fixed;
  fixed.reserve(points.size());
  for (const cv::Point2d& point : points) {
    fixed.emplace_back(static_cast<int>(std::lround(point.x * (1 << kShift))),
                       static_cast<int>(std::lround(point.y * (1 << kShift))));
  }
  cv::fillConvexPoly(*image, fixed, colour, cv::LINE_AA, kShift);
}

/// Grain of up to 4 grey levels, another one in each frame.
inline void addGrain(cv::Mat* image, int frame) {
  std::uint32_t state = 12345U + 977U * static_cast<std::uint32_t>(frame);
  for (int row = 0; row < image->rows; ++row) {
    std::uint8_t* bytes = image->ptr<std::uint8_t>(row);
    for (int i = 0; i < image->cols * image->channels(); ++i) {
      state = state * 1664525U + 1013904223U;
      bytes[i] = cv::saturate_cast<std::uint8_t>(bytes[i] + static_cast<int>(state >> 30U));
    }
  }
}

inline cv::Mat depth(const DrawnSequence& sequence, int frame) {
  cv::Mat depth(sequence.height, sequence.width, CV_32FC1);
  for (int row = 0; row < depth.rows; ++row) {
    depth.row(row).setTo(1.0F + 0.004F * static_cast<float>(row) +
                         0.01F * static_cast<float>(frame));
  }
  depth(cv::Rect(0, 0, 8, 8)).setTo(std::numeric_limits<float>::quiet_NaN());
  return depth;
}

}  // namespace drawing

/// One frame: colour, depth, camera, pose, and the 16 edges of four quadrilaterals with ids from 0.
/// Inside each is a smaller one that nobody annotated (false positives). Rows of the annotation
/// begin with another line in each frame, so that indices and ids differ.
inline SequenceFrame drawFrame(const DrawnSequence& sequence, int number) {
  SequenceFrame drawn;
  Frame& frame = drawn.frame;
  const Stamp step = std::llround(static_cast<double>(kNanosecondsPerSecond) / sequence.rate);
  frame.stamp = sequence.first_stamp + number * step;
  std::string digits = std::to_string(number);
  frame.name = std::string(4 - std::min<std::size_t>(4, digits.size()), '0') + digits;
  frame.image = cv::Mat(sequence.height, sequence.width, CV_8UC3, cv::Scalar::all(90));
  LineSegments lines;
  for (int quad = 0; quad < drawing::kQuads; ++quad) {
    const std::array<cv::Point2d, 4> points = drawing::corners(sequence, quad, number, 1);
    drawing::fill(&frame.image, points, drawing::quadColour(quad));
    drawing::fill(&frame.image, drawing::corners(sequence, quad, number, 0.35 + 0.05 * quad),
                  cv::Scalar(20 + 60 * quad, 110, 250 - 70 * quad));
    for (std::size_t corner = 0; corner < points.size(); ++corner) {
      const cv::Point2d& from = points[corner];
      const cv::Point2d& to = points[(corner + 1) % points.size()];
      const auto id = static_cast<std::int64_t>(lines.size());
      lines.push_back({from.x, from.y, to.x, to.y, kNoScore, id});
    }
  }
  std::rotate(
      lines.begin(),
      lines.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(number) % lines.size()),
      lines.end());
  drawing::addGrain(&frame.image, number);
  drawn.ground_truth = std::move(lines);

  frame.depth = drawing::depth(sequence, number);
  drawn.depth_stamp = frame.stamp;
  Camera camera;
  camera.name = "drawn";
  camera.width = sequence.width;
  camera.height = sequence.height;
  camera.fx = camera.fy = 0.9 * sequence.width;
  camera.cx = 0.5 * (sequence.width - 1);
  camera.cy = 0.5 * (sequence.height - 1);
  frame.camera = camera;
  Pose pose;
  pose.translation = Eigen::Vector3d(0.01 * number, -0.002 * number, 0.005 * number);
  pose.rotation = Eigen::AngleAxisd(0.004 * number, Eigen::Vector3d::UnitZ());
  frame.pose = pose;
  drawn.image_file = "images/" + frame.name + ".png";
  return drawn;
}

inline std::vector<SequenceFrame> drawSequence(const DrawnSequence& sequence = {}) {
  std::vector<SequenceFrame> frames;
  frames.reserve(static_cast<std::size_t>(sequence.frames));
  for (int number = 0; number < sequence.frames; ++number) {
    frames.push_back(drawFrame(sequence, number));
  }
  return frames;
}

/// `folder`/NNNN.csv for every frame with annotated lines, gt_associations_step1/ in it (which
/// carry the ids), and stamps.txt unless `with_stamps` is false. Lines keep every bit.
inline void writeAnnotations(const std::vector<SequenceFrame>& frames,
                             const std::filesystem::path& folder, bool with_stamps = true) {
  const std::filesystem::path pairs = folder / "gt_associations_step1";
  std::filesystem::create_directories(pairs);
  std::vector<StampedFile> stamps;
  const SequenceFrame* before = nullptr;
  for (const SequenceFrame& drawn : frames) {
    if (!drawn.ground_truth) {
      before = nullptr;
      continue;
    }
    writeLinesCsv(folder / (drawn.frame.name + ".csv"), *drawn.ground_truth);
    stamps.push_back({drawn.frame.stamp, drawn.frame.name + ".csv"});
    if (before != nullptr) {
      std::ofstream file(pairs / (before->frame.name + "_" + drawn.frame.name + ".csv"));
      for (const auto& [i, j] : pairsOfEqualIds(*before->ground_truth, *drawn.ground_truth)) {
        file << i << "," << j << "\n";
      }
    }
    before = &drawn;
  }
  if (with_stamps) {
    writeStampsFile(folder / "stamps.txt", stamps);
  }
}

/// The sequence in the benchmark's own layout: images, lines, ids, poses, calibration and stamps.
inline void writeEvolinFolder(const std::vector<SequenceFrame>& frames,
                              const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder / "images");
  writeAnnotations(frames, folder / "gt_lines", false);
  std::filesystem::rename(folder / "gt_lines" / "gt_associations_step1",
                          folder / "gt_associations_step1");
  std::ofstream poses(folder / "poses.txt");
  std::vector<StampedFile> stamps;
  for (const SequenceFrame& drawn : frames) {
    const Frame& frame = drawn.frame;
    cv::imwrite((folder / drawn.image_file).string(), frame.image);
    stamps.push_back({frame.stamp, drawn.image_file});
    const Eigen::Vector3d& at = frame.pose->translation;
    const Eigen::Quaterniond& turn = frame.pose->rotation;
    poses << formatStamp(frame.stamp);
    for (const double value : {at.x(), at.y(), at.z(), turn.x(), turn.y(), turn.z(), turn.w()}) {
      poses << " " << formatDouble(value);
    }
    poses << "\n";
  }
  const Camera& camera = *frames.front().frame.camera;
  std::ofstream(folder / "calibration_matrix.txt")
      << camera.fx << " 0 " << camera.cx << "\n0 " << camera.fy << " " << camera.cy << "\n0 0 1\n";
  writeStampsFile(folder / "stamps.txt", stamps);
}

}  // namespace evolin::test
