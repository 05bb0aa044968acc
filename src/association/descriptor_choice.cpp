// Options of associators by descriptor, and the limits on where two lines lie.
#include "evolin_ros/association/descriptor_choice.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace evolin {
namespace {

constexpr double kNoAngleLimit = 90;

struct Placement {
  double x;  ///< of the middle
  double y;
  double direction;  ///< degrees; NaN of a line that is not finite
};

std::vector<Placement> placementsOf(const LineSegments& lines) {
  std::vector<Placement> placements;
  placements.reserve(lines.size());
  for (const LineSegment& line : lines) {
    const double direction = std::atan2(line.y2 - line.y1, line.x2 - line.x1) * 180 / M_PI;
    placements.push_back({line.x1 / 2 + line.x2 / 2, line.y1 / 2 + line.y2 / 2,
                          line.isFinite() ? direction : std::numeric_limits<double>::quiet_NaN()});
  }
  return placements;
}

/// Of two directions from -180 to 180, 0 to 90 degrees; NaN stays NaN.
double angleBetween(double a, double b) {
  const double turn = std::fmod(std::abs(a - b), 180.0);
  return turn > 90 ? 180 - turn : turn;
}

}  // namespace

void readDescriptorChoice(ParameterReader* reader, DescriptorChoice* choice) {
  reader->read("cross_check", &choice->cross_check);
  reader->read("max_distance", &choice->max_distance, 0, choice->max_distance);
  reader->read("max_ratio", &choice->max_ratio, 0, 1);
  reader->read("max_displacement", &choice->max_displacement, 0, 1e6);
  reader->read("max_angle", &choice->max_angle, 0, kNoAngleLimit);
}

MatchingRules matchingRules(const DescriptorChoice& choice, const LineSegments& first,
                            const LineSegments& second) {
  MatchingRules rules;
  rules.cross_check = choice.cross_check;
  rules.max_distance = choice.max_distance;
  rules.max_ratio = choice.max_ratio;
  const bool limits_place = choice.max_displacement > 0;
  const bool limits_angle = choice.max_angle < kNoAngleLimit;
  if (!limits_place && !limits_angle) {
    return rules;
  }
  rules.may_match = [choice, limits_place, limits_angle, of_first = placementsOf(first),
                     of_second = placementsOf(second)](std::size_t i, std::size_t j) {
    const Placement& a = of_first[i];
    const Placement& b = of_second[j];
    return (!limits_place || std::hypot(a.x - b.x, a.y - b.y) <= choice.max_displacement) &&
           (!limits_angle || angleBetween(a.direction, b.direction) <= choice.max_angle);
  };
  return rules;
}

}  // namespace evolin
