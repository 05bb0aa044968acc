// `evolin run` gives the report of the nodelets that drop nothing, on any number of threads, from
// the whole bag and from its halves.
#include <gtest/gtest.h>

#include "associate_command.h"
#include "bag_run.h"
#include "detect_command.h"
#include "evolin_ros/dataset/synthetic/synthetic_sequence.h"
#include "run_command.h"
#include "test/support/drawn_sequence.h"
#include "test/support/shared_data.h"

namespace evolin::test {
namespace {

/// Everything but how long it took, how it came about, and who counted the input's images.
nlohmann::json figuresOf(nlohmann::json report) {
  report.erase("timing");
  report.erase("provenance");
  report.at("coverage").erase("input_images");
  report.at("coverage").erase("reason");
  return report;
}

/// The report of `evolin run` on these bags.
nlohmann::json runOn(const std::vector<std::filesystem::path>& bags, const std::string& detector,
                     int threads, const std::string& associator = "lbd") {
  const TemporaryFolder folder;
  std::vector<std::string> arguments = {"run", "--quiet", "--threads", std::to_string(threads)};
  arguments.insert(arguments.end(), {"--detector", detector, "--associator", associator});
  for (const std::filesystem::path& bag : bags) {
    arguments.insert(arguments.end(), {"--input", bag.string()});
  }
  const std::filesystem::path output = folder.path() / "out";
  arguments.insert(arguments.end(), {"--output", output.string(), "--set", "heatmap_budget=0"});
  EXPECT_EQ(cli::runProgram({cli::runCommand()}, arguments), cli::kExitDone);
  return readReport(output / "report.json");
}

/// What is not there cannot differ.
void expectFiguresOfAllFamilies(const nlohmann::json& report, std::size_t frames) {
  EXPECT_EQ(report.at("complete"), true);
  EXPECT_EQ(report.at("pass"), 1);
  EXPECT_EQ(report.at("coverage").at("evaluated"), frames);
  EXPECT_EQ(report.at("notes").size(), 0U);
  EXPECT_EQ(report.at("heatmap").at("frames"), frames);
  EXPECT_EQ(report.at("association").at("pairs"), frames - 1);
  EXPECT_GT(report.at("association").at("counts").at("true_positives"), 0);
  EXPECT_EQ(report.at("pose").at("pairs"), frames - 1);
  EXPECT_GT(report.at("detection").at("entries").at(0).at("counts").at("true_positives"), 0);
}

void expectOnlineAndOfflineAgree(const std::vector<SequenceFrame>& frames,
                                 const std::string& detector) {
  const TemporaryFolder folder;
  const std::filesystem::path whole = folder.path() / "whole.bag";
  const std::vector<std::filesystem::path> halves = {folder.path() / "first.bag",
                                                     folder.path() / "second.bag"};
  const auto middle = frames.begin() + static_cast<std::ptrdiff_t>(frames.size() / 2);
  writeBag(frames, whole);
  writeBag({frames.begin(), middle}, halves[0]);
  writeBag({middle, frames.end()}, halves[1]);
  const nlohmann::json offline = figuresOf(runOn({whole}, detector, 1));
  expectFiguresOfAllFamilies(offline, frames.size());
  EXPECT_EQ(offline, figuresOf(runOn({whole}, detector, 2))) << "two threads";
  EXPECT_EQ(offline, figuresOf(runOn(halves, detector, 1))) << "halves";
  EXPECT_EQ(offline, figuresOf(runOn(halves, detector, 2))) << "halves, two threads";
  // The nodelets' budget for the heatmap of a frame is in seconds, which a busy machine may spend.
  ros::param::set(testNamespace() + "/evaluator/heatmap_budget", 0);
  ros::param::set(testNamespace() + "/evaluator/drain_timeout", 30);
  {
    BagRun run(detector);
    EXPECT_EQ(offline, figuresOf(run.play(whole))) << "nodelets";
  }
  BagRun run(detector);
  run.play(halves[0]);
  EXPECT_EQ(offline, figuresOf(run.play(halves[1]))) << "nodelets, halves";
}

TEST(OnlineRun, SyntheticBag) {
  synthetic::SyntheticOptions options;
  options.frames = 24;
  options.width = 320;
  options.height = 240;
  const synthetic::SyntheticSequence sequence(options);
  std::vector<SequenceFrame> frames;
  for (std::size_t number = 0; number < sequence.size(); ++number) {
    frames.push_back(sequence.frame(number));
  }
  expectOnlineAndOfflineAgree(frames, kDefaultDetector);
}

/// Lines and matches that were written to folders go through the nodelets as any method's.
TEST(OnlineRun, RecordedLinesAndMatches) {
  const std::vector<SequenceFrame> frames = drawSequence();
  const TemporaryFolder folder;
  const std::filesystem::path bag = folder.path() / "drawn.bag";
  const std::string lines = (folder.path() / "lines").string();
  const std::string matches = (folder.path() / "matches").string();
  writeBag(frames, bag);
  const std::vector<cli::Command> commands = {cli::detectCommand(), cli::associateCommand()};
  ASSERT_EQ(cli::runProgram(commands, {"detect", "--quiet", "--input", bag.string(), "--detector",
                                       kDefaultDetector, "--output", lines}),
            cli::kExitDone);
  ASSERT_EQ(cli::runProgram(commands, {"associate", "--quiet", "--input", bag.string(),
                                       "--associator", "lbd", "--output", matches}),
            cli::kExitDone);
  const nlohmann::json offline =
      figuresOf(runOn({bag}, "recorded:folder=" + lines, 2, "recorded:folder=" + matches));
  const nlohmann::json direct = figuresOf(runOn({bag}, kDefaultDetector, 1));
  expectFiguresOfAllFamilies(offline, frames.size());
  EXPECT_EQ(offline.at("detection").at("entries"), direct.at("detection").at("entries"));
  EXPECT_EQ(offline.at("association").at("counts"), direct.at("association").at("counts"));
  const std::string space = testNamespace();
  ros::param::set(space + "/evaluator/heatmap_budget", 0);
  ros::param::set(space + "/detector/parameters/folder", lines);
  ros::param::set(space + "/associator/associator", "recorded");
  ros::param::set(space + "/associator/parameters/folder", matches);
  BagRun run("recorded");
  EXPECT_EQ(offline, figuresOf(run.play(bag)));
}

TEST(OnlineRun, IclSample) {
  EVOLIN_REQUIRE_SHARED_DATA();
  SequenceOptions options;
  options.pose_offset = -1;
  options.same_rows = true;  // a row is the same physical line in all frames of the sample
  options.camera = "icl";
  options.camera_folder = EVOLIN_SOURCE_DIR "/config/cameras";
  const auto reader = openSequence(sharedFolder() / "data" / "icl_nuim_lr_sample", options);
  std::vector<SequenceFrame> frames;
  while (std::optional<SequenceFrame> frame = reader->next()) {
    frames.push_back(std::move(*frame));
  }
  const nlohmann::json whole = [&] {
    const TemporaryFolder folder;
    writeBag(frames, folder.path() / "icl.bag");
    const nlohmann::json offline = figuresOf(runOn({folder.path() / "icl.bag"}, "hough_p", 1));
    EXPECT_EQ(offline, figuresOf(runOn({folder.path() / "icl.bag"}, "hough_p", 2)));
    ros::param::set(testNamespace() + "/evaluator/heatmap_budget", 0);
    ros::param::set(testNamespace() + "/evaluator/drain_timeout", 30);
    BagRun run("hough_p");
    EXPECT_EQ(offline, figuresOf(run.play(folder.path() / "icl.bag")));
    return offline;
  }();
  EXPECT_EQ(whole.at("coverage").at("evaluated"), frames.size());
  EXPECT_EQ(whole.at("association").at("pairs"), frames.size() - 1);
}

}  // namespace
}  // namespace evolin::test
