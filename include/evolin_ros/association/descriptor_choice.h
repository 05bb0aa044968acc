// Which descriptors' pairs an associator takes: the options that associators by descriptor share.
#pragma once

#include "evolin_ros/association/descriptor_matching.h"
#include "evolin_ros/base/parameters.h"
#include "evolin_ros/geometry/line_segment.h"

namespace evolin {

/// The defaults keep every pair of mutual nearest neighbours, with the largest distance that there
/// is as `largest_distance`.
struct DescriptorChoice {
  explicit DescriptorChoice(double largest_distance) : max_distance(largest_distance) {}

  bool cross_check = true;      ///< keep a pair only if each line is the other's nearest
  double max_distance;          ///< of the descriptors, in their unit, inclusive
  double max_ratio = 1;         ///< of the distance to the second nearest; 1: no such test
  double max_displacement = 0;  ///< pixels between the lines' middles, inclusive; 0: no limit
  double max_angle = 90;        ///< degrees between the lines' directions, whatever the endpoints'
                                ///< order, inclusive; 90: no limit
};

/// Reads the options by their names into `choice`, which holds the defaults. Throws as
/// ParameterReader.
void readDescriptorChoice(ParameterReader* reader, DescriptorChoice* choice);

/// The rules that `choice` makes for the lines of two frames. A line with a coordinate that is not
/// finite passes no limit.
MatchingRules matchingRules(const DescriptorChoice& choice, const LineSegments& first,
                            const LineSegments& second);

}  // namespace evolin
