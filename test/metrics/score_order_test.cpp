// Order by falling score against a stable sort.
#include "src/metrics/score_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <vector>

#include "test/support/random_lines.h"

namespace evolin {
namespace {

std::vector<std::uint32_t> sortedPlaces(const std::vector<double>& scores) {
  std::vector<std::uint32_t> places(scores.size());
  std::iota(places.begin(), places.end(), 0U);
  std::stable_sort(places.begin(), places.end(),
                   [&scores](std::uint32_t a, std::uint32_t b) { return scores[a] > scores[b]; });
  return places;
}

/// Few are ordered in another way than many.
constexpr std::size_t kCounts[] = {0, 1, 2, 100, 5000};

TEST(ScoreOrder, IsThatOfAStableSort) {
  test::RandomLines random(4);
  for (const std::size_t count : kCounts) {
    std::vector<double> any;
    std::vector<double> often_equal;
    std::vector<double> far_apart;
    for (std::size_t i = 0; i < count; ++i) {
      any.push_back(random.uniform(-1, 1));
      often_equal.push_back(static_cast<double>(random.index(7)) / 4);
      far_apart.push_back(random.uniform(-1, 1) * (i % 2 == 0 ? 1e-300 : 1e300));
    }
    EXPECT_EQ(placesByFallingScore(any), sortedPlaces(any)) << count;
    EXPECT_EQ(placesByFallingScore(often_equal), sortedPlaces(often_equal)) << count;
    EXPECT_EQ(placesByFallingScore(far_apart), sortedPlaces(far_apart)) << count;
  }
}

TEST(ScoreOrder, TakesBothZerosAsEqualAndInfiniteOnesAsTheEnds) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const double values[] = {-0.0, 0.0, 1, kInfinity, -kInfinity, -1, 0.0, -0.0, 5e-324, -5e-324};
  for (const std::size_t count : kCounts) {
    std::vector<double> scores;
    for (std::size_t i = 0; i < count; ++i) {
      scores.push_back(values[i % 10]);
    }
    EXPECT_EQ(placesByFallingScore(scores), sortedPlaces(scores)) << count;
  }
}

}  // namespace
}  // namespace evolin
