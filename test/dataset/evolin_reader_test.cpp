// EVOLIN folders: everything by row and by stem, and the real sample.
#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>

#include "evolin_ros/dataset/csv.h"
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

// Three images, three poses whose x is their row.
class EvolinFolder : public TemporaryFolder {
 public:
  explicit EvolinFolder(const std::string& images = "images") {
    for (const char* name : {"0000.png", "0001.png", "0002.png"}) {
      writeImage(path() / images / name);
    }
    write("poses.txt", "1 0 0 0 0 0 0 1\n2 1 0 0 0 0 0 1\n3 2 0 0 0 0 0 1\n");
  }
  void addDepth() const {
    writeDepth(path() / "depth/0000.png", 5000);
    writeDepth(path() / "depth/0001.png", 10000);
    writeDepth(path() / "depth/0002.png", 15000);
  }
};

std::string nameOf(const SequenceFrame& frame) { return frame.frame.name; }

TEST(EvolinReader, TakesImagesFromEitherFolderInOrderOfStems) {
  for (const char* images : {"images", "rgb"}) {
    const EvolinFolder folder(images);
    const auto reader = openSequence(folder.path(), {});
    EXPECT_EQ(reader->layout(), Layout::kEvolin);
    const std::vector<SequenceFrame> frames = readAll(reader.get());
    ASSERT_EQ(frames.size(), 3U);
    EXPECT_EQ(frames[1].image_file, std::string(images) + "/0001.png");
    EXPECT_EQ(frames[1].frame.stamp, 1033333333);
  }
}

TEST(EvolinReader, TakesAFolderWithATrailingSlash) {
  const EvolinFolder folder;
  folder.addDepth();
  const std::vector<SequenceFrame> frames = readAll(folder.path() / "");
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_EQ(frames[0].image_file, "images/0000.png");
  EXPECT_FALSE(frames[0].frame.depth.empty());
}

TEST(EvolinReader, SortsPlainNumbersByValue) {
  const TemporaryFolder folder;
  for (const char* name : {"10.png", "2.jpg", "1.png"}) {
    writeImage(folder.path() / "images" / name);
  }
  const std::vector<SequenceFrame> frames = readAll(folder.path());
  EXPECT_EQ(nameOf(frames[0]), "1");
  EXPECT_EQ(nameOf(frames[1]), "2");
  EXPECT_EQ(nameOf(frames[2]), "10");
}

TEST(EvolinReader, PairsPosesByRowAndShiftsThem) {
  const EvolinFolder folder;
  SequenceOptions options;
  auto reader = openSequence(folder.path(), options);
  EXPECT_EQ(reader->poseRule(), "by row");
  EXPECT_EQ(readAll(reader.get())[2].frame.pose->translation.x(), 2);
  options.pose_offset = -1;
  reader = openSequence(folder.path(), options);
  EXPECT_EQ(reader->poseRule(), "by row, image i takes pose row i - 1");
  const std::vector<SequenceFrame> frames = readAll(reader.get());
  EXPECT_FALSE(frames[0].frame.pose.has_value());
  EXPECT_EQ(frames[2].frame.pose->translation.x(), 1);
  EXPECT_EQ(reader->counts().missing_poses, 1U);
}

TEST(EvolinReader, RefusesAnotherNumberOfPosesThanOfImages) {
  const EvolinFolder folder;
  SequenceOptions options;
  const std::string row = "1 0 0 0 0 0 0 1\n";
  folder.write("poses.txt", row + row);
  expectError<ParseError>([&] { openSequence(folder.path(), options); },
                          {"poses.txt", "2 poses for 3 images", "one each"});
  options.pose_offset = -1;
  EXPECT_EQ(readAll(folder.path(), options).size(), 3U);
  folder.write("poses.txt", row + row + row + row);
  expectError<ParseError>([&] { openSequence(folder.path(), options); },
                          {"4 poses for 3 images", "1 fewer (pose offset -1)"});
  options.pose_offset = 1;
  EXPECT_EQ(readAll(folder.path(), options).size(), 3U);
  folder.write("poses.txt", "");
  expectError([&] { openSequence(folder.path(), {}); }, {"poses.txt", "0 poses for 3 images"});
}

TEST(EvolinReader, CountsPosesByTheListOfImagesWhereThereIsOne) {
  const EvolinFolder folder;
  folder.write("stamps.txt",
               "5.5 images/0000.png\n6.5 images/0001.png\n7.5 images/0002.png\n"
               "8.5 images/0003.png\n");
  expectError<ParseError>([&] { openSequence(folder.path(), {}); },
                          {"3 poses for 4 images of stamps.txt"});
}

TEST(EvolinReader, PairsDepthByListElseByStem) {
  const EvolinFolder folder;
  folder.addDepth();
  std::vector<SequenceFrame> frames = readAll(folder.path());
  EXPECT_EQ(frames[1].frame.depth.at<float>(0, 0), 2.0F);
  EXPECT_EQ(frames[1].depth_stamp, std::optional<Stamp>(frames[1].frame.stamp));
  folder.write("depth_associations.txt", "0 2\n1.0 0\n");
  frames = readAll(folder.path());
  EXPECT_EQ(frames[0].frame.depth.at<float>(0, 0), 3.0F);
  EXPECT_EQ(frames[0].depth_stamp, std::optional<Stamp>(1066666667));
  EXPECT_EQ(frames[1].frame.depth.at<float>(0, 0), 1.0F);
  EXPECT_TRUE(frames[2].frame.depth.empty());
}

TEST(EvolinReader, RefusesDepthAssociationsThatPointNowhere) {
  const EvolinFolder folder;
  folder.write("depth_associations.txt", "0 0\n");
  expectError([&] { openSequence(folder.path(), {}); }, {"depth_associations.txt", "depth/"});
  folder.addDepth();
  const struct {
    std::string row;
    std::string said;
  } cases[] = {{"3 0", "image index is '3'"},
               {"1 3", "depth index is '3'"},
               {"-1 0", "'-1'"},
               {"1 0.5", "'0.5'"},
               {"1 nan", "'nan'"},
               {"1", "1 fields"},
               {"0 1", "occurs twice"},
               {"one 1", "'one'"}};
  for (const auto& bad : cases) {
    folder.write("depth_associations.txt", "0 0\n" + bad.row + "\n");
    expectError<ParseError>([&] { openSequence(folder.path(), {}); },
                            {"depth_associations.txt:2", bad.said});
  }
}

TEST(EvolinReader, TakesTheSizeOfTheCalibratedCameraFromTheImage) {
  const EvolinFolder folder;
  folder.write("calibration_matrix.txt", "481.2 0 4\n0 -480 3\n0 0 1\n");
  const std::vector<SequenceFrame> frames = readAll(folder.path());
  ASSERT_TRUE(frames[0].frame.camera.has_value());
  EXPECT_EQ(frames[0].frame.camera->width, 8);
  EXPECT_EQ(frames[0].frame.camera->height, 6);
  EXPECT_EQ(frames[0].frame.camera->fy, -480);
}

TEST(EvolinReader, RefusesAZeroFocalLength) {
  const EvolinFolder folder;
  folder.write("calibration_matrix.txt", "0 0 4\n0 -480 3\n0 0 1\n");
  expectError<ParseError>([&] { openSequence(folder.path(), {}); },
                          {"calibration_matrix.txt:1", "fx is 0"});
}

TEST(EvolinReader, TakesStampsFromItsList) {
  const EvolinFolder folder;
  folder.write("stamps.txt", "5.5 images/0000.png\n6.5 0001.png\n7.5 0002\n");
  const std::vector<SequenceFrame> frames = readAll(folder.path());
  EXPECT_EQ(frames[0].frame.stamp, 5500000000);
  EXPECT_EQ(frames[2].frame.stamp, 7500000000);
}

TEST(EvolinReader, KeepsRowsInStepWhenAListedImageIsMissing) {
  const EvolinFolder folder;
  folder.write("stamps.txt", "5.5 images/0000.png\n6.5 images/0001.png\n7.5 images/0002.png\n");
  std::filesystem::remove(folder.path() / "images/0001.png");
  const auto strict = openSequence(folder.path(), {});
  EXPECT_TRUE(strict->next().has_value());
  expectError<ParseError>([&] { strict->next(); }, {"stamps.txt:2", "images/0001.png"});
  SequenceOptions options;
  options.allow_missing = true;
  const auto lenient = openSequence(folder.path(), options);
  const std::vector<SequenceFrame> frames = readAll(lenient.get());
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[1].frame.pose->translation.x(), 2);
  EXPECT_EQ(lenient->counts().missing_images, 1U);
}

TEST(EvolinReader, WantsAStampForEveryImageInOrder) {
  const EvolinFolder folder;
  folder.write("stamps.txt", "5.5 0000.png\n6.5 0001.png\n");
  expectError<ParseError>([&] { openSequence(folder.path(), {}); }, {"stamps.txt", "'0002'"});
  folder.write("stamps.txt", "5.5 0001.png\n6.5 0000.png\n7.5 0002.png\n");
  expectError<ParseError>([&] { openSequence(folder.path(), {}); }, {"'0001'", "order"});
  folder.write("stamps.txt", "5.5 0000.png\n6.5 0000.png\n");
  expectError<ParseError>([&] { openSequence(folder.path(), {}); }, {"'0000'", "twice"});
  folder.write("stamps.txt", "5.5 0000.png\n5.5 0001.png\n");
  expectError<ParseError>([&] { openSequence(folder.path(), {}); }, {"stamps.txt:2"});
}

TEST(EvolinReader, GivesAnnotatedLinesByStem) {
  const EvolinFolder folder;
  folder.write("gt_lines/0001.csv", "1,2,3,4\n");
  folder.write("gt_lines/0002.csv", "");
  const auto reader = openSequence(folder.path(), {});
  const std::vector<SequenceFrame> frames = readAll(reader.get());
  EXPECT_FALSE(frames[0].ground_truth.has_value());
  ASSERT_TRUE(frames[1].ground_truth.has_value());
  EXPECT_EQ(frames[1].ground_truth->at(0).x2, 3);
  EXPECT_EQ(frames[1].ground_truth->at(0).id, kNoId);
  ASSERT_TRUE(frames[2].ground_truth.has_value());
  EXPECT_TRUE(frames[2].ground_truth->empty());
  EXPECT_EQ(reader->counts().missing_ground_truth, 1U);
}

TEST(EvolinReader, NamesTheMalformedRowOfAnAnnotation) {
  const EvolinFolder folder;
  for (const char* row : {"1,2,3", "1,2,3,x", "1,2,nan,4"}) {
    folder.write("gt_lines/0001.csv", std::string("1,2,3,4\n") + row + "\n");
    expectError<ParseError>([&] { openSequence(folder.path(), {}); }, {"gt_lines/0001.csv:2"});
  }
}

TEST(EvolinReader, RefusesTwoImagesOfOneStem) {
  const EvolinFolder folder;
  writeImage(folder.path() / "images/0001.jpg");
  expectError([&] { openSequence(folder.path(), {}); }, {"0001", "same stem"});
}

TEST(EvolinReader, ReadsTheRealSampleWithIdsEqualToRows) {
  EVOLIN_REQUIRE_SHARED_DATA();
  const std::filesystem::path folder = test::sharedFolder() / "data/icl_nuim_lr_sample";
  SequenceOptions options;
  options.pose_offset = -1;
  const auto reader = openSequence(folder, options);
  EXPECT_EQ(reader->layout(), Layout::kEvolin);
  const std::vector<SequenceFrame> frames = readAll(reader.get());
  ASSERT_EQ(frames.size(), 10U);
  EXPECT_FALSE(frames[0].frame.pose.has_value());
  EXPECT_EQ(frames[1].frame.pose->translation.z(), -2.25);
  EXPECT_EQ(reader->counts().missing_poses, 1U);
  EXPECT_EQ(reader->counts().missing_depths, 0U);
  for (const SequenceFrame& frame : frames) {
    ASSERT_TRUE(frame.ground_truth.has_value());
    ASSERT_EQ(frame.ground_truth->size(), 57U);
    for (std::size_t row = 0; row < 57; ++row) {
      EXPECT_EQ(frame.ground_truth->at(row).id, static_cast<std::int64_t>(row));
    }
    EXPECT_EQ(frame.frame.camera->fy, -480);
    EXPECT_EQ(frame.frame.camera->width, 640);
    EXPECT_EQ(frame.frame.depth.size(), frame.frame.image.size());
  }
  EXPECT_TRUE(readAll(folder)[0].frame.pose.has_value());
}

TEST(EvolinReader, GivesPairedLinesOfTheSeededSetsEqualAndDenseIds) {
  EVOLIN_REQUIRE_SHARED_DATA();
  const std::filesystem::path sets = test::sharedFolder() / "data/golden/sets";
  for (const char* name : {"basic", "edge", "timing"}) {
    std::map<std::string, LineSegments> lines;
    std::set<std::int64_t> ids;
    for (const SequenceFrame& frame : readAll(sets / name)) {
      ASSERT_TRUE(frame.ground_truth.has_value()) << name;
      for (const LineSegment& line : *frame.ground_truth) {
        ids.insert(line.id);
      }
      lines[frame.frame.name] = *frame.ground_truth;
    }
    ASSERT_FALSE(ids.empty());
    EXPECT_EQ(*ids.begin(), 0) << name;
    EXPECT_EQ(*ids.rbegin() + 1, static_cast<std::int64_t>(ids.size())) << name;
    for (const auto& file : listFiles(sets / name / "gt_associations", {".csv"})) {
      const std::string stem = file.stem().string();
      const LineSegments& first = lines.at(stem.substr(0, 4));
      const LineSegments& second = lines.at(stem.substr(5));
      std::set<IndexPair> equal;
      for (std::size_t i = 0; i < first.size(); ++i) {
        for (std::size_t j = 0; j < second.size(); ++j) {
          if (first[i].id == second[j].id) {
            equal.emplace(i, j);
          }
        }
      }
      const IndexPairs pairs = readIndexPairsCsv(file);
      EXPECT_EQ(equal, std::set<IndexPair>(pairs.begin(), pairs.end())) << file;
    }
  }
}

}  // namespace
}  // namespace evolin
