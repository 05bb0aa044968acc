// Segments in space from depth along segments of the image: exact surfaces, occlusion, bleeding,
// noise and holes, and the known edges of the synthetic room.
#include "evolin_ros/geometry/segment_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "evolin_ros/dataset/synthetic/synthetic_sequence.h"
#include "test/support/expect_error.h"
#include "test/support/random_lines.h"

namespace evolin {
namespace {

constexpr int kWidth = 160;
constexpr int kHeight = 120;

Camera camera() {
  Camera result;
  result.width = kWidth;
  result.height = kHeight;
  result.fx = 150;
  result.fy = -150;  // y up, as in ICL-NUIM
  result.cx = 79.5;
  result.cy = 59.5;
  return result;
}

LineSegment line(double x1, double y1, double x2, double y2) {
  LineSegment result;
  result.x1 = x1;
  result.y1 = y1;
  result.x2 = x2;
  result.y2 = y2;
  return result;
}

/// Depth in metres by pixel.
cv::Mat depthOf(const std::function<double(double x, double y)>& metres) {
  cv::Mat depth(kHeight, kWidth, CV_32FC1);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      depth.at<float>(y, x) = static_cast<float>(metres(x, y));
    }
  }
  return depth;
}

/// A plane whose inverse depth is a + b x + c y.
double plane(double a, double b, double c, double x, double y) { return 1 / (a + b * x + c * y); }

void expectEndDepths(const std::optional<SegmentFit>& fit, double first, double second,
                     double tolerance) {
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->segment.p1.z(), first, tolerance);
  EXPECT_NEAR(fit->segment.p2.z(), second, tolerance);
}

TEST(SegmentFit, IsExactOnASlantedPlane) {
  const auto metres = [](double x, double y) { return plane(0.4, 0.001, -0.0008, x, y); };
  const DepthMap depth(depthOf(metres));
  const LineSegment segment = line(20.3, 30.7, 120.4, 80.1);
  const auto fit = fitSegment(camera(), segment, depth);
  expectEndDepths(fit, metres(20.3, 30.7), metres(120.4, 80.1), 1e-5);
  EXPECT_EQ(fit->support, 1);
  EXPECT_LT(fit->rms, 1e-6);
  const Segment3d expected =
      backProject(camera(), segment, {metres(20.3, 30.7), metres(120.4, 80.1)}, false);
  EXPECT_LT((fit->segment.p1 - expected.p1).norm(), 1e-5);
  EXPECT_LT((fit->segment.p2 - expected.p2).norm(), 1e-5);
}

TEST(SegmentFit, FindsTheEdgeOfTwoPlanes) {
  // A ridge and a valley along the column 70: the depth of the edge is not the mean beside it.
  for (const double slope : {-0.006, 0.006}) {
    const auto metres = [slope](double x, double y) {
      return 1 / (0.5 + 0.001 * y + slope * std::abs(x - 70));
    };
    const DepthMap depth(depthOf(metres));
    expectEndDepths(fitSegment(camera(), line(70, 10, 70, 100), depth), metres(70, 10),
                    metres(70, 100), 2e-4);
  }
}

TEST(SegmentFit, TakesTheSurfaceInFront) {
  // A box from column 60 on, a wall behind it; the line lies up to a pixel and a half beside.
  const auto metres = [](double x, double y) {
    return x >= 60 ? plane(0.8, 0.0004, 0.001, x, y) : plane(0.3, 0.0005, 0, x, y);
  };
  const DepthMap depth(depthOf(metres));
  for (const double offset : {-1.5, -0.5, 0.0, 0.5, 1.5}) {
    const double x = 59.5 + offset;
    const auto fit = fitSegment(camera(), line(x, 15, x, 105), depth);
    expectEndDepths(fit, plane(0.8, 0.0004, 0.001, x, 15), plane(0.8, 0.0004, 0.001, x, 105), 2e-3);
  }
}

TEST(SegmentFit, TakesAThinRodInFront) {
  const auto metres = [](double x, double) { return x == 80 || x == 81 ? 1.5 : 3.0; };
  const DepthMap depth(depthOf(metres));
  expectEndDepths(fitSegment(camera(), line(79.6, 20, 79.6, 100), depth), 1.5, 1.5, 1e-6);
}

TEST(SegmentFit, IgnoresAnOccluderInTheWay) {
  const auto metres = [](double x, double y) { return y > 40 && y < 60 ? 1.0 : 2 + 0.002 * x; };
  const DepthMap depth(depthOf(metres));
  const auto fit = fitSegment(camera(), line(70, 10, 70, 110), depth);
  expectEndDepths(fit, 2.14, 2.14, 1e-4);
  EXPECT_NEAR(fit->support, 0.8, 0.05);
}

TEST(SegmentFit, EndsTooFewDepths) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(fitSegment(camera(), line(10, 10, 100, 80),
                          DepthMap(cv::Mat(kHeight, kWidth, CV_32FC1, cv::Scalar(nan)))));
  // Two thirds of the way without depth.
  const auto metres = [](double x, double) { return x < 55 ? 2.0 : 0.0; };
  EXPECT_FALSE(fitSegment(camera(), line(10, 60, 145, 60), DepthMap(depthOf(metres))));
  SegmentFitOptions lenient;
  lenient.min_support = 0.3;
  expectEndDepths(fitSegment(camera(), line(10, 60, 145, 60), DepthMap(depthOf(metres)), lenient),
                  2, 2, 1e-6);
  const DepthMap flat(cv::Mat(kHeight, kWidth, CV_32FC1, cv::Scalar(2)));
  EXPECT_FALSE(fitSegment(camera(), line(10, -20, 100, -5), flat)) << "outside";
  EXPECT_FALSE(fitSegment(camera(), line(10, 10, 10.4, 10.2), flat)) << "shorter than a pixel";
  EXPECT_TRUE(fitSegment(camera(), line(10, 10, 13, 11), flat));
}

TEST(SegmentFit, HoldsInNoiseAndHoles) {
  test::RandomLines random(5);
  double worst = 0;
  for (int trial = 0; trial < 50; ++trial) {
    cv::Mat depth = depthOf([&](double x, double y) {
      const double share = random.uniform(0, 1);
      const double noise = 0.005 * (random.uniform(-1, 1) + random.uniform(-1, 1));
      if (share < 0.2) return 0.0;                     // a hole
      if (share < 0.3) return random.uniform(0.5, 8);  // anything
      return (1 + noise) * (x >= 60 ? 1.5 : 3.0) + 0 * y;
    });
    const auto fit = fitSegment(camera(), line(60, 15, 60, 105), DepthMap(depth));
    ASSERT_TRUE(fit);
    worst =
        std::max({worst, std::abs(fit->segment.p1.z() - 1.5), std::abs(fit->segment.p2.z() - 1.5)});
  }
  EXPECT_LT(worst, 0.02) << "1.3 % of the depth, noise of single pixels is 0.4 %";
}

TEST(SegmentFit, GivesTheSameTwice) {
  test::RandomLines random(6);
  const DepthMap depth(depthOf([&](double, double) { return random.uniform(1.9, 2.1); }));
  const LineSegment segment = line(12, 100, 140, 9);
  SegmentFitOptions coarse;
  coarse.tolerance = 0.1;
  const auto a = fitSegment(camera(), segment, depth, coarse);
  const auto b = fitSegment(camera(), segment, depth, coarse);
  ASSERT_TRUE(a);
  ASSERT_TRUE(b);
  EXPECT_EQ(a->segment.p1, b->segment.p1);
  EXPECT_EQ(a->segment.p2, b->segment.p2);
}

TEST(SegmentFit, RefusesWhatCannotBe) {
  const DepthMap flat(cv::Mat(kHeight, kWidth, CV_32FC1, cv::Scalar(2)));
  test::expectError([&] { fitSegment(camera(), line(0, 0, NAN, 5), flat); }, {"not finite"});
  Camera uncalibrated = camera();
  uncalibrated.fx = 0;
  test::expectError([&] { fitSegment(uncalibrated, line(0, 0, 5, 5), flat); }, {"focal length"});
  SegmentFitOptions options;
  validate(options);
  options.tolerance = 0;
  test::expectError([&] { validate(options); }, {"tolerance is 0", "0.5"});
  options = {};
  options.min_support = 1.5;
  test::expectError([&] { validate(options); }, {"min_support is 1.5"});
}

/// How far the ends of lifted lines are from the edges that they show, as shares of the depth.
struct Errors {
  std::vector<double> shares;
  std::size_t missing = 0;

  double quantile(double q) {
    std::sort(shares.begin(), shares.end());
    return shares.at(static_cast<std::size_t>(q * static_cast<double>(shares.size() - 1)));
  }
};

void addError(const std::optional<Segment3d>& found, const Segment3d& edge, Errors* errors) {
  if (!found) {
    ++errors->missing;
    return;
  }
  const Eigen::Vector3d direction = (edge.p2 - edge.p1).normalized();
  for (const Eigen::Vector3d& point : {found->p1, found->p2}) {
    const Eigen::Vector3d offset = point - edge.p1;
    errors->shares.push_back((offset - offset.dot(direction) * direction).norm() / point.z());
  }
}

/// Depth of the farther surface spreads a pixel over every edge, and there is noise.
cv::Mat bleeding(const cv::Mat& exact, std::uint64_t seed) {
  cv::Mat depth;
  cv::dilate(exact, depth, cv::getStructuringElement(cv::MORPH_RECT, {3, 3}));
  test::RandomLines random(seed);
  depth.forEach<float>([](float& value, const int*) { value = std::isnan(value) ? 0 : value; });
  for (int y = 0; y < depth.rows; ++y) {
    for (int x = 0; x < depth.cols; ++x) {
      float& value = depth.at<float>(y, x);
      value *= static_cast<float>(1 + 0.003 * (random.uniform(-1, 1) + random.uniform(-1, 1)));
    }
  }
  return depth;
}

TEST(SegmentFit, FindsTheKnownEdgesOfTheSyntheticRoom) {
  const synthetic::SyntheticSequence sequence({});
  for (const bool bleeds : {false, true}) {
    Errors fitted;
    Errors by_endpoints;
    for (const std::size_t number : {0, 30, 60}) {
      const SequenceFrame frame = sequence.frame(number);
      const DepthMap depth(bleeds ? bleeding(frame.frame.depth, number) : frame.frame.depth);
      const Pose pose = sequence.pose(number);
      const Eigen::Matrix3d to_camera = pose.rotation.toRotationMatrix().transpose();
      for (const LineSegment& truth : frame.ground_truth.value()) {
        if (truth.length() < 20) {
          continue;
        }
        const synthetic::Edge& edge = sequence.scene().edges[sequence.edgeOf(truth.id)];
        const Segment3d expected{to_camera * (edge.from - pose.translation),
                                 to_camera * (edge.to - pose.translation)};
        const auto fit = fitSegment(sequence.camera(), truth, depth);
        addError(fit ? std::optional<Segment3d>(fit->segment) : std::nullopt, expected, &fitted);
        const cv::Point first = nearestPixel(truth.x1, truth.y1, depth.size());
        const cv::Point second = nearestPixel(truth.x2, truth.y2, depth.size());
        const EndpointDepths ends{depth.at(first.x, first.y), depth.at(second.x, second.y)};
        addError(ends.areKnown()
                     ? std::optional<Segment3d>(backProject(sequence.camera(), truth, ends, false))
                     : std::nullopt,
                 expected, &by_endpoints);
      }
    }
    const std::string kind = bleeds ? "bleeding" : "exact";
    RecordProperty(kind + "_fitted_median", std::to_string(fitted.quantile(0.5)));
    RecordProperty(kind + "_fitted_90_percent", std::to_string(fitted.quantile(0.9)));
    RecordProperty(kind + "_endpoints_median", std::to_string(by_endpoints.quantile(0.5)));
    RecordProperty(kind + "_endpoints_90_percent", std::to_string(by_endpoints.quantile(0.9)));
    EXPECT_LT(fitted.quantile(0.5), bleeds ? 5e-3 : 5e-4) << kind;
    EXPECT_LT(fitted.quantile(0.9), bleeds ? 0.02 : 0.006) << kind;
    EXPECT_LT(8 * fitted.quantile(0.9), by_endpoints.quantile(0.9))
        << kind << ": single pixels fall on what is behind the edge";
    EXPECT_GT(fitted.shares.size(), 300U) << kind;
    EXPECT_LT(fitted.missing, fitted.shares.size() / 20) << kind;
  }
}

}  // namespace
}  // namespace evolin
