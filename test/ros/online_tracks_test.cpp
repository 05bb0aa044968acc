// The three ways of attaching a front-end that follows lines by ids, from its own messages to the
// report: the numbers are those of the lines themselves.
#include <geometry_msgs/PolygonStamped.h>
#include <gtest/gtest.h>
#include <ros/param.h>
#include <sensor_msgs/PointCloud.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "conversions.h"
#include "online_stream.h"
#include "test/ros/adapters/tracked_sequence.h"

namespace evolin::test {
namespace {

constexpr std::size_t kFrames = 12;
constexpr char kSource[] = "pl_vins";

Camera pinhole() {
  Camera camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = camera.fy = 525;
  camera.cx = 319.5;
  camera.cy = 239.5;
  return camera;
}

Camera bent(const std::string& model, std::vector<double> distortion, double focal) {
  Camera camera = pinhole();
  camera.fx = focal;
  camera.fy = 1.003 * focal;
  camera.distortion_model = model;
  camera.distortion = std::move(distortion);
  return camera;
}

/// An evaluator of detection, association and tracks; a camera and annotations that it listens to.
class Field {
 public:
  explicit Field(const std::string& matches_from, int frame_step = 1)
      : space_(testNamespace()), manager_(space_) {
    const std::string evaluator = space_ + "/evaluator";
    ros::param::set(evaluator + "/output_dir", folder_.path().string());
    ros::param::set(evaluator + "/metrics",
                    std::vector<std::string>{"detection", "association", "tracks"});
    ros::param::set(evaluator + "/matches_from", matches_from);
    ros::param::set(evaluator + "/frame_step", frame_step);
    ros::param::set(space_ + "/adapter/frame_step", frame_step);
    if (!manager_.load("evaluator", "evolin_ros/Evaluator")) {
      throw std::runtime_error("the evaluator was not loaded; its manager's log says why");
    }
    ros::NodeHandle handle(space_);
    camera_info_ = handle.advertise<sensor_msgs::CameraInfo>("camera_info", 1000, true);
    ground_truth_ = handle.advertise<evolin_ros::LineArray>("ground_truth/lines", 1000);
  }

  const std::string& space() const { return space_; }
  Manager& manager() { return manager_; }

  void sendCamera(const Camera& camera, Stamp stamp) {
    std_msgs::Header header;
    header.stamp = ros_shell::toRosTime(stamp);
    header.frame_id = "cam0";
    camera_info_.publish(ros_shell::toMessage(camera, header));
  }

  void sendGroundTruth(const TrackedFrame& frame) {
    ground_truth_.publish(ros_shell::toMessage(frame.truth));
  }

  ::testing::AssertionResult waitForListeners() {
    return waitFor("the evaluator", [&] {
      return ground_truth_.getNumSubscribers() > 0 && camera_info_.getNumSubscribers() > 0;
    });
  }

  nlohmann::json finish() {
    callTrigger(space_ + "/evaluator/finish");
    return readReport(folder_.path() / "report.json");
  }

 private:
  TemporaryFolder folder_;
  std::string space_;
  Manager manager_;
  ros::Publisher camera_info_;
  ros::Publisher ground_truth_;
};

struct WireOptions {
  int cameras = 1;
  int camera_index = 0;
  int every = 1;  ///< frames of which the front-end publishes one
};

/// The stand-in front-end, the adapter and the evaluator, from known lines to the report.
class PlVins {
 public:
  PlVins(const Camera& camera, int frame_step, const WireOptions& wire)
      : field_("topic", frame_step), camera_(camera) {
    const std::string& space = field_.space();
    const std::string front_end = space + "/linefeature_tracker";
    ros::param::set(front_end + "/K",
                    std::vector<double>{camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1});
    ros::param::set(front_end + "/D",
                    camera.distortion.empty() ? std::vector<double>(4, 0.0) : camera.distortion);
    ros::param::set(front_end + "/distortion_model", camera.distortion_model);
    ros::param::set(front_end + "/cameras", wire.cameras);
    ros::param::set(front_end + "/every", wire.every);
    ros::param::set(space + "/adapter/number_of_cameras", wire.cameras);
    ros::param::set(space + "/adapter/camera_index", wire.camera_index);
    lines_ = std::make_unique<Collector<evolin_ros::LineArray>>(space + "/lines");
    matches_ = std::make_unique<Collector<evolin_ros::LineMatchArray>>(space + "/matches");
    known_ = ros::NodeHandle(space).advertise<evolin_ros::LineArray>("known_lines", 1000);
    front_end_ = std::make_unique<Process>(
        std::vector<std::string>{"rosrun", "evolin_ros", "line_cloud_front_end",
                                 "__name:=linefeature_tracker", "__ns:=" + space});
  }

  /// What comes of the frames that the front-end publishes, `expected` of them.
  void run(const std::vector<TrackedFrame>& frames, std::size_t expected) {
    ASSERT_TRUE(field_.manager().load("adapter", "evolin_ros/PointCloudLines",
                                      {{"linefeature", "linefeature_tracker/linefeature"}}));
    ASSERT_TRUE(field_.waitForListeners());
    ASSERT_TRUE(lines_->waitForPublisher());
    ASSERT_TRUE(matches_->waitForPublisher());
    // This process, and the manager with its evaluator.
    ASSERT_TRUE(field_.manager().waitForListener("lines", 2));
    ASSERT_TRUE(waitFor("the front-end", [&] { return known_.getNumSubscribers() > 0; }));
    const std::string front_end = field_.space() + "/linefeature_tracker";
    ASSERT_TRUE(waitForListener(front_end, front_end + "/linefeature"));
    for (const TrackedFrame& frame : frames) {
      field_.sendCamera(camera_, frame.truth.stamp);
      field_.sendGroundTruth(frame);
      known_.publish(ros_shell::toMessage(frame.found));
    }
    ASSERT_TRUE(lines_->waitForCount(expected));
    report_ = field_.finish();
  }

  std::vector<evolin_ros::LineArray> lines() const { return lines_->messages(); }
  std::vector<evolin_ros::LineMatchArray> matches() const { return matches_->messages(); }
  const nlohmann::json& report() const { return report_; }

 private:
  Field field_;
  Camera camera_;
  std::unique_ptr<Collector<evolin_ros::LineArray>> lines_;
  std::unique_ptr<Collector<evolin_ros::LineMatchArray>> matches_;
  ros::Publisher known_;
  std::unique_ptr<Process> front_end_;
  nlohmann::json report_;
};

/// Largest difference of a coordinate, in pixels; every line must be there, in its place.
double worstPixel(const std::vector<evolin_ros::LineArray>& messages,
                  const std::vector<TrackedFrame>& frames) {
  double worst = 0;
  EXPECT_EQ(messages.size(), frames.size());
  for (std::size_t i = 0; i < std::min(messages.size(), frames.size()); ++i) {
    const LineSet got = ros_shell::fromMessage(messages[i]);
    const LineSet& known = frames[i].found;
    EXPECT_EQ(got.stamp, known.stamp);
    EXPECT_EQ(got.frame_id, "cam0") << "not the cloud's, which is always world";
    EXPECT_EQ(got.source, kSource);
    EXPECT_EQ(got.width, known.width);
    EXPECT_EQ(got.height, known.height);
    EXPECT_FALSE(got.scored);
    EXPECT_EQ(got.lines.size(), known.lines.size());
    for (std::size_t row = 0; row < std::min(got.lines.size(), known.lines.size()); ++row) {
      const LineSegment& a = got.lines[row];
      const LineSegment& b = known.lines[row];
      EXPECT_EQ(a.id, b.id);
      worst = std::max({worst, std::abs(a.x1 - b.x1), std::abs(a.y1 - b.y1), std::abs(a.x2 - b.x2),
                        std::abs(a.y2 - b.y2)});
    }
  }
  return worst;
}

void expectDirectNumbers(const nlohmann::json& report, const std::vector<TrackedFrame>& frames,
                         int frame_step) {
  const nlohmann::json direct = nlohmann::json::parse(toJson(directReport(frames, frame_step)));
  EXPECT_EQ(report.at("detection").at("frames"), frames.size());
  EXPECT_EQ(report.at("detection").at("entries"), direct.at("detection").at("entries"));
  EXPECT_EQ(report.at("association_detected"), direct.at("association_detected"));
  EXPECT_EQ(report.at("association_detected").at("pairs"),
            frames.size() - static_cast<std::size_t>(frame_step));
  EXPECT_GT(report.at("association_detected").at("f_score"), 0.5);
  EXPECT_LT(report.at("association_detected").at("precision"), 1);
  EXPECT_EQ(report.at("tracks"), direct.at("tracks"));
  EXPECT_GT(report.at("tracks").at("identity_switches"), 0);
}

void expectThroughTheWire(const Camera& camera, bool exact, double tolerance) {
  const std::vector<TrackedFrame> frames =
      trackedSequence(kFrames, kSource, exact ? &camera : nullptr);
  PlVins bench(camera, 1, {});
  ASSERT_NO_FATAL_FAILURE(bench.run(frames, kFrames));
  const double worst = worstPixel(bench.lines(), frames);
  ::testing::Test::RecordProperty("worst_pixel", std::to_string(worst * 1e6) + "e-6");
  EXPECT_LE(worst, tolerance);
  expectDirectNumbers(bench.report(), frames, 1);
  expectCoverage(bench.report(), kFrames, kFrames);
}

TEST(OnlineTracks, OfPlVinsOnAPinholeEqualTheDirectNumbers) {
  // Coordinates that single precision holds: what is left is the error of the projection.
  expectThroughTheWire(pinhole(), true, 1e-6);
}

TEST(OnlineTracks, OfPlVinsAreRoundedByTheWireAlone) {
  // Half a unit in the last place of numbers below 1, which is 2^-25, times the focal length.
  expectThroughTheWire(pinhole(), false, 525 * 0x1p-25 * 1.01);
}

TEST(OnlineTracks, OfPlVinsOnAPlumbBobEqualTheDirectNumbers) {
  expectThroughTheWire(bent("plumb_bob", {-0.28340811, 0.07395907, 0.00019359, 1.76e-05}, 458),
                       false, 1e-3);
}

TEST(OnlineTracks, OfPlVinsOnARationalPolynomialEqualTheDirectNumbers) {
  expectThroughTheWire(
      bent("rational_polynomial", {0.6, -1.2, 0.0004, -0.0003, 0.9, 0.45, -1.05, 0.75}, 610), false,
      1e-3);
}

TEST(OnlineTracks, OfPlVinsOnAnEquidistantLensEqualTheDirectNumbers) {
  expectThroughTheWire(bent("equidistant", {-0.0134, 0.0207, -0.0126, 0.0026}, 300), false, 1e-3);
}

TEST(OnlineTracks, OfPlVinsHaveTheStampsOfTheImagesThatItPublishes) {
  const std::vector<TrackedFrame> frames = trackedSequence(kFrames, kSource);
  WireOptions wire;
  wire.every = 2;
  wire.cameras = 2;
  PlVins bench(pinhole(), 2, wire);
  ASSERT_NO_FATAL_FAILURE(bench.run(frames, kFrames / 2));
  std::vector<TrackedFrame> published;
  for (std::size_t i = 0; i < kFrames; i += 2) {
    published.push_back(frames[i]);
  }
  EXPECT_LE(worstPixel(bench.lines(), published), 2e-5);
  expectDirectNumbers(bench.report(), published, 2);
  expectCoverage(bench.report(), kFrames, kFrames / 2, {{"unmatched", kFrames / 2}});
  const std::vector<evolin_ros::LineMatchArray> matches = bench.matches();
  ASSERT_EQ(matches.size(), published.size() - 2);
  for (std::size_t i = 0; i < matches.size(); ++i) {
    EXPECT_EQ(ros_shell::fromRos(matches[i].first_stamp), published[i].found.stamp);
    EXPECT_EQ(ros_shell::fromRos(matches[i].header.stamp), published[i + 2].found.stamp);
    EXPECT_EQ(matches[i].source, kSource);
    EXPECT_EQ(matches[i].lines_source, kSource);
  }
}

TEST(OnlineTracks, AreAllAnEvaluatorNeeds) {
  const std::vector<TrackedFrame> frames = trackedSequence(kFrames, "my_front_end");
  LogReader log;
  Field field("ids", 3);
  ros::NodeHandle handle(field.space());
  ros::Publisher lines = handle.advertise<evolin_ros::LineArray>("lines", 1000);
  ros::Publisher matches = handle.advertise<evolin_ros::LineMatchArray>("matches", 1000);
  ASSERT_TRUE(field.waitForListeners());
  ASSERT_TRUE(waitFor("the evaluator at lines and matches", [&] {
    return lines.getNumSubscribers() > 0 && matches.getNumSubscribers() > 0;
  }));
  for (const TrackedFrame& frame : frames) {
    field.sendGroundTruth(frame);
    lines.publish(ros_shell::toMessage(frame.found));
  }
  MatchSet foreign;
  foreign.first_stamp = frames[0].found.stamp;
  foreign.stamp = frames[1].found.stamp;
  foreign.lines_source = "my_front_end";
  matches.publish(ros_shell::toMessage(foreign));
  EXPECT_TRUE(log.waitFor(rosgraph_msgs::Log::WARN, {"/matches", "matches_from is ids"}));
  const nlohmann::json report = field.finish();
  expectDirectNumbers(report, frames, 3);
  expectCoverage(report, kFrames, kFrames);
  EXPECT_EQ(report.at("association").at("not_evaluated").at("skipped"), 1);
}

/// docs/examples/own_front_end_adapter.cpp between a front-end's own message and the evaluator.
TEST(OnlineTracks, ComeThroughAnAdapterOfTwentyLines) {
  // Single precision again: points on a grid of 1/1024 pixel.
  std::vector<TrackedFrame> frames = trackedSequence(kFrames, "my_front_end");
  Field field("ids");
  ros::NodeHandle handle(field.space());
  ros::Publisher own = handle.advertise<geometry_msgs::PolygonStamped>("my_lines", 1000);
  Collector<evolin_ros::LineArray> lines(field.space() + "/lines");
  const Process adapter({"rosrun", "evolin_ros", "own_front_end_adapter",
                         "__name:=my_lines_adapter", "__ns:=" + field.space()});
  ASSERT_TRUE(lines.waitForPublisher());
  ASSERT_TRUE(field.waitForListeners());
  ASSERT_TRUE(waitFor("the adapter", [&] { return own.getNumSubscribers() > 0; }));
  ASSERT_TRUE(waitForListener(field.space() + "/my_lines_adapter", field.space() + "/lines", 2))
      << "this test and the evaluator";
  for (TrackedFrame& frame : frames) {
    geometry_msgs::PolygonStamped message;
    message.header.stamp = ros_shell::toRosTime(frame.found.stamp);
    message.header.frame_id = "cam0";
    const auto point = [&message](double* x, double* y, std::int64_t id) {
      geometry_msgs::Point32 corner;
      corner.x = static_cast<float>(*x = std::nearbyint(*x * 1024) / 1024);
      corner.y = static_cast<float>(*y = std::nearbyint(*y * 1024) / 1024);
      corner.z = static_cast<float>(id);
      message.polygon.points.push_back(corner);
    };
    for (LineSegment& line : frame.found.lines) {
      point(&line.x1, &line.y1, line.id);
      point(&line.x2, &line.y2, line.id);
    }
    field.sendGroundTruth(frame);
    own.publish(message);
  }
  ASSERT_TRUE(lines.waitForCount(kFrames));
  expectDirectNumbers(field.finish(), frames, 1);
}

}  // namespace
}  // namespace evolin::test
