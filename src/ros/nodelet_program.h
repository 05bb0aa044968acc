// A program around one nodelet, for those who want a plain node.
#pragma once

#include <string>

namespace evolin::ros_shell {

/// Runs nodelet `type` as node `name` until ROS shuts down; remappings and private parameters come
/// from the command line, as with 'nodelet standalone'. Returns the exit status: 1 when the nodelet
/// refuses to start, whose reason is logged.
int runNodelet(int argc, char** argv, const std::string& type, const std::string& name);

}  // namespace evolin::ros_shell
