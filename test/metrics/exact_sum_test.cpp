// The sum that does not depend on the order.
#include "evolin_ros/metrics/exact_sum.h"

#include <gtest/gtest.h>

#include <vector>

#include "test/support/random_lines.h"

namespace evolin {
namespace {

TEST(ExactSum, AddsWhatPlainSumsLose) {
  ExactSum sum;
  sum.add(1e15);
  for (int i = 0; i < 1024; ++i) {
    sum.add(1.0 / 1024 / 1024);
  }
  EXPECT_EQ(sum.value(), 1e15 + 1.0 / 1024);
}

TEST(ExactSum, CarriesFromTheFraction) {
  ExactSum sum;
  sum.add(0.75);
  sum.add(0.75);
  EXPECT_EQ(sum.value(), 1.5);
  sum += sum;
  EXPECT_EQ(sum.value(), 3);
  ExactSum half;
  half.add(0.5);
  half += half;
  EXPECT_EQ(half.value(), 1);
}

TEST(ExactSum, IsTheSameInEveryOrderAndGrouping) {
  test::RandomLines random(5);
  std::vector<double> values(1000);
  for (double& value : values) {
    value = random.uniform(0, 1) / (1 + static_cast<double>(random.index(1000)));
  }
  ExactSum forward;
  double plain = 0;
  for (const double value : values) {
    forward.add(value);
    plain += value;
  }
  random.shuffle(&values);
  ExactSum left;
  ExactSum right;
  for (std::size_t i = 0; i < values.size(); ++i) {
    (i < 300 ? left : right).add(values[i]);
  }
  right += left;
  EXPECT_EQ(forward.value(), right.value());
  EXPECT_NEAR(forward.value(), plain, 1e-11);
}

}  // namespace
}  // namespace evolin
