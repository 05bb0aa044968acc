// A shipped file of parameters against the defaults of an associator by descriptor.
#pragma once

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "evolin_ros/association/descriptor_choice.h"

namespace evolin::test {

/// `node` names every option, and `loaded` from it is `defaults`.
inline void expectHoldsAllDefaults(const YAML::Node& node, const DescriptorChoice& loaded,
                                   const DescriptorChoice& defaults) {
  EXPECT_EQ(loaded.cross_check, defaults.cross_check);
  EXPECT_EQ(loaded.max_distance, defaults.max_distance);
  EXPECT_EQ(loaded.max_ratio, defaults.max_ratio);
  EXPECT_EQ(loaded.max_displacement, defaults.max_displacement);
  EXPECT_EQ(loaded.max_angle, defaults.max_angle);
  EXPECT_EQ(node.size(), 5U);
  for (const char* key :
       {"cross_check", "max_distance", "max_ratio", "max_displacement", "max_angle"}) {
    EXPECT_TRUE(node[key].IsDefined()) << key;
  }
}

}  // namespace evolin::test
