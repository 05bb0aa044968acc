// Recorded lines come back bit by bit, by stamp.
#include "evolin_ros/detection/recorded_detector.h"

#include <gtest/gtest.h>

#include "test/support/expect_error.h"
#include "test/support/temporary_folder.h"

namespace evolin {
namespace {

using test::expectError;

class RecordedDetectorTest : public ::testing::Test {
 protected:
  RecordedDetectorTest() {
    folder_.write("lines/0000.csv", "0.1,0.2,30,4\n5,6,7,8\n");
    folder_.write("lines/0001.csv", "");
    folder_.write("stamps.txt", "1.000000 lines/0000.csv\n2.000000 lines/0001.csv\n");
  }

  void configure() {
    YAML::Node parameters;
    parameters["folder"] = folder_.path().string();
    detector_.configure(parameters);
  }

  LineSegments detectAt(double seconds) {
    Frame frame;
    frame.stamp = fromSeconds(seconds);
    return detector_.detect(frame);
  }

  test::TemporaryFolder folder_;
  RecordedDetector detector_;
};

TEST_F(RecordedDetectorTest, PlaysLinesByStamp) {
  configure();
  EXPECT_FALSE(detector_.givesScores());
  const LineSegments lines = detectAt(1.0005);
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0].x1, 0.1);
  EXPECT_EQ(lines[1].y2, 8);
  EXPECT_TRUE(detectAt(2).empty());
  expectError([&] { detectAt(1.5); }, {"0.001 s of 1.500000", "from 1.000000 to 2.000000"});
}

TEST_F(RecordedDetectorTest, PlaysScores) {
  folder_.write("scores/0000.csv", "0.5\n0.25\n");
  folder_.write("scores/0001.csv", "");
  configure();
  EXPECT_TRUE(detector_.givesScores());
  EXPECT_EQ(detectAt(1)[1].score, 0.25);
}

TEST_F(RecordedDetectorTest, RefusesWhatItCannotPlay) {
  expectError([&] { detectAt(1); }, {"before configure()"});
  expectError<ConfigError>([&] { detector_.configure(YAML::Node()); }, {"'folder'", "not set"});
  expectError<ConfigError>([&] { detector_.configure(YAML::Load("{folder: x, foldr: y}")); },
                           {"'foldr'", "folder"});
  std::filesystem::remove(folder_.path() / "stamps.txt");
  expectError<ConfigError>([&] { configure(); }, {"no stamps.txt", "'stamps'"});
}

}  // namespace
}  // namespace evolin
