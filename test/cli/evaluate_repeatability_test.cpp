// `evolin evaluate repeatability` as a user meets it: options, output, refusals, exit statuses.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "evaluate_command.h"
#include "evolin_ros/base/text.h"
#include "evolin_ros/dataset/csv.h"
#include "evolin_ros/metrics/repeatability.h"
#include "test/support/random_lines.h"
#include "test/support/temporary_folder.h"

namespace evolin::cli {
namespace {

using nlohmann::json;

constexpr double kFocalLength = 32;
constexpr double kWallDepth = 2;
constexpr double kMetresPerPixel = kWallDepth / kFocalLength;

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

std::string toText(const LineSegments& lines) {
  std::string text;
  for (const LineSegment& line : lines) {
    text += formatDouble(line.x1) + "," + formatDouble(line.y1) + "," + formatDouble(line.x2) +
            "," + formatDouble(line.y2) + "\n";
  }
  return text;
}

std::string stemOf(int frame) { return std::to_string(1000 + frame); }

/// A camera that moves along a wall, one pixel a frame. Five frames of 64 x 48 pixels, each with a
/// line on the wall (score 0.9) and one that belongs to no other frame (score 0.2).
class EvaluateRepeatabilityTest : public ::testing::Test {
 protected:
  static constexpr int kFrames = 5;

  void SetUp() override {
    folder_.write("thresholds.txt", "0.1 0.5\n");
    folder_.write("K.txt", "32 0 31.5\n0 32 23.5\n0 0 1\n");
    writeFrames(kFrames);
    for (int frame = 0; frame < kFrames; ++frame) {
      const std::string shift = std::to_string(30 - frame);
      const std::string stray = std::to_string(2 + 9 * frame);
      folder_.write("lines/" + stemOf(frame) + ".csv", shift + ",10," + std::to_string(50 - frame) +
                                                           ",30\n" + stray + ",41," +
                                                           std::to_string(9 * frame + 8) + ",4\n");
      folder_.write("scores/" + stemOf(frame) + ".csv", "0.9\n0.2\n");
    }
  }

  /// Depth images, poses and the list that joins them.
  void writeFrames(int count) const {
    std::string poses;
    std::string associations;
    std::filesystem::create_directories(path("depth"));
    for (int frame = 0; frame < count; ++frame) {
      poses +=
          std::to_string(frame) + " " + formatDouble(frame * kMetresPerPixel) + " 0 0 0 0 0 1\n";
      associations += std::to_string(frame) + " " + std::to_string(frame) + "\n";
      cv::imwrite(path("depth") + "/" + stemOf(frame) + ".png",
                  cv::Mat(48, 64, CV_16UC1, cv::Scalar(5000 * kWallDepth)));
    }
    folder_.write("poses.txt", poses);
    folder_.write("depth_associations.txt", associations);
  }

  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }

  Outcome repeatability(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"evaluate", "repeatability",
                                          "-p",       path("lines"),
                                          "-D",       path("depth"),
                                          "-P",       path("poses.txt"),
                                          "-a",       path("depth_associations.txt"),
                                          "-c",       path("K.txt")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }

  std::vector<std::string> scored(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"-s", path("scores"), "-S", path("thresholds.txt")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }

  /// Status 1, nothing on standard output, `words` on the last line of standard error.
  static void expectFailure(const Outcome& outcome, const std::vector<std::string>& words) {
    EXPECT_EQ(outcome.status, kExitFailed) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    const std::size_t message = outcome.err.find("evolin evaluate: ");
    ASSERT_NE(message, std::string::npos) << outcome.err;
    for (const std::string& word : words) {
      EXPECT_NE(outcome.err.find(word, message), std::string::npos)
          << word << " is not in " << outcome.err;
    }
  }

  test::TemporaryFolder folder_;
};

TEST_F(EvaluateRepeatabilityTest, HelpTellsOptionsAndDefaults) {
  const Outcome outcome = run({"evaluate", "repeatability", "--help"});
  EXPECT_EQ(outcome.status, kExitDone);
  for (const std::string word :
       {"--pred-lines", "--scores", "--score-thresholds", "--depths", "--poses",
        "--depth-associations", "--calibration-matrix", "--distance-thresholds", "5 10 15",
        "--frames-steps", "(=10)", "--pose-offset", "--depth-factor", "(=5000)",
        "repeatability_metrics.json", "--protocol", "--threads", "--bootstrap"}) {
    EXPECT_NE(outcome.out.find(word), std::string::npos) << word;
  }
}

TEST_F(EvaluateRepeatabilityTest, FindsTheWallsLinesAgain) {
  const Outcome outcome = repeatability({"-f", "1", "2", "-d", "3"});
  EXPECT_EQ(outcome.status, kExitDone) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  const json entries = json::parse(outcome.out);
  ASSERT_EQ(entries.size(), 8U);  // two figures for two distances and two steps
  for (std::size_t i = 0; i < entries.size(); ++i) {
    EXPECT_EQ(entries[i]["name"], i % 2 == 0 ? "repeatability" : "localization_error");
    // One line of two, exactly where it is expected.
    EXPECT_NEAR(entries[i]["value"].get<double>(), i % 2 == 0 ? 0.5 : 0.0, 1e-9) << i;
  }
  EXPECT_EQ(entries[2]["additional_information"]["frames_step_information"]["step"], 2);
  EXPECT_EQ(entries[4]["additional_information"]["distance_information"]["distance"], "structural");
}

TEST_F(EvaluateRepeatabilityTest, ScoreThresholdsFilterLines) {
  const json entries = json::parse(repeatability(scored({"-f", "1", "-d", "3"})).out);
  ASSERT_EQ(entries.size(), 8U);
  EXPECT_EQ(entries[0]["value"], 0.5);
  EXPECT_EQ(entries[4]["value"], 1.0);
  EXPECT_EQ(entries[4]["additional_information"]["score_information"]["score_threshold"], 0.5);
}

TEST_F(EvaluateRepeatabilityTest, DepthFactorScalesTheMotion) {
  // Half as far: the wall moves by two pixels a frame, four scaled ones, at both ends.
  const json entries =
      json::parse(repeatability(scored({"-f", "1", "-d", "20", "--depth-factor", "10000"})).out);
  ASSERT_EQ(entries.size(), 8U);
  EXPECT_NEAR(entries[7]["value"].get<double>(), 4, 1e-9);
}

TEST_F(EvaluateRepeatabilityTest, PaperProtocolIncludesTheThreshold) {
  const auto value = [this](const std::string& protocol) {
    const json entries = json::parse(repeatability(scored({"-f", "1", "-d", "4", "--depth-factor",
                                                           "10000", "--protocol", protocol}))
                                         .out);
    return entries[6]["value"].get<double>();
  };
  EXPECT_EQ(value("evolin"), 0);
  EXPECT_EQ(value("paper"), 1);
}

TEST_F(EvaluateRepeatabilityTest, WritesTheFileAndPrintsATable) {
  const Outcome outcome = repeatability({"-f", "1", "-o", path("new/out")});
  EXPECT_EQ(outcome.status, kExitDone) << outcome.err;
  EXPECT_EQ(outcome.out.rfind("distance ", 0), 0U) << outcome.out;
  std::ifstream stream(path("new/out/repeatability_metrics.json"));
  const std::string text((std::istreambuf_iterator<char>(stream)), {});
  EXPECT_EQ(text, repeatability({"-f", "1"}).out);
}

TEST_F(EvaluateRepeatabilityTest, ValuesOutOfRangeAreWrongUse) {
  const std::vector<std::vector<std::string>> cases = {
      {"-f", "0"},
      {"-f", "1", "1"},
      {"-f", "one"},
      {"-d", "-5"},
      {"-d", "nan"},
      {"--depth-factor", "0"},
      {"--depth-factor", "inf"},
      {"--protocol", "new"},
      {"--pose-offset", "x"},
      {"-s", path("scores")},
      {"-S", path("thresholds.txt")},
  };
  for (const std::vector<std::string>& arguments : cases) {
    const Outcome outcome = repeatability(arguments);
    EXPECT_EQ(outcome.status, kExitWrongUse) << arguments[0] << " " << outcome.err;
    EXPECT_EQ(outcome.out, "");
  }
  EXPECT_EQ(run({"evaluate", "repeatability", "-p", path("lines")}).status, kExitWrongUse);
}

TEST_F(EvaluateRepeatabilityTest, AStepWithoutPairsIsAnError) {
  expectFailure(repeatability(), {"--frames-steps 10", "5 frames"});
  expectFailure(repeatability({"-f", "1", "5"}), {"--frames-steps 5"});
}

TEST_F(EvaluateRepeatabilityTest, PoseOffsetLeavesOutAndCountsImagesWithoutPose) {
  const Outcome outcome = repeatability(scored({"-f", "1", "-d", "3", "--pose-offset", "-1"}));
  EXPECT_EQ(outcome.status, kExitDone) << outcome.err;
  EXPECT_NE(outcome.err.find("1 of 5 frames left out: no pose"), std::string::npos) << outcome.err;
  EXPECT_EQ(json::parse(outcome.out)[4]["value"], 1.0);  // the motion is the same
  expectFailure(repeatability({"-f", "1", "--pose-offset", "4"}), {"no pair"});
}

TEST_F(EvaluateRepeatabilityTest, PoseOffsetTakesOtherPoses) {
  folder_.write("poses.txt",
                "0 0 0 0 0 0 0 1\n1 9 0 0 0 0 0 1\n2 9.0625 0 0 0 0 0 1\n3 9.125 0 0 0 0 0 1\n"
                "4 9.1875 0 0 0 0 0 1\n5 9.25 0 0 0 0 0 1\n");
  const auto value = [this](const std::string& offset) {
    return json::parse(repeatability(scored({"-f", "1", "-d", "3", "--pose-offset", offset})).out)
        .at(4)["value"]
        .get<double>();
  };
  EXPECT_EQ(value("1"), 1);
  expectFailure(repeatability({"-f", "1"}), {"poses.txt: 6 poses", "5 line files"});
  folder_.write("poses.txt",
                "0 0 0 0 0 0 0 1\n1 9 0 0 0 0 0 1\n2 9.0625 0 0 0 0 0 1\n3 9.125 0 0 0 0 0 1\n"
                "4 9.1875 0 0 0 0 0 1\n");
  EXPECT_EQ(value("0"), 0.75);
}

TEST_F(EvaluateRepeatabilityTest, BadPosesAreNamedByFileAndLine) {
  folder_.write("poses.txt", "0 0 0 0 0 0 0 1\n1 zero 0 0 0 0 0 1\n");
  expectFailure(repeatability({"-f", "1"}), {"poses.txt:2", "'zero'"});
  folder_.write("poses.txt", "0 0 0 0 0 0 0 0\n");
  expectFailure(repeatability({"-f", "1"}), {"poses.txt:1", "quaternion"});
  folder_.write("poses.txt", "0 0 0 0 0 0 1\n");
  expectFailure(repeatability({"-f", "1"}), {"poses.txt:1", "7 fields"});
  std::filesystem::remove(path("poses.txt"));
  expectFailure(repeatability({"-f", "1"}), {"poses.txt"});
}

TEST_F(EvaluateRepeatabilityTest, BadCalibrationIsNamedByFileAndLine) {
  folder_.write("K.txt", "0 0 31.5\n0 32 23.5\n0 0 1\n");
  expectFailure(repeatability({"-f", "1"}), {"K.txt:1", "fx is 0"});
  folder_.write("K.txt", "32 0 31.5\n0 32 23.5\n");
  expectFailure(repeatability({"-f", "1"}), {"K.txt", "2 rows"});
  folder_.write("K.txt", "32 0 31.5\n0 32 x\n0 0 1\n");
  expectFailure(repeatability({"-f", "1"}), {"K.txt:2", "'x'"});
}

TEST_F(EvaluateRepeatabilityTest, MissingDepthImagesAreAnError) {
  std::filesystem::remove(path("depth/1004.png"));
  expectFailure(repeatability({"-f", "1"}),
                {"depth_associations.txt:5", "depth index", "'4'", "the folder has 4"});
  std::filesystem::remove_all(path("depth"));
  expectFailure(repeatability({"-f", "1"}), {"depth"});
}

TEST_F(EvaluateRepeatabilityTest, FramesWithoutDepthAreLeftOutAndCounted) {
  folder_.write("depth_associations.txt", "0 0\n1 1\n3 3\n4 4\n");
  const Outcome outcome = repeatability(scored({"-f", "1", "-d", "3"}));
  EXPECT_EQ(outcome.status, kExitDone) << outcome.err;
  EXPECT_NE(outcome.err.find("1 of 5 frames left out: no depth"), std::string::npos) << outcome.err;
  EXPECT_EQ(json::parse(outcome.out)[4]["value"], 1.0);
  folder_.write("depth_associations.txt", "0 0\n2 2\n4 4\n");
  expectFailure(repeatability({"-f", "1"}), {"--frames-steps 1", "no pair"});
}

TEST_F(EvaluateRepeatabilityTest, FramesAreTheRowsOfTheDepthListWherePosesAre) {
  std::string poses;
  for (const int frame : {0, 1, 3, 4}) {
    poses += "0 " + formatDouble(frame * kMetresPerPixel) + " 0 0 0 0 0 1\n";
  }
  folder_.write("poses.txt", poses);
  folder_.write("depth_associations.txt", "0 0\n1 1\n3 3\n4 4\n");
  const Outcome listed = repeatability({"-f", "1", "-d", "3"});
  EXPECT_EQ(listed.status, kExitDone) << listed.err;
  EXPECT_NE(listed.err.find("the 4 rows of"), std::string::npos) << listed.err;
  std::filesystem::remove(path("lines/1002.csv"));
  std::filesystem::remove(path("depth/1002.png"));
  folder_.write("depth_associations.txt", "0 0\n1 1\n2 2\n3 3\n");
  const Outcome without = repeatability({"-f", "1", "-d", "3"});
  EXPECT_EQ(without.status, kExitDone) << without.err;
  EXPECT_EQ(without.out, listed.out);
}

TEST_F(EvaluateRepeatabilityTest, BadDepthImagesAreNamed) {
  const auto size = std::filesystem::file_size(path("depth/1002.png"));
  std::filesystem::resize_file(path("depth/1002.png"), size / 2);
  expectFailure(repeatability({"-f", "1"}), {"depth/1002.png", "truncated"});
  cv::imwrite(path("depth/1002.png"), cv::Mat(48, 64, CV_8UC1, cv::Scalar(9)));
  expectFailure(repeatability({"-f", "1"}), {"depth/1002.png", "8 bits"});
}

TEST_F(EvaluateRepeatabilityTest, BadLinesAndScoresAreNamed) {
  folder_.write("lines/1003.csv", "1,1,2,2\n1,nan,2,2\n");
  expectFailure(repeatability({"-f", "1"}), {"lines/1003.csv:2", "'nan'"});
  folder_.write("lines/1003.csv", "1,1,2,2\n");
  expectFailure(repeatability(scored({"-f", "1"})), {"scores/1003.csv"});
  std::filesystem::remove(path("scores/1003.csv"));
  expectFailure(repeatability(scored({"-f", "1"})), {"scores", "1003"});
  std::filesystem::remove(path("lines/1003.csv"));
  expectFailure(repeatability({"-f", "1"}), {"depth_associations.txt:5", "image index", "'4'"});
}

TEST_F(EvaluateRepeatabilityTest, EmptyFramesAndLinesOutsideTheImageAreFine) {
  folder_.write("lines/1001.csv", "");
  folder_.write("lines/1002.csv", "-5,-6,700,900\n3,3,3,3\n");
  for (const std::string protocol : {"evolin", "paper"}) {
    const Outcome outcome = repeatability({"-f", "1", "2", "--protocol", protocol});
    EXPECT_EQ(outcome.status, kExitDone) << outcome.err;
    for (const json& entry : json::parse(outcome.out)) {
      EXPECT_TRUE(std::isfinite(entry["value"].get<double>()));
    }
  }
}

/// More frames than are held at once.
class LongRepeatabilityTest : public EvaluateRepeatabilityTest {
 protected:
  static constexpr int kLength = 150;

  void SetUp() override {
    folder_.write("K.txt", "32 0 31.5\n0 32 23.5\n0 0 1\n");
    writeFrames(kLength);
    test::RandomLines random(2);
    const LineSegments world = random.anywhere(12, 64, 48);
    for (int frame = 0; frame < kLength; ++frame) {
      folder_.write("lines/" + stemOf(frame) + ".csv", toText(random.detectionsOf(world, 12, 4)));
    }
  }
};

TEST_F(LongRepeatabilityTest, EqualsTheLibraryOnAllPairs) {
  RepeatabilityOptions options;
  options.frame_steps = {1, 70, 140};
  RepeatabilityMetrics metrics(options);
  Camera camera;
  camera.fx = camera.fy = kFocalLength;
  camera.cx = 31.5;
  camera.cy = 23.5;
  const cv::Mat depth(48, 64, CV_32FC1, cv::Scalar(kWallDepth));
  std::vector<SpatialFrame> frames;
  for (int frame = 0; frame < kLength; ++frame) {
    Pose pose;
    pose.translation.x() = frame * kMetresPerPixel;
    frames.push_back(liftLines(Protocol::kEvolin, stemOf(frame),
                               readLinesCsv(path("lines/" + stemOf(frame) + ".csv")),
                               DepthMap(depth), camera, pose));
  }
  for (const int step : options.frame_steps) {
    const auto distance = static_cast<std::size_t>(step);
    for (std::size_t first = 0; first + distance < frames.size(); ++first) {
      metrics.addPair(step, frames[first], frames[first + distance]);
    }
  }
  const json entries = json::parse(repeatability({"-f", "1", "70", "140"}).out);
  ASSERT_EQ(entries.size(), 2 * metrics.settings().size());
  for (std::size_t setting = 0; setting < metrics.settings().size(); ++setting) {
    EXPECT_EQ(entries[2 * setting]["value"].get<double>(), metrics.figures(setting)->repeatability);
    EXPECT_EQ(entries[2 * setting + 1]["value"].get<double>(),
              metrics.figures(setting)->localization_error);
  }
}

TEST_F(LongRepeatabilityTest, ThreadsDoNotChangeTheResult) {
  const auto text = [this](const std::string& threads) {
    return repeatability({"-f", "1", "3", "--threads", threads, "--bootstrap", "20"}).out;
  };
  const std::string one = text("1");
  EXPECT_GT(one.size(), 1000U);
  EXPECT_EQ(text("3"), one);
  EXPECT_EQ(text("0"), one);
}

TEST_F(LongRepeatabilityTest, BootstrapAddsIntervalsAroundTheValues) {
  for (const std::string protocol : {"evolin", "paper"}) {
    const json entries = json::parse(
        repeatability({"-f", "1", "2", "--bootstrap", "200", "--protocol", protocol}).out);
    ASSERT_EQ(entries.size(), 24U);
    for (const json& entry : entries) {
      const json& interval = entry["additional_information"]["confidence_interval"];
      EXPECT_EQ(interval["level"], 0.95);
      EXPECT_LT(interval["low"].get<double>(), entry["value"].get<double>()) << entry;
      EXPECT_GT(interval["high"].get<double>(), entry["value"].get<double>()) << entry;
      EXPECT_LT(interval["high"].get<double>() - interval["low"].get<double>(),
                entry["value"].get<double>())
          << entry;
    }
  }
}

}  // namespace
}  // namespace evolin::cli
