// Recorded lines come back bit by bit, by stamp.
#include "evolin_ros/detection/recorded_detector.h"

#include <gtest/gtest.h>

#include <map>

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

TEST_F(RecordedDetectorTest, PlaysTheTimesThatTheMethodTook) {
  folder_.write("times.txt", "# seconds name\n0.025 0000\n");
  configure();
  EXPECT_FALSE(detector_.processingTime()) << "before the first frame";
  detectAt(1);
  EXPECT_EQ(detector_.processingTime(), 0.025);
  detectAt(2);
  EXPECT_FALSE(detector_.processingTime()) << "of a frame without an entry";
}

TEST_F(RecordedDetectorTest, FindsTimesBesideTheFolderOfLines) {
  folder_.write("times.txt", "0.5 0001\n");
  YAML::Node parameters;
  parameters["folder"] = (folder_.path() / "lines").string();
  detector_.configure(parameters);
  detectAt(2);
  EXPECT_EQ(detector_.processingTime(), 0.5);
}

TEST_F(RecordedDetectorTest, RefusesTimesThatAreNone) {
  for (const auto& [text, words] :
       std::map<std::string, std::string>{{"0.1 0000\nx 0001\n", "times.txt:2"},
                                          {"-1 0000\n", "at least 0"},
                                          {"0.1\n", "expected 'seconds name'"},
                                          {"1 a\n1 a\n", "twice"}}) {
    folder_.write("times.txt", text);
    RecordedDetector detector;
    YAML::Node parameters;
    parameters["folder"] = folder_.path().string();
    expectError<ParseError>([&] { detector.configure(parameters); }, {words});
  }
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
