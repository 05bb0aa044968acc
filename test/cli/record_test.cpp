// `evolin detect` and `evolin associate` as a user meets them: what they write is read back by the
// readers of the published layout and played back by the plug-ins `recorded`.
#include <gtest/gtest.h>

#include <fstream>

#include "associate_command.h"
#include "bag_writer.h"
#include "detect_command.h"
#include "evolin_ros/dataset/annotation_folder.h"
#include "evolin_ros/dataset/association_folder.h"
#include "evolin_ros/dataset/csv.h"
#include "plugin_loader.h"
#include "test/cli/outcome.h"
#include "test/support/drawn_sequence.h"
#include "test/support/temporary_folder.h"

namespace evolin::cli {
namespace {

namespace fs = std::filesystem;
using test::Outcome;

class RecordTest : public ::testing::Test {
 protected:
  RecordTest() {
    sequence_.frames = 7;
    frames_ = test::drawSequence(sequence_);
    test::writeEvolinFolder(frames_, folder_.path() / "data");
    BagWriter writer(folder_.path() / "data.bag");
    for (const SequenceFrame& frame : frames_) {
      writer.add(frame);
    }
    writer.close();
  }

  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }

  static Outcome run(const std::vector<std::string>& arguments) {
    return test::runCaptured({detectCommand(), associateCommand()}, arguments);
  }

  Outcome detect(const std::string& input, const std::string& output,
                 const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"detect",   "--quiet",    "--input",    path(input),
                                          "--output", path(output), "--detector", detector_};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }

  Outcome associate(const std::string& input, const std::string& output,
                    const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"associate", "--quiet",    "--input",      path(input),
                                          "--output",  path(output), "--associator", "lbd"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }

  static std::string contents(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  /// By name below the folder, but for the file that tells of the run.
  static std::map<std::string, std::string> tree(const fs::path& folder) {
    std::map<std::string, std::string> files;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
      if (entry.is_regular_file() && entry.path().extension() == ".csv") {
        files[fs::relative(entry.path(), folder).string()] = contents(entry.path());
      }
    }
    return files;
  }

  test::DrawnSequence sequence_;
  std::vector<SequenceFrame> frames_;
  test::TemporaryFolder folder_;
  std::string detector_ = "lsd";
};

TEST_F(RecordTest, DetectedLinesComeBackByStampAndByName) {
  const Outcome outcome = detect("data", "out");
  ASSERT_EQ(outcome.status, kExitDone) << outcome.err;
  EXPECT_NE(outcome.out.find("in 7 of 7 images"), std::string::npos) << outcome.out;
  const AnnotationFolder folder(path("out"));
  EXPECT_EQ(folder.size(), 7U);
  EXPECT_EQ(folder.unlisted(), 0U);
  PluginLoader loader;
  const std::shared_ptr<LineDetector> detector = loader.loadDetector(detector_);
  detector->configure(YAML::Node());
  EXPECT_EQ(folder.hasScores(), detector->givesScores());
  for (const SequenceFrame& frame : frames_) {
    const LineSegments expected = detector->detect(frame.frame);
    ASSERT_FALSE(expected.empty());
    for (const auto& lines : {folder.at(frame.frame.stamp), folder.byName(frame.frame.name)}) {
      ASSERT_TRUE(lines);
      ASSERT_EQ(lines->size(), expected.size());
      for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_EQ((*lines)[i].x1, expected[i].x1);
        EXPECT_EQ((*lines)[i].y2, expected[i].y2);
        EXPECT_TRUE((*lines)[i].score == expected[i].score || !expected[i].hasScore());
      }
    }
  }
}

TEST_F(RecordTest, BagFolderAndPlaybackGiveTheSameLinesOnAnyNumberOfThreads) {
  ASSERT_EQ(detect("data", "folder", {"--threads", "1"}).status, kExitDone);
  ASSERT_EQ(detect("data.bag", "bag", {"--threads", "3"}).status, kExitDone);
  const auto expected = tree(path("folder"));
  EXPECT_GE(expected.size(), 7U);
  EXPECT_EQ(tree(path("bag")), expected);
  detector_ = "recorded:folder=" + path("bag");
  ASSERT_EQ(detect("data", "again").status, kExitDone);
  EXPECT_EQ(tree(path("again")), expected);
  EXPECT_EQ(contents(path("again/stamps.txt")), contents(path("bag/stamps.txt")));
}

TEST_F(RecordTest, SelectedLinesAloneAreWritten) {
  ASSERT_EQ(detect("data", "all").status, kExitDone);
  ASSERT_EQ(detect("data", "three", {"--max-lines", "3"}).status, kExitDone);
  EXPECT_GT(readLinesCsv(path("all/lines/0000.csv")).size(), 3U);
  EXPECT_EQ(readLinesCsv(path("three/lines/0000.csv")).size(), 3U);
}

TEST_F(RecordTest, MatchesComeBackAsPairsOfRows) {
  const Outcome outcome = associate("data", "out", {"--frame-step", "2"});
  ASSERT_EQ(outcome.status, kExitDone) << outcome.err;
  EXPECT_NE(outcome.out.find("in 5 pairs of 7 images"), std::string::npos) << outcome.out;
  const AssociationFolder folder(path("out"));
  EXPECT_EQ(folder.size(), 5U) << "images less association files is the frame step";
  std::size_t right = 0;
  std::size_t all = 0;
  for (std::size_t i = 0; i + 2 < frames_.size(); ++i) {
    const auto pairs = folder.at(frames_[i].frame.stamp, frames_[i + 2].frame.stamp);
    ASSERT_TRUE(pairs);
    const IndexPairs from_file = readIndexPairsCsv(path(
        "out/associations/" + frames_[i].frame.name + "_" + frames_[i + 2].frame.name + ".csv"));
    EXPECT_EQ(*pairs, from_file);
    for (const auto& [first, second] : *pairs) {
      right += (*frames_[i].ground_truth)[static_cast<std::size_t>(first)].id ==
                       (*frames_[i + 2].ground_truth)[static_cast<std::size_t>(second)].id
                   ? 1
                   : 0;
      ++all;
    }
  }
  EXPECT_GT(2 * right, all) << "rows are those of the annotation";
}

TEST_F(RecordTest, MatchesOfDetectedLinesAreTheSameFromBagAndPlayback) {
  ASSERT_EQ(detect("data", "lines").status, kExitDone);
  ASSERT_EQ(associate("data", "one", {"--lines", path("lines"), "--threads", "1"}).status,
            kExitDone);
  ASSERT_EQ(associate("data.bag", "two", {"--lines", path("lines"), "--threads", "2"}).status,
            kExitDone);
  const auto expected = tree(path("one"));
  EXPECT_EQ(expected.size(), 6U);
  EXPECT_EQ(tree(path("two")), expected);
  ASSERT_EQ(run({"associate", "--quiet", "--input", path("data"), "--output", path("three"),
                 "--lines", path("lines"), "--associator", "recorded:folder=" + path("one")})
                .status,
            kExitDone);
  EXPECT_EQ(tree(path("three")), expected);
}

TEST_F(RecordTest, RefusalsNameWhatIsWrong) {
  const auto expectRefusal = [](const Outcome& outcome, int status, const std::string& word) {
    EXPECT_EQ(outcome.status, status) << outcome.err;
    EXPECT_NE(outcome.err.find(word), std::string::npos) << outcome.err;
  };
  expectRefusal(detect("data", "out", {"--image-topic", "/x"}), kExitWrongUse,
                "--image-topic goes with a bag");
  expectRefusal(detect("data", "out", {"--threads", "-1"}), kExitWrongUse, "--threads");
  expectRefusal(detect("none.bag", "out"), kExitFailed, "none.bag: no such file");
  detector_ = "hough_q";
  expectRefusal(detect("data", "out"), kExitFailed, "did you mean 'hough_p'");
  detector_ = "hough_p:thresold=3";
  expectRefusal(detect("data", "out"), kExitFailed, "'thresold'");
  detector_ = "hough_p:threshold";
  expectRefusal(detect("data", "out"), kExitWrongUse, "expected key=value");
  detector_ = "hough_p";
  fs::create_directories(path("mine"));
  std::ofstream(path("mine/precious.txt")) << "x";
  expectRefusal(detect("data", "mine"), kExitFailed, "holds no detect.txt");
  EXPECT_TRUE(fs::exists(path("mine/precious.txt")));
  fs::remove_all(path("data/gt_lines"));
  fs::remove_all(path("data/gt_associations_step1"));
  expectRefusal(associate("data", "out"), kExitFailed, "--lines");
  expectRefusal(associate("data", "out", {"--frame-step", "0"}), kExitWrongUse, "--frame-step");
  EXPECT_FALSE(fs::exists(path("out")));
}

}  // namespace
}  // namespace evolin::cli
