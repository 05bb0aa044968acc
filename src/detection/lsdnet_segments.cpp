// Axes, cuts and ends. As in lsdnet_regions.cpp, the kind of each intermediate is the authors':
// compile without floating-point contraction.
#include "lsdnet_segments.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace evolin::lsdnet {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr int kBins = 15;
constexpr double kLeastWidth = 1e-6;
constexpr double kWidening = 1e-12;

/// Ends are cut to whole pixels; what is not above 0 becomes 0.
int toPixel(float value) { return value > 0 ? static_cast<int>(std::min(value, 1e6F)) : 0; }

}  // namespace

bool Splitter::makeFrame(const Region& region, const RegionGrowing& maps, Frame* frame) const {
  const int columns = maps.columns();
  float weight = 0;
  float rows_sum = 0;
  float columns_sum = 0;
  bool one_row = true;
  bool one_column = true;
  for (const int pixel : region.pixels) {
    const float p = maps.probability(pixel);
    const auto r = static_cast<float>(pixel / columns);
    const auto c = static_cast<float>(pixel % columns);
    one_row = one_row && pixel / columns == region.pixels.front() / columns;
    one_column = one_column && pixel % columns == region.pixels.front() % columns;
    weight += p;
    rows_sum += r * p;
    columns_sum += c * p;
  }
  frame->row = rows_sum / weight;
  frame->column = columns_sum / weight;
  if (one_row || one_column) {
    const bool along_rows = one_row == swapped_axes_;
    frame->along_rows = along_rows ? 1 : 0;
    frame->along_columns = along_rows ? 0 : 1;
    return true;
  }
  float rr = 0;
  float cc = 0;
  float rc = 0;
  for (const int pixel : region.pixels) {
    const float p = maps.probability(pixel);
    const float dr = static_cast<float>(pixel / columns) - frame->row;
    const float dc = static_cast<float>(pixel % columns) - frame->column;
    rr += dr * dr * p;
    cc += dc * dc * p;
    rc += dr * dc * p;
  }
  rr /= weight;
  cc /= weight;
  rc /= weight;
  const float root = 4 * rc * rc + (rr - cc) * (rr - cc);
  const auto largest =
      static_cast<float>((static_cast<double>(cc + rr) + std::sqrt(static_cast<double>(root))) / 2);
  const double direction_r = rc;
  const double direction_c = largest - rr;
  const double squared = direction_r * direction_r + direction_c * direction_c;
  if (!(squared > 0)) {
    // Without covariance the longer side is the axis; the authors divide by nothing here.
    frame->along_rows = rr >= cc ? 1 : 0;
    frame->along_columns = rr >= cc ? 0 : 1;
    return !swapped_axes_;
  }
  const double sign = rc >= 0 ? 1 : -1;
  const auto theta =
      static_cast<float>(std::acos(std::min(sign * direction_c / std::sqrt(squared), 1.0)));
  const auto alpha = static_cast<float>(kPi / 2 - static_cast<double>(theta));
  frame->along_rows = std::cos(alpha);
  frame->along_columns = std::sin(alpha);
  return std::isfinite(alpha);
}

void Splitter::findCuts() {
  cuts_.clear();
  const double low = samples_.front().across;
  const double width = static_cast<double>(samples_.back().across) - low;
  if (!(width > kLeastWidth)) {
    return;
  }
  const double step = width / kBins;
  const double bin = step + kWidening;
  std::array<int, kBins + 1> counts{};
  double edge = low + bin;
  std::size_t place = 0;
  for (const Sample& sample : samples_) {
    // One step a sample at most: behind a gap the histogram lags.
    if (static_cast<double>(sample.across) > edge && place + 1 < counts.size()) {
      edge += bin;
      ++place;
    }
    ++counts[place];
  }
  std::array<double, kBins + 2> density{};
  std::size_t points = 0;
  double sum = 0;
  const double high = samples_.back().across;
  for (double point = low; point <= high && points < density.size(); point += step) {
    double value = 0;
    for (std::size_t i = 0; i < counts.size(); ++i) {
      if (counts[i] == 0) {
        continue;
      }
      const double z = point - (low + static_cast<double>(i) * bin + bin / 2);
      value += counts[i] * std::exp(-z * z / 2) / std::sqrt(2 * kPi);
    }
    density[points] = value / static_cast<double>(samples_.size());
    sum += density[points++];
  }
  for (std::size_t i = 0; i < points; ++i) {
    density[i] /= sum;
  }
  for (std::size_t i = 1; i + 1 < points; ++i) {
    if (density[i] <= density[i - 1] && density[i] <= density[i + 1]) {
      cuts_.push_back(static_cast<float>(low + step * static_cast<double>(i) + step / 2));
    }
  }
}

MapSegment Splitter::segmentOf(const Frame& frame, const Sample* begin, const Sample* end) {
  float across = 0;
  float weight = 0;
  float first = begin->along;
  float last = begin->along;
  for (const Sample* sample = begin; sample != end; ++sample) {
    across = static_cast<float>(static_cast<double>(across) +
                                static_cast<double>(sample->across) *
                                    static_cast<double>(sample->probability));
    weight += sample->probability;
    first = std::min(first, sample->along);
    last = std::max(last, sample->along);
  }
  const float place = across / weight;
  const auto row = [&](float along) {
    return toPixel(frame.along_rows * along - frame.along_columns * place + frame.row);
  };
  const auto column = [&](float along) {
    return toPixel(frame.along_columns * along + frame.along_rows * place + frame.column);
  };
  return {column(first), row(first), column(last), row(last),
          weight / static_cast<float>(end - begin)};
}

void Splitter::split(const Region& region, const RegionGrowing& maps,
                     std::vector<MapSegment>* segments) {
  Frame frame;
  if (region.pixels.empty() || !makeFrame(region, maps, &frame)) {
    return;
  }
  samples_.clear();
  for (const int pixel : region.pixels) {
    const float dr = static_cast<float>(pixel / maps.columns()) - frame.row;
    const float dc = static_cast<float>(pixel % maps.columns()) - frame.column;
    samples_.push_back({frame.along_rows * dr + frame.along_columns * dc,
                        -frame.along_columns * dr + frame.along_rows * dc,
                        maps.probability(pixel)});
  }
  std::stable_sort(samples_.begin(), samples_.end(),
                   [](const Sample& a, const Sample& b) { return a.across < b.across; });
  findCuts();
  const Sample* begin = samples_.data();
  const Sample* const end = begin + samples_.size();
  std::size_t cut = 0;
  for (const Sample* sample = begin; sample != end; ++sample) {
    // One step a sample at most, again; a part may stay empty.
    if (cut < cuts_.size() && sample->across > cuts_[cut]) {
      if (sample != begin) {
        segments->push_back(segmentOf(frame, begin, sample));
      }
      begin = sample;
      ++cut;
    }
  }
  segments->push_back(segmentOf(frame, begin, end));
}

}  // namespace evolin::lsdnet
