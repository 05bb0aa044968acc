// What is summed up side by side in vector registers against the same done one by one, and on one
// kind of processor against another.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/core/utility.hpp>
#include <vector>

#include "evolin_ros/association/descriptor_matching.h"
#include "src/association/distance_estimates.h"
#include "src/association/lbd_rows.h"
#include "test/support/random_lines.h"

namespace evolin {
namespace {

bool hasWide() { return cv::checkHardwareSupport(CV_CPU_AVX2); }

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
      const LbdSupport support = {1 + i / 2, static_cast<float>(150 + random.uniform(-far, far)),
                                  static_cast<float>(150 + random.uniform(-far, far)),
                                  std::cos(angle), std::sin(angle)};
      LbdRowSums of_generic;
      LbdRowSums of_wide;
      // Not clamped, a support must lie inside: 64 rows or 50 samples and 20 pixels do.
      generic::sumLbdRows(gradient, support, clamped || i % 2 == 0, &of_generic);
      wide::sumLbdRows(gradient, support, clamped || i % 2 == 0, &of_wide);
      EXPECT_EQ(std::memcmp(&of_generic, &of_wide, sizeof(LbdRowSums)), 0) << i << ", " << clamped;
    }
  }
}

TEST(DistanceEstimates, AreNearTheDistances) {
  constexpr std::size_t kValues = 72;
  constexpr std::size_t kCount = 2 * kEstimateColumns;
  test::RandomLines random(2);
  std::vector<float> row(kValues);
  std::vector<float> columns(kValues * kCount);
  for (std::vector<float>* values : {&row, &columns}) {
    for (float& value : *values) {
      value = static_cast<float>(random.uniform(-1, 1));
    }
  }
  for (const auto estimate : {&generic::estimateDistances, &wide::estimateDistances}) {
    if (estimate == &wide::estimateDistances && !hasWide()) {
      continue;
    }
    std::vector<float> estimates(kCount);
    estimate(row.data(), columns.data(), kValues, kCount, estimates.data());
    for (std::size_t j = 0; j < kCount; ++j) {
      double exact = 0;
      for (std::size_t d = 0; d < kValues; ++d) {
        const double difference = static_cast<double>(row[d]) - columns[d * kCount + j];
        exact += difference * difference;
      }
      EXPECT_NEAR(estimates[j], exact, 1e-5 * exact) << j;
    }
  }
}

cv::Mat randomDescriptors(int rows, double scale, test::RandomLines* random) {
  cv::Mat descriptors(rows, 12, CV_32F);
  for (int i = 0; i < rows; ++i) {
    for (int d = 0; d < descriptors.cols; ++d) {
      descriptors.at<float>(i, d) = static_cast<float>(scale * random->uniform(0, 1));
    }
  }
  return descriptors;
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
      const LineMatches matches = matchDescriptors(first, second, cross_check);
      ASSERT_EQ(matches.size(), expected.size()) << scale;
      for (std::size_t k = 0; k < matches.size(); ++k) {
        EXPECT_EQ(matches[k].first, expected[k].first) << scale;
        EXPECT_EQ(matches[k].second, expected[k].second) << scale;
      }
    }
  }
}

}  // namespace
}  // namespace evolin
