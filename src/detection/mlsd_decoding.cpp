// Centres and displacements to segments.
#include "mlsd_decoding.h"

#include <cmath>
#include <limits>
#include <vector>

#include "evolin_ros/base/error.h"
#include "evolin_ros/inference/feature_map.h"

namespace evolin::mlsd {
namespace {

constexpr int kMaps = 5;

float sigmoid(float logit) { return 1.0F / (1.0F + std::exp(-logit)); }

/// A little below the logit of `probability`, so that rounding never loses a centre.
float logitBelow(double probability) {
  if (probability <= 0) {
    return -std::numeric_limits<float>::infinity();
  }
  if (probability >= 1) {
    return std::numeric_limits<float>::infinity();
  }
  const double logit = std::log(probability / (1 - probability));
  return static_cast<float>(logit - 1e-3 * (1 + std::abs(logit)));
}

}  // namespace

Decoder::Decoder(const DecodingOptions& options)
    : options_(options), least_logit_(logitBelow(options.score_threshold)) {}

LineSegments Decoder::decode(const cv::Mat& maps, cv::Size size) {
  const bool batch = maps.dims == 4 && maps.size[0] == 1;
  if (maps.empty() || maps.depth() != CV_32F || maps.channels() != 1 || !maps.isContinuous() ||
      (maps.dims != 3 && !batch) || maps.size[maps.dims - 3] != kMaps) {
    throw Error("M-LSD's maps are a float tensor [5, rows, columns]");
  }
  const int rows = maps.size[maps.dims - 2];
  const int columns = maps.size[maps.dims - 1];
  const std::size_t area = static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns);
  const float* logits = maps.ptr<float>();
  // Maxima are those of the probabilities, which rounding makes equal where logits are not.
  probability_.create(rows, columns, CV_32FC1);
  float* probability = probability_.ptr<float>();
  for (std::size_t i = 0; i < area; ++i) {
    probability[i] = logits[i] > least_logit_ ? sigmoid(logits[i]) : 0.0F;
  }
  std::vector<Peak> centres =
      localMaxima(probability_, 3, static_cast<float>(options_.score_threshold));
  keepBest(static_cast<std::size_t>(options_.candidates), &centres);

  const double x_scale = static_cast<double>(size.width) / columns;
  const double y_scale = static_cast<double>(size.height) / rows;
  LineSegments lines;
  lines.reserve(centres.size());
  for (const Peak& centre : centres) {
    const float* moved = logits + area + static_cast<std::size_t>(centre.y) * columns + centre.x;
    const float dx1 = moved[0];
    const float dy1 = moved[area];
    const float dx2 = moved[2 * area];
    const float dy2 = moved[3 * area];
    const float length = std::sqrt((dx1 - dx2) * (dx1 - dx2) + (dy1 - dy2) * (dy1 - dy2));
    if (!(length > static_cast<float>(options_.min_grid_length))) {
      continue;
    }
    LineSegment line;
    line.x1 = x_scale * (static_cast<float>(centre.x) + dx1);
    line.y1 = y_scale * (static_cast<float>(centre.y) + dy1);
    line.x2 = x_scale * (static_cast<float>(centre.x) + dx2);
    line.y2 = y_scale * (static_cast<float>(centre.y) + dy2);
    line.score = centre.value;
    if (line.isFinite()) {
      lines.push_back(line);
    }
  }
  return lines;
}

}  // namespace evolin::mlsd
