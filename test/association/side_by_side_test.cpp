// What is summed up side by side in vector registers against the same done one by one, and on one
// kind of processor against another.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>
#include <numeric>
#include <opencv2/core.hpp>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

#include "evolin_ros/association/descriptor_matching.h"
#include "src/association/distance_estimates.h"
#include "src/association/lbd_gradient.h"
#include "src/association/lbd_rows.h"
#include "test/support/random_lines.h"

namespace evolin {
namespace {

bool hasWide() { return cv::checkHardwareSupport(CV_CPU_AVX2); }

bool hasWidest() { return cv::checkHardwareSupport(CV_CPU_AVX512_SKX); }

TEST(LbdRows, AreTheSameToTheLastBitOnEveryProcessor) {
  if (!hasWide()) {
    GTEST_SKIP() << "this processor has no AVX2";
  }
  constexpr int kSize = 300;
  test::RandomLines random(1);
  std::vector<std::int32_t> pixels(kSize * kSize);
  for (std::int32_t& pixel : pixels) {
    pixel = static_cast<std::int32_t>(random.uniform(-1000, 1000)) * 65536 +
            (static_cast<std::int32_t>(random.uniform(-1000, 1000)) & 0xFFFF);
  }
  const LbdGradientView gradient = {pixels.data(), kSize, kSize};
  for (const bool clamped : {false, true}) {
    for (int i = 0; i < 100; ++i) {
      const auto angle = static_cast<float>(random.uniform(-3.2, 3.2));
      const double far = clamped ? 200 : 20;
      // Up to 199 samples, of which places are found 64 at a time.
      const LbdSupport support = {
          clamped ? 1 + 2 * i : 1 + i / 2, static_cast<float>(150 + random.uniform(-far, far)),
          static_cast<float>(150 + random.uniform(-far, far)), std::cos(angle), std::sin(angle)};
      LbdRowSums of_generic;
      LbdRowSums of_wide;
      // Not clamped, a support must lie inside: 64 rows or 50 samples and 20 pixels do.
      generic::sumLbdRows(gradient, support, clamped || i % 2 == 0, &of_generic);
      wide::sumLbdRows(gradient, support, clamped || i % 2 == 0, &of_wide);
      EXPECT_EQ(std::memcmp(&of_generic, &of_wide, sizeof(LbdRowSums)), 0) << i << ", " << clamped;
      if (hasWidest()) {
        LbdRowSums of_widest;
        widest::sumLbdRows(gradient, support, clamped || i % 2 == 0, &of_widest);
        EXPECT_EQ(std::memcmp(&of_generic, &of_widest, sizeof(LbdRowSums)), 0)
            << i << ", " << clamped;
      }
    }
  }
}

// One row after the other and one sample after the other, as the header says.
TEST(LbdRows, AreWhatAWalkAlongEachRowSums) {
  constexpr int kSize = 200;
  test::RandomLines random(5);
  std::vector<std::int32_t> pixels(kSize * kSize);
  for (std::int32_t& pixel : pixels) {
    pixel = static_cast<std::int32_t>(random.uniform(-1000, 1000)) * 65536 +
            (static_cast<std::int32_t>(random.uniform(-1000, 1000)) & 0xFFFF);
  }
  // Along x, so that positions are whole numbers and derivatives are the sums' own components.
  const LbdSupport support = {150, 20, 60, 1, 0};
  LbdRowSums sums;
  sumLbdRows({pixels.data(), kSize, kSize}, support, false, &sums);
  for (int lane = 0; lane < kLbdLanes; ++lane) {
    float expected[kLbdSums] = {};
    for (int k = 0; k < support.samples; ++k) {
      const std::int32_t word = pixels[static_cast<std::size_t>((60 + lane) * kSize + 20 + k)];
      const auto dx = static_cast<float>(static_cast<std::int16_t>(word & 0xFFFF));
      const auto dy = static_cast<float>(word >> 16);
      expected[dx > 0 ? 0 : 1] += std::abs(dx);
      expected[dy > 0 ? 2 : 3] += std::abs(dy);
    }
    for (int s = 0; s < kLbdSums; ++s) {
      EXPECT_EQ(sums.values[s][lane], expected[s]) << lane << ", " << s;
    }
  }
}

cv::Mat noise(int width, int height, int seed) {
  cv::Mat image(height, width, CV_8UC1);
  cv::RNG(seed).fill(image, cv::RNG::UNIFORM, 0, 256);
  if (seed % 3 == 1) {
    image = image > 127;  // the extremes alone
  }
  return image;
}

std::vector<std::int32_t> gradientOf(decltype(&generic::computeLbdGradient) compute,
                                     const cv::Mat& image) {
  std::vector<std::uint16_t> scratch(lbdGradientScratch(image.cols));
  std::vector<std::int32_t> gradient(image.total());
  compute({image.data, image.step, image.cols, image.rows}, kLbdGaussian, scratch.data(),
          gradient.data());
  return gradient;
}

// Weights in whole numbers, of which the two-dimensional sum is exact.
int smoothAt(const cv::Mat& image, int x, int y) {
  constexpr int kWeights[] = {14, 62, 104, 62, 14};
  int sum = 0;
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 5; ++j) {
      const int row = std::clamp(y + i - 2, 0, image.rows - 1);
      const int column = std::clamp(x + j - 2, 0, image.cols - 1);
      sum += kWeights[i] * kWeights[j] * image.at<std::uint8_t>(row, column);
    }
  }
  return (sum + 32768) / 65536;
}

TEST(LbdGradient, IsSobelOfTheSmoothedImageOnEveryProcessor) {
  for (int i = 0; i < 60; ++i) {
    const int width = i < 12 ? 1 + i : 20 + 3 * i;
    const int height = i < 24 ? 1 + i / 2 : 15 + i;
    const cv::Mat wider = noise(width + 5, height + 3, i);
    const cv::Mat image = wider(cv::Rect(2, 1, width, height));  // nothing around it is seen
    const std::vector<std::int32_t> gradient = gradientOf(&generic::computeLbdGradient, image);
    if (hasWide()) {
      EXPECT_EQ(gradient, gradientOf(&wide::computeLbdGradient, image)) << i;
    }
    cv::Mat smooth(height, width, CV_8UC1);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        smooth.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(smoothAt(image, x, y));
      }
    }
    cv::Mat dx;
    cv::Mat dy;
    cv::Sobel(smooth, dx, CV_16S, 1, 0, 3, 1, 0, cv::BORDER_REPLICATE);
    cv::Sobel(smooth, dy, CV_16S, 0, 1, 3, 1, 0, cv::BORDER_REPLICATE);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const std::int32_t word = gradient[static_cast<std::size_t>(y * width + x)];
        ASSERT_EQ(static_cast<std::int16_t>(word & 0xFFFF), dx.at<std::int16_t>(y, x)) << i;
        ASSERT_EQ(word >> 16, dy.at<std::int16_t>(y, x)) << i;
      }
    }
    // OpenCV's versions round the Gaussian's weights differently.
    cv::Mat of_opencv;
    cv::GaussianBlur(image.clone(), of_opencv, cv::Size(5, 5), 1, 1, cv::BORDER_REPLICATE);
    EXPECT_LE(cv::norm(smooth, of_opencv, cv::NORM_INF), 2) << i;
  }
}

class DistanceEstimates : public ::testing::TestWithParam<bool> {
 protected:
  void SetUp() override {
    if (GetParam() && !(hasWide() && cv::checkHardwareSupport(CV_CPU_FMA3))) {
      GTEST_SKIP() << "this processor has no AVX2 and FMA";
    }
    functions_ = GetParam() ? wide::estimateFunctions() : generic::estimateFunctions();
  }

  EstimateFunctions functions_{};
};

TEST_P(DistanceEstimates, AreNearTheDistances) {
  constexpr std::size_t kValues = 72;
  constexpr std::size_t kRows = 8;
  constexpr std::size_t kCount = 3 * kEstimateColumns;
  test::RandomLines random(2);
  std::vector<float> values(kRows * kValues);
  std::vector<float> columns(kCount * kValues);
  for (std::vector<float>* all : {&values, &columns}) {
    for (float& value : *all) {
      value = static_cast<float>(random.uniform(-1, 1));
    }
  }
  const auto inColumn = [&](std::size_t j, std::size_t d) {
    return columns[(j / kEstimateColumns * kValues + d) * kEstimateColumns + j % kEstimateColumns];
  };
  std::vector<float> squares(kCount);
  for (std::size_t j = 0; j < kCount; ++j) {
    for (std::size_t d = 0; d < kValues; ++d) {
      squares[j] += inColumn(j, d) * inColumn(j, d);
    }
  }
  squares.back() = std::numeric_limits<float>::quiet_NaN();
  std::vector<EstimateRow> rows;
  for (std::size_t i = 0; i < kRows; ++i) {
    const float* const row = values.data() + i * kValues;
    rows.push_back({row, std::inner_product(row, row + kValues, row, 0.0F)});
  }
  for (std::size_t count = 1; count <= kRows; ++count) {
    std::vector<float> estimates(count * kCount);
    functions_.estimate(rows.data(), count, {columns.data(), squares.data(), kValues, kCount},
                        estimates.data());
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = 0; j + 1 < kCount; ++j) {
        double exact = 0;
        for (std::size_t d = 0; d < kValues; ++d) {
          const double difference =
              static_cast<double>(rows[i].values[d]) - static_cast<double>(inColumn(j, d));
          exact += difference * difference;
        }
        EXPECT_NEAR(estimates[i * kCount + j], exact, 1e-5 * (rows[i].squares + squares[j]));
      }
      EXPECT_TRUE(std::isnan(estimates[(i + 1) * kCount - 1]));
    }
  }
}

TEST_P(DistanceEstimates, GiveLowestOnesAndCandidates) {
  constexpr std::size_t kCount = 2 * kEstimateColumns;
  constexpr float kInfinite = std::numeric_limits<float>::infinity();
  test::RandomLines random(6);
  for (int round = 0; round < 200; ++round) {
    std::vector<float> estimates(kCount);
    std::vector<float> limits(kCount);
    std::vector<std::uint32_t> expected;
    float lowest = kInfinite;
    std::vector<float> lowered(kCount);
    for (std::size_t j = 0; j < kCount; ++j) {
      const double kind = random.uniform(0, 1);
      estimates[j] = kind < 0.2 || round == 0 ? std::numeric_limits<float>::quiet_NaN()
                                              : static_cast<float>(random.uniform(-1, 9));
      limits[j] = kind > 0.9 ? estimates[j] : static_cast<float>(random.uniform(-1, 0));
      lowest = std::min(lowest, std::isnan(estimates[j]) ? kInfinite : estimates[j]);
      lowered[j] = estimates[j] < limits[j] ? estimates[j] : limits[j];
      if (estimates[j] <= 0.5F || estimates[j] <= limits[j]) {
        expected.push_back(static_cast<std::uint32_t>(j));
      }
    }
    std::vector<std::uint32_t> places(kCount);
    places.resize(
        functions_.find_candidates(estimates.data(), kCount, 0.5F, limits.data(), places.data()));
    EXPECT_EQ(places, expected) << round;
    EXPECT_EQ(functions_.take_lowest(estimates.data(), kCount, limits.data()), lowest) << round;
    for (std::size_t j = 0; j < kCount; ++j) {
      EXPECT_TRUE(limits[j] == lowered[j] || std::isnan(lowered[j])) << round;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Processors, DistanceEstimates, ::testing::Bool());

cv::Mat randomDescriptors(int rows, double scale, test::RandomLines* random) {
  cv::Mat descriptors(rows, 12, CV_32F);
  for (int i = 0; i < rows; ++i) {
    for (int d = 0; d < descriptors.cols; ++d) {
      descriptors.at<float>(i, d) = static_cast<float>(scale * random->uniform(0, 1));
    }
  }
  return descriptors;
}

MatchingRules rules(bool cross_check) {
  MatchingRules result;
  result.cross_check = cross_check;
  return result;
}

int nearestRow(const cv::Mat& of, int row, const cv::Mat& among) {
  int nearest = -1;
  double smallest = std::numeric_limits<double>::infinity();
  for (int j = 0; j < among.rows; ++j) {
    double sum = 0;
    for (int d = 0; d < of.cols; ++d) {
      const double difference =
          static_cast<double>(of.at<float>(row, d)) - static_cast<double>(among.at<float>(j, d));
      sum += difference * difference;
    }
    if (sum < smallest) {
      smallest = sum;
      nearest = j;
    }
  }
  return nearest;
}

TEST(DescriptorMatching, EqualsAnExhaustiveSearchAlsoWhereSinglePrecisionCannotTell) {
  test::RandomLines random(3);
  // Squares vanish or overflow in single precision at the ends.
  for (const double scale : {1e-30, 1e-6, 1.0, 1e6, 1e30}) {
    const cv::Mat first = randomDescriptors(60, scale, &random);
    cv::Mat second = randomDescriptors(70, scale, &random);
    for (int j = 0; j < 30; ++j) {
      // Twins, some of them a last bit apart.
      first.row(j).copyTo(second.row(2 * j));
      first.row(j).copyTo(second.row(2 * j + 1));
      float& value = second.at<float>(2 * j + j % 2, j % 12);
      value = std::nextafter(value, j % 3 == 0 ? 1e38F : 0.0F);
    }
    for (const bool cross_check : {false, true}) {
      LineMatches expected;
      for (int i = 0; i < first.rows; ++i) {
        const int j = nearestRow(first, i, second);
        if (!cross_check || nearestRow(second, j, first) == i) {
          expected.push_back({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j), 0});
        }
      }
      const LineMatches matches = matchDescriptors(first, second, rules(cross_check));
      ASSERT_EQ(matches.size(), expected.size()) << scale;
      for (std::size_t k = 0; k < matches.size(); ++k) {
        EXPECT_EQ(matches[k].first, expected[k].first) << scale;
        EXPECT_EQ(matches[k].second, expected[k].second) << scale;
      }
    }
  }
}

// Row i's distances to all rows that it may match, in their order.
std::vector<std::pair<double, int>> ranked(const cv::Mat& of, int row, const cv::Mat& among,
                                           const std::function<bool(int)>& may) {
  std::vector<std::pair<double, int>> distances;
  for (int j = 0; j < among.rows; ++j) {
    if (may(j)) {
      distances.emplace_back(cv::norm(of.row(row), among.row(j)), j);
    }
  }
  std::sort(distances.begin(), distances.end());
  return distances;
}

bool standsOut(const std::vector<std::pair<double, int>>& ranked, double ratio) {
  return ranked.size() < 2 || ranked[0].first < ratio * ranked[1].first;
}

TEST(DescriptorMatching, EqualsAnExhaustiveSearchWithRatioAndLimits) {
  test::RandomLines random(4);
  const auto may = [](int i, int j) { return (7 * i + 3 * j) % 5 != 1; };
  std::size_t found = 0;
  for (int round = 0; round < 20; ++round) {
    const cv::Mat first = randomDescriptors(40, 1, &random);
    cv::Mat second = randomDescriptors(50, 1, &random);
    for (int j = 0; j < 25; ++j) {
      second.row(j) = first.row(j) + 0.2 * second.row(j);
    }
    for (const bool cross_check : {false, true}) {
      MatchingRules chosen = rules(cross_check);
      chosen.max_ratio = 0.8;
      chosen.max_distance = 0.6;
      chosen.may_match = [&](std::size_t i, std::size_t j) {
        return may(static_cast<int>(i), static_cast<int>(j));
      };
      IndexPairs expected;
      for (int i = 0; i < first.rows; ++i) {
        const auto there = ranked(first, i, second, [&](int j) { return may(i, j); });
        if (there.empty() || there[0].first > 0.6 || !standsOut(there, 0.8)) {
          continue;
        }
        const int j = there[0].second;
        const auto back = ranked(second, j, first, [&](int k) { return may(k, j); });
        if (!cross_check || (back[0].second == i && standsOut(back, 0.8))) {
          expected.emplace_back(i, j);
        }
      }
      IndexPairs pairs;
      for (const LineMatch& match : matchDescriptors(first, second, chosen)) {
        pairs.emplace_back(match.first, match.second);
      }
      EXPECT_EQ(pairs, expected) << "round " << round;
      found += pairs.size();
    }
  }
  EXPECT_GT(found, 200U);
}

}  // namespace
}  // namespace evolin
