// Runs a test program as a ROS node.
#include <gtest/gtest.h>
#include <ros/init.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "online_test");
  const ros::NodeHandle handle;  // keeps the node up for the whole run
  ros::AsyncSpinner spinner(1);
  spinner.start();
  return RUN_ALL_TESTS();
}
