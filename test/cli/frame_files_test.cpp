// Which depth image and which pose belong to which line file, and what does not fit together.
#include "frame_files.h"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "evolin_ros/base/error.h"
#include "test/support/expect_error.h"
#include "test/support/temporary_folder.h"

namespace evolin::cli {
namespace {

using test::expectError;

std::string posesOf(int count) {
  std::string text;
  for (int row = 0; row < count; ++row) {
    text += "0 " + std::to_string(row) + " 0 0 0 0 0 1\n";
  }
  return text;
}

/// Five line files and five depth images of the same names; pose row k lies at x = k.
class FrameFilesTest : public ::testing::Test {
 protected:
  void SetUp() override {
    for (int frame = 0; frame < 5; ++frame) {
      const std::string stem = "000" + std::to_string(frame);
      folder_.write("lines/" + stem + ".csv", "1,2,3,4\n");
      folder_.write("depth/" + stem + ".png", "");
    }
    folder_.write("poses.txt", posesOf(5));
    folder_.write("list.txt", "0 0\n1 1\n2 2\n3 3\n4 4\n");
  }

  FrameFolders folders(int pose_offset = 0) const {
    FrameFolders folders;
    folders.lines = (folder_.path() / "lines").string();
    folders.depths = (folder_.path() / "depth").string();
    folders.depth_associations = (folder_.path() / "list.txt").string();
    folders.poses = (folder_.path() / "poses.txt").string();
    folders.pose_offset = pose_offset;
    return folders;
  }

  /// "0000 0000 0, ...": stem, stem of the depth and pose row of every frame; "-": none.
  std::string listed(int pose_offset = 0) const {
    std::string text;
    for (const FrameFiles& frame : listFrames(folders(pose_offset)).frames) {
      text += text.empty() ? "" : ", ";
      text += frame.stem + " " + (frame.depth.empty() ? "-" : frame.depth.stem().string()) + " ";
      text += frame.pose ? std::to_string(static_cast<int>(frame.pose->translation.x())) : "-";
    }
    return text;
  }

  void expectRefused(std::initializer_list<std::string> words, int pose_offset = 0) const {
    expectError<Error>([&] { listFrames(folders(pose_offset)); }, words);
  }

  void remove(const std::string& name) const { std::filesystem::remove(folder_.path() / name); }

  test::TemporaryFolder folder_;
};

TEST_F(FrameFilesTest, JoinsByPlace) {
  EXPECT_EQ(listed(), "0000 0000 0, 0001 0001 1, 0002 0002 2, 0003 0003 3, 0004 0004 4");
  EXPECT_FALSE(listFrames(folders()).by_depth_list);
}

TEST_F(FrameFilesTest, OffsetsShiftPosesAlone) {
  EXPECT_EQ(listed(-1), "0000 0000 -, 0001 0001 0, 0002 0002 1, 0003 0003 2, 0004 0004 3");
  folder_.write("poses.txt", posesOf(6));
  EXPECT_EQ(listed(1), "0000 0000 1, 0001 0001 2, 0002 0002 3, 0003 0003 4, 0004 0004 5");
  folder_.write("poses.txt", posesOf(4));
  EXPECT_EQ(listed(-1), "0000 0000 -, 0001 0001 0, 0002 0002 1, 0003 0003 2, 0004 0004 3");
}

TEST_F(FrameFilesTest, AFrameThatTheListDoesNotNameHasNoDepth) {
  folder_.write("list.txt", "0 0\n1 1\n3 3\n4 4\n");
  EXPECT_EQ(listed(), "0000 0000 0, 0001 0001 1, 0002 - 2, 0003 0003 3, 0004 0004 4");
}

TEST_F(FrameFilesTest, FramesAreTheRowsOfTheListWherePosesAre) {
  folder_.write("list.txt", "0 0\n1 1\n3 2\n4 4\n");
  folder_.write("poses.txt", posesOf(4));
  EXPECT_EQ(listed(), "0000 0000 0, 0001 0001 1, 0003 0002 2, 0004 0004 3");
  EXPECT_TRUE(listFrames(folders()).by_depth_list);
}

TEST_F(FrameFilesTest, MoreDepthImagesThanLinesAreFine) {
  remove("lines/0004.csv");
  remove("lines/0003.csv");
  folder_.write("list.txt", "0 0\n1 2\n2 4\n");
  folder_.write("poses.txt", posesOf(3));
  EXPECT_EQ(listed(), "0000 0000 0, 0001 0002 1, 0002 0004 2");
}

TEST_F(FrameFilesTest, AnotherNumberOfPosesIsRefusedWithTheCounts) {
  folder_.write("poses.txt", posesOf(4));
  expectRefused({"poses.txt: 4 poses", "5 line files", "lines"});
  folder_.write("poses.txt", posesOf(6));
  expectRefused({"poses.txt: 6 poses", "5 line files"});
  expectRefused({"6 poses", "1 fewer (--pose-offset -1)"}, -1);
  folder_.write("poses.txt", "");
  expectRefused({"poses.txt: 0 poses"});
  folder_.write("list.txt", "0 0\n1 1\n2 2\n");
  folder_.write("poses.txt", posesOf(4));
  expectRefused({"4 poses", "5 line files", "3 rows of", "list.txt"});
}

TEST_F(FrameFilesTest, AMissingLineFileIsNoShift) {
  remove("lines/0002.csv");
  expectRefused({"list.txt:5", "image index", "'4'", "4 line files", "5 depth images"});
  folder_.write("list.txt", "0 0\n1 1\n2 2\n3 3\n");
  expectRefused({"list.txt:3", "lines/0003.csv", "depth/0002.png", "place 2", "4 line files"});
}

TEST_F(FrameFilesTest, AMissingDepthImageIsNoShift) {
  remove("depth/0001.png");
  expectRefused({"list.txt:5", "depth index", "'4'", "5 line files", "4 depth images"});
  folder_.write("list.txt", "0 0\n1 1\n2 2\n3 3\n");
  expectRefused({"list.txt:2", "lines/0001.csv", "depth/0002.png", "equal names"});
}

TEST_F(FrameFilesTest, NamesThatTheFoldersDoNotShareSayNothing) {
  for (int frame = 0; frame < 5; ++frame) {
    std::filesystem::rename(folder_.path() / ("depth/000" + std::to_string(frame) + ".png"),
                            folder_.path() / ("depth/13.5" + std::to_string(frame) + ".png"));
  }
  EXPECT_EQ(listed(), "0000 13.50 0, 0001 13.51 1, 0002 13.52 2, 0003 13.53 3, 0004 13.54 4");
}

TEST_F(FrameFilesTest, ListsGoUpAndAreNotEmpty) {
  folder_.write("list.txt", "0 0\n2 2\n1 1\n3 3\n4 4\n");
  expectRefused({"list.txt:3", "image index 1 comes after 2"});
  folder_.write("list.txt", "# image depth\n");
  expectRefused({"list.txt: has no rows"});
}

TEST_F(FrameFilesTest, NumbersInAnotherOrderThanByValueAreRefused) {
  for (int frame = 0; frame < 5; ++frame) {
    std::filesystem::rename(folder_.path() / ("lines/000" + std::to_string(frame) + ".csv"),
                            folder_.path() / ("lines/" + std::to_string(8 + frame) + ".csv"));
  }
  expectRefused({"lines", "8 stands behind 12"});
}

TEST_F(FrameFilesTest, ScoresOfOtherStemsAreRefused) {
  folder_.write("scores/0000.csv", "1\n");
  FrameFolders scored = folders();
  scored.scores = (folder_.path() / "scores").string();
  expectError<Error>([&] { listFrames(scored); }, {"scores", "0001", "5 lines, 1 scores"});
}

TEST(DepthImages, AreOfOneSize) {
  const test::TemporaryFolder folder;
  std::vector<FrameFiles> frames(3);
  for (std::size_t index = 1; index < frames.size(); ++index) {
    frames[index].depth = folder.path() / (std::to_string(index) + ".png");
    cv::imwrite(frames[index].depth.string(), cv::Mat(48, 64, CV_16UC1, cv::Scalar(1000)));
  }
  EXPECT_EQ(DepthImages(frames, 500).read(frames[2]).at(3, 4), 2.0);
  cv::imwrite(frames[2].depth.string(), cv::Mat(24, 32, CV_16UC1, cv::Scalar(1000)));
  const DepthImages images(frames, 500);
  expectError<Error>([&] { images.read(frames[2]); }, {"2.png", "32 x 24", "64 x 48", "1.png"});
}

}  // namespace
}  // namespace evolin::cli
