// `evolin evaluate heatmap` as a user meets it: output, options, refusals.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "evaluate_command.h"
#include "test/support/temporary_folder.h"

namespace evolin::cli {
namespace {

using nlohmann::json;

struct Outcome {
  int status;
  std::string out;
  std::string err;
};

Outcome run(const std::vector<std::string>& arguments) {
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  const int status = runProgram({evaluateCommand()}, arguments);
  std::string out = ::testing::internal::GetCapturedStdout();
  return {status, out, ::testing::internal::GetCapturedStderr()};
}

/// Frames of 300 x 400 (pairs up to 5 pixels apart). The true line has 100 pixels; the better
/// prediction covers the first 50 of them, the worse lies 100 pixels off with 100 more; in the last
/// frame both are off.
class EvaluateHeatmap : public ::testing::Test {
 protected:
  void SetUp() override {
    for (int frame = 0; frame < 4; ++frame) {
      const std::string stem = "000" + std::to_string(frame);
      const std::string row = std::to_string(frame < 3 ? 50 : 300);
      folder_.write("gt/" + stem + ".csv", "100,50,199,50\n");
      folder_.write("pred/" + stem + ".csv", "100,150,199,150\n100," + row + ",149," + row + "\n");
      folder_.write("scores/" + stem + ".csv", "0.2\n0.9\n");
      std::filesystem::create_directories(path("imgs"));
      cv::imwrite(path("imgs/" + stem + ".png"), cv::Mat(400, 300, CV_8UC1, cv::Scalar(0)));
    }
    folder_.write("thresholds.txt", "0.1 0.5\n");
  }

  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }

  Outcome heatmap(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"evaluate", "heatmap",  "-p", path("pred"),
                                          "-g",       path("gt"), "-i", path("imgs")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }

  Outcome scored(std::vector<std::string> more = {}) const {
    more.insert(more.end(), {"-s", path("scores"), "-S", path("thresholds.txt")});
    return heatmap(more);
  }

  static void expectFailure(const Outcome& outcome, const std::vector<std::string>& words) {
    EXPECT_EQ(outcome.status, kExitFailed) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    for (const std::string& word : words) {
      EXPECT_NE(outcome.err.find(word), std::string::npos) << word << " is not in " << outcome.err;
    }
  }

  test::TemporaryFolder folder_;
};

TEST_F(EvaluateHeatmap, UnscoredGivesPrecisionRecallAndFScore) {
  const Outcome outcome = heatmap();
  ASSERT_EQ(outcome.status, kExitDone) << outcome.err;
  const json entries = json::parse(outcome.out);
  ASSERT_EQ(entries.size(), 3U);
  EXPECT_EQ(entries[0]["name"], "precision");
  EXPECT_DOUBLE_EQ(entries[0]["value"].get<double>(), 150.0 / 600);
  EXPECT_EQ(entries[1]["name"], "recall");
  EXPECT_DOUBLE_EQ(entries[1]["value"].get<double>(), 150.0 / 400);
  EXPECT_EQ(entries[2]["name"], "fscore");
  EXPECT_DOUBLE_EQ(entries[2]["value"].get<double>(), 0.3);
  EXPECT_TRUE(entries[0]["additional_information"].is_null());
}

TEST_F(EvaluateHeatmap, ScoredGivesTheCurveByFallingThresholdAndItsSummary) {
  const Outcome outcome = scored();
  ASSERT_EQ(outcome.status, kExitDone) << outcome.err;
  const json entries = json::parse(outcome.out);
  ASSERT_EQ(entries.size(), 3U);
  EXPECT_EQ(entries[0]["name"], "pr_curve");
  EXPECT_EQ(entries[0]["values"]["x"], json({150.0 / 400, 150.0 / 400}));
  EXPECT_EQ(entries[0]["values"]["y"], json({150.0 / 200, 150.0 / 600}));
  EXPECT_EQ(entries[1]["name"], "average_precision");
  EXPECT_EQ(entries[1]["value"], 0.0);
  EXPECT_EQ(entries[2]["name"], "max_fscore");
  EXPECT_DOUBLE_EQ(entries[2]["value"].get<double>(), 0.5);
}

TEST_F(EvaluateHeatmap, WritesTheDefaultFile) {
  ASSERT_EQ(heatmap({"-o", path("out")}).status, kExitDone);
  std::ifstream stream(path("out/heatmap_metrics.json"));
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  EXPECT_EQ(text, heatmap().out);
}

TEST_F(EvaluateHeatmap, ThreadsAndProtocolsDoNotChangeTheResult) {
  const std::string one = scored({"--threads", "1", "--bootstrap", "20"}).out;
  EXPECT_GT(one.size(), 300U);
  EXPECT_EQ(scored({"--threads", "4", "--bootstrap", "20"}).out, one);
  EXPECT_EQ(scored({"--protocol", "paper", "--bootstrap", "20"}).out, one);
}

TEST_F(EvaluateHeatmap, BootstrapAddsIntervalsAroundTheScalars) {
  for (const Outcome& outcome : {heatmap({"--bootstrap", "200", "--bootstrap-block", "1"}),
                                 scored({"--bootstrap", "200", "--bootstrap-block", "1"})}) {
    ASSERT_EQ(outcome.status, kExitDone) << outcome.err;
    for (const json& entry : json::parse(outcome.out)) {
      if (!entry.contains("value")) {
        EXPECT_TRUE(entry["additional_information"].is_null());
        continue;
      }
      const json& interval = entry["additional_information"]["confidence_interval"];
      EXPECT_LE(interval["low"].get<double>(), entry["value"].get<double>());
      EXPECT_GE(interval["high"].get<double>(), entry["value"].get<double>());
      if (entry["name"] != "average_precision") {  // 0 in every sample: recall stands still
        EXPECT_LT(interval["low"].get<double>(), interval["high"].get<double>());
      }
    }
  }
}

TEST_F(EvaluateHeatmap, ScoresAndThresholdsNeedEachOther) {
  for (const std::vector<std::string>& alone :
       {std::vector<std::string>{"-s", path("scores")}, {"-S", path("thresholds.txt")}}) {
    const Outcome outcome = heatmap(alone);
    EXPECT_EQ(outcome.status, kExitWrongUse);
    EXPECT_NE(outcome.err.find("need each other"), std::string::npos) << outcome.err;
  }
}

TEST_F(EvaluateHeatmap, HelpTellsOptionsAndDefaults) {
  const Outcome outcome = run({"evaluate", "heatmap", "--help"});
  EXPECT_EQ(outcome.status, kExitDone);
  for (const std::string word :
       {"--pred-lines", "--gt-lines", "--imgs", "--scores", "--score-thresholds", "--output",
        "heatmap_metrics.json", "--protocol", "--threads", "--bootstrap"}) {
    EXPECT_NE(outcome.out.find(word), std::string::npos) << word;
  }
}

TEST_F(EvaluateHeatmap, MissingFilesAreNamedByStem) {
  std::filesystem::remove(path("scores/0002.csv"));
  expectFailure(scored(), {"scores", "0002"});
  EXPECT_EQ(heatmap().status, kExitDone);
  std::filesystem::remove(path("imgs/0001.png"));
  expectFailure(heatmap(), {"image", "0001"});
  std::filesystem::remove(path("pred/0003.csv"));
  expectFailure(heatmap(), {"predicted lines", "0003"});
}

TEST_F(EvaluateHeatmap, BadCellsAreNamedByFileAndLine) {
  folder_.write("gt/0001.csv", "1,2,3,4\n1,nan,3,4\n");
  expectFailure(heatmap(), {"gt/0001.csv:2", "'nan'"});
  folder_.write("gt/0001.csv", "1,2,3,4\n");
  folder_.write("scores/0001.csv", "1\n2\n3\n");
  expectFailure(scored(), {"scores/0001.csv"});
}

TEST_F(EvaluateHeatmap, EmptyFilesAreFramesWithoutLines) {
  folder_.write("pred/0001.csv", "");
  folder_.write("gt/0003.csv", "");
  const json entries = json::parse(heatmap().out);
  EXPECT_DOUBLE_EQ(entries[0]["value"].get<double>(), 100.0 / 450);
  EXPECT_DOUBLE_EQ(entries[1]["value"].get<double>(), 100.0 / 300);
}

}  // namespace
}  // namespace evolin::cli
