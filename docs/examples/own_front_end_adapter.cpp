// Twenty lines between a front-end's own messages and the evaluator. PolygonStamped stands for your
// message: two by two, its points are ends of tracked lines in pixels, with the track's id as z.
#include <evolin_ros/LineArray.h>
#include <geometry_msgs/PolygonStamped.h>
#include <ros/ros.h>

#include <limits>

int main(int argc, char** argv) {
  ros::init(argc, argv, "my_lines_adapter");
  ros::NodeHandle node;
  const ros::Publisher lines = node.advertise<evolin_ros::LineArray>("lines", 1000);
  const ros::Subscriber own = node.subscribe<geometry_msgs::PolygonStamped>(
      "my_lines", 1000, [&](const geometry_msgs::PolygonStamped::ConstPtr& mine) {
        evolin_ros::LineArray array;
        array.header = mine->header;  // the image's stamp: lines and ground truth pair up by it
        array.width = 640;            // of the image, in pixels
        array.height = 480;
        array.source = "my_front_end";
        for (std::size_t i = 0; i + 1 < mine->polygon.points.size(); i += 2) {
          const auto& a = mine->polygon.points[i];
          const auto& b = mine->polygon.points[i + 1];
          evolin_ros::Line line;
          line.x1 = a.x, line.y1 = a.y, line.x2 = b.x, line.y2 = b.y;
          line.score = std::numeric_limits<double>::quiet_NaN();  // none
          line.id = static_cast<std::int64_t>(a.z);               // -1: not tracked
          array.lines.push_back(line);
        }
        lines.publish(array);
      });
  ros::spin();
}
