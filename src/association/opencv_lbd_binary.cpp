// The binary line band descriptor of OpenCV.
#include "evolin_ros/association/opencv_lbd_binary.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "evolin_opencv_features.h"
#include "evolin_ros/association/lbd_binary_descriptor.h"
#include "evolin_ros/base/availability.h"
#include "evolin_ros/base/error.h"
#if EVOLIN_HAS_LINE_DESCRIPTOR
#include <opencv2/line_descriptor.hpp>
#endif

namespace evolin {

std::string whyNoOpenCvLbdBinary() {
  return EVOLIN_HAS_LINE_DESCRIPTOR
             ? std::string()
             : missingInOpenCv("BinaryDescriptor (module line_descriptor of opencv_contrib)",
                               "3.0 where opencv_contrib is installed");
}

#if EVOLIN_HAS_LINE_DESCRIPTOR
namespace {

using cv::line_descriptor::BinaryDescriptor;
using cv::line_descriptor::KeyLine;

// OpenCV counts the lines of a call in 16 bits and crashes on more.
constexpr std::size_t kLinesACall = 30000;

struct DescribableLine {
  std::size_t index;
  KeyLine key_line;
};

KeyLine makeKeyLine(const LineSegment& line, const cv::Size& image) {
  const auto x1 = static_cast<float>(line.x1);
  const auto y1 = static_cast<float>(line.y1);
  const auto x2 = static_cast<float>(line.x2);
  const auto y2 = static_cast<float>(line.y2);
  const float dx = x2 - x1;
  const float dy = y2 - y1;
  KeyLine result;
  result.startPointX = result.sPointInOctaveX = x1;
  result.startPointY = result.sPointInOctaveY = y1;
  result.endPointX = result.ePointInOctaveX = x2;
  result.endPointY = result.ePointInOctaveY = y2;
  result.octave = 0;  // other octaves use another pyramid than OpenCV's own detector
  result.class_id = 0;
  result.angle = std::atan2(dy, dx);
  result.pt = cv::Point2f(0.5F * (x1 + x2), 0.5F * (y1 + y2));
  result.size = std::abs(dx * dy);
  result.lineLength = std::hypot(dx, dy);
  result.response = result.lineLength / static_cast<float>(std::max(image.width, image.height));
  // Samples a row of the support, as in the float descriptor; none would divide zero by zero.
  result.numOfPixels = static_cast<int>(std::ceil(std::max(std::abs(dx), std::abs(dy))));
  return result;
}

std::vector<DescribableLine> describableLines(const LineSegments& lines, const cv::Size& image) {
  std::vector<DescribableLine> result;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::optional<LineSegment> part = describedPart(lines[i], image);
    if (!part) {
      continue;
    }
    const KeyLine key_line = makeKeyLine(*part, image);
    if (key_line.numOfPixels > 0) {
      result.push_back({i, key_line});
    }
  }
  return result;
}

// Rows of the result belong to `key_lines` in order. OpenCV finds a row by the line's class_id: two
// of one id would share a row and leave the other unwritten. A fresh object for each call, as it
// keeps images and writes to itself in a const function.
cv::Mat compute(const cv::Mat& gray, std::vector<KeyLine> key_lines, bool floats) {
  for (std::size_t i = 0; i < key_lines.size(); ++i) {
    key_lines[i].class_id = static_cast<int>(i);
  }
  cv::Mat descriptors;
  BinaryDescriptor extractor;
  extractor.compute(gray, key_lines, descriptors, floats);
  const int width = floats ? descriptors.cols : kLbdBinaryBytes;
  if (descriptors.rows != static_cast<int>(key_lines.size()) || descriptors.cols != width) {
    throw Error("binary LBD of OpenCV: OpenCV's BinaryDescriptor returned " +
                std::to_string(descriptors.rows) + " rows of " + std::to_string(descriptors.cols) +
                ", expected " + std::to_string(key_lines.size()) + " of " + std::to_string(width));
  }
  return descriptors;
}

// Without texture OpenCV divides zero by zero. Nothing exceeds NaN, so the bits of such a line are
// all 0; but they also are where texture only grows from the first band to the last. The float
// descriptors tell one from the other.
void dropFlatLines(const cv::Mat& gray, const std::vector<DescribableLine>& lines,
                   BinaryDescriptors* descriptors) {
  std::vector<KeyLine> suspects;
  std::vector<std::size_t> indices;
  for (const DescribableLine& line : lines) {
    if (cv::countNonZero(descriptors->bits.row(static_cast<int>(line.index))) == 0) {
      suspects.push_back(line.key_line);
      indices.push_back(line.index);
    }
  }
  if (suspects.empty()) {
    return;
  }
  const cv::Mat floats = compute(gray, suspects, true);
  for (std::size_t i = 0; i < suspects.size(); ++i) {
    descriptors->valid[indices[i]] = cv::checkRange(floats.row(static_cast<int>(i))) ? 1 : 0;
  }
}

void describeBlock(const cv::Mat& gray, const std::vector<DescribableLine>& lines,
                   BinaryDescriptors* descriptors) {
  std::vector<KeyLine> key_lines;
  key_lines.reserve(lines.size());
  for (const DescribableLine& line : lines) {
    key_lines.push_back(line.key_line);
  }
  const cv::Mat rows = compute(gray, std::move(key_lines), false);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    rows.row(static_cast<int>(i)).copyTo(descriptors->bits.row(static_cast<int>(lines[i].index)));
    descriptors->valid[lines[i].index] = 1;
  }
  dropFlatLines(gray, lines, descriptors);
}

}  // namespace

BinaryDescriptors describeOpenCvLbdBinary(const cv::Mat& gray, const LineSegments& lines) {
  const std::string size = std::to_string(gray.cols) + "x" + std::to_string(gray.rows);
  if (gray.empty() || gray.type() != CV_8UC1) {
    throw Error("binary LBD of OpenCV: the image is " + size + " of OpenCV type " +
                std::to_string(gray.type()) + ", expected a non-empty 8-bit grey image");
  }
  if (std::max(gray.cols, gray.rows) > kOpenCvLbdBinaryLargestSide) {
    throw Error("binary LBD of OpenCV: the image is " + size + ", expected at most " +
                std::to_string(kOpenCvLbdBinaryLargestSide) + " pixels a side");
  }
  try {
    BinaryDescriptors result;
    result.bits = cv::Mat::zeros(static_cast<int>(lines.size()), kLbdBinaryBytes, CV_8U);
    result.valid.assign(lines.size(), 0);
    const std::vector<DescribableLine> describable = describableLines(lines, gray.size());
    for (std::size_t begin = 0; begin < describable.size(); begin += kLinesACall) {
      const std::size_t end = std::min(describable.size(), begin + kLinesACall);
      const auto first = describable.begin();
      describeBlock(
          gray,
          {first + static_cast<std::ptrdiff_t>(begin), first + static_cast<std::ptrdiff_t>(end)},
          &result);
    }
    return result;
  } catch (const cv::Exception& error) {
    throw Error("binary LBD of OpenCV: OpenCV's BinaryDescriptor failed on " +
                std::to_string(lines.size()) + " lines of an image of " + size + ": " +
                error.what());
  }
}

#else

BinaryDescriptors describeOpenCvLbdBinary(const cv::Mat&, const LineSegments&) {
  throw UnavailableError("binary LBD of OpenCV: " + whyNoOpenCvLbdBinary());
}

#endif

}  // namespace evolin
