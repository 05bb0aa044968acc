// nodelet's own loader, hosting one nodelet under the node's own name.
#include "nodelet_program.h"

#include <nodelet/loader.h>
#include <ros/init.h>
#include <ros/node_handle.h>
#include <ros/this_node.h>

#include <vector>

namespace evolin::ros_shell {

int runNodelet(int argc, char** argv, const std::string& type, const std::string& name) {
  ros::init(argc, argv, name);
  const ros::NodeHandle handle;
  nodelet::Loader loader(false);
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  // Remappings of the command line hold for the whole process already.
  if (!loader.load(ros::this_node::getName(), type, nodelet::M_string(), arguments)) {
    return 1;
  }
  ros::spin();
  return 0;
}

}  // namespace evolin::ros_shell
