// Smoothing, scaling, 2x2 gradients, and the order of seeds.
#include "lsd_field.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace evolin::lsd {
namespace {

constexpr double kDegree = CV_PI / 180;
constexpr std::int32_t kGreatestSquare = 4 * 255 * 255;
constexpr std::size_t kWeakSquares = 2048;
// A seed's key is its bin, the strongest first, and below it the pixel.
constexpr unsigned kBinShift = 32;
constexpr std::uint64_t kPixelMask = 0xffffffffU;

bool isBefore(std::uint64_t a, std::uint64_t b) { return a >> kBinShift < b >> kBinShift; }

using Keys = std::vector<std::uint64_t>;

/// Brings the middle one of the second, the central and the last key to the front.
void medianToFront(Keys::iterator first, Keys::iterator last) {
  const auto a = first + 1;
  const auto b = first + (last - first) / 2;
  const auto c = last - 1;
  if (isBefore(*a, *b)) {
    std::iter_swap(first, isBefore(*b, *c) ? b : isBefore(*a, *c) ? c : a);
  } else {
    std::iter_swap(first, isBefore(*a, *c) ? a : isBefore(*b, *c) ? c : b);
  }
}

/// Splits [first + 1, last) by the key at `first`, which is neither the least nor the greatest.
Keys::iterator splitByFirst(Keys::iterator first, Keys::iterator last) {
  const std::uint64_t pivot = *first;
  auto low = first + 1;
  auto high = last;
  while (true) {
    while (isBefore(*low, pivot)) ++low;
    --high;
    while (isBefore(pivot, *high)) --high;
    if (low >= high) {
      return low;
    }
    std::iter_swap(low, high);
    ++low;
  }
}

void sortByInsertion(Keys::iterator first, Keys::iterator last) {
  for (auto next = first; next != last; ++next) {
    const std::uint64_t key = *next;
    auto hole = next;
    for (; hole != first && isBefore(key, *(hole - 1)); --hole) *hole = *(hole - 1);
    *hole = key;
  }
}

/// Sorts [first, last) by bins but leaves alone what lies beyond `last_bin`.
void sortRange(Keys::iterator first, Keys::iterator last, int depth, std::uint64_t last_bin) {
  constexpr int kSmall = 16;
  while (last - first > kSmall) {
    if (depth-- == 0) {
      std::partial_sort(first, last, last, isBefore);
      return;
    }
    medianToFront(first, last);
    const std::uint64_t pivot_bin = *first >> kBinShift;
    const auto cut = splitByFirst(first, last);
    if (pivot_bin <= last_bin) {
      sortRange(cut, last, depth, last_bin);
    }
    last = cut;
  }
  sortByInsertion(first, last);
}

/// Among equals, the published library has the order that the introspective sort of libstdc++ makes
/// of all pixels, seeds or not; and the first pixel of a line to be a seed shapes its region. So
/// the same steps are taken here, but for ranges without any seed.
void sortLikeIntrosort(std::uint64_t last_bin, Keys* keys) {
  int depth = 0;
  for (std::size_t size = keys->size(); size > 1; size /= 2) depth += 2;
  sortRange(keys->begin(), keys->end(), depth, last_bin);
}

}  // namespace

void FieldBuilder::build(const cv::Mat& gray, Field* field) {
  const double scale = parameters_.scale;
  if (scale == 1) {
    differentiate(gray, field);
  } else {
    const cv::Size size(cvRound(gray.cols * scale), cvRound(gray.rows * scale));
    if (size.width < 2 || size.height < 2) {
      field->width = field->height = 0;
      field->angles.clear();
      field->seeds.clear();
      return;
    }
    const double sigma = scale < 1 ? parameters_.sigma_scale / scale : parameters_.sigma_scale;
    // Beyond that radius the weights are below a thousandth.
    const int radius = static_cast<int>(std::ceil(sigma * std::sqrt(2 * 3 * std::log(10.0))));
    cv::GaussianBlur(gray, smoothed_, cv::Size(2 * radius + 1, 2 * radius + 1), sigma, sigma,
                     cv::BORDER_REFLECT_101 | cv::BORDER_ISOLATED);
    cv::resize(smoothed_, scaled_, size, 0, 0,
               style_.exact_scaling ? cv::INTER_LINEAR_EXACT : cv::INTER_LINEAR);
    differentiate(scaled_, field);
  }
  sortSeeds(field);
}

void FieldBuilder::differentiate(const cv::Mat& image, Field* field) {
  field->width = image.cols;
  field->height = image.rows;
  const auto pixels = static_cast<std::size_t>(image.cols) * static_cast<std::size_t>(image.rows);
  field->angles.assign(pixels, kNoAngle);
  field->magnitudes.resize(pixels);
  squares_.assign(pixels, 0);
  // Rounding may turn weaker gradients by more than the tolerance.
  weakest_ = parameters_.quantization / std::sin(parameters_.angle_tolerance * kDegree);
  const auto weakest_square = static_cast<std::int32_t>(
      std::min(std::floor(4 * weakest_ * weakest_), static_cast<double>(kGreatestSquare)));
  greatest_square_ = 0;
  for (int y = 0; y + 1 < image.rows; ++y) {
    const std::uint8_t* here = image.ptr<std::uint8_t>(y);
    const std::uint8_t* below = image.ptr<std::uint8_t>(y + 1);
    const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(image.cols);
    std::int32_t* squares = squares_.data() + row;
    std::int32_t greatest = 0;
    for (int x = 0; x + 1 < image.cols; ++x) {
      const auto falling = static_cast<std::int16_t>(below[x + 1] - here[x]);
      const auto rising = static_cast<std::int16_t>(here[x + 1] - below[x]);
      // (a + b)^2 + (a - b)^2
      squares[x] = 2 * (falling * falling + rising * rising);
      greatest = std::max(greatest, squares[x]);
    }
    greatest_square_ = std::max(greatest_square_, greatest);
    for (int x = 0; x + 1 < image.cols; ++x) {
      if (squares[x] <= weakest_square) {
        continue;
      }
      const int falling = below[x + 1] - here[x];
      const int rising = here[x + 1] - below[x];
      const std::size_t i = row + static_cast<std::size_t>(x);
      field->angles[i] = static_cast<float>(cv::fastAtan2(static_cast<float>(falling + rising),
                                                          static_cast<float>(rising - falling)) *
                                            kDegree);
      field->magnitudes[i] = static_cast<float>(std::sqrt(squares[x] / 4.0));
    }
  }
}

void FieldBuilder::sortSeeds(Field* field) {
  if (style_.order == SeedOrder::kRows) {
    field->seeds.clear();
    for (std::size_t i = 0; i < field->size(); ++i) {
      if (field->angles[i] != kNoAngle) field->seeds.push_back(static_cast<std::int32_t>(i));
    }
    return;
  }
  const double last_bin = parameters_.bins - 1;
  const double steps = greatest_square_ > 0 ? last_bin / std::sqrt(greatest_square_ / 4.0) : 0;
  const auto binOf = [&](double magnitude) {
    return static_cast<std::uint64_t>(last_bin) -
           static_cast<std::uint64_t>(std::min(last_bin, magnitude * steps));
  };
  // Most gradients are weak: roots of those are taken once.
  bins_of_weak_.resize(kWeakSquares);
  for (std::size_t square = 0; square < kWeakSquares; ++square) {
    bins_of_weak_[square] = binOf(std::sqrt(static_cast<double>(square) / 4.0));
  }
  const auto keyOf = [&](std::size_t i) {
    const auto square = static_cast<std::size_t>(squares_[i]);
    const std::uint64_t bin =
        square < kWeakSquares ? bins_of_weak_[square] : binOf(std::sqrt(squares_[i] / 4.0));
    return bin << kBinShift | i;
  };
  if (style_.order == SeedOrder::kIntrosort) {
    keys_.resize(static_cast<std::size_t>(field->width - 1) *
                 static_cast<std::size_t>(field->height - 1));
    auto next = keys_.begin();
    for (int y = 0; y + 1 < field->height; ++y) {
      std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(field->width);
      for (int x = 0; x + 1 < field->width; ++x) *next++ = keyOf(i++);
    }
    sortLikeIntrosort(binOf(weakest_), &keys_);
  } else {
    keys_.clear();
    for (std::size_t i = 0; i < field->size(); ++i) {
      if (field->angles[i] != kNoAngle) keys_.push_back(keyOf(i));
    }
    std::sort(keys_.begin(), keys_.end());
  }
  field->seeds.clear();
  for (const std::uint64_t key : keys_) {
    const std::uint64_t pixel = key & kPixelMask;
    if (field->angles[pixel] != kNoAngle) {
      field->seeds.push_back(static_cast<std::int32_t>(pixel));
    }
  }
}

}  // namespace evolin::lsd
