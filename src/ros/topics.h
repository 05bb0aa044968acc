// Names of all topics and services, relative and thus remappable, and the lengths of their queues.
#pragma once

namespace evolin::ros_shell {

namespace topics {
constexpr char kImage[] = "image";
constexpr char kDepth[] = "depth";
constexpr char kCameraInfo[] = "camera_info";
constexpr char kLines[] = "lines";
constexpr char kLinesImage[] = "lines_image";
constexpr char kMatches[] = "matches";
constexpr char kMatchesImage[] = "matches_image";
constexpr char kOverlay[] = "overlay";
constexpr char kMarkers[] = "markers";
constexpr char kGroundTruthLines[] = "ground_truth/lines";
constexpr char kGroundTruthPose[] = "ground_truth/pose";
constexpr char kDetectionFrame[] = "metrics/detection/frame";
constexpr char kDetectionCumulative[] = "metrics/detection/cumulative";
constexpr char kHeatmapFrame[] = "metrics/heatmap/frame";
constexpr char kHeatmapCumulative[] = "metrics/heatmap/cumulative";
constexpr char kRepeatabilityFrame[] = "metrics/repeatability/frame";
constexpr char kRepeatabilityCumulative[] = "metrics/repeatability/cumulative";
constexpr char kAssociationFrame[] = "metrics/association/frame";
constexpr char kAssociationCumulative[] = "metrics/association/cumulative";
constexpr char kDetectedAssociationFrame[] = "metrics/association_detected/frame";
constexpr char kDetectedAssociationCumulative[] = "metrics/association_detected/cumulative";
constexpr char kPoseFrame[] = "metrics/pose/frame";
constexpr char kPoseCumulative[] = "metrics/pose/cumulative";
constexpr char kTracksCumulative[] = "metrics/tracks/cumulative";
constexpr char kLineCloud[] = "linefeature";  ///< as PL-VINS calls it
constexpr char kMarker[] = "marker";
constexpr char kOpencvAppsLines[] = "opencv_apps_lines";
constexpr char kLines3d[] = "lines_3d";
constexpr char kTf[] = "/tf";
constexpr char kTfStatic[] = "/tf_static";
constexpr char kCoverage[] = "coverage";
/// Behind the resolved name of lines or matches: headers of the frames for which none will come.
constexpr char kLeftOutSuffix[] = "_left_out";
}  // namespace topics

namespace services {
constexpr char kReload[] = "reload";
constexpr char kSaveReport[] = "save_report";
constexpr char kReset[] = "reset";
constexpr char kFinish[] = "finish";
constexpr char kPause[] = "pause";
constexpr char kGetReport[] = "get_report";
}  // namespace services

/// What evolin bag writes: the topics of TUM's own bags and the ground truth.
namespace bag_topics {
constexpr char kImage[] = "/camera/rgb/image_color";
constexpr char kCameraInfo[] = "/camera/rgb/camera_info";
constexpr char kDepth[] = "/camera/depth/image";
constexpr char kDepthCameraInfo[] = "/camera/depth/camera_info";
constexpr char kTf[] = "/tf";
constexpr char kGroundTruthLines[] = "/ground_truth/lines";
constexpr char kGroundTruthPose[] = "/ground_truth/pose";
constexpr char kCameraFrame[] = "openni_rgb_optical_frame";
constexpr char kWorldFrame[] = "world";
}  // namespace bag_topics

/// Images are large: enough for a method to catch up, not for a whole sequence.
constexpr int kImageQueue = 30;
/// Where we queue ourselves, and count what we drop.
constexpr int kUnlimitedQueue = 0;
/// Lines, matches and metrics are small; a burst must not lose any.
constexpr int kResultQueue = 1000;

}  // namespace evolin::ros_shell
