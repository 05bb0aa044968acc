// The lbd plug-in: robustness, its cache, its shipped parameters, and the golden matches.
#include "evolin_ros/association/lbd_associator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>
#include <vector>

#include "evolin_ros/base/error.h"
#include "test/association/descriptor_choice_support.h"
#include "test/support/golden.h"

namespace evolin {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

LineSegment segment(double x1, double y1, double x2, double y2) {
  LineSegment line;
  line.x1 = x1;
  line.y1 = y1;
  line.x2 = x2;
  line.y2 = y2;
  return line;
}

FrameLines texturedFrame(const LineSegments& lines) {
  FrameLines frame;
  frame.frame.image = cv::Mat(200, 240, CV_8UC1);
  cv::RNG random(11);
  random.fill(frame.frame.image, cv::RNG::UNIFORM, 0, 256);
  cv::GaussianBlur(frame.frame.image, frame.frame.image, cv::Size(9, 9), 2.0);
  frame.lines = lines;
  return frame;
}

LineSegments someLines() {
  return {segment(50, 50, 150, 60), segment(60, 150, 170, 120), segment(120, 40, 110, 160),
          segment(40, 40, 60, 150)};
}

class LbdAssociatorTest : public ::testing::Test {
 protected:
  void SetUp() override { associator_.configure(YAML::Node()); }

  LbdAssociator associator_;
};

TEST_F(LbdAssociatorTest, PairsEqualFramesLineByLineAtDistanceZero) {
  const FrameLines first = texturedFrame(someLines());
  const FrameLines second = texturedFrame(someLines());
  const LineMatches matches = associator_.match(first, second);
  ASSERT_EQ(matches.size(), 4U);
  for (std::uint32_t i = 0; i < 4; ++i) {
    EXPECT_EQ(matches[i].first, i);
    EXPECT_EQ(matches[i].second, i);
    EXPECT_EQ(matches[i].distance, 0.0F);
  }
}

TEST_F(LbdAssociatorTest, FollowsAPermutationOfTheLines) {
  const FrameLines first = texturedFrame(someLines());
  LineSegments lines = someLines();
  std::swap(lines[0], lines[3]);
  const FrameLines second = texturedFrame(lines);
  const LineMatches matches = associator_.match(first, second);
  ASSERT_EQ(matches.size(), 4U);
  EXPECT_EQ(matches[0].second, 3U);
  EXPECT_EQ(matches[1].second, 1U);
  EXPECT_EQ(matches[3].second, 0U);
}

TEST_F(LbdAssociatorTest, LeavesLinesWithoutLengthOrPlaceUnmatched) {
  LineSegments lines = someLines();
  lines.insert(lines.begin(), segment(90, 90, 90, 90));
  lines.push_back(segment(kNan, 1, 2, 3));
  lines.push_back(segment(1e9, 1, -1e9, 3));
  lines.push_back(segment(90, 90, 90, 90));
  const LineMatches matches = associator_.match(texturedFrame(lines), texturedFrame(lines));
  ASSERT_EQ(matches.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(matches[i].first, i + 1);
    EXPECT_EQ(matches[i].second, i + 1);
  }
}

TEST_F(LbdAssociatorTest, MatchesNothingToNothing) {
  const FrameLines none = texturedFrame({});
  const FrameLines some = texturedFrame(someLines());
  EXPECT_TRUE(associator_.match(none, some).empty());
  EXPECT_TRUE(associator_.match(some, none).empty());
  EXPECT_TRUE(associator_.match(none, none).empty());
}

TEST_F(LbdAssociatorTest, DescribesAFrameOnce) {
  FrameLines first = texturedFrame(someLines());
  const FrameLines second = texturedFrame(someLines());
  const LineMatches before = associator_.match(first, second);
  ASSERT_TRUE(first.description.has_value());
  first.frame.image = cv::Mat();  // a second description would have to throw
  LineMatches after;
  ASSERT_NO_THROW(after = associator_.match(first, second));
  EXPECT_EQ(after.size(), before.size());
}

TEST_F(LbdAssociatorTest, ReplacesAnotherMethodsCacheAndOneOfOtherLines) {
  FrameLines first = texturedFrame(someLines());
  const FrameLines second = texturedFrame(someLines());
  first.description = std::string("another method's");
  EXPECT_EQ(associator_.match(first, second).size(), 4U);
  first.lines.pop_back();
  EXPECT_EQ(associator_.match(first, second).size(), 3U);
}

TEST_F(LbdAssociatorTest, KeepsOneSidedPairsOnlyWithoutCrossCheck) {
  LineSegments doubled = someLines();
  doubled.push_back(doubled.front());
  const FrameLines first = texturedFrame(doubled);
  const FrameLines second = texturedFrame(someLines());
  EXPECT_EQ(associator_.match(first, second).size(), 4U);
  LbdAssociator one_sided;
  one_sided.configure(YAML::Load("{cross_check: false}"));
  EXPECT_EQ(one_sided.match(first, second).size(), 5U);
}

TEST_F(LbdAssociatorTest, MatchesOnlyWithinTheLimitsOnDisplacementAndAngle) {
  LineSegments moved = someLines();
  for (std::size_t i = 0; i < moved.size(); ++i) {
    moved[i].y1 += static_cast<double>(i);  // middles move by i / 2 pixels
  }
  const FrameLines first = texturedFrame(someLines());
  const FrameLines second = texturedFrame(moved);
  ASSERT_EQ(associator_.match(first, second).size(), 4U);
  LbdAssociator near;
  near.configure(YAML::Load("{max_displacement: 1.0}"));
  EXPECT_EQ(near.match(first, second).size(), 3U);
  near.configure(YAML::Load("{max_displacement: 0.99}"));
  EXPECT_EQ(near.match(first, second).size(), 2U);

  // Turned about its middle by 12 degrees: the first line and all others' own direction.
  LineSegments turned = someLines();
  const double angle = 12 * M_PI / 180;
  const LineSegment& line = turned[0];
  const double dx = (line.x2 - line.x1) / 2;
  const double dy = (line.y2 - line.y1) / 2;
  const double x = (line.x1 + line.x2) / 2;
  const double y = (line.y1 + line.y2) / 2;
  const double ax = std::cos(angle) * dx - std::sin(angle) * dy;
  const double ay = std::sin(angle) * dx + std::cos(angle) * dy;
  turned[0] = segment(x - ax, y - ay, x + ax, y + ay);
  const FrameLines third = texturedFrame(turned);
  LbdAssociator wide;
  wide.configure(YAML::Load("{max_angle: 12.1, max_displacement: 1}"));
  EXPECT_EQ(wide.match(first, third).size(), 4U);
  LbdAssociator narrow;
  narrow.configure(YAML::Load("{max_angle: 11.9, max_displacement: 1}"));
  EXPECT_EQ(narrow.match(first, third).size(), 3U);
}

// Directions are compared without their sense: a line and the same from its other end are 0 apart.
TEST_F(LbdAssociatorTest, LimitsTheAngleWhateverTheEndpointsOrder) {
  LbdAssociator narrow;
  narrow.configure(YAML::Load("{max_angle: 1, cross_check: false}"));
  const FrameLines first = texturedFrame({segment(50, 50, 150, 50.1)});
  for (const LineSegment& other :
       {segment(150, 50.1, 50, 50), segment(50, 50.1, 150, 50), segment(150, 50, 50, 50.1)}) {
    EXPECT_EQ(narrow.match(first, texturedFrame({other})).size(), 1U);
  }
  EXPECT_TRUE(narrow.match(first, texturedFrame({segment(50, 50, 150, 53)})).empty());
}

// Its direction can be computed all the same: that of the x axis.
TEST_F(LbdAssociatorTest, NoLimitLetsALineThroughThatIsNotFinite) {
  const LineSegments level = {segment(50, 50, 150, 50)};
  const LineSegments endless = {segment(0, 0, std::numeric_limits<double>::infinity(), 5)};
  DescriptorChoice choice(2);
  for (const double max_angle : {30.0, 89.0}) {
    choice.max_angle = max_angle;
    EXPECT_TRUE(matchingRules(choice, level, level).may_match(0, 0));
    EXPECT_FALSE(matchingRules(choice, level, endless).may_match(0, 0)) << max_angle;
    EXPECT_FALSE(matchingRules(choice, endless, endless).may_match(0, 0)) << max_angle;
  }
}

TEST_F(LbdAssociatorTest, DropsPairsByDistanceAndByRatio) {
  LineSegments moved = someLines();
  for (LineSegment& line : moved) {
    line.y1 += 1;
    line.y2 += 1;
  }
  moved.push_back(segment(50, 50.9, 150, 60.9));  // nearly the first one's true match
  const FrameLines first = texturedFrame(someLines());
  const FrameLines second = texturedFrame(moved);
  const LineMatches all = associator_.match(first, second);
  ASSERT_EQ(all.size(), 4U);
  LbdAssociator ratio;
  ratio.configure(YAML::Load("{max_ratio: 0.8}"));
  const LineMatches sure = ratio.match(first, second);
  ASSERT_EQ(sure.size(), 3U);
  EXPECT_EQ(sure[0].first, 1U);
  float farthest = 0;
  for (const LineMatch& match : all) {
    farthest = std::max(farthest, match.distance);
  }
  LbdAssociator strict;
  strict.configure(YAML::Load("{max_distance: " + std::to_string(0.999 * farthest) + "}"));
  EXPECT_EQ(strict.match(first, second).size(), 3U);
}

TEST_F(LbdAssociatorTest, RefusesUnknownParametersOtherImagesAndUseBeforeConfigure) {
  LbdAssociator fresh;
  EXPECT_THROW(fresh.match(texturedFrame(someLines()), texturedFrame(someLines())), Error);
  for (const char* bad : {"{crosscheck: true}", "{max_distance: 2.1}", "{max_ratio: 1.5}",
                          "{max_ratio: -0.1}", "{max_displacement: -1}", "{max_displacement: far}",
                          "{max_angle: 91}", "{max_angle: .nan}"}) {
    EXPECT_THROW(fresh.configure(YAML::Load(bad)), ConfigError) << bad;
  }
  FrameLines deep = texturedFrame(someLines());
  deep.frame.image.convertTo(deep.frame.image, CV_16U);
  EXPECT_THROW(associator_.match(deep, texturedFrame(someLines())), Error);
}

TEST_F(LbdAssociatorTest, ShippedFileHoldsAllDefaults) {
  const std::filesystem::path file =
      std::filesystem::path(EVOLIN_SOURCE_DIR) / "config" / "associators" / "lbd.yaml";
  const YAML::Node node = YAML::LoadFile(file.string());
  LbdAssociator loaded;
  ASSERT_NO_THROW(loaded.configure(node));
  test::expectHoldsAllDefaults(node, loaded.parameters(), LbdAssociator().parameters());
}

struct GoldenPair {
  int first;
  int second;
};

// Equal pairs as a share of the golden ones, over all golden frame pairs; distances of equal pairs
// agree.
void compareWithGolden(LbdAssociator* associator, const std::string& lines,
                       const std::vector<GoldenPair>& frame_pairs) {
  const std::filesystem::path lbd = test::goldenFolder() / "lbd";
  std::size_t golden_count = 0;
  std::size_t ours_count = 0;
  std::size_t equal = 0;
  std::size_t near = 0;
  for (const GoldenPair& pair : frame_pairs) {
    FrameLines frames[2];
    for (int side = 0; side < 2; ++side) {
      const int index = side == 0 ? pair.first : pair.second;
      frames[side].frame = test::goldenColor(index);
      frames[side].lines = readLinesCsv(lbd / "lines" / lines / (test::goldenStem(index) + ".csv"));
    }
    std::map<IndexPair, double> golden;
    for (const auto& row : test::readTable(
             lbd / "matches" / lines /
             (test::goldenStem(pair.first) + "_" + test::goldenStem(pair.second) + ".csv"))) {
      golden[{static_cast<std::int64_t>(row.at(0)), static_cast<std::int64_t>(row.at(1))}] =
          row.at(2);
    }
    const LineMatches matches = associator->match(frames[0], frames[1]);
    golden_count += golden.size();
    ours_count += matches.size();
    for (const LineMatch& match : matches) {
      const auto found = golden.find({match.first, match.second});
      if (found != golden.end()) {
        ++equal;
        near += std::abs(found->second - match.distance) < 1e-2 ? 1 : 0;
      }
    }
  }
  ::testing::Test::RecordProperty("golden_matches", static_cast<int>(golden_count));
  ::testing::Test::RecordProperty("equal_matches", static_cast<int>(equal));
  ASSERT_GT(golden_count, 0U);
  EXPECT_GE(static_cast<double>(equal), 0.99 * static_cast<double>(golden_count));
  EXPECT_GE(static_cast<double>(equal), 0.99 * static_cast<double>(ours_count));
  EXPECT_GE(static_cast<double>(near), 0.99 * static_cast<double>(equal));
}

const std::vector<GoldenPair> kGoldenPairs = {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 5}, {0, 5}};

TEST_F(LbdAssociatorTest, EqualsTheGoldenMatchesOfAnnotatedLines) {
  EVOLIN_REQUIRE_SHARED_DATA();
  compareWithGolden(&associator_, "gt", kGoldenPairs);
}

TEST_F(LbdAssociatorTest, EqualsTheGoldenMatchesOfDetectedLines) {
  EVOLIN_REQUIRE_SHARED_DATA();
  compareWithGolden(&associator_, "lsd", kGoldenPairs);
}

}  // namespace
}  // namespace evolin
