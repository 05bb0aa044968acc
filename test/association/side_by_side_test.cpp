// What is summed up side by side in vector registers against the same done one by one, and on one
// kind of processor against another.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/core/utility.hpp>
#include <utility>
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
    if (estimate == &wide::estimateDistances &&
        !(hasWide() && cv::checkHardwareSupport(CV_CPU_FMA3))) {
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
