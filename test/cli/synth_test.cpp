// `evolin synth` as a user meets it: folder, bag, refusals.
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/Image.h>

#include <cstring>
#include <fstream>
#include <map>

#include "conversions.h"
#include "evolin_ros/base/text.h"
#include "evolin_ros/dataset/stamps_file.h"
#include "evolin_ros/dataset/synthetic/synthetic_sequence.h"
#include "synth_command.h"
#include "test/support/temporary_folder.h"
#include "topics.h"

namespace evolin::cli {
namespace {

namespace fs = std::filesystem;
namespace topics = ros_shell::bag_topics;

struct Outcome {
  int status;
  std::string out;
  std::string err;
};

class SynthTest : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }

  Outcome run(const std::string& output, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"synth",    "--output", path(output), "--size", "96x72",
                                          "--frames", "3",        "--rate",     "5"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runAsGiven(arguments);
  }

  static Outcome runAsGiven(const std::vector<std::string>& arguments) {
    ::testing::internal::CaptureStdout();
    ::testing::internal::CaptureStderr();
    const int status = runProgram({synthCommand()}, arguments);
    std::string out = ::testing::internal::GetCapturedStdout();
    return {status, out, ::testing::internal::GetCapturedStderr()};
  }

  /// Names below the test's folder, hidden ones included.
  std::vector<std::string> leftovers() const {
    std::vector<std::string> names;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_.path())) {
      names.push_back(entry.path().filename().string());
    }
    return names;
  }

  static void expectRefusal(const Outcome& outcome, int status,
                            const std::vector<std::string>& words) {
    EXPECT_EQ(outcome.status, status) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    for (const std::string& word : words) {
      EXPECT_NE(outcome.err.find(word), std::string::npos) << word << " is not in " << outcome.err;
    }
  }

  static std::map<std::string, std::string> contents(const fs::path& folder) {
    std::map<std::string, std::string> files;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
      if (entry.is_regular_file()) {
        std::string& text = files[fs::relative(entry.path(), folder).string()];
        std::ifstream stream(entry.path(), std::ios::binary);
        text.assign(std::istreambuf_iterator<char>(stream), {});
      }
    }
    return files;
  }

  static synthetic::SyntheticOptions sameOptions() {
    synthetic::SyntheticOptions options;
    options.width = 96;
    options.height = 72;
    options.frames = 3;
    options.rate = 5;
    return options;
  }

  test::TemporaryFolder folder_;
};

TEST_F(SynthTest, FolderIsASequenceWithEverything) {
  const Outcome outcome = run("room");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("3 frames, 96 x 72"), std::string::npos) << outcome.out;
  const synthetic::SyntheticSequence expected(sameOptions());
  const std::unique_ptr<SequenceReader> reader = openSequence(path("room"), {});
  EXPECT_EQ(reader->layout(), Layout::kEvolin);
  ASSERT_EQ(reader->size(), 3U);
  std::map<std::int64_t, std::int64_t> names;
  for (std::size_t i = 0; i < 3; ++i) {
    const SequenceFrame given = expected.frame(i);
    const SequenceFrame read = reader->next().value();
    EXPECT_EQ(read.frame.stamp, given.frame.stamp);
    EXPECT_EQ(cv::norm(read.frame.image, given.frame.image, cv::NORM_INF), 0);
    EXPECT_LE(cv::norm(read.frame.depth, given.frame.depth, cv::NORM_INF), 0.000101);
    EXPECT_EQ(read.frame.camera->fx, given.frame.camera->fx);
    EXPECT_EQ(read.frame.pose->translation, given.frame.pose->translation);
    EXPECT_TRUE(read.frame.pose->rotation.isApprox(given.frame.pose->rotation, 1e-15));
    ASSERT_EQ(read.ground_truth->size(), given.ground_truth->size());
    for (std::size_t row = 0; row < given.ground_truth->size(); ++row) {
      const LineSegment& a = (*read.ground_truth)[row];
      const LineSegment& b = (*given.ground_truth)[row];
      EXPECT_TRUE(a.x1 == b.x1 && a.y1 == b.y1 && a.x2 == b.x2 && a.y2 == b.y2);
      EXPECT_EQ(names.emplace(b.id, a.id).first->second, a.id);
    }
  }
  EXPECT_EQ(reader->counts().missing_depths + reader->counts().missing_poses +
                reader->counts().missing_ground_truth,
            0U);
  EXPECT_TRUE(fs::exists(path("room/synth.txt")));
  EXPECT_EQ(readLines(path("room/edges.txt")).size(), expected.scene().edges.size() + 1);
  EXPECT_EQ(leftovers(), std::vector<std::string>{"room"});
}

TEST_F(SynthTest, ThreadsChangeNoByte) {
  ASSERT_EQ(run("one", {"--threads", "1"}).status, 0);
  ASSERT_EQ(run("two", {"--threads", "2"}).status, 0);
  ASSERT_EQ(run("other", {"--seed", "2"}).status, 0);
  const auto one = contents(path("one"));
  EXPECT_GT(one.size(), 12U);
  EXPECT_EQ(one, contents(path("two")));
  EXPECT_NE(one, contents(path("other")));
}

TEST_F(SynthTest, BagHasTheSameFrames) {
  ASSERT_EQ(run("room.bag").status, 0);
  const synthetic::SyntheticSequence expected(sameOptions());
  const rosbag::Bag bag(path("room.bag"));
  const auto number_of = [&](const std_msgs::Header& header) {
    for (std::size_t i = 0; i < expected.size(); ++i) {
      if (ros_shell::toRosTime(expected.stamp(i)) == header.stamp) {
        return i;
      }
    }
    ADD_FAILURE() << "no frame has stamp " << header.stamp;
    return std::size_t{0};
  };
  std::map<std::string, int> counts;
  for (const rosbag::MessageInstance& message : rosbag::View(bag)) {
    ++counts[message.getTopic()];
    if (message.getTopic() == topics::kImage || message.getTopic() == topics::kDepth) {
      const sensor_msgs::Image::ConstPtr image = message.instantiate<sensor_msgs::Image>();
      const SequenceFrame frame = expected.frame(number_of(image->header));
      const cv::Mat& pixels =
          message.getTopic() == topics::kImage ? frame.frame.image : frame.frame.depth;
      ASSERT_EQ(image->data.size(), pixels.total() * pixels.elemSize());
      EXPECT_EQ(std::memcmp(image->data.data(), pixels.data, image->data.size()), 0);
    } else if (message.getTopic() == topics::kGroundTruthLines) {
      const auto lines = message.instantiate<evolin_ros::LineArray>();
      const LineSegments given = expected.groundTruth(number_of(lines->header));
      ASSERT_EQ(lines->lines.size(), given.size());
      for (std::size_t row = 0; row < given.size(); ++row) {
        EXPECT_EQ(lines->lines[row].id, given[row].id);
        EXPECT_EQ(lines->lines[row].x1, given[row].x1);
      }
    }
  }
  for (const char* topic : {topics::kImage, topics::kDepth, topics::kCameraInfo, topics::kTf,
                            topics::kGroundTruthLines, topics::kGroundTruthPose}) {
    EXPECT_EQ(counts[topic], 3) << topic;
  }
  const std::vector<StampedFile> stamps = readStampsFile(path("room.stamps.txt"));
  ASSERT_EQ(stamps.size(), 3U);
  EXPECT_EQ(stamps[2].file, "images/0002.png");
  EXPECT_EQ(stamps[2].stamp, expected.stamp(2));
  EXPECT_EQ(leftovers().size(), 2U);
}

TEST_F(SynthTest, RefusesBadValues) {
  const auto refused = [&](const std::string& option, const std::string& value,
                           const std::vector<std::string>& words) {
    expectRefusal(runAsGiven({"synth", "--output", path("x"), option, value}), 2, words);
  };
  refused("--size", "0x0", {"width", "is 0", "expected 32"});
  refused("--size", "640", {"--size", "'640'", "640x480"});
  refused("--size", "640x480x3", {"--size"});
  refused("--size", "-640x480", {"--size"});
  refused("--size", "640x99999", {"height", "99999"});
  refused("--frames", "0", {"frames", "is 0", "expected 1"});
  refused("--frames", "many", {"--frames", "many"});
  refused("--rate", "0", {"rate", "is 0"});
  refused("--noise", "-1", {"noise", "-1"});
  refused("--blur", "nan", {"blur"});
  refused("--seed", "-1", {"--seed", "-1"});
  refused("--threads", "-1", {"--threads", "-1"});
  refused("--sead", "1", {"--sead", "--seed"});
  expectRefusal(runAsGiven({"synth"}), 2, {"--output"});
  EXPECT_TRUE(leftovers().empty());
}

TEST_F(SynthTest, ReplacesOnlyItsOwnAndOnlyByForce) {
  ASSERT_EQ(run("room").status, 0);
  ASSERT_EQ(run("room.bag").status, 0);
  expectRefusal(run("room"), 1, {"room", "exists", "--force"});
  expectRefusal(run("room.bag"), 1, {"room.bag", "exists", "--force"});
  folder_.write("room/old_file", "of the last run");
  ASSERT_EQ(run("room/", {"--force", "--seed", "3"}).status, 0);
  EXPECT_FALSE(fs::exists(path("room/old_file")));
  ASSERT_EQ(run("room.bag", {"-f"}).status, 0);
  // Somebody's own folder is not touched, whatever the options.
  folder_.write("thesis/chapter1.tex", "two years of work");
  expectRefusal(run("thesis", {"--force"}), 1, {"thesis", "synth.txt"});
  EXPECT_TRUE(fs::exists(path("thesis/chapter1.tex")));
  folder_.write("plain", "a file");
  expectRefusal(run("plain", {"--force"}), 1, {"plain"});
  fs::create_directories(path("empty"));
  EXPECT_EQ(run("empty").status, 0);
  EXPECT_EQ(leftovers().size(), 6U);  // room, its bag and stamps, thesis, plain, empty
}

TEST_F(SynthTest, OneFrameIsASequenceToo) {
  ASSERT_EQ(run("room", {"--frames", "1"}).status, 2);  // given twice
  ASSERT_EQ(runAsGiven({"synth", "-o", path("room"), "--frames", "1", "--size", "64x48"}).status,
            0);
  const std::unique_ptr<SequenceReader> reader = openSequence(path("room"), {});
  EXPECT_TRUE(reader->next().has_value());
  EXPECT_FALSE(reader->next().has_value());
}

TEST_F(SynthTest, HelpTellsOptionsAndUnits) {
  const Outcome outcome = runAsGiven({"synth", "--help"});
  EXPECT_EQ(outcome.status, 0);
  for (const char* word : {"--output", "--frames", "--rate", "--size", "--seed", "--noise",
                           "--blur", "--threads", "--force", "grey", "pixels"}) {
    EXPECT_NE(outcome.out.find(word), std::string::npos) << word;
  }
}

}  // namespace
}  // namespace evolin::cli
