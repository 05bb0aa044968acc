// ICL-NUIM folders: associations in both orders, poses by number, stamps from numbers.
#include <gtest/gtest.h>

#include <string>

#include "evolin_ros/dataset/sequence_reader.h"
#include "small_sequence.h"
#include "test/support/expect_error.h"
#include "test/support/temporary_folder.h"

namespace evolin {
namespace {

using test::expectError;
using test::readAll;
using test::TemporaryFolder;
using test::writeDepth;
using test::writeImage;

// Images 0, 1, 2 with depth; poses 1, 2, 3 whose x is their number.
class IclFolder : public TemporaryFolder {
 public:
  IclFolder() {
    write("associations.txt",
          "0 depth/0.png 0 rgb/0.png\n1 depth/1.png 1 rgb/1.png\n2 depth/2.png 2 rgb/2.png\n");
    write("livingRoom.gt.freiburg", "1 1 0 0 0 0 0 1\n2 2 0 0 0 0 0 1\n3 3 0 0 0 0 0 1\n");
    for (const char* name : {"0.png", "1.png", "2.png"}) {
      writeImage(path() / "rgb" / name);
      writeDepth(path() / "depth" / name);
    }
  }
};

TEST(IclReader, PairsPosesByNumberSoThatImageZeroHasNone) {
  const IclFolder folder;
  const auto reader = openSequence(folder.path(), {});
  EXPECT_EQ(reader->layout(), Layout::kIcl);
  EXPECT_EQ(reader->poseRule(), "by frame number");
  const std::vector<SequenceFrame> frames = readAll(reader.get());
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_FALSE(frames[0].frame.pose.has_value());
  EXPECT_EQ(frames[1].frame.pose->translation.x(), 1);
  EXPECT_EQ(frames[2].frame.pose->translation.x(), 2);
  EXPECT_EQ(reader->counts().missing_poses, 1U);
}

TEST(IclReader, PairsPosesByRowWhenAnOffsetIsGiven) {
  const IclFolder folder;
  SequenceOptions options;
  options.pose_offset = 0;
  std::vector<SequenceFrame> frames = readAll(folder.path(), options);
  EXPECT_EQ(frames[0].frame.pose->translation.x(), 1);
  options.pose_offset = -1;
  EXPECT_EQ(openSequence(folder.path(), options)->poseRule(),
            "by row, image i takes pose row i - 1");
  frames = readAll(folder.path(), options);
  EXPECT_FALSE(frames[0].frame.pose.has_value());
  EXPECT_EQ(frames[2].frame.pose->translation.x(), 2);
  options.pose_offset = 2;
  frames = readAll(folder.path(), options);
  EXPECT_EQ(frames[0].frame.pose->translation.x(), 3);
  EXPECT_FALSE(frames[1].frame.pose.has_value());
}

TEST(IclReader, StampsFramesAtThirtyHertzToTheNanosecond) {
  const IclFolder folder;
  const std::vector<SequenceFrame> frames = readAll(folder.path());
  EXPECT_EQ(frames[0].frame.stamp, 1000000000);
  EXPECT_EQ(frames[1].frame.stamp, 1033333333);
  EXPECT_EQ(frames[2].frame.stamp, 1066666667);
  EXPECT_EQ(frames[2].depth_stamp, std::optional<Stamp>(1066666667));
}

TEST(IclReader, TakesTheNumberForTheStampWhereNumbersIncrease) {
  const IclFolder folder;
  folder.write("associations.txt", "3 depth/0.png 3 rgb/0.png\n31 depth/1.png 30 rgb/1.png\n");
  std::vector<SequenceFrame> frames = readAll(folder.path());
  EXPECT_EQ(frames[0].frame.stamp, 1100000000);
  EXPECT_EQ(frames[0].frame.pose->translation.x(), 3);
  EXPECT_EQ(frames[1].frame.stamp, 2000000000);
  EXPECT_EQ(frames[1].depth_stamp, std::optional<Stamp>(2033333333));
  folder.write("associations.txt", "3 depth/0.png 3 rgb/0.png\n3 depth/1.png 3 rgb/1.png\n");
  frames = readAll(folder.path());
  EXPECT_EQ(frames[0].frame.stamp, 1000000000);
  EXPECT_EQ(frames[1].frame.stamp, 1033333333);
  EXPECT_EQ(frames[1].frame.pose->translation.x(), 3);
}

TEST(IclReader, TellsTheColumnsByTheFolderOfTheFile) {
  const IclFolder folder;
  folder.write("associations.txt", "# rgb first\n1 ./rgb/1.png 1 ./depth/1.png\n");
  const std::vector<SequenceFrame> frames = readAll(folder.path());
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].image_file, "rgb/1.png");
  EXPECT_EQ(frames[0].frame.name, "1");
  EXPECT_FALSE(frames[0].frame.depth.empty());
}

TEST(IclReader, DoesWithoutATrajectory) {
  const IclFolder folder;
  std::filesystem::remove(folder.path() / "livingRoom.gt.freiburg");
  const auto reader = openSequence(folder.path(), {});
  EXPECT_EQ(reader->layout(), Layout::kIcl);
  EXPECT_EQ(reader->poseRule(), "none");
  EXPECT_FALSE(readAll(reader.get())[1].frame.pose.has_value());
}

TEST(IclReader, TakesTheNegativeFocalLengthFromTheCamera) {
  const TemporaryFolder folder;
  folder.write("associations.txt", "0 depth/0.png 0 rgb/0.png\n");
  writeImage(folder.path() / "rgb/0.png", 9, cv::Size(640, 480));
  writeDepth(folder.path() / "depth/0.png", 5000, cv::Size(640, 480));
  SequenceOptions options;
  options.camera = "icl";
  options.camera_folder = test::cameraFolder();
  EXPECT_EQ(readAll(folder.path(), options).at(0).frame.camera->fy, -480);
}

TEST(IclReader, NamesFileLineAndValueOfWhatIsWrong) {
  const IclFolder folder;
  const struct {
    std::string row;
    std::string said;
  } cases[] = {{"1 depth/1.png 1", "3 fields"},
               {"1 depth/1.png 1 depth/1.png", "two files of depth/"},
               {"1 rgb/1.png 1 rgb/1.png", "no file of depth/"},
               {"one depth/1.png 1 rgb/1.png", "one"},
               {"1 depth/1.png -1 rgb/1.png", "-1"},
               {"1 depth/1.png 99999999999 rgb/1.png", "99999999999"}};
  for (const auto& bad : cases) {
    folder.write("associations.txt", "0 depth/0.png 0 rgb/0.png\n" + bad.row + "\n");
    expectError<ParseError>([&] { openSequence(folder.path(), {}); },
                            {"associations.txt:2", bad.said});
  }
  folder.write("associations.txt", "");
  expectError<ParseError>([&] { openSequence(folder.path(), {}); }, {"lists no image"});
}

TEST(IclReader, NamesListAndLineOfMissingFiles) {
  const IclFolder folder;
  std::filesystem::remove(folder.path() / "rgb/1.png");
  std::filesystem::remove(folder.path() / "depth/2.png");
  SequenceOptions options;
  options.allow_missing = true;
  const auto lenient = openSequence(folder.path(), options);
  EXPECT_EQ(readAll(lenient.get()).size(), 2U);
  EXPECT_EQ(lenient->counts().missing_images, 1U);
  EXPECT_EQ(lenient->counts().missing_depths, 1U);
  const auto strict = openSequence(folder.path(), {});
  EXPECT_TRUE(strict->next().has_value());
  expectError<ParseError>([&] { strict->next(); }, {"associations.txt:2", "rgb/1.png"});
}

TEST(IclReader, WantsOneTrajectoryAndOneList) {
  const IclFolder folder;
  folder.write("other.gt.freiburg", "1 1 0 0 0 0 0 1\n");
  expectError([&] { openSequence(folder.path(), {}); }, {"several", "other.gt.freiburg"});
  std::filesystem::remove(folder.path() / "other.gt.freiburg");
  folder.write("associations_b.txt", "0 depth/0.png 0 rgb/0.png\n");
  EXPECT_EQ(openSequence(folder.path(), {})->size(), 3U);
  std::filesystem::remove(folder.path() / "associations.txt");
  EXPECT_EQ(openSequence(folder.path(), {})->size(), 1U);
  std::filesystem::remove(folder.path() / "associations_b.txt");
  expectError([&] { openSequence(folder.path(), {}); },
              {"livingRoom.gt.freiburg", "no associations*.txt"});
}

}  // namespace
}  // namespace evolin
