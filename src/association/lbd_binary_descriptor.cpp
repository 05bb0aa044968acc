// The binary line band descriptor, from the bands of the float one.
#include "evolin_ros/association/lbd_binary_descriptor.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "evolin_ros/association/lbd_descriptor.h"
#include "evolin_ros/geometry/clipping.h"

namespace evolin {
namespace {

constexpr int kBands = 9;
constexpr int kBandSize = kLbdSize / kBands;
static_assert(kBandSize == 8, "a byte compares two bands, one bit an element");

struct BandPair {
  int first;
  int second;
};

constexpr std::array<BandPair, kLbdBinaryBytes> makePairs() {
  std::array<BandPair, kLbdBinaryBytes> pairs{};
  std::size_t count = 0;
  for (int first = 0; first < kBands; ++first) {
    for (int second = first + 1; second < kBands; ++second) {
      if (first > 1 || second < 7) {
        pairs[count++] = {first, second};
      }
    }
  }
  return pairs;
}

constexpr std::array<BandPair, kLbdBinaryBytes> kPairs = makePairs();
static_assert(kPairs.back().first == 7 && kPairs.back().second == 8, "32 pairs, all of them used");

void compareBands(const float* floats, std::uint8_t* bytes) {
  for (std::size_t c = 0; c < kPairs.size(); ++c) {
    const float* const first = floats + kPairs[c].first * kBandSize;
    const float* const second = floats + kPairs[c].second * kBandSize;
    unsigned bits = 0;
    for (int k = 0; k < kBandSize; ++k) {
      bits |= (first[k] > second[k] ? 1U : 0U) << k;
    }
    bytes[c] = static_cast<std::uint8_t>(bits);
  }
}

// The float descriptor is zeros where the line has no length or no gradient is around it, and NaN
// where it is beyond the largest coordinate.
bool isDescription(const float* floats) {
  return std::any_of(floats, floats + kLbdSize, [](float value) { return value > 0; });
}

}  // namespace

std::optional<LineSegment> describedPart(const LineSegment& line, const cv::Size& image) {
  const std::optional<LineSegment> part = clipToRectangle(
      line, {-1, -1, static_cast<double>(image.width), static_cast<double>(image.height)});
  return part && part->isFinite() ? part : std::nullopt;
}

BinaryDescriptors describeLbdBinary(const cv::Mat& gray, const LineSegments& lines) {
  LineSegments parts;
  std::vector<int> rows;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (const std::optional<LineSegment> part = describedPart(lines[i], gray.size())) {
      parts.push_back(*part);
      rows.push_back(static_cast<int>(i));
    }
  }
  const cv::Mat floats = describeLbd(gray, parts);
  BinaryDescriptors result;
  result.bits = cv::Mat::zeros(static_cast<int>(lines.size()), kLbdBinaryBytes, CV_8U);
  result.valid.assign(lines.size(), 0);
  for (int i = 0; i < floats.rows; ++i) {
    const float* const row = floats.ptr<float>(i);
    if (isDescription(row)) {
      compareBands(row, result.bits.ptr<std::uint8_t>(rows[static_cast<std::size_t>(i)]));
      result.valid[static_cast<std::size_t>(rows[static_cast<std::size_t>(i)])] = 1;
    }
  }
  return result;
}

}  // namespace evolin
