// Every registered detector over hard, random, tiny and huge images.
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <ostream>
#include <set>
#include <string>
#include <vector>

#include "evolin_ros/detection/cannylines.h"
#include "evolin_ros/detection/edlines.h"
#include "evolin_ros/detection/elsed.h"
#include "evolin_ros/detection/fld.h"
#include "evolin_ros/detection/fsg.h"
#include "evolin_ros/detection/hough_p.h"
#include "evolin_ros/detection/kht.h"
#include "evolin_ros/detection/lsd.h"
#include "evolin_ros/detection/lsdnet.h"
#include "evolin_ros/detection/lswms.h"
#include "evolin_ros/detection/mlsd.h"
#include "evolin_ros/detection/opencv_edlines.h"
#include "evolin_ros/detection/opencv_fld.h"
#include "evolin_ros/detection/opencv_lsd.h"
#include "test/detection/own_detectors.h"
#include "test/support/fuzz_images.h"
#include "test/support/lsd_release.h"
#include "test/support/models.h"
#include "test/support/plugin_names.h"

namespace evolin {
namespace {

/// A registered detector: how to make one, and the file that a network needs.
struct Method {
  std::string title;  ///< the plug-in's name, and what its parameters make of it
  std::string name;
  std::function<std::unique_ptr<LineDetector>()> make;
  std::function<test::Model()> model;
  std::string parameters = "{}";
};

template <typename Detector>
Method method(const std::string& name, const std::string& parameters = "{}",
              const std::string& title = "") {
  return {title.empty() ? name : title,
          name,
          [] { return std::make_unique<Detector>(); },
          {},
          parameters};
}

/// As the benchmark runs it, but cut to the image, which networks leave to whoever wants it.
template <typename Detector>
Method network(const std::string& name, std::function<test::Model()> model) {
  return {name, name, [] { return std::make_unique<Detector>(); }, std::move(model),
          "{clip: true}"};
}

const std::vector<Method>& methods() {
  static const std::vector<Method> all = {
      method<CannyLines>("cannylines"),
      method<CannyLines>("cannylines", "{compatible: false}", "cannylines_exact"),
      method<EdLines>("edlines"),
      method<Elsed>("elsed"),
      method<Fld>("fld"),
      method<Fsg>("fsg"),
      method<HoughP>("hough_p"),
      method<Kht>("kht"),
      method<Lsd>("lsd"),
      method<Lsd>("lsd", "{compatible: false}", "lsd_article"),
      network<LsdNet>("lsdnet", test::lsdNetModel),
      method<Lswms>("lswms"),
      method<Lswms>("lswms", "{compatible: true}", "lswms_compatible"),
      network<Mlsd>("mlsd", test::mlsdTiny512),
      method<OpenCvEdLines>("opencv_edlines"),
      method<OpenCvFld>("opencv_fld"),
      // From OpenCV 4.8 on the advanced refinement takes seconds for an edge that is exactly
      // upright.
      method<OpenCvLsd>("opencv_lsd", test::whyLsdDiffers().empty() ? "{}" : "{refine: standard}"),
  };
  return all;
}

/// Plays lines back and never looks at the pixels.
const std::set<std::string> kNoImages = {"recorded"};

/// For the names of tests that fail.
void PrintTo(const Method& method, std::ostream* stream) { *stream << method.title; }

class FuzzedDetector : public ::testing::TestWithParam<Method> {
 protected:
  void SetUp() override {
    parameters_ = YAML::Load(GetParam().parameters);
    if (GetParam().model) {
      const test::Model model = GetParam().model();
      EVOLIN_REQUIRE_MODEL(model);
      parameters_["model"] = model.file.string();
    }
    const std::string why = GetParam().make()->whyUnavailable();
    if (!why.empty()) {
      GTEST_SKIP() << why;
    }
  }

  std::unique_ptr<LineDetector> configured() const {
    std::unique_ptr<LineDetector> detector = GetParam().make();
    detector->configure(parameters_);
    return detector;
  }

  bool isNetwork() const { return static_cast<bool>(GetParam().model); }

  YAML::Node parameters_;
};

Frame frameOf(const test::NamedImage& one) {
  Frame frame;
  frame.name = one.name;
  frame.image = one.image;
  return frame;
}

bool samePixels(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && cv::norm(a, b, cv::NORM_INF) == 0;
}

TEST(FuzzedDetectors, AreAllThatAreRegistered) {
  std::set<std::string> names = kNoImages;
  for (const Method& method : methods()) names.insert(method.name);
  EXPECT_EQ(test::pluginNames(EVOLIN_SOURCE_DIR "/plugins/detectors.xml"), names);
}

// Twice by one instance that has seen the others, and by one that has seen only every other image.
TEST_P(FuzzedDetector, GivesTheSameSoundLinesInTheImageEachTime) {
  const auto first = configured();
  const auto second = configured();
  std::vector<test::NamedImage> images = test::fuzzImages();
  if (isNetwork()) {
    // They take seconds an image and see all at one size of their own: a few scenes will do.
    images.erase(images.begin(), images.end() - 12);
  }
  std::size_t found = 0;
  for (std::size_t i = 0; i < images.size(); ++i) {
    const Frame frame = frameOf(images[i]);
    const cv::Mat before = frame.image.clone();
    LineSegments lines;
    ASSERT_NO_THROW(lines = first->detect(frame)) << frame.name;
    ASSERT_TRUE(samePixels(frame.image, before)) << frame.name << ": the image was written to";
    ASSERT_NO_FATAL_FAILURE(test::expectSound(lines, *first, frame.name));
    ASSERT_NO_FATAL_FAILURE(test::expectLinesInImage(lines, frame.image.size(), frame.name));
    ASSERT_NO_FATAL_FAILURE(
        test::expectEqualLines(first->detect(frame), lines, frame.name + ", again"));
    if (i % 2 == 0) {
      ASSERT_NO_FATAL_FAILURE(
          test::expectEqualLines(second->detect(frame), lines, frame.name + ", by another"));
    }
    found += lines.size();
  }
  EXPECT_GT(found, images.size() / 4) << "hardly any line to look at";
}

TEST_P(FuzzedDetector, TakesAnImageOf8192Squared) {
  test::NamedImage huge{"8192x8192", test::hugeImage()};
  const Frame frame = frameOf(huge);
  LineSegments lines;
  {
    // Gone before the second, as each may need many bytes a pixel.
    const auto detector = configured();
    ASSERT_NO_THROW(lines = detector->detect(frame));
    ASSERT_NO_FATAL_FAILURE(test::expectSound(lines, *detector, frame.name));
  }
  ASSERT_NO_FATAL_FAILURE(test::expectLinesInImage(lines, frame.image.size(), frame.name));
  test::expectEqualLines(configured()->detect(frame), lines, frame.name + ", by another");
}

TEST_P(FuzzedDetector, RefusesOtherImagesAndGoesOn) {
  const auto detector = configured();
  Frame good;
  good.image = test::quadrilateralImage();
  const LineSegments lines = detector->detect(good);
  EXPECT_FALSE(lines.empty());
  for (const test::NamedImage& one : test::foreignImages()) {
    EXPECT_THROW(detector->detect(frameOf(one)), Error) << one.name;
    test::expectEqualLines(detector->detect(good), lines, "after " + one.name);
  }
}

INSTANTIATE_TEST_SUITE_P(Detectors, FuzzedDetector, ::testing::ValuesIn(methods()),
                         [](const auto& info) { return info.param.title; });

}  // namespace
}  // namespace evolin
