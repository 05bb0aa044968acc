// Which frames are kept as the worst, and their pictures.
#include "worst_frames.h"

#include <gtest/gtest.h>

#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "test/evaluation/sample_frames.h"
#include "test/support/temporary_folder.h"

namespace evolin::cli {
namespace {

using test::handTruth;
using test::kSecond;
using test::kSide;
using test::line;
using test::lineSet;

/// `right` of the two annotated lines, and `wrong` far from both.
LineSet linesOf(Stamp stamp, int right, int wrong) {
  LineSegments lines = handTruth(stamp).lines;
  lines.resize(static_cast<std::size_t>(right));
  for (int i = 0; i < wrong; ++i) {
    lines.push_back(line(5 + i, 100, 30 + i, 120));
  }
  return lineSet(stamp, "detector", lines);
}

ImagePart imageOf(Stamp stamp, int scale = 1) {
  ImagePart image;
  image.frame.stamp = stamp;
  image.frame.image = cv::Mat(kSide * scale, kSide * scale, CV_8UC1, cv::Scalar(90));
  return image;
}

void give(WorstFrames* frames, Stamp stamp, int right, int wrong, bool truth_first = true) {
  if (truth_first) {
    frames->takeGroundTruth(handTruth(stamp));
  }
  frames->takeLines(linesOf(stamp, right, wrong), imageOf(stamp));
  if (!truth_first) {
    frames->takeGroundTruth(handTruth(stamp));
  }
}

std::vector<std::string> rowsOf(const WorstFrames& frames, const std::filesystem::path& folder) {
  frames.write(folder);
  std::ifstream file(folder / "worst_frames.csv");
  std::vector<std::string> rows;
  for (std::string row; std::getline(file, row);) {
    rows.push_back(row);
  }
  return rows;
}

TEST(WorstFrames, AreThoseWithTheLowestFScoreFromTheWorstOn) {
  WorstFrames frames(3, {});
  give(&frames, 1 * kSecond, 2, 0);         // F 1
  give(&frames, 2 * kSecond, 1, 1);         // F 0.5
  give(&frames, 3 * kSecond, 0, 2, false);  // F 0
  give(&frames, 4 * kSecond, 1, 5, false);  // F 0.25
  give(&frames, 5 * kSecond, 2, 1);         // F 0.8
  const test::TemporaryFolder folder;
  EXPECT_EQ(rowsOf(frames, folder.path()),
            (std::vector<std::string>{
                "stamp,file,distance,threshold,f_score,true_positives,false_positives,misses",
                "3.000000,worst_frames/1.jpg,structural,5,0,0,2,2",
                "4.000000,worst_frames/2.jpg,structural,5,0.25,1,5,1",
                "2.000000,worst_frames/3.jpg,structural,5,0.5,1,1,1"}));
  const cv::Mat picture = cv::imread((folder.path() / "worst_frames" / "1.jpg").string());
  EXPECT_EQ(picture.size(), cv::Size(kSide, kSide));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "worst_frames" / "4.jpg"));
}

TEST(WorstFrames, OfEqualsTheEarlierOnesStay) {
  WorstFrames frames(2, {});
  for (const Stamp second : {4, 1, 3, 2}) {
    give(&frames, second * kSecond, 1, 1);
  }
  const test::TemporaryFolder folder;
  const std::vector<std::string> rows = rowsOf(frames, folder.path());
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[1].rfind("1.000000,", 0), 0U) << rows[1];
  EXPECT_EQ(rows[2].rfind("2.000000,", 0), 0U) << rows[2];
}

TEST(WorstFrames, OfNoneThereIsNoFile) {
  const test::TemporaryFolder folder;
  WorstFrames nobody_asked(0, {});
  give(&nobody_asked, kSecond, 0, 1);
  EXPECT_TRUE(rowsOf(nobody_asked, folder.path()).empty());
  WorstFrames no_truth(2, {});
  no_truth.takeLines(linesOf(kSecond, 1, 1), imageOf(kSecond));
  EXPECT_TRUE(rowsOf(no_truth, folder.path()).empty());
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(WorstFrames, AFrameThatCannotBeJudgedIsNoneOfThem) {
  WorstFrames frames(2, {});
  frames.takeGroundTruth(lineSet(kSecond, "ground_truth", {line(10, 10, 10, 10)}));
  frames.takeLines(linesOf(kSecond, 0, 1), imageOf(kSecond));
  give(&frames, 2 * kSecond, 1, 1);
  const test::TemporaryFolder folder;
  const std::vector<std::string> rows = rowsOf(frames, folder.path());
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[1].rfind("2.000000,", 0), 0U) << rows[1];
}

TEST(WorstFrames, PicturesOfLargeImagesAreSmaller) {
  WorstFrames frames(1, {});
  frames.takeGroundTruth(handTruth(kSecond));
  frames.takeLines(linesOf(kSecond, 1, 0), imageOf(kSecond, 10));
  const test::TemporaryFolder folder;
  frames.write(folder.path());
  const cv::Mat picture = cv::imread((folder.path() / "worst_frames" / "1.jpg").string());
  EXPECT_EQ(picture.size(), cv::Size(640, 640));
}

TEST(WorstFrames, LinesWhoseGroundTruthNeverComesDoNotPileUp) {
  WorstFrames frames(1, {});
  for (Stamp second = 1; second <= 1000; ++second) {
    frames.takeLines(linesOf(second * kSecond, 1, 1), imageOf(second * kSecond));
  }
  // The oldest were given up, the newest still wait.
  frames.takeGroundTruth(handTruth(kSecond));
  const test::TemporaryFolder folder;
  EXPECT_TRUE(rowsOf(frames, folder.path()).empty());
  frames.takeGroundTruth(handTruth(1000 * kSecond));
  EXPECT_EQ(rowsOf(frames, folder.path()).size(), 2U);
}

}  // namespace
}  // namespace evolin::cli
