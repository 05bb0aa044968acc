// `evolin run` as a user meets it: the same figures from a folder and from a bag, on any number of
// threads; reports of passes; interrupts.
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "bag_writer.h"
#include "evolin_ros/base/sha256.h"
#include "evolin_ros/evaluation/sequence_run.h"
#include "plugin_loader.h"
#include "run_command.h"
#include "synth_command.h"
#include "test/cli/outcome.h"
#include "test/support/drawn_sequence.h"
#include "test/support/environment.h"
#include "test/support/temporary_folder.h"
#include "validate_command.h"

namespace evolin::cli {
namespace {

namespace fs = std::filesystem;
using test::Outcome;

nlohmann::json readReport(const fs::path& folder) {
  std::ifstream file(folder / "report.json");
  return nlohmann::json::parse(file);
}

nlohmann::json figuresOf(nlohmann::json report) {
  report.erase("timing");
  report.erase("provenance");
  return report;
}

void writeBag(const std::vector<SequenceFrame>& frames, const fs::path& file) {
  BagWriter writer(file);
  for (const SequenceFrame& frame : frames) {
    writer.add(frame);
  }
  writer.close();
}

class RunTest : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }

  Outcome run(const std::string& input, const std::string& output,
              const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"run",      "--input",      path(input),
                                          "--output", path(output),   "--detector",
                                          "hough_p",  "--associator", "lbd"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return test::runCaptured({runCommand()}, arguments);
  }

  nlohmann::json report(const std::string& output) const { return readReport(path(output)); }

  test::TemporaryFolder folder_;
};

TEST_F(RunTest, TheReportDependsNeitherOnThreadsNorOnTheStorage) {
  const std::vector<SequenceFrame> frames = test::drawSequence();
  writeBag(frames, path("data.bag"));
  test::writeEvolinFolder(frames, path("data"));
  const Outcome outcome = run("data.bag", "one", {"--threads", "1", "--quiet"});
  ASSERT_EQ(outcome.status, kExitDone) << outcome.err;
  EXPECT_EQ(outcome.err, "") << "--quiet";
  EXPECT_NE(outcome.out.find("12 of 12 frames evaluated"), std::string::npos) << outcome.out;
  ASSERT_EQ(run("data.bag", "three", {"--threads", "3"}).status, kExitDone);
  const nlohmann::json one = report("one");
  EXPECT_EQ(one.at("complete"), true);
  EXPECT_EQ(one.at("coverage").at("input_images"), 12);
  EXPECT_EQ(one.at("association").at("pairs"), 11);
  EXPECT_EQ(one.at("pose").at("pairs"), 11);
  EXPECT_GT(one.at("heatmap").at("frames"), 0);
  EXPECT_EQ(figuresOf(one), figuresOf(report("three")));
  // The folder has no depth: what needs none is the same.
  const std::vector<std::string> few = {"--metrics", "detection,association,tracks"};
  ASSERT_EQ(run("data", "folder", few).status, kExitDone);
  ASSERT_EQ(run("data.bag", "bag", few).status, kExitDone);
  EXPECT_EQ(figuresOf(report("folder")), figuresOf(report("bag")));
  EXPECT_EQ(report("folder").at("detection"), one.at("detection"));
}

TEST_F(RunTest, DepthAndPosesReachAnAssociatorFromABagAsFromAFolder) {
  for (const char* const name : {"room", "room.bag"}) {
    ASSERT_EQ(test::runCaptured({synthCommand()}, {"synth", "--output", path(name), "--frames", "4",
                                                   "--size", "160x120"})
                  .status,
              kExitDone);
    for (const char* const associator : {"oracle", "geometric:prediction=pose"}) {
      const Outcome outcome =
          test::runCaptured({runCommand()}, {"run", "--input", path(name), "--output", path("out"),
                                             "--detector", "hough_p", "--associator", associator,
                                             "--metrics", "association", "--quiet"});
      ASSERT_EQ(outcome.status, kExitDone) << outcome.err;
      const nlohmann::json association = report("out").at("association");
      EXPECT_EQ(association.at("pairs"), 3) << name << " " << associator;
      EXPECT_GT(association.at("f_score"), 0.9) << name << " " << associator;
    }
  }
}

TEST_F(RunTest, ABagWithoutWhatAnAssociatorNeedsIsRefusedByName) {
  std::vector<SequenceFrame> frames = test::drawSequence();
  for (SequenceFrame& frame : frames) {
    frame.frame.depth = cv::Mat();
  }
  writeBag(frames, path("data.bag"));
  const Outcome outcome = run("data.bag", "out", {"--metrics", "association"});
  EXPECT_EQ(outcome.status, kExitDone) << "lbd needs none: " << outcome.err;
  const Outcome refused = test::runCaptured(
      {runCommand()}, {"run", "--input", path("data.bag"), "--output", path("none"), "--detector",
                       "hough_p", "--associator", "oracle", "--metrics", "association"});
  EXPECT_EQ(refused.status, kExitFailed);
  for (const char* const word : {"data.bag", "a plug-in needs depth", "has no depth"}) {
    EXPECT_NE(refused.err.find(word), std::string::npos) << refused.err;
  }
}

TEST_F(RunTest, ARecordingWithoutACameraIsRefusedWhereThatAloneIsNeeded) {
  const char* const before = std::getenv("ROS_PACKAGE_PATH");
  const test::Variable packages(
      "ROS_PACKAGE_PATH",
      std::string(EVOLIN_SOURCE_DIR "/test/plugins:") + (before == nullptr ? "" : before));
  const auto detect = [this](const std::string& bag) {
    return test::runCaptured({runCommand()},
                             {"run", "--input", path(bag), "--output", path("out"), "--detector",
                              "test_camera", "--metrics", "detection", "--quiet"});
  };
  std::vector<SequenceFrame> frames = test::drawSequence();
  writeBag(frames, path("data.bag"));
  const Outcome outcome = detect("data.bag");
  ASSERT_EQ(outcome.status, kExitDone) << outcome.err;
  EXPECT_EQ(report("out").at("coverage").at("evaluated"), 12);
  test::writeEvolinFolder(frames, path("bare_folder"));
  fs::remove(path("bare_folder/calibration_matrix.txt"));
  for (SequenceFrame& frame : frames) {
    frame.frame.camera.reset();
  }
  writeBag(frames, path("bare.bag"));
  for (const std::string input : {"bare.bag", "bare_folder"}) {
    const Outcome refused = detect(input);
    EXPECT_EQ(refused.status, kExitFailed);
    for (const std::string& word :
         {input, std::string("a plug-in needs camera"), std::string("has no camera")}) {
      EXPECT_NE(refused.err.find(word), std::string::npos) << refused.err;
    }
  }
}

TEST_F(RunTest, TheReportSaysHowItCameAboutAndWhereTheTimeWent) {
  writeBag(test::drawSequence(), path("data.bag"));
  ASSERT_EQ(run("data.bag", "out",
                {"--set", "repeatability_steps=[1,2]", "--frame-step", "2", "--associate",
                 "detected", "--source", "mine", "--min-length", "5", "--metrics",
                 "detection,repeatability,association"})
                .status,
            kExitDone);
  const nlohmann::json made = report("out");
  const nlohmann::json& parameters = made.at("provenance").at("parameters");
  EXPECT_EQ(parameters.at("detector"), "hough_p");
  EXPECT_EQ(parameters.at("repeatability_steps"), nlohmann::json::parse("[1, 2]"));
  EXPECT_EQ(parameters.at("frame_step"), 2);
  EXPECT_EQ(parameters.at("associate"), "detected");
  const nlohmann::json& input = made.at("provenance").at("input");
  EXPECT_EQ(input.at("bags").at(0).at("bag"), path("data.bag"));
  EXPECT_EQ(input.at("image_topic"), "/camera/rgb/image_color");
  EXPECT_EQ(made.at("provenance").at("sha256").at("data.bag"), sha256OfFile(path("data.bag")));
  EXPECT_EQ(made.at("detection").at("source").get<std::string>().rfind("mine#", 0), 0U);
  EXPECT_EQ(made.at("association_detected").at("pairs"), 10);
  EXPECT_FALSE(made.contains("pose"));
  const nlohmann::json& run = made.at("timing").at("run");
  EXPECT_EQ(run.at("frames"), 12);
  EXPECT_NEAR(run.at("recorded_s").get<double>(), 0.4, 1e-6);
  double sum = 0;
  for (const auto& [stage, seconds] : run.at("seconds").items()) {
    EXPECT_GE(seconds.get<double>(), 0) << stage;
    sum += seconds.get<double>();
  }
  for (const char* stage :
       {"decode", "detect", "describe", "match", "detection", "repeatability"}) {
    EXPECT_GT(run.at("seconds").at(stage).get<double>(), 0) << stage;
  }
  EXPECT_EQ(run.at("seconds").at("heatmap"), 0);
  for (const auto& [stage, seconds] : run.at("processor_seconds").items()) {
    // Both clocks are read one after the other.
    EXPECT_LE(seconds.get<double>(), run.at("seconds").at(stage).get<double>() + 0.1) << stage;
  }
  EXPECT_GT(run.at("processor_seconds").at("detect"), 0);
  EXPECT_LT(sum, run.at("wall_s").get<double>() * run.at("threads").get<int>());
}

TEST_F(RunTest, PicturesOfTheWorstFramesAreKeptAsAsked) {
  test::writeEvolinFolder(test::drawSequence(), path("data"));
  ASSERT_EQ(run("data", "two", {"--metrics", "detection", "--worst-frames", "2"}).status,
            kExitDone);
  EXPECT_TRUE(fs::exists(path("two/worst_frames/2.jpg")));
  EXPECT_FALSE(fs::exists(path("two/worst_frames/3.jpg")));
  ASSERT_EQ(run("data", "none", {"--metrics", "detection", "--worst-frames", "0"}).status,
            kExitDone);
  EXPECT_FALSE(fs::exists(path("none/worst_frames.csv")));
  EXPECT_EQ(run("data", "less", {"--worst-frames", "-1"}).status, kExitWrongUse);
}

TEST_F(RunTest, ABrokenImageIsCountedAndNamed) {
  std::vector<SequenceFrame> frames = test::drawSequence();
  test::writeEvolinFolder(frames, path("data"));
  fs::remove(path("data/images/0003.png"));
  ASSERT_EQ(run("data", "out", {"--metrics", "detection"}).status, kExitFailed);
  EXPECT_FALSE(fs::exists(path("out")));
  ASSERT_EQ(run("data", "out", {"--metrics", "detection", "--allow-missing"}).status, kExitDone);
  EXPECT_EQ(report("out").at("coverage").at("evaluated"), 11);
  EXPECT_NE(report("out").at("notes").dump().find("1 listed images are missing"),
            std::string::npos);
}

TEST_F(RunTest, RefusalsNameWhatIsWrong) {
  const auto expectRefusal = [](const Outcome& outcome, const std::string& word) {
    EXPECT_EQ(outcome.status, kExitWrongUse) << outcome.err;
    EXPECT_NE(outcome.err.find(word), std::string::npos) << outcome.err;
  };
  expectRefusal(run("data.bag", "out", {"--associate", "both"}), "'both'");
  expectRefusal(run("data.bag", "out", {"--metrics", "detection,speed"}), "speed");
  expectRefusal(run("data.bag", "out", {"--protocol", "mine"}), "evolin");
  expectRefusal(run("data.bag", "out", {"--set", "heatmap_buget=3"}), "'heatmap_budget'");
  expectRefusal(run("data.bag", "out", {"--set", "best_lines=0"}), "best_lines");
  expectRefusal(run("data.bag", "out", {"--frame-step", "0"}), "frame");
}

TEST_F(RunTest, ValidateTakesItsRecordingWithAndWithoutTheOption) {
  writeBag(test::drawSequence(), folder_.path() / "drawn.bag");
  const Outcome named =
      test::runCaptured({validateCommand()}, {"validate", "--input", path("drawn.bag"), "--quiet"});
  const Outcome bare =
      test::runCaptured({validateCommand()}, {"validate", path("drawn.bag"), "--quiet"});
  EXPECT_EQ(bare.status, 0);
  EXPECT_NE(bare.out.find("detection: can be measured"), std::string::npos) << bare.out;
  EXPECT_EQ(bare.out, named.out);
}

TEST_F(RunTest, TimeThatJumpsBackBeginsAPassOfItsOwn) {
  test::DrawnSequence five;
  five.frames = 5;
  const std::vector<SequenceFrame> frames = test::drawSequence(five);
  test::DrawnSequence earlier = five;
  earlier.first_stamp -= 100 * kNanosecondsPerSecond;
  class TwoPasses : public PartReader {
   public:
    explicit TwoPasses(std::vector<SequenceFrame> frames) : frames_(std::move(frames)) {}
    std::optional<StreamPart> next() override {
      if (next_ == 2 * frames_.size()) {
        return std::nullopt;
      }
      SequenceFrame& frame = frames_[next_ / 2];
      if (next_++ % 2 == 1) {
        return ImagePart{frame.frame, ""};
      }
      LineSet truth;
      truth.stamp = frame.frame.stamp;
      truth.source = "ground_truth";
      truth.width = frame.frame.image.cols;
      truth.height = frame.frame.image.rows;
      truth.lines = *frame.ground_truth;
      return truth;
    }
    std::size_t images() const override { return frames_.size(); }
    std::vector<std::string> notes() const override { return {}; }
    std::string provenance() const override { return "null"; }

   private:
    std::vector<SequenceFrame> frames_;
    std::size_t next_ = 0;
  };
  std::vector<SequenceFrame> both = frames;
  for (SequenceFrame& frame : test::drawSequence(earlier)) {
    both.push_back(std::move(frame));
  }
  TwoPasses reader(both);
  SequenceRunOptions options;
  options.threads = 2;
  options.evaluation.pass.families = {MetricFamily::kDetection};
  PluginLoader loader;
  options.front_end.make_detector = [&] {
    const auto detector = loader.loadDetector("hough_p");
    detector->configure(YAML::Node());
    return detector;
  };
  options.front_end.lines_source = "hough_p";
  class Counting : public LineAssociator {
   public:
    void configure(const YAML::Node& /*parameters*/) override {}
    LineMatches match(const FrameLines& /*first*/, const FrameLines& /*second*/) override {
      ++pairs_;
      return {};
    }
    MatchCounts counts() const override { return {{"pairs", pairs_}}; }

   private:
    std::size_t pairs_ = 0;
  };
  options.front_end.make_associator = [] { return std::make_shared<Counting>(); };
  options.front_end.matches_source = "counting";
  const auto runOver = [&options](PartReader* parts) {
    return runSequence(
        options, parts, [](std::size_t) {}, [] { return false; });
  };
  TwoPasses one_pass(frames);
  EXPECT_EQ(runOver(&one_pass).reports.at(0).notes,
            std::vector<std::string>{"matches of counting: 4 pairs"});
  const SequenceRunResult result = runOver(&reader);
  ASSERT_EQ(result.reports.size(), 2U);
  EXPECT_EQ(result.reports[0].notes, std::vector<std::string>());
  EXPECT_EQ(result.reports[1].notes,
            std::vector<std::string>{"matches of counting: 8 pairs (of all passes)"});
  EXPECT_EQ(result.reports[0].pass, 1);
  EXPECT_EQ(result.reports[0].coverage.evaluated, 5U);
  EXPECT_EQ(result.reports[1].pass, 2);
  EXPECT_EQ(result.reports[1].coverage.evaluated, 5U);
}

TEST_F(RunTest, CtrlCWritesWhatIsDoneAndSaysSo) {
  test::DrawnSequence many;
  many.frames = 240;
  writeBag(test::drawSequence(many), path("data.bag"));
  // The hidden folder is made once signals are taken, before the first frame.
  const fs::path hidden = path(".out.tmp-" + std::to_string(getpid()));
  std::atomic<bool> ended{false};
  std::thread user([&] {
    while (!fs::exists(hidden) && !ended) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    if (!ended) {
      std::raise(SIGINT);
    }
  });
  const Outcome outcome = run("data.bag", "out", {"--threads", "1", "--metrics", "detection"});
  ended = true;
  user.join();
  EXPECT_EQ(outcome.status, kExitInterrupted) << outcome.err;
  EXPECT_NE(outcome.err.find("marked incomplete"), std::string::npos) << outcome.err;
  const nlohmann::json made = report("out");
  EXPECT_EQ(made.at("complete"), false);
  // So long a sequence leaves the image: not every frame can be scored, but every one is counted.
  const nlohmann::json& coverage = made.at("coverage");
  const auto seen = coverage.at("seen").get<std::size_t>();
  EXPECT_GT(seen, 0U);
  EXPECT_LT(seen, 240U);
  EXPECT_EQ(coverage.at("input_images"), seen);
  EXPECT_EQ(made.at("timing").at("detector").at("frames"), seen);
  EXPECT_FALSE(fs::exists(hidden));
}

}  // namespace
}  // namespace evolin::cli
