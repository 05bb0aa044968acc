// Every registered associator over hard, random, tiny and huge images with hostile lines.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <ostream>
#include <set>
#include <string>
#include <vector>

#include "evolin_ros/association/geometric_associator.h"
#include "evolin_ros/association/lbd_associator.h"
#include "evolin_ros/association/lbd_binary_associator.h"
#include "evolin_ros/association/lk_tracking_associator.h"
#include "evolin_ros/association/oracle_associator.h"
#include "evolin_ros/association/random_associator.h"
#include "evolin_ros/association/verified_associator.h"
#include "evolin_ros/base/error.h"
#include "test/association/textured_images.h"
#include "test/support/fuzz_images.h"
#include "test/support/plugin_names.h"

namespace evolin {
namespace {

using test::segment;

struct Method {
  std::string title;  ///< plug-in's name, and what its parameters make of it
  std::string name;
  std::function<std::unique_ptr<LineAssociator>()> make;
  std::string parameters;
  bool reads_images;
  bool one_way = false;  ///< several lines of the first frame may have the same one in the second
};

/// For the names of tests that fail.
void PrintTo(const Method& method, std::ostream* stream) { *stream << method.title; }

template <typename Associator>
Method method(const std::string& name, bool reads_images, const std::string& title = "",
              const std::string& parameters = "{}") {
  return {title.empty() ? name : title, name, [] { return std::make_unique<Associator>(); },
          parameters, reads_images};
}

Method oneWay(Method method) {
  method.one_way = true;
  return method;
}

/// As the loader hands every associator out, with the matches verified.
template <typename Associator>
Method verified(const std::string& name) {
  return {
      name + "_verified", name,
      [name] { return std::make_unique<VerifiedAssociator>(name, std::make_shared<Associator>()); },
      "{verify: pose}", true};
}

const std::vector<Method>& methods() {
  static const std::vector<Method> all = {
      method<GeometricAssociator>("geometric", true),
      method<GeometricAssociator>("geometric", false, "geometric_none", "{prediction: none}"),
      method<GeometricAssociator>("geometric", false, "geometric_pose", "{prediction: pose}"),
      method<LbdAssociator>("lbd", true),
      oneWay(method<LbdAssociator>("lbd", true, "lbd_one_way", "{cross_check: false}")),
      method<LbdAssociator>("lbd", true, "lbd_gated",
                            "{max_ratio: 0.9, max_displacement: 50, max_angle: 30}"),
      verified<LbdAssociator>("lbd"),
      method<LbdBinaryAssociator>("lbd_binary", true),
      method<LkTrackingAssociator>("lk_tracking", true),
      method<LkTrackingAssociator>("lk_tracking", true, "lk_tracking_deep",
                                   "{window: 5, levels: 10, min_support: 0}"),
      method<OpenCvLbdBinaryAssociator>("opencv_lbd_binary", true),
      method<OracleAssociator>("oracle", false),
      method<RandomAssociator>("random", false),
  };
  return all;
}

/// Plays matches back and never looks at the pixels or the lines.
const std::set<std::string> kNoLines = {"recorded"};

class FuzzedAssociator : public ::testing::TestWithParam<Method> {
 protected:
  void SetUp() override {
    const std::string why = GetParam().make()->whyUnavailable();
    if (!why.empty()) {
      GTEST_SKIP() << why;
    }
  }

  static std::unique_ptr<LineAssociator> configured() {
    std::unique_ptr<LineAssociator> associator = GetParam().make();
    associator->configure(YAML::Load(GetParam().parameters));
    return associator;
  }
};

/// Without length, tiny, equal, turned, along and beyond the borders, enormous, not finite; then
/// some anywhere.
LineSegments hostileLines(cv::Size size, test::RandomLines* random) {
  const double right = size.width - 1;
  const double bottom = size.height - 1;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const double most = std::numeric_limits<double>::max();
  LineSegments lines = {
      segment(0, 0, 0, 0),
      segment(right / 2, bottom / 2, right / 2 + 1e-9, bottom / 2),
      segment(right / 2, bottom / 2, right / 2 + 0.5, bottom / 2 + 0.5),
      segment(0, 0, right, bottom),
      segment(right, bottom, 0, 0),
      segment(0, 0, right, bottom),
      segment(-0.5, -0.5, right + 0.5, -0.5),
      segment(right + 0.5, -0.5, right + 0.5, bottom + 0.5),
      segment(-30, bottom / 3, right + 40, bottom / 2),
      segment(-200, -100, -10, -300),
      segment(right + 5, 0, right + 500, bottom),
      segment(-32767, 3, 32767, 5),
      segment(-32768, 3, 32768, 5),
      segment(0, -1e9, 5, 1e9),
      segment(-1e30, 0, 1e30, 1e30),
      segment(-most, -most, most, most),
      segment(nan, 0, 10, 10),
      segment(0, 0, infinity, 5),
      segment(nan, nan, nan, nan),
  };
  for (const LineSegment& line : random->anywhere(30, size.width, size.height)) {
    lines.push_back(line);
  }
  return lines;
}

/// Depth of all kinds, and none at some places.
cv::Mat hostileDepth(cv::Size size, test::RandomLines* random) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> odd = {nan,    nan,  0, -1, std::numeric_limits<float>::infinity(),
                                  1e-30F, 1e30F};
  cv::Mat depth(size, CV_32FC1);
  for (int y = 0; y < depth.rows; ++y) {
    for (int x = 0; x < depth.cols; ++x) {
      const std::size_t kind = random->index(40);
      depth.at<float>(y, x) = kind < odd.size() ? odd[kind] : 1 + 0.01F * static_cast<float>(x);
    }
  }
  return depth;
}

FrameLines frameLines(const std::string& name, const cv::Mat& image, const LineSegments& lines,
                      Stamp stamp, const cv::Mat& depth) {
  FrameLines frame;
  frame.frame.name = name;
  frame.frame.stamp = stamp;
  frame.frame.image = image;
  frame.frame.depth = depth;
  Camera camera;
  camera.width = image.cols;
  camera.height = image.rows;
  camera.fx = 100;
  camera.fy = -100;
  camera.cx = image.cols / 2.0;
  camera.cy = image.rows / 2.0;
  frame.frame.camera = camera;
  Pose pose;
  pose.translation.x() = 1e-9 * static_cast<double>(stamp);
  frame.frame.pose = pose;
  frame.lines = lines;
  return frame;
}

/// The same taken so far ahead that the depth's nearer points lie behind the camera.
FrameLines ahead(FrameLines frame) {
  frame.frame.pose->translation.z() += 3;
  return frame;
}

/// The same without what an associator has kept in it.
FrameLines afresh(FrameLines frame) {
  frame.description.reset();
  return frame;
}

/// Indices of lines, each once and the first ones in order, distances that are numbers or absent.
void expectSoundMatches(const LineMatches& matches, const FrameLines& first,
                        const FrameLines& second, bool one_way, const std::string& what) {
  std::set<std::size_t> taken;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    ASSERT_LT(matches[i].first, first.lines.size()) << what;
    ASSERT_LT(matches[i].second, second.lines.size()) << what;
    ASSERT_TRUE(i == 0 || matches[i].first > matches[i - 1].first) << what;
    ASSERT_TRUE(taken.insert(matches[i].second).second || one_way) << what;
    ASSERT_FALSE(std::isinf(matches[i].distance)) << what;
    ASSERT_FALSE(matches[i].distance < 0) << what;
  }
}

void expectEqualMatches(const LineMatches& a, const LineMatches& b, const std::string& what) {
  ASSERT_EQ(a.size(), b.size()) << what;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].first, b[i].first) << what;
    ASSERT_EQ(a[i].second, b[i].second) << what;
    ASSERT_TRUE(a[i].distance == b[i].distance ||
                (std::isnan(a[i].distance) && std::isnan(b[i].distance)))
        << what;
  }
}

/// The image a few pixels on, what leaves it coming in again on the other side.
cv::Mat rolled(const cv::Mat& image) {
  const int dx = std::min(2, image.cols - 1);
  cv::Mat moved(image.size(), image.type());
  image.colRange(0, image.cols - dx).copyTo(moved.colRange(dx, image.cols));
  if (dx > 0) image.colRange(image.cols - dx, image.cols).copyTo(moved.colRange(0, dx));
  return moved;
}

TEST(FuzzedAssociators, AreAllThatAreRegistered) {
  std::set<std::string> names = kNoLines;
  for (const Method& method : methods()) names.insert(method.name);
  EXPECT_EQ(test::pluginNames(EVOLIN_SOURCE_DIR "/plugins/associators.xml"), names);
}

// With its own descriptions kept, with fresh ones, and by another instance.
TEST_P(FuzzedAssociator, GivesTheSameSoundMatchesEachTime) {
  const auto one = configured();
  const auto other = configured();
  std::size_t found = 0;
  const std::vector<test::NamedImage> images = test::fuzzImages();
  // Other patterns at each size; each of them costs all the hostile lines.
  for (std::size_t i = 0; i < images.size(); i += 3) {
    const test::NamedImage& image = images[i];
    test::RandomLines random(i + 1);
    const cv::Size size = image.image.size();
    const LineSegments lines = hostileLines(size, &random);
    const cv::Mat depth = hostileDepth(size, &random);
    const FrameLines first = frameLines(image.name, image.image, lines, 0, depth);
    const FrameLines second = frameLines(image.name, rolled(image.image), lines, 20000000, depth);
    const FrameLines without = frameLines(image.name, image.image, {}, 20000000, depth);
    LineMatches matches;
    ASSERT_NO_THROW(matches = one->match(first, second)) << image.name;
    ASSERT_NO_FATAL_FAILURE(
        expectSoundMatches(matches, first, second, GetParam().one_way, image.name));
    ASSERT_NO_FATAL_FAILURE(
        expectEqualMatches(one->match(first, second), matches, image.name + ", again"));
    ASSERT_NO_FATAL_FAILURE(expectEqualMatches(other->match(afresh(first), afresh(second)), matches,
                                               image.name + ", by another"));
    LineMatches behind;
    ASSERT_NO_THROW(behind = one->match(first, ahead(second))) << image.name;
    ASSERT_NO_FATAL_FAILURE(
        expectSoundMatches(behind, first, second, GetParam().one_way, image.name));
    EXPECT_TRUE(one->match(first, without).empty()) << image.name;
    EXPECT_TRUE(one->match(without, second).empty()) << image.name;
    found += matches.size();
  }
  EXPECT_GT(found, 100U) << "hardly any match to look at";
}

TEST_P(FuzzedAssociator, TakesImagesOf8192Squared) {
  const cv::Mat image = test::hugeImage();
  test::RandomLines random(1);
  const LineSegments lines = hostileLines(image.size(), &random);
  // A row of it, repeated: nothing but the oracle reads it.
  const cv::Mat depth = cv::repeat(hostileDepth({image.cols, 1}, &random), image.rows, 1);
  const FrameLines first = frameLines("8192x8192", image, lines, 0, depth);
  const FrameLines second = frameLines("8192x8192, on", rolled(image), lines, 20000000, depth);
  LineMatches matches;
  ASSERT_NO_THROW(matches = configured()->match(first, second));
  ASSERT_NO_FATAL_FAILURE(
      expectSoundMatches(matches, first, second, GetParam().one_way, "8192x8192"));
  expectEqualMatches(configured()->match(afresh(first), afresh(second)), matches, "by another");
}

TEST_P(FuzzedAssociator, RefusesOtherImagesWhereItReadsThem) {
  const auto associator = configured();
  test::RandomLines random(1);
  for (const test::NamedImage& one : test::foreignImages()) {
    const cv::Size size(64, 48);
    const LineSegments lines = hostileLines(size, &random);
    const cv::Mat depth = hostileDepth(size, &random);
    cv::Mat image = one.image;
    const FrameLines first = frameLines(one.name, image, lines, 0, depth);
    const FrameLines second = frameLines(one.name, image.clone(), lines, 20000000, depth);
    if (GetParam().reads_images) {
      EXPECT_THROW(associator->match(first, second), Error) << one.name;
    } else {
      EXPECT_NO_THROW(associator->match(first, second)) << one.name;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Associators, FuzzedAssociator, ::testing::ValuesIn(methods()),
                         [](const auto& info) { return info.param.title; });

}  // namespace
}  // namespace evolin
