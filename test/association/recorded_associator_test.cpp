// Recorded matches come back by the frames' stamps.
#include "evolin_ros/association/recorded_associator.h"

#include <gtest/gtest.h>

#include "test/support/expect_error.h"
#include "test/support/temporary_folder.h"

namespace evolin {
namespace {

using test::expectError;

FrameLines frameAt(double seconds, std::size_t lines) {
  FrameLines frame;
  frame.frame.stamp = fromSeconds(seconds);
  frame.lines.resize(lines);
  return frame;
}

class RecordedAssociatorTest : public ::testing::Test {
 protected:
  RecordedAssociatorTest() {
    folder_.write("associations/0000_0001.csv", "2,0\n0,1\n");
    folder_.write("stamps.txt", "1.000000 0000.csv\n2.000000 0001.csv\n3.000000 0002.csv\n");
    YAML::Node parameters;
    parameters["folder"] = folder_.path().string();
    associator_.configure(parameters);
  }

  test::TemporaryFolder folder_;
  RecordedAssociator associator_;
};

TEST_F(RecordedAssociatorTest, PlaysPairsSortedByTheFirstIndex) {
  const LineMatches matches = associator_.match(frameAt(1, 3), frameAt(2, 2));
  ASSERT_EQ(matches.size(), 2U);
  EXPECT_EQ(matches[0].first, 0U);
  EXPECT_EQ(matches[0].second, 1U);
  EXPECT_EQ(matches[1].first, 2U);
  EXPECT_EQ(matches[1].second, 0U);
}

TEST_F(RecordedAssociatorTest, RefusesWhatWasNotRecorded) {
  expectError([&] { associator_.match(frameAt(2, 3), frameAt(3, 3)); },
              {"no file for the frames at 2.000000 and 3.000000", "frame step"});
  expectError([&] { associator_.match(frameAt(1, 2), frameAt(2, 2)); },
              {"pair (2, 0)", "2 and 2 lines"});
  RecordedAssociator blank;
  expectError([&] { blank.match(frameAt(1, 0), frameAt(2, 0)); }, {"before configure()"});
  expectError<ConfigError>([&] { blank.configure(YAML::Node()); }, {"'folder'", "not set"});
}

}  // namespace
}  // namespace evolin
