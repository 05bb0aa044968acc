// A stand-in for the line trackers of PL-VIO and PL-VINS, as a node: known lines of raw images in,
// the cloud that such a tracker publishes of them out. Lens distortion is undone by OpenCV, as the
// trackers do it, and not by the code under test.
#include <evolin_ros/LineArray.h>
#include <ros/ros.h>
#include <sensor_msgs/PointCloud.h>

#include <opencv2/calib3d.hpp>
#include <string>
#include <vector>

namespace {

struct Tracker {
  std::vector<double> matrix;      ///< K, row by row
  std::vector<double> distortion;  ///< D
  std::string model;
  int cameras = 1;
  int every = 1;  ///< of so many frames one is published: the trackers limit their rate
  int frame = 0;
  ros::Publisher cloud;

  std::vector<cv::Point2d> normalized(const std::vector<cv::Point2d>& pixels) const {
    std::vector<cv::Point2d> result;
    if (pixels.empty()) {
      return result;
    }
    const cv::Matx33d k(matrix.data());
    if (model == "equidistant") {
      cv::fisheye::undistortPoints(pixels, result, k, distortion);
    } else {
      cv::undistortPoints(
          pixels, result, k, distortion, cv::noArray(), cv::noArray(),
          cv::TermCriteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 500, 1e-14));
    }
    return result;
  }

  void onLines(const evolin_ros::LineArray& known) {
    if (frame++ % every != 0) {
      return;
    }
    std::vector<cv::Point2d> pixels;
    for (const evolin_ros::Line& line : known.lines) {
      pixels.emplace_back(line.x1, line.y1);
      pixels.emplace_back(line.x2, line.y2);
    }
    const std::vector<cv::Point2d> points = normalized(pixels);
    sensor_msgs::PointCloud message;
    message.header = known.header;
    message.header.frame_id = "world";
    message.channels.resize(3);
    for (int camera = 0; camera < cameras; ++camera) {
      for (std::size_t i = 0; i < known.lines.size(); ++i) {
        // Other cameras see other lines; these only have to be told apart.
        const double shift = 0.1 * camera;
        geometry_msgs::Point32 start;
        start.x = static_cast<float>(points[2 * i].x + shift);
        start.y = static_cast<float>(points[2 * i].y);
        start.z = 1;
        message.points.push_back(start);
        message.channels[0].values.push_back(
            static_cast<float>(known.lines[i].id * cameras + camera));
        message.channels[1].values.push_back(static_cast<float>(points[2 * i + 1].x + shift));
        message.channels[2].values.push_back(static_cast<float>(points[2 * i + 1].y));
      }
    }
    cloud.publish(message);
  }
};

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "linefeature_tracker");
  ros::NodeHandle handle;
  ros::NodeHandle parameters("~");
  Tracker tracker;
  if (!parameters.getParam("K", tracker.matrix) || tracker.matrix.size() != 9 ||
      !parameters.getParam("D", tracker.distortion)) {
    ROS_FATAL("~K must hold 9 numbers, ~D a list of them");
    return 1;
  }
  parameters.getParam("distortion_model", tracker.model);
  parameters.getParam("cameras", tracker.cameras);
  parameters.getParam("every", tracker.every);
  tracker.cloud = parameters.advertise<sensor_msgs::PointCloud>("linefeature", 1000);
  const ros::Subscriber known = handle.subscribe<evolin_ros::LineArray>(
      "known_lines", 1000,
      [&tracker](const evolin_ros::LineArray::ConstPtr& lines) { tracker.onLines(*lines); });
  ros::spin();
}
