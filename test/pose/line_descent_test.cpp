// The sums over many matched lines against the formulas for one, and what is told of a descent's
// end ahead of it.
#include "src/pose/line_descent.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <opencv2/core/utility.hpp>
#include <vector>

#include "src/pose/line_residual.h"
#include "test/pose/line_scene.h"

namespace evolin {
namespace {

Camera makeCamera() {
  Camera camera;
  camera.fx = 481.2;
  camera.fy = -480;
  camera.cx = 319.5;
  camera.cy = 239.5;
  return camera;
}

const Camera kCamera = makeCamera();

SpatialMatches drawnMatches(std::size_t count, double noise, double wrong,
                            test::RandomLines* random) {
  const auto part = [random](double most) { return random->uniform(-most, most); };
  const Pose motion =
      test::motionOf({part(0.03), part(0.03), part(0.03)}, {part(0.1), part(0.1), part(0.1)});
  SpatialMatches matches = test::observe(test::randomSegments(count, random), motion, kCamera);
  test::addNoise(noise, kCamera, random, &matches);
  test::makeWrong(wrong, random, &matches);
  return matches;
}

LineTable tableOf(const SpatialMatches& matches) {
  LineTable table(matches.size());
  for (const SpatialMatch& match : matches) {
    table.add(match.second.point1, match.second.point2, imageLine(match.first, false), kCamera,
              match.match);
  }
  return table;
}

constexpr LineMotion kShift = {{1, 0, 0, 0, 1, 0, 0, 0, 1}, {0.01, -0.02, 0.03}};

LineSums sumsOf(const SpatialMatches& matches, double delta) {
  LineTable table = tableOf(matches);
  LineSums sums;
  lineSums(table.view(), kShift, delta, &sums);
  return sums;
}

TEST(LineSums, AreThoseOfTheObservationsOneByOne) {
  test::RandomLines random(1);
  for (const std::size_t count : {1U, 2U, 3U, 4U, 5U, 130U}) {
    const SpatialMatches matches = drawnMatches(count, 1, 0.2, &random);
    for (const double delta : {1.0, 300.0, 1e100}) {
      Matrix6d hessian = Matrix6d::Zero();
      Vector6d right_side = Vector6d::Zero();
      double cost = 0;
      for (const SpatialMatch& match : matches) {
        const Eigen::Vector3d line = imageLine(match.first, false);
        for (const Eigen::Vector3d& point : {match.second.point1, match.second.point2}) {
          const Eigen::Vector3d moved =
              point +
              Eigen::Vector3d(kShift.translation[0], kShift.translation[1], kShift.translation[2]);
          const double residual = lineResidual(line, kCamera, moved);
          const Vector6d jacobian =
              lineResidualJacobian(moved, lineResidualGradient(line, kCamera, moved)).transpose();
          const double size = std::abs(residual);
          const double weight = size > delta ? delta / size : 1;
          hessian += weight * jacobian * jacobian.transpose();
          right_side -= weight * residual * jacobian;
          cost += size > delta ? delta * (2 * size - delta) : residual * residual;
        }
      }
      const LineSums sums = sumsOf(matches, delta);
      EXPECT_NEAR(sums.cost, cost, 1e-9 * cost) << count << ", " << delta;
      int next = 0;
      for (int row = 0; row < 6; ++row) {
        EXPECT_NEAR(sums.right_side[row], right_side[row], 1e-9 * right_side.norm());
        for (int column = row; column < 6; ++column) {
          EXPECT_NEAR(sums.hessian[next++], hessian(row, column), 1e-9 * hessian.norm());
        }
      }
    }
  }
}

using Loops = void (*)(const LineTableView&, const LineMotion&, double, LineSums*);

void expectSameBits(Loops loops) {
  test::RandomLines random(2);
  for (const std::size_t count : {1U, 7U, 150U, 300U}) {
    for (const double delta : {1.0, 1e100}) {
      LineTable table = tableOf(drawnMatches(count, 1, 0.2, &random));
      LineTable same = table;
      LineSums of_generic;
      LineSums others;
      generic::lineSums(table.view(), kShift, delta, &of_generic);
      loops(same.view(), kShift, delta, &others);
      EXPECT_EQ(std::memcmp(&of_generic, &others, sizeof(LineSums)), 0) << count;
      for (std::size_t row = 0; row < count; ++row) {
        EXPECT_EQ(table.meanSquare(row), same.meanSquare(row)) << count << ", " << row;
      }
    }
  }
}

TEST(LineSums, AreTheSameToTheLastBitWithAvx2) {
  if (!cv::checkHardwareSupport(CV_CPU_AVX2)) {
    GTEST_SKIP() << "this processor has no AVX2";
  }
  expectSameBits(&wide::lineSums);
}

TEST(LineSums, AreTheSameToTheLastBitWithAvx512) {
  if (!cv::checkHardwareSupport(CV_CPU_AVX512_SKX)) {
    GTEST_SKIP() << "this processor has no AVX-512";
  }
  expectSameBits(&widest::lineSums);
}

TEST(LineTable, KeepsOrderAndPlacesOfWhatItKeeps) {
  test::RandomLines random(3);
  LineTable table = tableOf(drawnMatches(37, 2, 0.3, &random));
  LineSums sums;
  lineSums(table.view(), kShift, 1, &sums);
  std::vector<double> squares;
  for (std::size_t row = 0; row < table.size(); ++row) {
    squares.push_back(table.meanSquare(row));
  }
  std::vector<double> sorted = squares;
  std::sort(sorted.begin(), sorted.end());
  const double gate = sorted[20];
  EXPECT_EQ(table.countWithin(gate), 21U);
  table.removeAbove(gate);
  ASSERT_EQ(table.size(), 21U);
  for (std::size_t row = 0; row < table.size(); ++row) {
    EXPECT_EQ(table.meanSquare(row), squares[table.places()[row]]);
    EXPECT_TRUE(row == 0 || table.places()[row - 1] < table.places()[row]);
  }
}

TEST(LineDescent, EndsWhereItWasSaidToBeSettled) {
  test::RandomLines random(4);
  const EvolinPoseOptions options;
  int early = 0;
  for (int scene = 0; scene < 150; ++scene) {
    const SpatialMatches matches = drawnMatches(30 + scene, 0.5 * (scene % 4), 0.1, &random);
    for (const double gate : {20000.0, 800.0, 100.0, 10.0}) {
      LineTable table = tableOf(matches);
      LineDescent descent(options, &table);
      descent.start(true);
      while (!descent.finished() && !descent.isSettled(gate)) {
        descent.step();
      }
      LineTable at_once = table;
      at_once.removeAbove(gate);
      early += descent.finished() ? 0 : 1;
      while (!descent.finished()) {
        descent.step();
      }
      table.removeAbove(gate);
      EXPECT_EQ(at_once.places(), table.places()) << "scene " << scene << ", gate " << gate;
    }
  }
  EXPECT_GT(early, 100);
}

}  // namespace
}  // namespace evolin
