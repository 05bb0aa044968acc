// Every family of `evolin evaluate` on folders with something wrong: an error that names it, or the
// figure that the metric defines; and options that must not change a result.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "evaluate_command.h"
#include "test/support/temporary_folder.h"

namespace evolin::cli {
namespace {

using Arguments = std::vector<std::string>;

struct Outcome {
  int status;
  std::string out;
  std::string err;
};

const Arguments& allFamilies() {
  static const Arguments kFamilies = {"vectorized", "heatmap", "repeatability", "association",
                                      "pose"};
  return kFamilies;
}

/// Four frames of 64 x 48 pixels in which all families have something to measure: true and detected
/// lines with scores, a wall two metres off, and a camera that moves one pixel a frame.
class BrokenInput : public ::testing::Test {
 protected:
  static constexpr int kFrames = 4;

  void SetUp() override {
    std::string poses;
    std::string list;
    std::filesystem::create_directories(path("depth"));
    std::filesystem::create_directories(path("imgs"));
    for (int frame = 0; frame < kFrames; ++frame) {
      const std::string stem = "000" + std::to_string(frame);
      const int left = 20 - frame;
      std::string lines;
      for (int line = 0; line < 6; ++line) {
        lines += std::to_string(left + 4 * line) + "," + std::to_string(3 + 7 * line) + "," +
                 std::to_string(left + 40 - 5 * line) + "," + std::to_string(40 - 6 * line) + "\n";
      }
      folder_.write("gt/" + stem + ".csv", lines);
      folder_.write("lines/" + stem + ".csv", lines + "1,2,9,4\n");
      folder_.write("scores/" + stem + ".csv", "0.9\n0.8\n0.7\n0.6\n0.5\n0.4\n0.3\n");
      cv::imwrite(path("imgs/" + stem + ".png"), cv::Mat(48, 64, CV_8UC1, cv::Scalar(0)));
      cv::imwrite(path("depth/" + stem + ".png"), cv::Mat(48, 64, CV_16UC1, cv::Scalar(10000)));
      poses += "0 " + std::to_string(0.0625 * frame) + " 0 0 0 0 0 1\n";
      list += std::to_string(frame) + " " + std::to_string(frame) + "\n";
      if (frame > 0) {
        const std::string pair = "000" + std::to_string(frame - 1) + "_" + stem + ".csv";
        folder_.write("pairs/" + pair, "0,0\n1,1\n2,2\n3,3\n4,4\n5,5\n");
        folder_.write("pred_pairs/" + pair, "0,0\n1,2\n");
      }
    }
    folder_.write("poses.txt", poses);
    folder_.write("list.txt", list);
    folder_.write("K.txt", "32 0 31.5\n0 32 23.5\n0 0 1\n");
    folder_.write("thresholds.txt", "0.1 0.5\n");
  }

  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }

  Outcome run(const std::string& family, const Arguments& more = {}) const {
    const Arguments detection = {"-p", path("lines"),         "-g", path("gt"),
                                 "-i", path("imgs"),          "-s", path("scores"),
                                 "-S", path("thresholds.txt")};
    const std::map<std::string, Arguments> options = {
        {"vectorized", detection},
        {"heatmap", detection},
        {"repeatability",
         {"-p", path("lines"), "-s", path("scores"), "-S", path("thresholds.txt"), "-D",
          path("depth"), "-P", path("poses.txt"), "-a", path("list.txt"), "-c", path("K.txt"), "-f",
          "1"}},
        {"association", {"-p", path("pred_pairs"), "-g", path("pairs")}},
        {"pose",
         {"-l", path("gt"), "-a", path("pairs"), "-d", path("depth"), "-p", path("poses.txt"), "-A",
          path("list.txt"), "-c", path("K.txt")}}};
    Arguments arguments = {"evaluate", family};
    arguments.insert(arguments.end(), options.at(family).begin(), options.at(family).end());
    arguments.insert(arguments.end(), more.begin(), more.end());
    ::testing::internal::CaptureStdout();
    ::testing::internal::CaptureStderr();
    const int status = runProgram({evaluateCommand()}, arguments);
    std::string out = ::testing::internal::GetCapturedStdout();
    return {status, out, ::testing::internal::GetCapturedStderr()};
  }

  /// Each of `families` ends with status 1 and a message with all `words`, the others as before.
  void expectRefused(const Arguments& families, const Arguments& words) const {
    for (const std::string& family : allFamilies()) {
      const Outcome outcome = run(family);
      const bool refused = std::find(families.begin(), families.end(), family) != families.end();
      EXPECT_EQ(outcome.status, refused ? kExitFailed : kExitDone) << family << ": " << outcome.err;
      EXPECT_EQ(outcome.out.empty(), refused) << family << ": " << outcome.out;
      for (const std::string& word : refused ? words : Arguments()) {
        EXPECT_NE(outcome.err.find(word), std::string::npos)
            << family << ": " << word << " is not in " << outcome.err;
      }
    }
  }

  /// The family's table, which a run without an error printed.
  std::string tableOf(const std::string& family, const Arguments& more = {}) const {
    Arguments arguments = {"--format", "table"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = run(family, arguments);
    EXPECT_EQ(outcome.status, kExitDone) << family << ": " << outcome.err;
    return outcome.out;
  }

  void expectInTable(const std::string& family, const std::string& words) const {
    const std::string table = tableOf(family);
    EXPECT_NE(table.find(words), std::string::npos) << family << ": no '" << words << "' in\n"
                                                    << table;
    EXPECT_EQ(table.find("nan"), std::string::npos) << table;
  }

  void empty(const std::string& folder) const {
    for (const auto& entry : std::filesystem::directory_iterator(path(folder))) {
      folder_.write(folder + "/" + entry.path().filename().string(), "");
    }
  }

  test::TemporaryFolder folder_;
};

TEST_F(BrokenInput, WholeFoldersAreFine) {
  expectRefused({}, {});
  for (const std::string& family : allFamilies()) {
    EXPECT_EQ(tableOf(family).find("no value"), std::string::npos) << family;
  }
}

TEST_F(BrokenInput, AMissingScoreFile) {
  std::filesystem::remove(path("scores/0002.csv"));
  expectRefused({"vectorized", "heatmap", "repeatability"}, {"scores", "0002", "3 scores"});
}

TEST_F(BrokenInput, MoreScoresThanLines) {
  folder_.write("scores/0002.csv", "1\n2\n3\n4\n5\n6\n7\n8\n");
  expectRefused({"vectorized", "heatmap", "repeatability"},
                {"scores/0002.csv", "8 score(s), expected 7"});
}

TEST_F(BrokenInput, ACellThatIsNoNumber) {
  folder_.write("lines/0002.csv", "1,2,3,4\n1,2,x,4\n");
  expectRefused({"vectorized", "heatmap", "repeatability"}, {"lines/0002.csv:2", "'x'"});
}

TEST_F(BrokenInput, ATrueCellThatIsNoNumber) {
  folder_.write("gt/0002.csv", "1,2,3,4\n1,2,x,4\n");
  expectRefused({"vectorized", "heatmap", "pose"}, {"gt/0002.csv:2", "'x'"});
}

TEST_F(BrokenInput, AnIndexThatIsNoNumber) {
  folder_.write("pairs/0001_0002.csv", "0,0\n1,x\n");
  expectRefused({"association", "pose"}, {"pairs/0001_0002.csv:2", "'x'"});
}

TEST_F(BrokenInput, NanCoordinates) {
  folder_.write("lines/0002.csv", "1,2,3,4\n1,2,nan,4\n");
  expectRefused({"vectorized", "heatmap", "repeatability"}, {"lines/0002.csv:2", "'nan'"});
}

TEST_F(BrokenInput, NanCoordinatesOfTheTruth) {
  folder_.write("gt/0002.csv", "1,2,3,4\n1,2,nan,4\n");
  expectRefused({"vectorized", "heatmap", "pose"}, {"gt/0002.csv:2", "'nan'"});
}

TEST_F(BrokenInput, NegativeCoordinatesAreClamped) {
  const auto results = [this] {
    std::string text;
    for (const std::string& family : allFamilies()) {
      text += tableOf(family);
    }
    return text;
  };
  folder_.write("lines/0002.csv", "-5,-7,30,20\n");
  folder_.write("scores/0002.csv", "0.9\n");
  const std::string outside = results();
  folder_.write("lines/0002.csv", "0,0,30,20\n");
  EXPECT_EQ(outside, results());
}

TEST_F(BrokenInput, NegativeCoordinatesOfTheTruth) {
  // Vectorized metrics would compare with a line that no detection can be; drawn lines and lifted
  // ones are clamped.
  folder_.write("gt/0002.csv", "1,2,30,40\n-5,2,30,4\n3,4,50,6\n7,8,9,40\n40,2,44,44\n2,2,60,40\n");
  expectRefused({"vectorized"}, {"gt/0002.csv:2", "frame 0002, row 1", "-5,2,30,4", "64 x 48"});
}

TEST_F(BrokenInput, NegativeIndices) {
  folder_.write("pairs/0001_0002.csv", "0,0\n-1,1\n");
  expectRefused({"association", "pose"}, {"pairs/0001_0002.csv:2", "'-1'"});
}

TEST_F(BrokenInput, AMissingFileOfTruth) {
  std::filesystem::remove(path("gt/0003.csv"));
  folder_.write("poses.txt", "0 0 0 0 0 0 0 1\n");
  for (const std::string family : {"vectorized", "heatmap"}) {
    EXPECT_NE(run(family).err.find("no true lines of 0003"), std::string::npos) << run(family).err;
  }
  EXPECT_EQ(run("pose").status, kExitFailed);
}

TEST_F(BrokenInput, AFrameWithoutTruth) {
  folder_.write("gt/0002.csv", "");
  folder_.write("pairs/0001_0002.csv", "");
  folder_.write("pairs/0002_0003.csv", "");
  expectRefused({}, {});
  expectInTable("pose", "inf");  // two of three pairs are not found
}

TEST_F(BrokenInput, NoTruthAtAll) {
  empty("gt");
  empty("pairs");
  expectInTable("vectorized", "no value for average_precision, recall, fscore: no lines are");
  expectInTable("heatmap", "no value for average_precision, max_fscore: no lines are annotated");
  expectInTable("association", "no value for recall, fscore: no true pairs are given");
  expectInTable("pose", "inf");
  const std::string json = run("vectorized").out;
  EXPECT_NE(json.find("\"value\": NaN"), std::string::npos) << json;  // as published
  EXPECT_NE(run("association").out.find("\"value\": 0.0"), std::string::npos);
}

TEST_F(BrokenInput, AnEmptyFolderOfTruth) {
  for (const std::string folder : {"gt", "pairs"}) {
    std::filesystem::remove_all(path(folder));
    std::filesystem::create_directories(path(folder));
  }
  for (const std::string family : {"vectorized", "heatmap", "association", "pose"}) {
    const Outcome outcome = run(family);
    EXPECT_EQ(outcome.status, kExitFailed) << family;
    EXPECT_NE(outcome.err.find("has no file .csv"), std::string::npos) << outcome.err;
  }
}

TEST_F(BrokenInput, NothingDetected) {
  empty("lines");
  empty("scores");
  empty("pred_pairs");
  expectInTable("vectorized", "no value for average_precision: no lines were detected");
  expectInTable("vectorized", "no value for precision, fscore: no line has a score above");
  expectInTable("heatmap", "no value for average_precision, max_fscore: no line has a score above");
  expectInTable("repeatability", "no value for repeatability: no lines were detected");
  expectInTable("repeatability", "no value for localization_error: no line was found again");
  expectInTable("association", "no value for precision, fscore: no pairs are predicted");
  EXPECT_NE(tableOf("association").find("        -  0.0000       -\n"), std::string::npos)
      << tableOf("association");
  EXPECT_NE(run("association", {"--format", "csv"})
                .out.find("precision,,,,,,,,,no pairs are predicted\n"),
            std::string::npos);
}

TEST_F(BrokenInput, OnlyLinesThatTheProtocolDrops) {
  for (int frame = 0; frame < kFrames; ++frame) {
    const std::string stem = "000" + std::to_string(frame);
    folder_.write("lines/" + stem + ".csv", "5,5,30,5\n5,5,5,30\n");
    folder_.write("scores/" + stem + ".csv", "0.9\n0.8\n");
  }
  expectInTable("vectorized",
                "no value for average_precision: the protocol drops all 8 detected lines");
  expectInTable(
      "vectorized",
      "no value for precision, fscore: no line that the protocol keeps has a score above");
  expectInTable("heatmap", "precision");  // every line is drawn
  EXPECT_EQ(tableOf("heatmap").find("no line"), std::string::npos) << tableOf("heatmap");
  EXPECT_EQ(tableOf("vectorized", {"--protocol", "paper"}).find("drops"), std::string::npos);
}

TEST_F(BrokenInput, NoPoseFound) {
  for (const std::string pair : {"0000_0001", "0001_0002", "0002_0003"}) {
    folder_.write("pairs/" + pair + ".csv", "0,0\n");
  }
  const std::string table = tableOf("pose", {"--statistics"});
  EXPECT_NE(table.find("angular_rotation_error_rmse"), std::string::npos) << table;
  EXPECT_NE(table.find(": no pose was found"), std::string::npos) << table;
  EXPECT_EQ(table.find("nan"), std::string::npos) << table;
}

TEST_F(BrokenInput, DepthImagesOfDifferentSizes) {
  cv::imwrite(path("depth/0002.png"), cv::Mat(24, 32, CV_16UC1, cv::Scalar(10000)));
  expectRefused({"repeatability", "pose"}, {"depth/0002.png", "32 x 24", "64 x 48"});
}

TEST_F(BrokenInput, MorePosesThanFrames) {
  folder_.write("poses.txt", std::string("0 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n") +
                                 "3 0 0 0 0 0 0 1\n4 0 0 0 0 0 0 1\n");
  expectRefused({"repeatability", "pose"}, {"poses.txt: 5 poses", "4 line files"});
}

TEST_F(BrokenInput, ThreadsDoNotChangeResultsOrMessages) {
  for (const std::string& family : allFamilies()) {
    for (const Arguments& more : {Arguments{}, Arguments{"--protocol", "paper"}}) {
      const auto text = [&](const std::string& threads) {
        Arguments arguments = {"--threads", threads, "--bootstrap", "30"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Outcome outcome = run(family, arguments);
        EXPECT_EQ(outcome.status, kExitDone) << family << ": " << outcome.err;
        return outcome.out + outcome.err;
      };
      const std::string one = text("1");
      EXPECT_NE(one.find("confidence_interval"), std::string::npos) << family;
      EXPECT_EQ(text("2"), one) << family;
      EXPECT_EQ(text("16"), one) << family;
      EXPECT_EQ(text("0"), one) << family;
    }
  }
  folder_.write("gt/0001.csv", "x\n");
  folder_.write("gt/0002.csv", "y\n");
  folder_.write("lines/0001.csv", "x\n");
  folder_.write("lines/0002.csv", "y\n");
  folder_.write("pairs/0001_0002.csv", "x\n");
  folder_.write("pairs/0002_0003.csv", "y\n");
  for (const std::string& family : allFamilies()) {
    for (const std::string threads : {"1", "3"}) {
      EXPECT_NE(run(family, {"--threads", threads}).err.find(".csv:1: "), std::string::npos);
      EXPECT_NE(run(family, {"--threads", threads}).err.find("'x'"), std::string::npos) << family;
    }
  }
}

TEST_F(BrokenInput, OptionsOutOfRangeAreWrongUse) {
  const std::vector<Arguments> cases = {
      {"--threads", "-1"},    {"--threads", "1025"}, {"--threads", "x"}, {"--bootstrap", "-1"},
      {"--bootstrap", "1.5"}, {"--protocol", "new"}, {"--protocol", ""}, {"--format", "xml"}};
  for (const std::string& family : allFamilies()) {
    for (const Arguments& more : cases) {
      const Outcome outcome = run(family, more);
      EXPECT_EQ(outcome.status, kExitWrongUse) << family << " " << more[0] << " " << more[1];
      EXPECT_NE(outcome.err.find(more[0]), std::string::npos) << outcome.err;
      EXPECT_EQ(outcome.out, "");
    }
  }
}

}  // namespace
}  // namespace evolin::cli
