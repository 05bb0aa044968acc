// Finding and loading plug-ins without a running master.
#include "plugin_loader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/core.hpp>
#include <thread>

#include "evolin_ros/base/error.h"
#include "test/support/expect_error.h"

namespace evolin {
namespace {

using test::expectError;

std::vector<std::string> namesOf(const std::vector<PluginInfo>& infos) {
  std::vector<std::string> names;
  names.reserve(infos.size());
  for (const PluginInfo& info : infos) names.push_back(info.name);
  return names;
}

Frame squareFrame() {
  Frame frame;
  frame.image = cv::Mat(120, 160, CV_8UC1, cv::Scalar(20));
  frame.image(cv::Rect(40, 30, 80, 60)).setTo(220);
  return frame;
}

TEST(PluginLoader, ListsOwnPluginsByName) {
  PluginLoader loader;
  const std::vector<PluginInfo> detectors = loader.listDetectors();
  const std::vector<std::string> names = namesOf(detectors);
  EXPECT_TRUE(std::is_sorted(names.begin(), names.end()));
  for (const char* expected :
       {"cannylines", "edlines", "elsed", "fld", "fsg", "hough_p", "kht", "lsd", "lsdnet", "lswms",
        "mlsd", "opencv_edlines", "opencv_fld", "opencv_lsd"}) {
    EXPECT_EQ(std::count(names.begin(), names.end(), expected), 1) << expected;
  }
  const std::vector<PluginInfo> associators = loader.listAssociators();
  const std::vector<std::string> associator_names = namesOf(associators);
  EXPECT_EQ(std::count(associator_names.begin(), associator_names.end(), "lbd"), 1);
  for (const auto& infos : {detectors, associators}) {
    for (const PluginInfo& info : infos) {
      EXPECT_FALSE(info.description.empty()) << info.name;
      if (info.name == "hough_p" || info.name == "lbd") {
        EXPECT_EQ(info.package, "evolin_ros");
        EXPECT_EQ(info.why_unavailable, "") << "every OpenCV has what it needs";
      }
    }
  }
}

TEST(PluginLoader, ListsTheReasonThatThePluginGives) {
  PluginLoader loader;
  for (const PluginInfo& info : loader.listDetectors()) {
    if (info.package == "evolin_ros") {
      EXPECT_EQ(info.why_unavailable, loader.loadDetector(info.name)->whyUnavailable());
    }
  }
}

TEST(PluginLoader, LoadsWhatWorks) {
  PluginLoader loader;
  const auto detector = loader.loadDetector("hough_p");
  detector->configure(YAML::Load("{threshold: 30}"));
  EXPECT_GE(detector->detect(squareFrame()).size(), 4U) << "the square has four sides";
  EXPECT_NE(loader.loadDetector("hough_p"), detector) << "every user has an instance of its own";
  loader.loadAssociator("lbd")->configure(YAML::Node());
}

TEST(PluginLoader, GivesEveryAssociatorTheVerificationsParameters) {
  PluginLoader loader;
  for (const PluginInfo& info : loader.listAssociators()) {
    if (!info.why_unavailable.empty() || info.name == "recorded") {  // which asks for its folder
      continue;
    }
    const auto associator = loader.loadAssociator(info.name);
    associator->configure(YAML::Load("{verify: pose}"));
    EXPECT_TRUE(associator->needs().depth) << info.name;
    expectError([&] { associator->configure(YAML::Load("{verify: pose, verify_min_inlier: 9}")); },
                {"associator " + info.name, "verify_min_inliers"});
  }
}

TEST(PluginLoader, NamesTheNearestForAnUnknownOne) {
  PluginLoader loader;
  expectError([&] { loader.loadDetector("open_lsd"); },
              {"unknown detector 'open_lsd'", "did you mean 'opencv_lsd'", "hough_p"});
  expectError([&] { loader.loadAssociator("ldb"); },
              {"unknown associator 'ldb'", "did you mean 'lbd'"});
  expectError([&] { loader.loadDetector("lbd"); }, {"unknown detector 'lbd'"});
  expectError([&] { loader.loadDetector(""); }, {"unknown detector ''"});
}

TEST(PluginLoader, WhatItGaveOutOutlivesIt) {
  std::shared_ptr<LineDetector> detector;
  std::shared_ptr<LineAssociator> associator;
  {
    PluginLoader loader;
    detector = loader.loadDetector("hough_p");
    associator = loader.loadAssociator("lbd");
  }
  detector->configure(YAML::Load("{threshold: 30}"));
  associator->configure(YAML::Node());
  FrameLines lines;
  lines.frame = squareFrame();
  lines.lines = detector->detect(lines.frame);
  ASSERT_FALSE(lines.lines.empty());
  EXPECT_FALSE(associator->match(lines, lines).empty());
  detector.reset();
  PluginLoader again;
  EXPECT_EQ(again.loadDetector("hough_p")->whyUnavailable(), "");
}

TEST(PluginLoader, TwoLoadersMayComeAndGoInAnyOrder) {
  for (int round = 0; round < 10; ++round) {
    auto first = std::make_unique<PluginLoader>();
    auto second = std::make_unique<PluginLoader>();
    const auto from_first = first->loadDetector("hough_p");
    auto from_second = second->loadDetector("hough_p");
    first.reset();
    from_second.reset();
    from_first->configure(YAML::Load("{threshold: 30}"));
    EXPECT_FALSE(from_first->detect(squareFrame()).empty());
    EXPECT_EQ(second->loadDetector("hough_p")->whyUnavailable(), "");
  }
}

TEST(PluginLoader, AnObjectMayGoOnAnotherThread) {
  auto loader = std::make_unique<PluginLoader>();
  auto detector = loader->loadDetector("hough_p");
  loader.reset();
  std::size_t lines = 0;
  std::thread worker([&lines, owned = std::move(detector)]() mutable {
    owned->configure(YAML::Load("{threshold: 30}"));
    lines = owned->detect(squareFrame()).size();
    owned.reset();
  });
  worker.join();
  EXPECT_GE(lines, 4U);
}

}  // namespace
}  // namespace evolin
