// Which topics of a bag are the camera's, by name where the user gave one, else by type.
#pragma once

#include <string>

#include "bag_parts.h"
#include "bag_source.h"

namespace evolin::ros_shell {

/// "": there is none.
struct BagTopicChoice {
  std::string image;
  std::string depth;
  std::string camera_info;
  std::string pose;  ///< not tf
  std::string ground_truth;
  bool tf = false;
  std::size_t images = 0;  ///< messages of the image topic
};

/// As openBagParts().
BagTopicChoice chooseTopics(BagSource* bag, const BagPartsOptions& options,
                            const WantedParts& wanted);

/// "topic (type)" of every topic, for messages.
std::string listTopics(const std::vector<BagTopic>& topics);

}  // namespace evolin::ros_shell
