// The viewer's parameters: defaults, layers, and errors that name the parameter.
#include "viewer_options.h"

#include <gtest/gtest.h>

#include "evolin_ros/base/error.h"
#include "test/support/expect_error.h"

namespace evolin::ros_shell {
namespace {

ViewerOptions read(const std::string& yaml) {
  return readViewerOptions(YAML::Load(yaml), "/viewer");
}

TEST(ViewerOptions, HaveTheDocumentedDefaults) {
  const ViewerOptions options = readViewerOptions(YAML::Node(), "/viewer");
  EXPECT_EQ(options.frame.threshold, 5);
  EXPECT_EQ(options.frame.protocol, Protocol::kEvolin);
  EXPECT_EQ(options.frame.trails_from, TrailsFrom::kMatches);
  EXPECT_EQ(options.frame.trail_length, 5);
  EXPECT_EQ(options.view.scale, 1);
  EXPECT_TRUE(options.view.margin);
  EXPECT_EQ(options.view.brightness, 0.6);
  EXPECT_EQ(options.view.line_width, 1.25);
  for (const auto layer : {&ViewOptions::true_positives, &ViewOptions::false_positives,
                           &ViewOptions::misses, &ViewOptions::dropped, &ViewOptions::trails}) {
    EXPECT_TRUE(options.view.*layer);
  }
  EXPECT_EQ(options.plane_distance, 1);
  EXPECT_EQ(options.queue_size, 30);
  EXPECT_EQ(options.patience, 3);
  EXPECT_EQ(options.image_transport, "raw");
  EXPECT_EQ(options.warn_after, 3);
}

TEST(ViewerOptions, AreReadOneByOne) {
  const ViewerOptions options = read(
      "{threshold: 10, protocol: paper, layers: [misses, not_scored], trails_from: ids,"
      " trail_length: 20, scale: 2, margin: false, brightness: 0.3, line_width: 2,"
      " plane_distance: 0.5, queue_size: 7, patience: 0, image_transport: compressed,"
      " warn_after: 0}");
  EXPECT_EQ(options.frame.threshold, 10);
  EXPECT_EQ(options.frame.protocol, Protocol::kPaper);
  EXPECT_EQ(options.frame.trails_from, TrailsFrom::kIds);
  EXPECT_EQ(options.frame.trail_length, 20);
  EXPECT_FALSE(options.view.true_positives);
  EXPECT_FALSE(options.view.false_positives);
  EXPECT_TRUE(options.view.misses);
  EXPECT_TRUE(options.view.dropped);
  EXPECT_FALSE(options.view.trails);
  EXPECT_EQ(options.view.scale, 2);
  EXPECT_FALSE(options.view.margin);
  EXPECT_EQ(options.view.brightness, 0.3);
  EXPECT_EQ(options.view.line_width, 2);
  EXPECT_EQ(options.plane_distance, 0.5);
  EXPECT_EQ(options.queue_size, 7);
  EXPECT_EQ(options.patience, 0);
  EXPECT_EQ(options.image_transport, "compressed");
  EXPECT_EQ(options.warn_after, 0);
  EXPECT_EQ(read("{trails_from: none}").frame.trails_from, TrailsFrom::kNone);
}

TEST(ViewerOptions, RefuseByName) {
  test::expectError<ConfigError>([] { read("{treshold: 5}"); }, {"'treshold'", "threshold"});
  test::expectError<ConfigError>([] { read("{threshold: 0}"); }, {"'threshold'", "0"});
  test::expectError<ConfigError>([] { read("{scale: 9}"); }, {"'scale'", "9", "8"});
  test::expectError<ConfigError>([] { read("{layers: [missed]}"); },
                                 {"'layers'", "missed", "misses"});
  test::expectError<ConfigError>([] { read("{trails_from: tracks}"); },
                                 {"'trails_from'", "tracks", "matches"});
  test::expectError<ConfigError>([] { read("{trail_length: 1}"); }, {"'trail_length'", "1", "2"});
}

}  // namespace
}  // namespace evolin::ros_shell
