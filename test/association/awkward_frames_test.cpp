// Every associator on images that are hardly any and lines that are none: matches are one to one
// and the same again, and nothing else happens.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "evolin_ros/association/geometric_associator.h"
#include "evolin_ros/association/lbd_associator.h"
#include "evolin_ros/association/lbd_binary_associator.h"
#include "evolin_ros/association/lk_tracking_associator.h"
#include "evolin_ros/association/oracle_associator.h"
#include "evolin_ros/association/random_associator.h"
#include "test/association/textured_images.h"
#include "test/detection/awkward_images.h"
#include "test/support/random_lines.h"

namespace evolin {
namespace {

/// A plug-in with parameters of its own.
template <class Associator>
struct Plain {
  static constexpr const char* kParameters = "{}";
  using Type = Associator;
};

struct Unpredicted {
  static constexpr const char* kParameters = "{prediction: none}";
  using Type = GeometricAssociator;
};

struct PredictedByPose {
  static constexpr const char* kParameters = "{prediction: pose}";
  using Type = GeometricAssociator;
};

struct DeepPyramid {
  static constexpr const char* kParameters = "{window: 5, levels: 10, min_support: 0}";
  using Type = LkTrackingAssociator;
};

/// Inside, outside, across the border, without length, and not finite.
LineSegments awkwardLines(const cv::Size& size, std::uint64_t seed) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const double right = size.width - 1;
  const double bottom = size.height - 1;
  LineSegments lines = {
      test::segment(0, 0, right, bottom),
      test::segment(right, 0, 0, bottom),
      test::segment(-0.5, -0.5, right + 0.5, -0.5),
      test::segment(right / 2, bottom / 2, right / 2, bottom / 2),
      test::segment(right / 2, bottom / 2, right / 2 + 1e-9, bottom / 2),
      test::segment(-50, -80, -10, -20),
      test::segment(right + 5, 0, right + 40, bottom),
      test::segment(-1e4, bottom / 2, 1e4, bottom / 2),
      test::segment(-1e12, -1e12, 1e12, 1e12),
      test::segment(1e300, 0, -1e300, 1),
      test::segment(kNan, 0, right, bottom),
      test::segment(0, 0, right, kNan),
      test::segment(0, kInfinity, right, bottom),
      test::segment(-kInfinity, 0, kInfinity, 0),
  };
  test::RandomLines random(seed);
  for (int i = 0; i < 12; ++i) {
    lines.push_back(test::segment(random.uniform(-2, right + 2), random.uniform(-2, bottom + 2),
                                  random.uniform(-2, right + 2), random.uniform(-2, bottom + 2)));
  }
  return lines;
}

/// With all that an associator may ask for. The depth has holes.
FrameLines frameOf(const cv::Mat& image, std::uint64_t seed, double forwards) {
  FrameLines frame;
  frame.frame.stamp = static_cast<Stamp>(seed);
  frame.frame.image = image;
  frame.frame.depth = cv::Mat(image.size(), CV_32FC1, cv::Scalar(2));
  frame.frame.depth.at<float>(image.rows / 2, image.cols / 2) =
      std::numeric_limits<float>::quiet_NaN();
  Camera camera;
  camera.width = image.cols;
  camera.height = image.rows;
  camera.fx = camera.fy = std::max(image.cols, image.rows);
  camera.cx = (image.cols - 1) / 2.0;
  camera.cy = (image.rows - 1) / 2.0;
  frame.frame.camera = camera;
  Pose pose;
  pose.translation.z() = forwards;
  frame.frame.pose = pose;
  frame.lines = awkwardLines(image.size(), seed);
  return frame;
}

using Pair = std::tuple<std::uint32_t, std::uint32_t, float>;

/// NaN distances (none) as -1, so that pairs compare.
std::vector<Pair> pairsOf(const LineMatches& matches) {
  std::vector<Pair> pairs;
  for (const LineMatch& match : matches) {
    pairs.emplace_back(match.first, match.second,
                       std::isnan(match.distance) ? -1.0F : match.distance);
  }
  return pairs;
}

template <class Plugin>
class AwkwardFrames : public ::testing::Test {
 protected:
  static std::unique_ptr<LineAssociator> make() {
    auto associator = std::make_unique<typename Plugin::Type>();
    associator->configure(YAML::Load(Plugin::kParameters));
    return associator;
  }

  static void expectOneToOne(const LineMatches& matches, const FrameLines& first,
                             const FrameLines& second) {
    std::set<std::uint32_t> taken;
    for (std::size_t i = 0; i < matches.size(); ++i) {
      ASSERT_LT(matches[i].first, first.lines.size());
      ASSERT_LT(matches[i].second, second.lines.size());
      EXPECT_TRUE(i == 0 || matches[i - 1].first < matches[i].first) << "not sorted, or twice";
      EXPECT_TRUE(taken.insert(matches[i].second).second) << matches[i].second << " twice";
    }
  }

  /// Matches, again by the same instance with what it kept, and by another one without.
  void check(const FrameLines& first, const FrameLines& second) {
    LineMatches matches;
    ASSERT_NO_THROW(matches = associator_->match(first, second));
    expectOneToOne(matches, first, second);
    EXPECT_EQ(pairsOf(associator_->match(first, second)), pairsOf(matches)) << "the second time";
    first.description.reset();
    second.description.reset();
    EXPECT_EQ(pairsOf(make()->match(first, second)), pairsOf(matches)) << "by another instance";
  }

  std::unique_ptr<LineAssociator> associator_ = std::make_unique<typename Plugin::Type>();
};

using Plugins =
    ::testing::Types<Plain<GeometricAssociator>, Unpredicted, PredictedByPose,
                     Plain<LkTrackingAssociator>, DeepPyramid, Plain<OracleAssociator>,
                     Plain<RandomAssociator>, Plain<LbdAssociator>, Plain<LbdBinaryAssociator>>;
TYPED_TEST_SUITE(AwkwardFrames, Plugins);

TYPED_TEST(AwkwardFrames, AreMatchedOneToOneAndTheSameAgain) {
  if (!this->associator_->whyUnavailable().empty()) {
    GTEST_SKIP() << this->associator_->whyUnavailable();
  }
  this->associator_->configure(YAML::Load(TypeParam::kParameters));
  for (const cv::Size& size : test::awkwardSizes()) {
    for (const int type : {CV_8UC1, CV_8UC3}) {
      SCOPED_TRACE(std::to_string(size.width) + "x" + std::to_string(size.height) + ", type " +
                   std::to_string(type));
      const cv::Mat noise = test::noise(size.height, size.width, type);
      const cv::Mat flat(size, type, cv::Scalar::all(128));
      cv::Mat step = flat.clone();
      step.colRange(size.width / 2, size.width).setTo(cv::Scalar::all(255));
      for (const cv::Mat& image : {noise, flat, step}) {
        this->check(frameOf(image, 1, 0), frameOf(image, 2, 0.05));
      }
      // Into a wall, so that lines come to lie behind the camera.
      this->check(frameOf(noise, 1, 0), frameOf(step, 1, 3));
      FrameLines without = frameOf(noise, 1, 0);
      without.lines.clear();
      this->check(without, frameOf(noise, 2, 0));
      this->check(frameOf(noise, 2, 0), without);
      this->check(without, without);
    }
  }
}

}  // namespace
}  // namespace evolin
