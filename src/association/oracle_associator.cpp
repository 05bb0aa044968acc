// Where the first frame's lines are seen in the second, and whether what is there is as far away.
#include "evolin_ros/association/oracle_associator.h"

#include <algorithm>
#include <string>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/parameters.h"

namespace evolin {

namespace {

const char* const kOwner = "associator oracle";

double distanceToLine(const Eigen::Vector3d& point, const Segment3d& line) {
  const Eigen::Vector3d along = (line.p2 - line.p1).normalized();
  return (point - line.p1).cross(along).norm();
}

/// Metres from the middle of either to the other, straight on; the smaller one.
double gapBetween(const Segment3d& a, const Segment3d& b) {
  return std::min(distanceToLine((a.p1 + a.p2) / 2, b), distanceToLine((b.p1 + b.p2) / 2, a));
}

}  // namespace

void OracleAssociator::configure(const YAML::Node& parameters) {
  OracleParameters read;
  ParameterReader reader(parameters, kOwner);
  readGates(&reader, &read.gates);
  reader.read("max_gap", &read.max_gap, 0, 1e6);
  reader.finish();
  parameters_ = read;
  configured_ = true;
}

LineMatches OracleAssociator::match(const FrameLines& first, const FrameLines& second) {
  if (!configured_) {
    throw Error(std::string(kOwner) + ": match() was called before configure()");
  }
  const SpatialSegments of_first = liftIntoSpace(first, kOwner);
  const SpatialSegments of_second = liftIntoSpace(second, kOwner);
  const Eigen::Isometry3d motion = motionOf(first, second, kOwner);
  LineMatches matches = matchGeometrically(expectIn(second, of_first, motion, kOwner), second.lines,
                                           parameters_.gates);
  const auto apart = [&](const LineMatch& match) {
    const std::optional<Segment3d>& a = of_first[match.first];
    const std::optional<Segment3d>& b = of_second[match.second];
    return a && b && gapBetween({motion * a->p1, motion * a->p2}, *b) > parameters_.max_gap;
  };
  matches.erase(std::remove_if(matches.begin(), matches.end(), apart), matches.end());
  return matches;
}

}  // namespace evolin
