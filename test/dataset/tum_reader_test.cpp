// TUM RGB-D folders: pairing by time, windows, and what the reader refuses.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <string>

#include "evolin_ros/dataset/sequence_reader.h"
#include "small_sequence.h"
#include "test/support/expect_error.h"
#include "test/support/shared_data.h"
#include "test/support/temporary_folder.h"

namespace evolin {
namespace {

using test::expectError;
using test::readAll;
using test::TemporaryFolder;
using test::writeDepth;
using test::writeImage;

// Three images at 10.0, 10.1 and 10.2 s.
class TumFolder : public TemporaryFolder {
 public:
  TumFolder() {
    write("rgb.txt", "# color images\n10.0 rgb/a.png\n10.1 rgb/b.png\n10.2 rgb/c.png\n");
    writeImage(path() / "rgb/a.png", 1);
    writeImage(path() / "rgb/b.png", 2);
    writeImage(path() / "rgb/c.png", 3);
  }
  void listDepth(const std::string& text) const {
    write("depth.txt", text);
    for (const char* name : {"a", "b", "c"}) {
      writeDepth(path() / "depth" / (std::string(name) + ".png"));
    }
  }
};

TEST(TumReader, GivesFramesWithoutDepthPoseAndCameraWhereThereAreNone) {
  const TumFolder folder;
  const auto reader = openSequence(folder.path(), {});
  EXPECT_EQ(reader->layout(), Layout::kTum);
  EXPECT_EQ(reader->size(), 3U);
  EXPECT_EQ(reader->poseRule(), "none");
  const std::vector<SequenceFrame> frames = readAll(reader.get());
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_EQ(frames[1].frame.stamp, 10100000000);
  EXPECT_EQ(frames[1].frame.name, "b");
  EXPECT_EQ(frames[1].image_file, "rgb/b.png");
  EXPECT_EQ(frames[1].frame.image.at<cv::Vec3b>(0, 0)[0], 2);
  EXPECT_TRUE(frames[1].frame.depth.empty());
  EXPECT_FALSE(frames[1].frame.pose || frames[1].frame.camera || frames[1].ground_truth);
  EXPECT_EQ(reader->counts().frames, 3U);
  EXPECT_EQ(reader->counts().missing_depths, 3U);
  EXPECT_EQ(reader->counts().missing_poses, 3U);
  EXPECT_EQ(reader->counts().missing_images, 0U);
  EXPECT_EQ(reader->counts().missing_ground_truth, 3U);
}

TEST(TumReader, PairsDepthWithinTwentyMilliseconds) {
  const TumFolder folder;
  folder.listDepth("9.98 depth/a.png\n10.121 depth/b.png\n10.205 depth/c.png\n");
  const std::vector<SequenceFrame> frames = readAll(folder.path());
  ASSERT_TRUE(frames[0].depth_stamp.has_value());
  EXPECT_EQ(*frames[0].depth_stamp, 9980000000);
  EXPECT_EQ(frames[0].frame.depth.at<float>(0, 0), 1.0F);
  EXPECT_FALSE(frames[1].depth_stamp.has_value());
  EXPECT_TRUE(frames[1].frame.depth.empty());
  EXPECT_EQ(*frames[2].depth_stamp, 10205000000);
}

TEST(TumReader, UsesEachDepthOnceAndServesTheClosestPairFirst) {
  const TumFolder folder;
  folder.write("rgb.txt", "10.000 rgb/a.png\n10.010 rgb/b.png\n10.030 rgb/c.png\n");
  // The depth at 10.012 is nearest to b; a must not take it, and falls back on nothing else.
  folder.listDepth("10.012 depth/a.png\n10.018 depth/b.png\n");
  const std::vector<SequenceFrame> frames = readAll(folder.path());
  EXPECT_EQ(frames[1].depth_stamp, std::optional<Stamp>(10012000000));
  EXPECT_EQ(frames[2].depth_stamp, std::optional<Stamp>(10018000000));
  EXPECT_FALSE(frames[0].depth_stamp.has_value());
}

TEST(TumReader, InterpolatesPosesByTime) {
  const TumFolder folder;
  folder.write("groundtruth.txt", "10.05 0 0 0 0 0 0 1\n10.15 1 0 0 0 0 0 1\n10.2 2 0 0 0 0 0 1\n");
  const auto reader = openSequence(folder.path(), {});
  EXPECT_EQ(reader->poseRule(), "by stamp, interpolated");
  const std::vector<SequenceFrame> frames = readAll(reader.get());
  EXPECT_FALSE(frames[0].frame.pose.has_value());
  ASSERT_TRUE(frames[1].frame.pose.has_value());
  EXPECT_NEAR(frames[1].frame.pose->translation.x(), 0.5, 1e-12);
  EXPECT_EQ(frames[2].frame.pose->translation.x(), 2);
  EXPECT_EQ(reader->counts().missing_poses, 1U);
}

TEST(TumReader, RefusesAPoseOffset) {
  const TumFolder folder;
  SequenceOptions options;
  options.pose_offset = -1;
  expectError([&] { openSequence(folder.path(), options); }, {"pose offset -1", "by time"});
  options.pose_offset = 0;
  EXPECT_NO_THROW(openSequence(folder.path(), options));
}

TEST(TumReader, NamesListAndLineOfAMissingImage) {
  const TumFolder folder;
  std::filesystem::remove(folder.path() / "rgb/b.png");
  const auto reader = openSequence(folder.path(), {});
  EXPECT_TRUE(reader->next().has_value());
  expectError<ParseError>([&] { reader->next(); },
                          {"rgb.txt:3", "rgb/b.png", "does not exist", "--allow-missing"});
}

TEST(TumReader, SkipsAndCountsMissingImagesWhenAllowed) {
  const TumFolder folder;
  std::filesystem::remove(folder.path() / "rgb/a.png");
  folder.write("rgb/c.png", "broken");
  SequenceOptions options;
  options.allow_missing = true;
  const auto reader = openSequence(folder.path(), options);
  const std::vector<SequenceFrame> frames = readAll(reader.get());
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].frame.name, "b");
  EXPECT_EQ(reader->counts().missing_images, 2U);
  EXPECT_EQ(reader->counts().frames, 1U);
}

TEST(TumReader, TreatsMissingDepthFilesLikewise) {
  const TumFolder folder;
  folder.listDepth("10.0 depth/a.png\n10.1 depth/gone.png\n10.2 depth/c.png\n");
  SequenceOptions options;
  const auto strict = openSequence(folder.path(), options);
  EXPECT_TRUE(strict->next().has_value());
  expectError<ParseError>([&] { strict->next(); },
                          {"depth.txt:2", "depth/gone.png", "--allow-missing"});
  options.allow_missing = true;
  const auto lenient = openSequence(folder.path(), options);
  const std::vector<SequenceFrame> frames = readAll(lenient.get());
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_TRUE(frames[1].frame.depth.empty());
  EXPECT_FALSE(frames[1].depth_stamp.has_value());
  EXPECT_EQ(lenient->counts().missing_depths, 1U);
}

TEST(TumReader, NamesATruncatedPng) {
  const TumFolder folder;
  std::ifstream stream(folder.path() / "rgb/a.png", std::ios::binary);
  const std::string content{std::istreambuf_iterator<char>(stream),
                            std::istreambuf_iterator<char>()};
  folder.write("rgb/a.png", content.substr(0, content.size() - 6));
  const auto reader = openSequence(folder.path(), {});
  expectError<ParseError>([&] { reader->next(); }, {"rgb/a.png", "truncated"});
}

TEST(TumReader, RefusesDepthOfAnotherSize) {
  const TumFolder folder;
  folder.listDepth("10.0 depth/a.png\n");
  writeDepth(folder.path() / "depth/a.png", 5000, cv::Size(4, 3));
  const auto reader = openSequence(folder.path(), {});
  expectError<ParseError>([&] { reader->next(); }, {"depth/a.png", "4 x 3", "8 x 6"});
}

TEST(TumReader, RefusesStampsThatDoNotIncrease) {
  const TumFolder folder;
  folder.write("rgb.txt", "10.1 rgb/a.png\n10.0 rgb/b.png\n");
  expectError<ParseError>([&] { openSequence(folder.path(), {}); }, {"rgb.txt:2", "increas"});
}

TEST(TumReader, RefusesAQuaternionOfZeroNorm) {
  const TumFolder folder;
  folder.write("groundtruth.txt", "10 0 0 0 0 0 0 0\n");
  expectError<ParseError>([&] { openSequence(folder.path(), {}); },
                          {"groundtruth.txt:1", "0 0 0 0", "non-zero norm"});
}

TEST(TumReader, RefusesAListWithoutImages) {
  const TemporaryFolder folder;
  folder.write("rgb.txt", "# nothing\n");
  expectError<ParseError>([&] { openSequence(folder.path(), {}); }, {"rgb.txt", "no image"});
}

TEST(TumReader, GivesTheCameraAskedFor) {
  const TumFolder folder;
  folder.write("small.yaml",
               "{width: 8, height: 6, fx: 10, fy: 10, cx: 4, cy: 3, "
               "depth_factor: 1000}\n");
  folder.listDepth("10.0 depth/a.png\n");
  SequenceOptions options;
  options.camera = (folder.path() / "small.yaml").string();
  const std::vector<SequenceFrame> frames = readAll(folder.path(), options);
  ASSERT_TRUE(frames[0].frame.camera.has_value());
  EXPECT_EQ(frames[0].frame.camera->fx, 10);
  EXPECT_EQ(frames[0].frame.depth.at<float>(0, 0), 5.0F);
  options.camera = "tum_fr1";
  options.camera_folder = test::cameraFolder();
  const auto reader = openSequence(folder.path(), options);
  expectError<ParseError>([&] { reader->next(); }, {"rgb/a.png", "8 x 6", "640 x 480", "tum_fr1"});
}

TEST(SequenceWindow, TakesStartAndDurationFromTheFirstImage) {
  const TumFolder folder;
  SequenceOptions options;
  options.start = 0.1;
  EXPECT_EQ(readAll(folder.path(), options).front().frame.name, "b");
  options.duration = 0.1;
  const std::vector<SequenceFrame> frames = readAll(folder.path(), options);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].frame.name, "b");
  EXPECT_EQ(openSequence(folder.path(), options)->size(), 1U);
}

TEST(SequenceWindow, RefusesWhatHoldsNoImage) {
  const TumFolder folder;
  SequenceOptions options;
  options.start = 0.3;
  expectError([&] { openSequence(folder.path(), options); }, {"start is 0.3", "0.2 s"});
  options.start = 0.05;
  options.duration = 0.01;
  expectError([&] { openSequence(folder.path(), options); }, {"no image between"});
  options.start = -1;
  expectError([&] { openSequence(folder.path(), options); }, {"start is -1"});
  options.start = 0;
  options.duration = 0;
  expectError([&] { openSequence(folder.path(), options); }, {"duration is 0"});
}

TEST(SequenceAnnotations, PairByStemOrByStamps) {
  const TumFolder folder;
  folder.write("by_stem/b.csv", "0,1,2,3\n");
  SequenceOptions options;
  options.ground_truth = folder.path() / "by_stem";
  const auto reader = openSequence(folder.path(), options);
  std::vector<SequenceFrame> frames = readAll(reader.get());
  EXPECT_FALSE(frames[0].ground_truth.has_value());
  ASSERT_TRUE(frames[1].ground_truth.has_value());
  EXPECT_EQ(frames[1].ground_truth->at(0).y2, 3);
  EXPECT_EQ(reader->counts().missing_ground_truth, 2U);

  folder.write("by_time/gt_lines/0000.csv", "0,1,2,3\n4,5,6,7\n");
  folder.write("by_time/stamps.txt", "10.2009 rgb/0000.png\n");
  options.ground_truth = folder.path() / "by_time";
  frames = readAll(folder.path(), options);
  ASSERT_TRUE(frames[2].ground_truth.has_value());
  EXPECT_EQ(frames[2].ground_truth->size(), 2U);
}

TEST(SequenceAnnotations, MustBelongToSomeImage) {
  const TumFolder folder;
  folder.write("gt_lines/0000.csv", "0,1,2,3\n");
  expectError([&] { openSequence(folder.path(), {}); },
              {"gt_lines", "stem", "0000.csv", "rgb/a.png"});
  folder.write("gt_lines/stamps.txt", "20 0000.csv\n");
  expectError([&] { openSequence(folder.path(), {}); }, {"stamps.txt", "0.001 s", "20.0", "10.0"});
}

TEST(OpenSequence, SaysWhatItLookedFor) {
  const TemporaryFolder folder;
  expectError([&] { openSequence(folder.path() / "none", {}); }, {"none", "not a folder"});
  const std::string tum = "rgb.txt";
  expectError([&] { openSequence(folder.path(), {}); },
              {"the folder is empty", tum, "associations*.txt", "images/ or rgb/"});
  folder.write("readme.txt", "x");
  expectError([&] { openSequence(folder.path(), {}); }, {"the layout is unknown", tum});
  SequenceOptions options;
  options.layout = Layout::kTum;
  expectError([&] { openSequence(folder.path(), options); }, {tum});
  options.layout = Layout::kIcl;
  expectError([&] { openSequence(folder.path(), options); }, {"associations*.txt"});
  options.layout = Layout::kEvolin;
  expectError([&] { openSequence(folder.path(), options); }, {"images/ or rgb/"});
}

TEST(Layout, GoesToTextAndBack) {
  for (const Layout layout : {Layout::kAuto, Layout::kTum, Layout::kIcl, Layout::kEvolin}) {
    EXPECT_EQ(parseLayout(toString(layout)), layout);
  }
  expectError([] { parseLayout("kitti"); }, {"kitti", "auto, tum, icl or evolin"});
}

TEST(TumReader, ReadsTheSparseRealSampleWithAPoseOnEveryImage) {
  EVOLIN_REQUIRE_SHARED_DATA();
  SequenceOptions options;
  options.camera = "tum_fr3";
  options.camera_folder = test::cameraFolder();
  const auto reader = openSequence(test::sharedFolder() / "data/tum_fr3_cabinet_sample", options);
  const std::vector<SequenceFrame> frames = readAll(reader.get());
  ASSERT_EQ(frames.size(), 58U);
  EXPECT_EQ(reader->counts().missing_poses, 0U);
  EXPECT_EQ(reader->counts().missing_depths, 0U);
  EXPECT_NEAR(frames[0].frame.pose->translation.x(), -2.5508, 1e-12);
  EXPECT_EQ(frames[0].frame.name, "1341841278.8427");
  for (const SequenceFrame& frame : frames) {
    EXPECT_EQ(frame.frame.image.type(), CV_8UC3);
    EXPECT_EQ(frame.frame.depth.size(), cv::Size(640, 480));
    EXPECT_EQ(frame.depth_stamp, std::optional<Stamp>(frame.frame.stamp));
  }
}

TEST(TumReader, TellsOfTheBrokenDownloadAndReadsWhatIsThere) {
  EVOLIN_REQUIRE_SHARED_DATA();
  const std::filesystem::path folder = test::sharedFolder() / "data/tum_fr1_desk_sample";
  const auto strict = openSequence(folder, {});
  EXPECT_EQ(strict->size(), 613U);
  expectError<ParseError>([&] { strict->next(); },
                          {"rgb.txt:4", "rgb/1305031452.791720.png", "--allow-missing"});
  SequenceOptions options;
  options.allow_missing = true;
  const auto reader = openSequence(folder, options);
  const std::vector<SequenceFrame> frames = readAll(reader.get());
  ASSERT_EQ(frames.size(), 9U);
  EXPECT_EQ(reader->counts().missing_images, 604U);
  EXPECT_EQ(reader->counts().missing_poses, 0U);
  EXPECT_EQ(reader->counts().missing_depths, 0U);
  EXPECT_EQ(*frames[0].depth_stamp, 1305031453374112000);
}

}  // namespace
}  // namespace evolin
