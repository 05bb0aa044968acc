// EVOLIN folders written and read back.
#include "evolin_ros/dataset/evolin_writer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "evolin_ros/dataset/csv.h"
#include "test/support/expect_error.h"
#include "test/support/temporary_folder.h"

namespace evolin {
namespace {

using test::expectError;
using test::TemporaryFolder;

/// 4 x 3, colours and depths of its own, one line an id.
SequenceFrame makeFrame(int number, const std::vector<std::int64_t>& ids) {
  SequenceFrame frame;
  frame.frame.stamp = kNanosecondsPerSecond + number * 100000007;
  frame.frame.image = cv::Mat(3, 4, CV_8UC3, cv::Scalar(number, 2 * number, 200));
  frame.frame.depth = cv::Mat(3, 4, CV_32FC1, cv::Scalar(1.5 + number));
  frame.frame.depth.at<float>(0, 1) = std::nanf("");
  frame.frame.depth.at<float>(0, 2) = 14;  // beyond 16 bits at 5000 a metre
  frame.frame.depth.at<float>(1, 1) = 2.00011F;
  Camera camera;
  camera.width = 4;
  camera.height = 3;
  camera.fx = 3.125;
  camera.fy = 3.25;
  camera.cx = 1.5;
  camera.cy = 1;
  frame.frame.camera = camera;
  Pose pose;
  pose.translation = {0.1 * number, 1.0 / 3, -2};
  pose.rotation = Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5);
  frame.frame.pose = pose;
  LineSegments lines;
  for (const std::int64_t id : ids) {
    LineSegment line{0.1 + static_cast<double>(id), 0, 1.0 / 3, 2};
    line.id = id;
    lines.push_back(line);
  }
  frame.ground_truth = lines;
  return frame;
}

std::vector<SequenceFrame> readBack(const std::filesystem::path& folder) {
  const std::unique_ptr<SequenceReader> reader = openSequence(folder, {});
  std::vector<SequenceFrame> frames;
  while (std::optional<SequenceFrame> frame = reader->next()) {
    frames.push_back(std::move(*frame));
  }
  return frames;
}

TEST(EvolinWriter, IsReadBackAsItWasGiven) {
  const TemporaryFolder folder;
  EvolinWriter writer(folder.path() / "made");
  for (const int number : {2, 0, 1}) {  // any order
    writer.addFrame(static_cast<std::size_t>(number), makeFrame(number, {5, 9}));
  }
  writer.finish();
  const std::vector<SequenceFrame> frames = readBack(folder.path() / "made");
  ASSERT_EQ(frames.size(), 3U);
  for (int number = 0; number < 3; ++number) {
    const SequenceFrame given = makeFrame(number, {5, 9});
    const SequenceFrame& read = frames[static_cast<std::size_t>(number)];
    EXPECT_EQ(read.frame.name, EvolinWriter::stem(static_cast<std::size_t>(number)));
    EXPECT_EQ(read.image_file, "images/" + read.frame.name + ".png");
    EXPECT_EQ(read.frame.stamp, given.frame.stamp);
    EXPECT_EQ(read.depth_stamp, std::optional<Stamp>(given.frame.stamp));
    EXPECT_EQ(read.frame.image.at<cv::Vec3b>(2, 3), given.frame.image.at<cv::Vec3b>(2, 3));
    EXPECT_EQ(read.frame.depth.at<float>(0, 0), 1.5F + static_cast<float>(number));
    EXPECT_TRUE(std::isnan(read.frame.depth.at<float>(0, 1)));
    EXPECT_TRUE(std::isnan(read.frame.depth.at<float>(0, 2)));
    EXPECT_EQ(read.frame.depth.at<float>(1, 1), 2.0002F);  // a step is 0.2 mm
    ASSERT_TRUE(read.frame.camera.has_value());
    EXPECT_EQ(read.frame.camera->fx, 3.125);
    EXPECT_EQ(read.frame.camera->fy, 3.25);
    EXPECT_EQ(read.frame.camera->cx, 1.5);
    ASSERT_TRUE(read.frame.pose.has_value());
    EXPECT_EQ(read.frame.pose->translation, given.frame.pose->translation);
    EXPECT_TRUE(read.frame.pose->rotation.isApprox(given.frame.pose->rotation, 1e-15));
    ASSERT_EQ(read.ground_truth->size(), 2U);
    EXPECT_EQ((*read.ground_truth)[1].x1, (*given.ground_truth)[1].x1);
    EXPECT_EQ((*read.ground_truth)[1].x2, 1.0 / 3);
  }
}

TEST(EvolinWriter, KeepsIdsOverGaps) {
  const TemporaryFolder folder;
  EvolinWriter writer(folder.path());
  const std::vector<std::vector<std::int64_t>> ids = {{7, 3}, {3}, {8, 7}, {}, {3, 8, 7}};
  for (std::size_t i = 0; i < ids.size(); ++i) {
    writer.addFrame(i, makeFrame(static_cast<int>(i), ids[i]));
  }
  writer.finish();
  const std::vector<SequenceFrame> frames = readBack(folder.path());
  std::map<std::int64_t, std::int64_t> names;  // ids are renumbered, the same ones everywhere
  for (std::size_t i = 0; i < ids.size(); ++i) {
    ASSERT_EQ(frames[i].ground_truth->size(), ids[i].size());
    for (std::size_t row = 0; row < ids[i].size(); ++row) {
      const std::int64_t read = (*frames[i].ground_truth)[row].id;
      EXPECT_EQ(names.emplace(ids[i][row], read).first->second, read);
    }
  }
  EXPECT_EQ(names.size(), 3U);
  EXPECT_NE(names[3], names[7]);
  EXPECT_NE(names[3], names[8]);
  EXPECT_NE(names[7], names[8]);
  const auto pairs = [&](const std::string& file) {
    return readIndexPairsCsv(folder.path() / file);
  };
  EXPECT_EQ(pairs("gt_associations_step1/0000_0001.csv"), (IndexPairs{{1, 0}}));
  EXPECT_TRUE(pairs("gt_associations_step1/0001_0002.csv").empty());
  EXPECT_EQ(pairs("gt_associations_gaps/0000_0002.csv"), (IndexPairs{{0, 1}}));
  EXPECT_EQ(pairs("gt_associations_gaps/0001_0004.csv"), (IndexPairs{{0, 0}}));
  EXPECT_EQ(pairs("gt_associations_gaps/0002_0004.csv"), (IndexPairs{{0, 1}, {1, 2}}));
  EXPECT_EQ(readIndexPairsCsv(folder.path() / "gt_associations_step1/0003_0004.csv").size(), 0U);
  EXPECT_EQ(readScoresCsv(folder.path() / "gt_ids/0002.csv"), (std::vector<double>{8, 7}));
}

TEST(EvolinWriter, WritesOnlyWhatFramesHave) {
  const TemporaryFolder folder;
  EvolinWriter writer(folder.path());
  SequenceFrame bare;
  bare.frame.stamp = 5;
  bare.frame.image = cv::Mat(3, 4, CV_8UC1, cv::Scalar(9));
  writer.addFrame(0, bare);
  writer.finish();
  for (const char* name : {"depth", "gt_lines", "poses.txt", "calibration_matrix.txt",
                           "depth_associations.txt", "gt_ids"}) {
    EXPECT_FALSE(std::filesystem::exists(folder.path() / name)) << name;
  }
  EXPECT_EQ(readBack(folder.path()).size(), 1U);
}

TEST(EvolinWriter, RefusesWhatRowsCannotSay) {
  const TemporaryFolder folder;
  EvolinWriter empty(folder.path() / "a");
  expectError([&] { empty.finish(); }, {"no frames"});
  EvolinWriter gap(folder.path() / "b");
  gap.addFrame(0, makeFrame(0, {}));
  gap.addFrame(2, makeFrame(2, {}));
  expectError([&] { gap.finish(); }, {"0002", "without gaps"});
  expectError([&] { gap.addFrame(2, makeFrame(2, {})); }, {"0002", "twice"});
  EvolinWriter poses(folder.path() / "c");
  SequenceFrame without = makeFrame(1, {});
  without.frame.pose.reset();
  poses.addFrame(0, makeFrame(0, {}));
  poses.addFrame(1, without);
  expectError([&] { poses.finish(); }, {"poses.txt", "1 of 2"});
  EvolinWriter stamps(folder.path() / "d");
  stamps.addFrame(0, makeFrame(1, {}));
  stamps.addFrame(1, makeFrame(1, {}));
  expectError([&] { stamps.finish(); }, {"stamps.txt", "expected one after"});
}

TEST(EvolinWriter, NamesTheFileThatCannotBeWritten) {
  const TemporaryFolder folder;
  folder.write("images", "a file where a folder belongs");
  EvolinWriter writer(folder.path());
  expectError([&] { writer.addFrame(0, makeFrame(0, {})); }, {"images"});
}

}  // namespace
}  // namespace evolin
