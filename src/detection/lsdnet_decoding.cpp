// Regions, their stitching, their segments.
#include "lsdnet_decoding.h"

#include <algorithm>
#include <array>

#include "evolin_ros/base/error.h"
#include "lsdnet_stitching.h"

namespace evolin::lsdnet {
namespace {

constexpr int kLeastSide = 4;

}  // namespace

Decoder::Decoder(const DecodingOptions& options)
    : options_(options), splitter_(options.compatible) {}

LineSegments Decoder::decode(const cv::Mat& maps, cv::Size size) {
  const bool batch = maps.dims == 4 && maps.size[0] == 1;
  if (maps.empty() || maps.depth() != CV_32F || maps.channels() != 1 || !maps.isContinuous() ||
      (maps.dims != 3 && !batch) || maps.size[maps.dims - 1] != 2 ||
      std::min(maps.size[maps.dims - 2], maps.size[maps.dims - 3]) < kLeastSide) {
    throw Error("LSDNet's maps are a float tensor [rows, columns, 2]");
  }
  const int rows = maps.size[maps.dims - 3];
  const int columns = maps.size[maps.dims - 2];
  growing_.setMaps(maps.ptr<float>(), rows, columns);
  Regions regions;
  if (options_.single_pass) {
    regions = growing_.grow(cv::Rect(0, 0, columns, rows));
  } else {
    const int row = rows / 2;
    const int column = columns / 2;
    std::array<Regions, 4> quarters = {
        growing_.grow(cv::Rect(0, 0, column, row)),
        growing_.grow(cv::Rect(column, 0, columns - column, row)),
        growing_.grow(cv::Rect(0, row, column, rows - row)),
        growing_.grow(cv::Rect(column, row, columns - column, rows - row))};
    regions = stitchQuarters(std::move(quarters), rows, columns);
  }
  segments_.clear();
  for (const Region& region : regions) {
    splitter_.split(region, growing_, &segments_);
  }
  std::stable_sort(segments_.begin(), segments_.end(),
                   [](const MapSegment& a, const MapSegment& b) { return a.score > b.score; });
  const auto toImage = [](int place, int from, int to) {
    const float share = static_cast<float>(place) / static_cast<float>(from);
    return static_cast<double>(static_cast<int>(share * static_cast<float>(to)));
  };
  LineSegments lines;
  lines.reserve(segments_.size());
  for (const MapSegment& segment : segments_) {
    LineSegment line;
    line.x1 = toImage(segment.x1, columns, size.width);
    line.y1 = toImage(segment.y1, rows, size.height);
    line.x2 = toImage(segment.x2, columns, size.width);
    line.y2 = toImage(segment.y2, rows, size.height);
    line.score = static_cast<double>(segment.score);
    lines.push_back(line);
  }
  return lines;
}

}  // namespace evolin::lsdnet
