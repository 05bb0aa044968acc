// The nodelet evolin_ros/OpencvAppsLines as a plain node.
#include "nodelet_program.h"

int main(int argc, char** argv) {
  return evolin::ros_shell::runNodelet(argc, argv, "evolin_ros/OpencvAppsLines",
                                       "opencv_apps_lines");
}
