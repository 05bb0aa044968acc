// `evolin evaluate pose`: the published figures, both strategies, and what it refuses.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "evaluate_command.h"
#include "test/support/shared_data.h"
#include "test/support/temporary_folder.h"

namespace evolin::cli {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using Arguments = std::vector<std::string>;

json readJson(const fs::path& file) {
  std::ifstream stream(file);
  return json::parse(stream);
}

struct Outcome {
  int status = 0;
  json entries;
  std::string errors;
};

Outcome evaluatePoses(const Arguments& folders, const Arguments& more = {}) {
  const test::TemporaryFolder folder;
  Arguments arguments = {"evaluate", "pose"};
  arguments.insert(arguments.end(), folders.begin(), folders.end());
  arguments.insert(arguments.end(), more.begin(), more.end());
  arguments.insert(arguments.end(), {"--output", (folder.path() / "out").string()});
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  Outcome outcome;
  outcome.status = runProgram({evaluateCommand()}, arguments);
  ::testing::internal::GetCapturedStdout();
  outcome.errors = ::testing::internal::GetCapturedStderr();
  if (outcome.status == kExitDone) {
    outcome.entries = readJson(folder.path() / "out" / "pose_errors.json");
  }
  return outcome;
}

/// The value of the first entry of that name (and threshold); a failed test when there is none.
double valueOf(const json& entries, const std::string& name, double threshold = 0) {
  for (const json& entry : entries) {
    if (entry["name"] == name &&
        (threshold == 0 ||
         entry["additional_information"]["threshold_information"]["threshold"] == threshold)) {
      return entry["value"].get<double>();
    }
  }
  ADD_FAILURE() << "no entry " << name;
  return std::nan("");
}

Arguments livingRoom() {
  const fs::path sample = test::sharedFolder() / "data" / "icl_nuim_lr_sample";
  return {"--lines",
          (sample / "gt_lines").string(),
          "--associations",
          (sample / "gt_associations_step1").string(),
          "--depths",
          (sample / "depth").string(),
          "--poses",
          (sample / "poses.txt").string(),
          "--depth-associations",
          (sample / "depth_associations.txt").string(),
          "--calibration-matrix",
          (sample / "calibration_matrix.txt").string()};
}

Arguments drawnScene() {
  const fs::path set = test::sharedFolder() / "data/golden/sets/pose_basic";
  return {"-l", (set / "lines").string(),
          "-a", (set / "associations").string(),
          "-d", (set / "depth").string(),
          "-p", (set / "poses.txt").string(),
          "-A", (set / "depth_associations.txt").string(),
          "-c", (set / "calibration_matrix.txt").string()};
}

void expectGolden(const json& actual, const json& expected) {
  ASSERT_EQ(actual.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    ASSERT_EQ(actual[i]["name"], expected[i]["name"]) << i;
    ASSERT_EQ(actual[i]["additional_information"], expected[i]["additional_information"]) << i;
    const double value = expected[i]["value"];
    const std::string name = expected[i]["name"];
    const double tolerance = name == "median_absolute_translation_error" ? 5e-5
                             : name == "median_angular_rotation_error"   ? 1e-3
                                                                         : 1e-4 * value;
    EXPECT_NEAR(actual[i]["value"].get<double>(), value, tolerance) << name << ", entry " << i;
  }
}

TEST(EvaluatePose, EqualsThePublishedFiguresOnTheLivingRoom) {
  EVOLIN_REQUIRE_SHARED_DATA();
  const json golden = readJson(test::sharedFolder() / "data/golden/icl/pose_error.json");
  for (const char* threads : {"1", "3"}) {
    const Outcome outcome = evaluatePoses(livingRoom(), {"-t", "1", "3", "--threads", threads});
    ASSERT_EQ(outcome.status, kExitDone) << outcome.errors;
    expectGolden(outcome.entries, golden);
    EXPECT_NE(outcome.errors.find("9 pairs of frames 1 apart"), std::string::npos)
        << outcome.errors;
  }
}

TEST(EvaluatePose, EqualsThePublishedFiguresOnTheDrawnScene) {
  EVOLIN_REQUIRE_SHARED_DATA();
  const Outcome outcome = evaluatePoses(drawnScene());
  ASSERT_EQ(outcome.status, kExitDone) << outcome.errors;
  expectGolden(outcome.entries,
               readJson(test::sharedFolder() /
                        "data/golden/sets/pose_basic/expected/pose_error.json")["results"]);
  EXPECT_NE(outcome.errors.find("7 ill-conditioned"), std::string::npos) << outcome.errors;
}

TEST(EvaluatePose, TheTruePairingIsNearerAndLeavesOutAPair) {
  EVOLIN_REQUIRE_SHARED_DATA();
  const Outcome by_row = evaluatePoses(livingRoom());
  const Outcome by_number = evaluatePoses(livingRoom(), {"--pose-offset", "-1"});
  ASSERT_EQ(by_number.status, kExitDone) << by_number.errors;
  EXPECT_NE(by_number.errors.find("8 pairs"), std::string::npos) << by_number.errors;
  EXPECT_NE(by_number.errors.find("1 pairs without a pose"), std::string::npos);
  EXPECT_NE(by_number.errors.find("row i - 1"), std::string::npos);
  // The camera moves by 2 mm a frame, as much as the error of a translation: only the angles tell
  // which pairing is right.
  for (const char* name : {"median_angular_rotation_error", "median_angular_translation_error"}) {
    EXPECT_LT(valueOf(by_number.entries, name), valueOf(by_row.entries, name)) << name;
  }
}

TEST(EvaluatePose, RobustIsBetterOnTheDrawnScene) {
  EVOLIN_REQUIRE_SHARED_DATA();
  const Outcome evolin = evaluatePoses(drawnScene(), {"--statistics"});
  const Outcome robust = evaluatePoses(drawnScene(), {"--statistics", "--strategy", "robust"});
  ASSERT_EQ(robust.status, kExitDone) << robust.errors;
  for (const char* name : {"median_angular_rotation_error", "median_absolute_translation_error",
                           "absolute_translation_error_rmse"}) {
    EXPECT_LT(valueOf(robust.entries, name), 0.5 * valueOf(evolin.entries, name)) << name;
  }
  EXPECT_EQ(valueOf(robust.entries, "ill_conditioned_pairs"), 0);
  EXPECT_EQ(valueOf(robust.entries, "failed_pairs"), 0);
  EXPECT_EQ(valueOf(robust.entries, "pairs"), 7);
  EXPECT_GT(valueOf(robust.entries, "success_rate"), valueOf(evolin.entries, "success_rate"));
  EXPECT_GE(valueOf(robust.entries, "pose_error_auc", 3), valueOf(robust.entries, "auc_max", 3));
}

TEST(EvaluatePose, ThePaperKeepsMoreMatches) {
  EVOLIN_REQUIRE_SHARED_DATA();
  const Outcome paper = evaluatePoses(drawnScene(), {"--protocol", "paper", "--statistics"});
  ASSERT_EQ(paper.status, kExitDone) << paper.errors;
  EXPECT_EQ(valueOf(paper.entries, "ill_conditioned_pairs"), 0);
}

TEST(EvaluatePose, BootstrapAddsIntervalsToTheMedians) {
  EVOLIN_REQUIRE_SHARED_DATA();
  const Outcome outcome = evaluatePoses(drawnScene(), {"--bootstrap", "200"});
  ASSERT_EQ(outcome.status, kExitDone) << outcome.errors;
  for (int i = 0; i < 3; ++i) {
    const json& entry = outcome.entries[static_cast<std::size_t>(i)];
    const json& interval = entry["additional_information"]["confidence_interval"];
    EXPECT_LE(interval["low"].get<double>(), entry["value"].get<double>());
    EXPECT_GE(interval["high"].get<double>(), entry["value"].get<double>());
    EXPECT_LT(interval["low"].get<double>(), interval["high"].get<double>());
  }
}

/// A tiny sequence of its own: three frames without motion.
class EvaluatePoseFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    for (int frame = 0; frame < 3; ++frame) {
      folder_.write("lines/000" + std::to_string(frame) + ".csv",
                    "10,10,50,12\n12,40,14,90\n60,20,90,80\n30,60,90,20\n5,5,80,90\n20,80,90,85\n");
      // A plane of 2 metres as a portable grey map.
      std::string depth = "P5\n100 100\n65535\n";
      for (int pixel = 0; pixel < 100 * 100; ++pixel) {
        depth += {static_cast<char>(10000 >> 8), static_cast<char>(10000 & 0xff)};
      }
      folder_.write("depth/000" + std::to_string(frame) + ".pgm", depth);
    }
    const std::string matches = "0,0\n1,1\n2,2\n3,3\n4,4\n5,5\n";
    folder_.write("associations/0000_0001.csv", matches);
    folder_.write("associations/0001_0002.csv", matches);
    folder_.write("poses.txt", "0 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n");
    folder_.write("depth_associations.txt", "0 0\n1 1\n2 2\n");
    folder_.write("calibration_matrix.txt", "100 0 50\n0 100 50\n0 0 1\n");
  }

  Arguments folders() const {
    const fs::path& path = folder_.path();
    return {"-l", (path / "lines").string(),
            "-a", (path / "associations").string(),
            "-d", (path / "depth").string(),
            "-p", (path / "poses.txt").string(),
            "-A", (path / "depth_associations.txt").string(),
            "-c", (path / "calibration_matrix.txt").string()};
  }

  void expectFailure(const Arguments& more, int status, const std::string& part) const {
    const Outcome outcome = evaluatePoses(folders(), more);
    EXPECT_EQ(outcome.status, status) << outcome.errors;
    EXPECT_NE(outcome.errors.find(part), std::string::npos) << outcome.errors;
  }

  test::TemporaryFolder folder_;
};

TEST_F(EvaluatePoseFiles, AStillCameraHasNoErrorAndNoNan) {
  for (const char* strategy : {"evolin", "robust"}) {
    const Outcome outcome = evaluatePoses(folders(), {"--strategy", strategy, "--statistics"});
    ASSERT_EQ(outcome.status, kExitDone) << outcome.errors;
    for (const json& entry : outcome.entries) {
      EXPECT_TRUE(std::isfinite(entry["value"].get<double>())) << entry;
    }
    EXPECT_LT(valueOf(outcome.entries, "median_angular_rotation_error"), 1e-6);
    EXPECT_EQ(valueOf(outcome.entries, "near_static_pairs"), 2);
    EXPECT_EQ(valueOf(outcome.entries, "success_rate"), 1);
  }
}

TEST_F(EvaluatePoseFiles, APairWithoutAPoseFoundIsInfinite) {
  folder_.write("associations/0000_0001.csv", "0,0\n");
  folder_.write("associations/0001_0002.csv", "");
  const test::TemporaryFolder output;
  Arguments arguments = {"evaluate", "pose"};
  const Arguments inputs = folders();
  arguments.insert(arguments.end(), inputs.begin(), inputs.end());
  ::testing::internal::CaptureStdout();
  EXPECT_EQ(runProgram({evaluateCommand()}, arguments), kExitDone);
  const std::string text = ::testing::internal::GetCapturedStdout();
  EXPECT_NE(text.find("\"value\": Infinity"), std::string::npos) << text;
}

TEST_F(EvaluatePoseFiles, RefusesWhatDoesNotFitTogether) {
  folder_.write("associations/0000_0001.csv", "0,0\n1,9\n");
  expectFailure({}, kExitFailed, "0000_0001.csv:2: names line 9 of the second frame");
  folder_.write("associations/0000_0001.csv", "0,0\n");
  folder_.write("depth_associations.txt", "0 0\n1 7\n");
  expectFailure({}, kExitFailed, "depth_associations.txt:2");
  folder_.write("depth_associations.txt", "0 0\n");
  expectFailure({}, kExitFailed, "2 without depth");
  folder_.write("depth_associations.txt", "0 0\n0 1\n");
  expectFailure({}, kExitFailed, "occurs twice");
  folder_.write("depth_associations.txt", "0 0\n1 1\n2 2\n");
  folder_.write("poses.txt", "0 0 0 0 0 0 0 1\n");
  expectFailure({}, kExitFailed, "1 poses, expected one for each of the 3 line files");
  folder_.write("poses.txt", "0 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n");
  expectFailure({"--pose-offset", "-5"}, kExitFailed, "2 without a pose");
}

TEST_F(EvaluatePoseFiles, RefusesPairsNamedAfterOtherFrames) {
  fs::rename(folder_.path() / "associations/0001_0002.csv",
             folder_.path() / "associations/0001_0000.csv");
  expectFailure({}, kExitFailed, "names frames 0001 and 0000");
}

TEST_F(EvaluatePoseFiles, FramesAreTheRowsOfTheDepthListWherePosesAre) {
  folder_.write("depth_associations.txt", "0 0\n2 2\n");
  folder_.write("poses.txt", "0 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n");
  fs::remove(folder_.path() / "associations/0001_0002.csv");
  expectFailure({}, kExitFailed, "names frames 0000 and 0001");
  fs::rename(folder_.path() / "associations/0000_0001.csv",
             folder_.path() / "associations/0000_0002.csv");
  const Outcome outcome = evaluatePoses(folders());
  ASSERT_EQ(outcome.status, kExitDone) << outcome.errors;
  EXPECT_NE(outcome.errors.find("1 pairs of frames 1 apart"), std::string::npos) << outcome.errors;
  EXPECT_LT(valueOf(outcome.entries, "median_angular_rotation_error"), 1e-6);
}

TEST_F(EvaluatePoseFiles, RefusesDepthImagesOfAnotherSize) {
  folder_.write("depth/0001.pgm", "P5\n1 1\n65535\n12");
  expectFailure({}, kExitFailed, "0001.pgm: the depth image is 1 x 1 pixels, expected 100 x 100");
}

TEST_F(EvaluatePoseFiles, RefusesAsManyAssociationsAsFrames) {
  folder_.write("associations/more.csv", "0,0\n");
  expectFailure({}, kExitFailed, "3 association files for 3 line files");
}

TEST_F(EvaluatePoseFiles, RefusesOptionsOutOfRange) {
  expectFailure({"-t", "0"}, kExitWrongUse, "--pose-error-auc-thresholds 0");
  expectFailure({"--strategy", "ransac"}, kExitWrongUse, "evolin or robust");
  expectFailure({"--depth-factor", "-1"}, kExitWrongUse, "--depth-factor");
}

}  // namespace
}  // namespace evolin::cli
