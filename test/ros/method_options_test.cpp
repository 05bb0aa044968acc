// Levels of diagnostics and settings of the method nodelets, as they are read from parameters.
#include <gtest/gtest.h>

#include "associator_options.h"
#include "detector_options.h"
#include "evolin_ros/base/error.h"
#include "test/support/expect_error.h"

namespace evolin::ros_shell {
namespace {

using ::evolin::test::expectError;

DetectorOptions detector(const std::string& yaml) {
  return readDetectorOptions(YAML::Load(yaml), "/detector");
}

TEST(HealthLimits, AreReadByName) {
  const HealthLimits limits =
      detector("{diagnostic_period: 0.5, diagnostics: {latency_warn: 0.05, queue_error: 9}}")
          .health;
  EXPECT_EQ(limits.period, 0.5);
  EXPECT_EQ(limits.latency.warn, 0.05);
  EXPECT_EQ(limits.latency.error, HealthLimits().latency.error);
  EXPECT_EQ(limits.queue.error, 9);
  EXPECT_EQ(limits.queue.warn, HealthLimits().queue.warn);
}

TEST(HealthLimits, RefuseWhatTheyDoNotKnow) {
  expectError<ConfigError>([] { detector("{diagnostics: {latency_wran: 1}}"); },
                           {"/detector/diagnostics", "latency_wran", "latency_warn"});
  expectError<ConfigError>([] { detector("{diagnostics: {drops_warn: 2}}"); },
                           {"drops_warn", "2", "1"});
}

TEST(DetectorOptions, TagsWhatChangesTheLinesAlone) {
  EXPECT_EQ(detector("{}").taggedSource(), "lsd");
  EXPECT_EQ(detector("{detector: hough_p}").taggedSource(), "hough_p");
  EXPECT_EQ(detector("{source: mine}").taggedSource(), "mine");
  EXPECT_EQ(
      detector("{queue_size: 5, line_width: 3, realtime: true, rectify: refuse}").taggedSource(),
      "lsd");
  std::set<std::string> tagged;
  for (const char* yaml :
       {"{parameters: {scale: 1}}", "{parameters: {scale: 2}}", "{max_lines: 5}", "{min_length: 5}",
        "{score_threshold: 5}", "{score_threshold: 0}", "{rectify: true}",
        "{rectify: true, camera: tum_fr1}", "{source: mine, max_lines: 5}"}) {
    const std::string source = detector(yaml).taggedSource();
    EXPECT_NE(source.find('#'), std::string::npos) << yaml;
    tagged.insert(source);
  }
  EXPECT_EQ(tagged.size(), 9U);
}

TEST(DetectorOptions, AnotherMethodUnderAGivenNameIsTagged) {
  DetectorOptions options = detector("{source: mine, detector: hough_p}");
  options.named_detector = "hough_p";
  EXPECT_EQ(options.taggedSource(), "mine");
  options.named_detector = "lsd";
  EXPECT_NE(options.taggedSource(), "mine");
}

TEST(DetectorOptions, NameWhatOnlyARestartTakesUp) {
  const DetectorOptions first = detector("{}");
  EXPECT_EQ(first.needsRestart(detector("{max_lines: 3, detector: hough_p}")), "");
  EXPECT_EQ(first.needsRestart(detector("{queue_size: 3, lazy: false}")), "~queue_size, ~lazy");
}

TEST(DetectorOptions, RefuseValuesOutOfRange) {
  expectError<ConfigError>([] { detector("{rectify: maybe}"); }, {"rectify", "maybe", "refuse"});
  expectError<ConfigError>([] { detector("{min_length: -1}"); }, {"min_length", "-1", "0"});
  expectError<ConfigError>([] { detector("{line_width: 0}"); }, {"line_width", "0", "1"});
}

TEST(AssociatorOptions, TagsWhatChangesTheMatchesAlone) {
  const auto associator = [](const std::string& yaml) {
    return readAssociatorOptions(YAML::Load(yaml), "/associator");
  };
  EXPECT_EQ(associator("{}").taggedSource(), "lbd");
  EXPECT_EQ(associator("{queue_size: 3, lazy: false}").taggedSource(), "lbd");
  EXPECT_NE(associator("{parameters: {a: 1}}").taggedSource(),
            associator("{parameters: {a: 2}}").taggedSource());
  EXPECT_EQ(associator("{}").needsRestart(associator("{frame_step: 2}")), "~frame_step");
}

}  // namespace
}  // namespace evolin::ros_shell
