// `evolin` and `evolin evaluate` as a user meets them: options, output, refusals, exit statuses.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "evaluate_command.h"
#include "evolin_ros/base/text.h"
#include "test/support/random_lines.h"
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

std::string readText(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::string stemOf(int frame) { return "000" + std::to_string(frame); }

/// Three frames of 64 x 48 with two true lines and two scored predictions each: the first right,
/// the second a miss.
class EvaluateTest : public ::testing::Test {
 protected:
  void SetUp() override {
    for (int frame = 0; frame < 3; ++frame) {
      const std::string stem = stemOf(frame);
      folder_.write("gt/" + stem + ".csv", "10,10,50,30\n5,40,60,20\n");
      folder_.write("pred/" + stem + ".csv", "10,10,50,30.5\n1,1,3,2\n");
      folder_.write("scores/" + stem + ".csv", "0.9\n0.2\n");
      std::filesystem::create_directories(path("imgs"));
      cv::imwrite(path("imgs") + "/" + stem + (frame == 1 ? ".jpg" : ".png"),
                  cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(frame)));
      folder_.write("pred_pairs/" + stem + "_x.csv", "0,0\n1,2\n");
      folder_.write("gt_pairs/" + stem + "_x.csv", "0,0\n1,1\n2,2\n");
    }
    folder_.write("thresholds.txt", "0.1 0.5\n");
  }

  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }

  Outcome vectorized(const std::vector<std::string>& more = {}, bool scored = true) const {
    std::vector<std::string> arguments = {"evaluate", "vectorized", "-p", path("pred"),
                                          "-g",       path("gt"),   "-i", path("imgs")};
    if (scored) {
      arguments.insert(arguments.end(), {"-s", path("scores")});
    }
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }

  Outcome association(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"evaluate",         "association", "-p",
                                          path("pred_pairs"), "-g",          path("gt_pairs")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }

  /// Status 1, nothing on standard output, one line on standard error that holds `words`.
  static void expectFailure(const Outcome& outcome, const std::vector<std::string>& words) {
    EXPECT_EQ(outcome.status, kExitFailed) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(outcome.err.rfind("evolin evaluate: ", 0), 0U) << outcome.err;
    EXPECT_EQ(outcome.err.find('\n'), outcome.err.size() - 1) << outcome.err;
    for (const std::string& word : words) {
      EXPECT_NE(outcome.err.find(word), std::string::npos) << word << " is not in " << outcome.err;
    }
  }

  test::TemporaryFolder folder_;
};

void expectWrongUse(const std::vector<std::string>& arguments, const std::string& word) {
  const Outcome outcome = run(arguments);
  EXPECT_EQ(outcome.status, kExitWrongUse) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_NE(outcome.err.find(word), std::string::npos) << outcome.err;
}

TEST(Program, HelpListsTheVerbs) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{}, {"--help"}, {"-h"}}) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, kExitDone);
    EXPECT_NE(outcome.out.find("  evaluate  "), std::string::npos) << outcome.out;
  }
}

TEST(Program, VersionNamesTheProgram) {
  EXPECT_EQ(run({"--version"}).out.rfind("evolin_ros ", 0), 0U);
}

TEST(Program, UnknownVerbNamesTheNearest) {
  expectWrongUse({"evalute"}, "did you mean 'evaluate'?");
}

TEST(Program, FamilyHelpTellsOptionsAndDefaults) {
  const Outcome outcome = run({"evaluate", "vectorized", "--help"});
  EXPECT_EQ(outcome.status, kExitDone);
  for (const std::string word :
       {"--pred-lines", "--gt-lines", "--imgs", "--scores", "--score-thresholds",
        "--distance-thresholds", "5 10 15", "--output", "--output-file",
        "vectorized_classification_metrics.json", "--protocol", "--threads", "--bootstrap"}) {
    EXPECT_NE(outcome.out.find(word), std::string::npos) << word;
  }
  EXPECT_NE(run({"evaluate", "association", "-h"}).out.find("classification_metrics.json"),
            std::string::npos);
  EXPECT_NE(run({"evaluate", "--help"}).out.find("association"), std::string::npos);
}

TEST(Program, WrongUseIsStatusTwo) {
  expectWrongUse({"evaluate"}, "expected vectorized, ");
  expectWrongUse({"evaluate", "vectorised"}, "did you mean 'vectorized'?");
  expectWrongUse({"evaluate", "vectorized"}, "is required");
  expectWrongUse({"evaluate", "vectorized", "--pred-line", "x"}, "did you mean '--pred-lines'?");
  expectWrongUse({"evaluate", "association", "extra"}, "positional");
}

TEST_F(EvaluateTest, ValuesOutOfRangeAreWrongUse) {
  const std::vector<std::vector<std::string>> cases = {
      {"--threads", "-1"},   {"--threads", "two"}, {"--bootstrap", "-5"}, {"--format", "xml"},
      {"--protocol", "new"}, {"-d", "5", "0"},     {"-d", "nan"},         {"-O", "a/b.json"}};
  for (const std::vector<std::string>& arguments : cases) {
    const Outcome outcome = vectorized(arguments);
    EXPECT_EQ(outcome.status, kExitWrongUse) << arguments[0] << " " << outcome.err;
    EXPECT_EQ(outcome.out, "");
  }
  EXPECT_EQ(vectorized({"-S", path("thresholds.txt")}, false).status, kExitWrongUse);
}

TEST_F(EvaluateTest, PrintsJsonWithoutOutputFolder) {
  const Outcome outcome = vectorized({"-d", "4"});
  EXPECT_EQ(outcome.status, kExitDone) << outcome.err;
  const json entries = json::parse(outcome.out);
  ASSERT_EQ(entries.size(), 4U);  // AP and a curve for each of two distances
  EXPECT_EQ(entries[0]["name"], "average_precision");
  EXPECT_EQ(entries[1]["values"]["x"].size(), 6U);
}

TEST_F(EvaluateTest, UnscoredGivesClassificationAlone) {
  const json entries = json::parse(vectorized({"-d", "4", "-d", "8"}, false).out);
  ASSERT_EQ(entries.size(), 12U);
  EXPECT_EQ(entries[0]["name"], "precision");
  EXPECT_DOUBLE_EQ(entries[0]["value"].get<double>(), 0.5);
  EXPECT_EQ(entries[0]["additional_information"].count("score_information"), 0U);
}

TEST_F(EvaluateTest, ScoreThresholdsFilterPredictions) {
  const json entries = json::parse(vectorized({"-d", "4", "-S", path("thresholds.txt")}).out);
  ASSERT_EQ(entries.size(), 16U);
  EXPECT_DOUBLE_EQ(entries[4]["value"].get<double>(), 0.5);   // precision, score > 0.1
  EXPECT_DOUBLE_EQ(entries[10]["value"].get<double>(), 1.0);  // precision, score > 0.5
  EXPECT_DOUBLE_EQ(
      entries[10]["additional_information"]["score_information"]["score_threshold"].get<double>(),
      0.5);
}

TEST_F(EvaluateTest, AverageOfNothingIsNaN) {
  for (int frame = 0; frame < 3; ++frame) {
    folder_.write("pred/" + stemOf(frame) + ".csv", "");
    folder_.write("scores/" + stemOf(frame) + ".csv", "");
  }
  const Outcome outcome = vectorized({"-d", "4", "--bootstrap", "10"});
  EXPECT_EQ(outcome.status, kExitDone) << outcome.err;
  EXPECT_NE(outcome.out.find("\"low\": NaN, \"high\": NaN}}, \"value\": NaN}"), std::string::npos)
      << outcome.out;
  EXPECT_NE(outcome.out.find("\"values\": {\"x\": [], \"y\": []}"), std::string::npos);
}

TEST_F(EvaluateTest, WritesTheFileAndPrintsATable) {
  const Outcome outcome = vectorized({"-o", path("new/out")}, false);
  EXPECT_EQ(outcome.status, kExitDone) << outcome.err;
  EXPECT_EQ(outcome.out.rfind("distance ", 0), 0U) << outcome.out;
  const std::string text = readText(path("new/out/vectorized_classification_metrics.json"));
  EXPECT_EQ(text, vectorized({}, false).out);
}

TEST_F(EvaluateTest, OverwritesItsOwnOutputFolder) {
  EXPECT_EQ(association({"-o", path("out")}).status, kExitDone);
  folder_.write("out/classification_metrics.json", "old");
  EXPECT_EQ(association({"-o", path("out")}).status, kExitDone);
  EXPECT_EQ(readText(path("out/classification_metrics.json")).front(), '[');
}

TEST_F(EvaluateTest, OverwritesForeignFilesByForceAlone) {
  folder_.write("mine/classification_metrics.json", "theirs");
  expectFailure(association({"-o", path("mine")}), {"classification_metrics.json", "--force"});
  EXPECT_EQ(readText(path("mine/classification_metrics.json")), "theirs");
  EXPECT_EQ(association({"-o", path("mine"), "--force"}).status, kExitDone);
  EXPECT_EQ(readText(path("mine/classification_metrics.json")).front(), '[');
  // By now the file is one that evaluate made; those beside it are not.
  EXPECT_EQ(association({"-o", path("mine")}).status, kExitDone);
  folder_.write("mine/vectorized_classification_metrics.json", "theirs");
  expectFailure(vectorized({"-o", path("mine")}), {"vectorized_classification_metrics.json"});
  EXPECT_EQ(readText(path("mine/vectorized_classification_metrics.json")), "theirs");
}

TEST_F(EvaluateTest, FamiliesShareAnOutputFolder) {
  for (int pass = 0; pass < 2; ++pass) {
    EXPECT_EQ(association({"-o", path("out")}).status, kExitDone) << pass;
    EXPECT_EQ(vectorized({"-o", path("out")}).status, kExitDone) << pass;
  }
}

TEST_F(EvaluateTest, FormatsAgree) {
  const std::string csv = association({"--format", "csv"}).out;
  EXPECT_EQ(csv.rfind("name,", 0), 0U);
  EXPECT_NE(csv.find("precision,,,,,,0.5,,,\n"), std::string::npos) << csv;
  const std::string table = association({"--format", "table"}).out;
  EXPECT_NE(table.find("0.5000  0.3333  0.4000"), std::string::npos) << table;
}

TEST_F(EvaluateTest, PaperProtocolAnchorsAveragePrecision) {
  const json evolin = json::parse(vectorized({"-d", "4"}).out);
  const json paper = json::parse(vectorized({"-d", "4", "--protocol", "paper"}).out);
  // Three hits of six lines first: two or three steps of 1/6 at precision 1.
  EXPECT_NEAR(evolin[0]["value"].get<double>(), 2.0 / 6, 1e-12);
  EXPECT_NEAR(paper[0]["value"].get<double>(), 3.0 / 6, 1e-12);
}

/// Forty frames with some right and some wrong lines.
void writeSequence(const test::TemporaryFolder& folder) {
  test::RandomLines random(3);
  const auto to_text = [](const LineSegments& lines) {
    std::string text;
    for (const LineSegment& line : lines) {
      text += formatDouble(line.x1) + "," + formatDouble(line.y1) + "," + formatDouble(line.x2) +
              "," + formatDouble(line.y2) + "\n";
    }
    return text;
  };
  for (int frame = 0; frame < 40; ++frame) {
    const std::string stem = std::to_string(1000 + frame);
    const LineSegments truth = random.anywhere(12, 64, 48);
    const LineSegments predicted = random.detectionsOf(truth, 20, 4);
    std::string scores;
    for (const LineSegment& line : predicted) {
      scores += formatDouble(line.score) + "\n";
    }
    folder.write("many/gt/" + stem + ".csv", to_text(truth));
    folder.write("many/pred/" + stem + ".csv", to_text(predicted));
    folder.write("many/scores/" + stem + ".csv", scores);
    std::filesystem::create_directories(folder.path() / "many/imgs");
    cv::imwrite((folder.path() / "many/imgs" / (stem + ".png")).string(),
                cv::Mat(48, 64, CV_8UC1, cv::Scalar(0)));
  }
}

TEST_F(EvaluateTest, ThreadsDoNotChangeTheResult) {
  writeSequence(folder_);
  const auto text = [this](const std::string& threads) {
    return run({"evaluate", "vectorized", "-p", path("many/pred"), "-g", path("many/gt"), "-i",
                path("many/imgs"), "-s", path("many/scores"), "-S", path("thresholds.txt"),
                "--threads", threads, "--bootstrap", "20"})
        .out;
  };
  const std::string one = text("1");
  EXPECT_GT(one.size(), 1000U);
  EXPECT_EQ(text("4"), one);
  EXPECT_EQ(text("64"), one);
  EXPECT_EQ(text("0"), one);
}

TEST_F(EvaluateTest, BootstrapAddsIntervalsAroundTheValues) {
  writeSequence(folder_);
  const json entries =
      json::parse(run({"evaluate", "vectorized", "-p", path("many/pred"), "-g", path("many/gt"),
                       "-i", path("many/imgs"), "-s", path("many/scores"), "-S",
                       path("thresholds.txt"), "--bootstrap", "200"})
                      .out);
  int scalars = 0;
  for (const json& entry : entries) {
    if (!entry.contains("value")) {
      EXPECT_EQ(entry["additional_information"].count("confidence_interval"), 0U);
      continue;
    }
    ++scalars;
    const json& interval = entry["additional_information"]["confidence_interval"];
    EXPECT_EQ(interval["level"], 0.95);
    EXPECT_LT(interval["low"].get<double>(), entry["value"].get<double>());
    EXPECT_GT(interval["high"].get<double>(), entry["value"].get<double>());
    EXPECT_LT(interval["high"].get<double>() - interval["low"].get<double>(), 0.3);
  }
  EXPECT_EQ(scalars, 42);
  const json pairs = json::parse(association({"--bootstrap", "50"}).out);
  // All pairs are alike: the interval has no width.
  EXPECT_EQ(pairs[0]["additional_information"]["confidence_interval"]["low"], pairs[0]["value"]);
}

TEST_F(EvaluateTest, MissingFilesAreNamedByStem) {
  std::filesystem::remove(path("pred/0001.csv"));
  expectFailure(vectorized(), {"predicted lines", "0001"});
  folder_.write("pred/0001.csv", "1,1,2,2\n3,3,5,4\n");
  std::filesystem::remove(path("scores/0002.csv"));
  expectFailure(vectorized(), {"scores", "0002"});
  folder_.write("scores/0002.csv", "1\n1\n");
  std::filesystem::remove(path("imgs/0001.jpg"));
  expectFailure(vectorized(), {"image", "0001"});
}

TEST_F(EvaluateTest, FilesWithoutGroundTruthAreNamedByStem) {
  folder_.write("pred/0007.csv", "1,1,2,2\n");
  expectFailure(vectorized({}, false), {"true lines", "0007"});
}

TEST_F(EvaluateTest, MoreImagesThanFramesAreFine) {
  cv::imwrite(path("imgs") + "/0099.png", cv::Mat(48, 64, CV_8UC1, cv::Scalar(0)));
  EXPECT_EQ(vectorized().status, kExitDone);
}

TEST_F(EvaluateTest, AssociationFilesPairBothWays) {
  folder_.write("pred_pairs/0009_x.csv", "0,0\n");
  expectFailure(association(), {"true associations", "0009_x"});
  folder_.write("gt_pairs/0009_x.csv", "0,0\n");
  std::filesystem::remove(path("pred_pairs/0000_x.csv"));
  expectFailure(association(), {"predicted associations", "0000_x"});
}

TEST_F(EvaluateTest, BadContentIsNamedByFileAndLine) {
  folder_.write("scores/0001.csv", "1\n2\n3\n");
  expectFailure(vectorized(), {"scores/0001.csv"});
  folder_.write("scores/0001.csv", "1\nhigh\n");
  expectFailure(vectorized(), {"scores/0001.csv:2", "'high'"});
  folder_.write("scores/0001.csv", "1\n2\n");
  folder_.write("pred/0002.csv", "1,1,2,2\n1,nan,2,2\n");
  expectFailure(vectorized(), {"pred/0002.csv:2", "'nan'"});
  folder_.write("pred/0002.csv", "1,1,2,2\n1,1,2\n");
  expectFailure(vectorized(), {"pred/0002.csv:2"});
  folder_.write("gt_pairs/0001_x.csv", "0,0\n-1,2\n");
  expectFailure(association(), {"gt_pairs/0001_x.csv:2", "'-1'"});
}

TEST_F(EvaluateTest, BadGroundTruthIsNamedByFileAndLineAndByFrameAndRow) {
  folder_.write("gt/0001.csv", "10,10,50,30\n4,4,4,4\n");
  expectFailure(vectorized(), {"gt/0001.csv:2: ", "frame 0001, row 1", "4,4,4,4"});
  folder_.write("gt/0001.csv", "10,10,50,30\n4,4,400,4\n");
  expectFailure(vectorized(), {"gt/0001.csv:2: ", "frame 0001, row 1", "64 x 48"});
}

TEST_F(EvaluateTest, TheFirstOfSeveralBadFramesIsNamedWithAnyNumberOfThreads) {
  folder_.write("gt/0001.csv", "4,4,4,4\n");
  folder_.write("gt/0002.csv", "4,4,4,4\n");
  for (const std::string threads : {"1", "2", "3"}) {
    expectFailure(vectorized({"--threads", threads}), {"frame 0001"});
  }
}

TEST_F(EvaluateTest, UnreadableInputIsStatusOne) {
  folder_.write("imgs/0001.jpg", "no picture");
  expectFailure(vectorized(), {"imgs/0001.jpg"});
  expectFailure(run({"evaluate", "association", "-p", path("absent"), "-g", path("gt_pairs")}),
                {"absent"});
  std::filesystem::create_directories(path("empty"));
  expectFailure(run({"evaluate", "association", "-p", path("empty"), "-g", path("gt_pairs")}),
                {"empty"});
  expectFailure(vectorized({"-S", path("absent.txt")}), {"absent.txt"});
}

TEST_F(EvaluateTest, TwoImagesOfOneStemAreRefused) {
  cv::imwrite(path("imgs") + "/0000.jpg", cv::Mat(48, 64, CV_8UC1, cv::Scalar(0)));
  expectFailure(vectorized(), {"0000.jpg", "0000.png"});
}

}  // namespace
}  // namespace evolin::cli
