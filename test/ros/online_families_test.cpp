// Heatmap, repeatability, association of detected lines, relative pose and tracks from topics: the
// figures of the same parts inside this process, and coverage where parts are missing.
#include <cv_bridge/cv_bridge.h>
#include <geometry_msgs/PoseStamped.h>
#include <gtest/gtest.h>
#include <nav_msgs/Odometry.h>
#include <ros/param.h>
#include <sensor_msgs/image_encodings.h>
#include <tf2_msgs/TFMessage.h>

#include <cmath>

#include "conversions.h"
#include "evolin_ros/Coverage.h"
#include "evolin_ros/HeatmapMetrics.h"
#include "evolin_ros/PoseMetrics.h"
#include "evolin_ros/RepeatabilityMetrics.h"
#include "evolin_ros/evaluation/pass_evaluation.h"
#include "online_stream.h"
#include "test/evaluation/sample_frames.h"

namespace evolin::test {
namespace {

constexpr int kFrames = 12;
constexpr int kWidth = 160;
constexpr int kHeight = 120;
constexpr double kFocal = 150;
constexpr Stamp kPeriod = kNanosecondsPerSecond / 10;
constexpr Stamp kDepthDelay = 5000000;

Stamp stampOf(int frame) { return 10 * kNanosecondsPerSecond + frame * kPeriod; }

Camera camera() {
  Camera result;
  result.width = kWidth;
  result.height = kHeight;
  result.fx = kFocal;
  result.fy = kFocal;
  result.cx = 80;
  result.cy = 60;
  return result;
}

/// The camera moves to the right and turns a little.
Pose poseAt(Stamp stamp) {
  const double t = toSeconds(stamp - stampOf(0));
  Pose pose;
  pose.translation = {0.1 * t, 0.02 * std::sin(t), 0};
  pose.rotation = Eigen::AngleAxisd(0.02 * t, Eigen::Vector3d::UnitY());
  return pose;
}

/// Poses lie between the images, where nothing is without interpolation.
Stamp poseStampOf(int index) { return stampOf(index) - kPeriod / 2; }

/// A floor in front of the camera, 16 bits: millimetres.
cv::Mat depthImage() {
  cv::Mat depth(kHeight, kWidth, CV_16UC1);
  for (int y = 0; y < kHeight; ++y) {
    depth.row(y).setTo(4000 - 20 * y);
  }
  return depth;
}

/// Physical lines as the camera sees them, and a detector's noisy view.
LineSet annotatedLines(int frame) {
  RandomLines random(3);
  LineSegments lines = random.anywhere(20, kWidth - 30, kHeight - 1);
  for (std::size_t row = 0; row < lines.size(); ++row) {
    lines[row].id = static_cast<std::int64_t>(row);
    for (double* x : {&lines[row].x1, &lines[row].x2}) *x = std::max(0.0, *x + 25 - 1.5 * frame);
  }
  LineSet set = annotated(stampOf(frame), lines);
  set.width = kWidth;
  set.height = kHeight;
  set.frame_id = "camera";
  return set;
}

LineSet detectedLines(int frame) {
  RandomLines random(100 + static_cast<std::uint64_t>(frame));
  LineSet set = annotatedLines(frame);
  set.source = "detector";
  set.scored = true;
  set.processing_time = 0.004;
  for (LineSegment& line : set.lines) {
    for (double* value : {&line.x1, &line.y1, &line.x2, &line.y2}) {
      *value += random.uniform(-0.8, 0.8);
    }
    line.score = random.uniform(0, 1);
    line.id = kNoId;
  }
  return set;
}

MatchSet matches(int frame) {
  LineMatches pairs;
  for (std::uint32_t row = 0; row < 20; ++row) {
    LineMatch match;
    match.first = row;
    match.second = row % 7 == 3 ? (row + 1) % 20 : row;
    pairs.push_back(match);
  }
  return matchSet(stampOf(frame - 1), stampOf(frame), "detector", pairs);
}

PassOptions passOptions() {
  PassOptions options;
  options.motion.repeatabilities.frame_steps = {1, 5};
  return options;
}

/// What the same parts give without any topic between.
nlohmann::json expectedReport() {
  PassEvaluation pass(passOptions());
  const auto take = [&pass](EvaluationUpdate update) { runTasks({}, &pass, &update); };
  take(pass.setCamera(camera()));
  for (int frame = 0; frame <= kFrames; ++frame) {
    take(pass.addPose({poseStampOf(frame), poseAt(poseStampOf(frame))}));
    if (frame == kFrames) break;
    take(pass.addImage(stampOf(frame)));
    take(pass.addDepth(stampOf(frame) + kDepthDelay, DepthMap(depthImage(), 1000)));
    take(pass.addGroundTruth(annotatedLines(frame)));
    take(pass.addLines(detectedLines(frame)));
    if (frame > 0) take(pass.addMatches(matches(frame)));
  }
  return nlohmann::json::parse(toJson(pass.report(true)));
}

enum class PoseTopic { kNone, kPoseStamped, kOdometry, kTf };

struct SceneOptions {
  PoseTopic poses = PoseTopic::kPoseStamped;
  bool depth = true;
  int task_queue = 1000;
};

/// An evaluator alone in its manager, and everything that it listens to.
class Scene {
 public:
  explicit Scene(const SceneOptions& options)
      : options_(options), space_(testNamespace()), manager_(space_) {
    const std::string name = space_ + "/evaluator";
    ros::param::set(name + "/output_dir", folder_.path().string());
    ros::param::set(name + "/repeatability_steps", std::vector<int>{1, 5});
    ros::param::set(name + "/task_queue", options.task_queue);
    ros::param::set(name + "/pose_from", options.poses == PoseTopic::kTf ? "tf" : "topic");
    ros::param::set(name + "/world_frame", "/world");
    if (!manager_.load("evaluator", "evolin_ros/Evaluator")) {
      throw std::runtime_error("the evaluator was not loaded; its manager's log says why");
    }
    ros::NodeHandle handle(space_);
    lines_ = handle.advertise<evolin_ros::LineArray>("lines", 1000);
    ground_truth_ = handle.advertise<evolin_ros::LineArray>("ground_truth/lines", 1000);
    matches_ = handle.advertise<evolin_ros::LineMatchArray>("matches", 1000);
    camera_info_ = handle.advertise<sensor_msgs::CameraInfo>("camera_info", 1000);
    depth_ = handle.advertise<sensor_msgs::Image>("depth", 1000);
    if (options.poses == PoseTopic::kOdometry) {
      pose_ = handle.advertise<nav_msgs::Odometry>("ground_truth/pose", 1000);
    } else if (options.poses == PoseTopic::kTf) {
      pose_ = handle.advertise<tf2_msgs::TFMessage>("/tf", 1000);
    } else {
      pose_ = handle.advertise<geometry_msgs::PoseStamped>("ground_truth/pose", 1000);
    }
  }

  const std::string& space() const { return space_; }
  std::filesystem::path folder() const { return folder_.path(); }

  void play() {
    for (const ros::Publisher& publisher :
         {lines_, ground_truth_, matches_, camera_info_, depth_, pose_}) {
      ASSERT_TRUE(waitFor("the evaluator on " + publisher.getTopic(),
                          [&] { return publisher.getNumSubscribers() > 0; }));
    }
    for (int frame = 0; frame <= kFrames; ++frame) {
      sendPose(poseStampOf(frame));
      if (frame == kFrames) break;
      std_msgs::Header header;
      header.stamp = ros_shell::toRosTime(stampOf(frame));
      header.frame_id = "/camera";
      camera_info_.publish(ros_shell::toMessage(camera(), header));
      if (options_.depth) sendDepth(stampOf(frame) + kDepthDelay);
      ground_truth_.publish(ros_shell::toMessage(annotatedLines(frame)));
      lines_.publish(ros_shell::toMessage(detectedLines(frame)));
      if (frame > 0) matches_.publish(ros_shell::toMessage(matches(frame)));
    }
  }

  nlohmann::json finish() {
    callTrigger(space_ + "/evaluator/finish");
    return readReport(folder_.path() / "report.json");
  }

 private:
  void sendDepth(Stamp stamp) {
    std_msgs::Header header;
    header.stamp = ros_shell::toRosTime(stamp);
    depth_.publish(
        cv_bridge::CvImage(header, sensor_msgs::image_encodings::TYPE_16UC1, depthImage())
            .toImageMsg());
  }

  void sendPose(Stamp stamp) {
    const geometry_msgs::Pose pose = ros_shell::toMessage(poseAt(stamp));
    std_msgs::Header header;
    header.stamp = ros_shell::toRosTime(stamp);
    header.frame_id = "/world";
    if (options_.poses == PoseTopic::kPoseStamped) {
      geometry_msgs::PoseStamped message;
      message.header = header;
      message.pose = pose;
      pose_.publish(message);
    } else if (options_.poses == PoseTopic::kOdometry) {
      nav_msgs::Odometry message;
      message.header = header;
      message.pose.pose = pose;
      pose_.publish(message);
    } else if (options_.poses == PoseTopic::kTf) {
      tf2_msgs::TFMessage message;
      message.transforms.resize(1);
      message.transforms[0].header = header;
      message.transforms[0].child_frame_id = "/camera";
      message.transforms[0].transform.translation.x = pose.position.x;
      message.transforms[0].transform.translation.y = pose.position.y;
      message.transforms[0].transform.translation.z = pose.position.z;
      message.transforms[0].transform.rotation = pose.orientation;
      pose_.publish(message);
    }
  }

  SceneOptions options_;
  std::string space_;
  TemporaryFolder folder_;
  Manager manager_;
  ros::Publisher lines_;
  ros::Publisher ground_truth_;
  ros::Publisher matches_;
  ros::Publisher camera_info_;
  ros::Publisher depth_;
  ros::Publisher pose_;
};

/// tf interpolates by its own arithmetic: numbers within 1e-6, all else equal.
void expectAlike(const nlohmann::json& a, const nlohmann::json& b, const std::string& path) {
  ASSERT_EQ(a.type_name(), std::string(b.type_name())) << path;
  if (a.is_number()) {
    EXPECT_NEAR(a.get<double>(), b.get<double>(), 1e-6 * (1 + std::abs(b.get<double>()))) << path;
  } else if (a.is_structured()) {
    ASSERT_EQ(a.size(), b.size()) << path;
    for (const auto& item : a.items()) {
      if (a.is_object()) {
        ASSERT_TRUE(b.contains(item.key())) << path << "/" << item.key();
      }
      expectAlike(item.value(), a.is_array() ? b.at(std::stoul(item.key())) : b.at(item.key()),
                  path + "/" + item.key());
    }
  } else {
    EXPECT_EQ(a, b) << path;
  }
}

constexpr const char* kFamilies[] = {"heatmap", "repeatability", "association_detected", "pose",
                                     "tracks"};

TEST(OnlineFamilies, EqualTheFiguresInProcess) {
  const nlohmann::json expected = expectedReport();
  EXPECT_EQ(expected.at("pose").at("pairs"), kFrames - 1);
  EXPECT_EQ(expected.at("repeatability").at("frames"), kFrames);
  EXPECT_GT(expected.at("association_detected").at("f_score"), 0.5);
  Scene scene({});
  Collector<evolin_ros::HeatmapMetrics> heatmap(scene.space() + "/metrics/heatmap/frame");
  Collector<evolin_ros::RepeatabilityMetrics> repeatability(scene.space() +
                                                            "/metrics/repeatability/frame");
  Collector<evolin_ros::PoseMetrics> pose(scene.space() + "/metrics/pose/frame");
  ASSERT_TRUE(heatmap.waitForPublisher());
  ASSERT_TRUE(repeatability.waitForPublisher());
  ASSERT_TRUE(pose.waitForPublisher());
  scene.play();
  const nlohmann::json report = scene.finish();
  for (const char* family : kFamilies) {
    EXPECT_EQ(report.at(family), expected.at(family)) << family;
  }
  expectCoverage(report, kFrames, kFrames, {{"no_depth", 0}, {"no_pose", 0}});
  EXPECT_TRUE(heatmap.waitForCount(kFrames));
  EXPECT_TRUE(repeatability.waitForCount((kFrames - 1) + (kFrames - 5)));
  EXPECT_TRUE(pose.waitForCount(kFrames - 1));
  EXPECT_TRUE(std::filesystem::exists(scene.folder() / "relative_motion_estimate.tum"));

  // The sums are latched: whoever comes later gets them.
  Collector<evolin_ros::PoseMetrics> sums(scene.space() + "/metrics/pose/cumulative");
  ASSERT_TRUE(sums.waitForCount(1));
  const evolin_ros::PoseMetrics last = sums.messages().back();
  EXPECT_TRUE(last.cumulative);
  EXPECT_EQ(last.pairs, static_cast<unsigned>(kFrames - 1));
  EXPECT_EQ(last.rotation_median, expected.at("pose").at("rotation_median_deg"));
  ASSERT_EQ(last.auc.size(), 4U);
}

TEST(OnlineFamilies, TakeOdometry) {
  Scene scene({PoseTopic::kOdometry, true, 1000});
  scene.play();
  const nlohmann::json expected = expectedReport();
  const nlohmann::json report = scene.finish();
  EXPECT_EQ(report.at("repeatability"), expected.at("repeatability"));
  EXPECT_EQ(report.at("pose"), expected.at("pose"));
}

TEST(OnlineFamilies, TakeTfWithLeadingSlashes) {
  Scene scene({PoseTopic::kTf, true, 1000});
  scene.play();
  const nlohmann::json expected = expectedReport();
  const nlohmann::json report = scene.finish();
  expectAlike(report.at("repeatability"), expected.at("repeatability"), "repeatability");
  expectAlike(report.at("pose"), expected.at("pose"), "pose");
}

TEST(OnlineFamilies, SayWhatIsMissing) {
  Scene scene({PoseTopic::kPoseStamped, false, 1000});
  scene.play();
  const nlohmann::json report = scene.finish();
  const std::string reason = "not evaluated: no depth images were received";
  EXPECT_EQ(report.at("coverage").at("no_depth"), kFrames);
  EXPECT_EQ(report.at("coverage").at("evaluated"), kFrames);
  EXPECT_EQ(report.at("pose").at("reason"), reason);
  EXPECT_TRUE(report.at("pose").at("rotation_median_deg").is_null());
  EXPECT_EQ(report.at("pose").at("not_evaluated").at("no_depth"), kFrames - 1);
  for (const nlohmann::json& entry : report.at("repeatability").at("entries")) {
    EXPECT_TRUE(entry.at("repeatability").is_null());
    EXPECT_EQ(entry.at("reason"), reason);
  }
  EXPECT_EQ(report.at("heatmap"), expectedReport().at("heatmap")) << "needs no depth";
}

TEST(OnlineFamilies, AFullQueueIsCounted) {
  LogReader log;
  Scene scene({PoseTopic::kPoseStamped, true, 1});
  scene.play();
  const nlohmann::json report = scene.finish();
  const std::size_t left_out = report.at("coverage").at("heatmap_skipped").get<std::size_t>() +
                               report.at("coverage").at("pose_skipped").get<std::size_t>();
  const std::size_t done = report.at("heatmap").at("frames").get<std::size_t>() +
                           report.at("pose").at("pairs").get<std::size_t>();
  EXPECT_EQ(done + left_out, 2U * kFrames - 1);
  EXPECT_GE(done, 1U);
  if (left_out > 0) {
    EXPECT_TRUE(log.waitFor(rosgraph_msgs::Log::WARN, {"task_queue", "left out"}));
  }
}

}  // namespace
}  // namespace evolin::test
