// `evolin render` as a user meets it: pictures of a run's frames and pairs, refusals, and a video
// where ffmpeg is there.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "bag_writer.h"
#include "evolin_ros/drawing/evaluation_view.h"
#include "render_command.h"
#include "run_command.h"
#include "test/cli/outcome.h"
#include "test/support/drawn_sequence.h"
#include "test/support/temporary_folder.h"

namespace evolin::cli {
namespace {

namespace fs = std::filesystem;
using test::Outcome;

class RenderTest : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }

  Outcome call(std::vector<std::string> arguments) const {
    return test::runCaptured({renderCommand(), runCommand()}, arguments);
  }

  /// A run over four frames, in `data` and `run`.
  void makeRun() const {
    test::DrawnSequence sequence;
    sequence.frames = 4;
    test::writeEvolinFolder(test::drawSequence(sequence), path("data"));
    const Outcome outcome =
        call({"run", "--input", path("data"), "--detector", "hough_p:min_length=12", "--associator",
              "lbd", "--metrics", "detection,association", "--bootstrap", "0", "--quiet",
              "--output", path("run")});
    ASSERT_EQ(outcome.status, kExitDone) << outcome.err;
  }

  static std::size_t filesIn(const fs::path& folder) {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
  }

  test::TemporaryFolder folder_;
};

/// Pixels of about that colour (BGR), as anti-aliasing leaves them.
int pixelsLike(const cv::Mat& picture, const cv::Scalar& colour) {
  cv::Mat mask;
  cv::inRange(picture, colour - cv::Scalar::all(40), colour + cv::Scalar::all(40), mask);
  return cv::countNonZero(mask);
}

TEST_F(RenderTest, EveryFrameBecomesAPictureWithVerdictsAndMargin) {
  makeRun();
  const Outcome outcome = call({"render", "--run", path("run"), "--output", path("out"), "-q"});
  ASSERT_EQ(outcome.status, kExitDone) << outcome.err;
  EXPECT_NE(outcome.out.find("4 pictures"), std::string::npos) << outcome.out;
  EXPECT_EQ(filesIn(path("out")), 5U) << "four pictures and render.txt";
  int found = 0;
  for (const char* name : {"0000.png", "0003.png"}) {
    const cv::Mat picture = cv::imread(path("out/") + name);
    ASSERT_FALSE(picture.empty()) << name;
    EXPECT_EQ(picture.cols, 320 + kViewMargin);
    EXPECT_GE(picture.rows, 240);
    found += pixelsLike(picture(cv::Rect(0, 0, 320, 240)), {255, 175, 70});
    EXPECT_GT(pixelsLike(picture(cv::Rect(0, 0, 320, 240)), {255, 255, 255}), 20)
        << "missed lines are white";
  }
  EXPECT_GT(found, 20) << "found lines are blue";
}

TEST_F(RenderTest, MatchesStandSideBySide) {
  makeRun();
  const Outcome outcome = call(
      {"render", "--run", path("run"), "--picture", "matches", "--output", path("out"), "--quiet"});
  ASSERT_EQ(outcome.status, kExitDone) << outcome.err;
  EXPECT_EQ(filesIn(path("out")), 4U) << "three pairs and render.txt";
  EXPECT_EQ(cv::imread(path("out/0001_0002.png")).size(), cv::Size(640, 240));
}

TEST_F(RenderTest, ARecordingThatHasMovedIsNamed) {
  makeRun();
  fs::rename(path("data"), path("elsewhere"));
  EXPECT_EQ(call({"render", "--run", path("run"), "--output", path("out"), "-q"}).status,
            kExitFailed);
  EXPECT_FALSE(fs::exists(path("out")));
  const Outcome outcome = call({"render", "--run", path("run"), "--output", path("out"), "-q",
                                "--input", path("elsewhere")});
  EXPECT_EQ(outcome.status, kExitDone) << outcome.err;
}

TEST_F(RenderTest, TheRunsOptionsOfTheInputAreTakenOver) {
  makeRun();
  fs::rename(path("data/gt_lines"), path("annotations"));
  ASSERT_EQ(call({"run", "--input", path("data"), "--ground-truth", path("annotations"), "-levolin",
                  "--duration", "0.09", "--detector", "hough_p", "--metrics", "detection",
                  "--bootstrap", "0", "-q", "--output", path("run")})
                .status,
            kExitDone);
  Outcome outcome = call({"render", "-r" + path("run"), "--output", path("out"), "-q"});
  ASSERT_EQ(outcome.status, kExitDone) << outcome.err;
  EXPECT_NE(outcome.out.find("3 pictures"), std::string::npos) << outcome.out;
  const cv::Mat picture = cv::imread(path("out/0000.png"));
  EXPECT_GT(pixelsLike(picture(cv::Rect(0, 0, 320, 240)), {255, 255, 255}), 20)
      << "missed lines are those of the run's annotations";
  outcome =
      call({"render", "--run=" + path("run"), "--output", path("out"), "-q", "--duration=0.05"});
  ASSERT_EQ(outcome.status, kExitDone) << outcome.err;
  EXPECT_NE(outcome.out.find("2 pictures"), std::string::npos) << "its own goes over the run's";
}

TEST_F(RenderTest, OptionsOfAFolderAreNotTakenOverForABag) {
  makeRun();
  test::DrawnSequence sequence;
  sequence.frames = 4;
  BagWriter writer(path("data.bag"));
  for (const SequenceFrame& frame : test::drawSequence(sequence)) {
    writer.add(frame);
  }
  writer.close();
  ASSERT_EQ(call({"run", "--input", path("data"), "--pose-offset", "0", "--duration", "0.09",
                  "--detector", "hough_p", "--metrics", "detection", "--bootstrap", "0", "-q",
                  "--output", path("run")})
                .status,
            kExitDone);
  for (const std::string& input : {"--input=" + path("data.bag"), "-i" + path("data.bag")}) {
    const Outcome outcome =
        call({"render", "--run", path("run"), "--output", path("out"), "-q", input});
    EXPECT_EQ(outcome.status, kExitDone) << outcome.err;
    EXPECT_NE(outcome.out.find("4 pictures"), std::string::npos) << outcome.out;
  }
  // Another folder is read as the run read its own.
  const Outcome outcome = call(
      {"render", "--run", path("run"), "--output", path("out"), "-q", "--input", path("data")});
  EXPECT_NE(outcome.out.find("3 pictures"), std::string::npos) << outcome.out;
}

TEST_F(RenderTest, RefusalsNameWhatIsWrong) {
  makeRun();
  const auto expectRefusal = [this](std::vector<std::string> more, int status,
                                    const std::string& word) {
    std::vector<std::string> arguments = {"render", "--output", path("out")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = call(arguments);
    EXPECT_EQ(outcome.status, status) << outcome.err;
    EXPECT_NE(outcome.err.find(word), std::string::npos) << outcome.err;
    EXPECT_FALSE(fs::exists(path("out")));
  };
  expectRefusal({"--run", path("nowhere")}, kExitFailed, "nowhere/report.json");
  expectRefusal({"--run", path("run"), "--picture", "all"}, kExitWrongUse, "lines or matches");
  expectRefusal({"--run", path("run"), "--rate", "0"}, kExitWrongUse, "--rate");
  expectRefusal({"--run", path("run"), "--scale", "100"}, kExitWrongUse, "scale");
  std::ofstream(path("video.mp4")) << "somebody's";
  const Outcome outcome = call({"render", "--run", path("run"), "--output", path("video.mp4")});
  EXPECT_EQ(outcome.status, kExitFailed);
  EXPECT_NE(outcome.err.find("--force"), std::string::npos) << outcome.err;
  std::ofstream(path("run/report.json")) << "{\"protocol\": \"evolin\"}";
  expectRefusal({"--run", path("run")}, kExitFailed, "which detector");
}

TEST_F(RenderTest, AVideoNeedsFfmpegAndSaysSo) {
  makeRun();
  const std::string path_before = std::getenv("PATH");
  ASSERT_EQ(setenv("PATH", path("run").c_str(), 1), 0);
  const Outcome outcome =
      call({"render", "--run", path("run"), "--output", path("video.mp4"), "--quiet"});
  setenv("PATH", path_before.c_str(), 1);
  EXPECT_EQ(outcome.status, kExitFailed);
  EXPECT_NE(outcome.err.find("install the package ffmpeg"), std::string::npos) << outcome.err;
  EXPECT_FALSE(fs::exists(path("video.mp4")));
}

TEST_F(RenderTest, VideosHoldEveryFrame) {
  const char* full = std::getenv("EVOLIN_FULL");
  if (full == nullptr || std::string(full) != "1") {
    GTEST_SKIP() << "videos are tested under scripts/test --full (EVOLIN_FULL=1)";
  }
  if (std::system("ffprobe -version > /dev/null 2>&1") != 0) {
    GTEST_SKIP() << "ffmpeg is not installed";
  }
  makeRun();
  for (const std::string name : {"video.mp4", "video.gif"}) {
    const Outcome outcome =
        call({"render", "--run", path("run"), "--output", path(name), "--quiet"});
    ASSERT_EQ(outcome.status, kExitDone) << outcome.err;
    const std::string probe =
        "ffprobe -v error -count_frames -select_streams v -show_entries "
        "stream=nb_read_frames,width -of csv=p=0 " +
        path(name) + " > " + path("probe.txt");
    ASSERT_EQ(std::system(probe.c_str()), 0);
    std::ifstream file(path("probe.txt"));
    std::string line;
    std::getline(file, line);
    EXPECT_EQ(line, "570,4") << name;
  }
}

}  // namespace
}  // namespace evolin::cli
