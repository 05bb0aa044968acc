// The nodelet evolin_ros/Lines3d as a plain node.
#include "nodelet_program.h"

int main(int argc, char** argv) {
  return evolin::ros_shell::runNodelet(argc, argv, "evolin_ros/Lines3d", "lines_3d");
}
