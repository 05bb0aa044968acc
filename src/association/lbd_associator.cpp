// Associates lines by the float line band descriptor.
#include "evolin_ros/association/lbd_associator.h"

#include <any>
#include <limits>
#include <string>

#include "evolin_ros/association/descriptor_matching.h"
#include "evolin_ros/base/error.h"
#include "evolin_ros/base/parameters.h"

namespace evolin {
namespace {

const char* const kOwner = "associator lbd";

// What FrameLines::description holds; a type of its own, so that another method's cache is not
// mistaken for this one.
struct LbdDescription {
  cv::Mat descriptors;
};

bool hasLength(const LineSegment& line) {
  return static_cast<float>(line.x1) != static_cast<float>(line.x2) ||
         static_cast<float>(line.y1) != static_cast<float>(line.y2);
}

}  // namespace

void LbdAssociator::configure(const YAML::Node& parameters) {
  LbdParameters read(kLbdLargestDistance);
  ParameterReader reader(parameters, kOwner);
  readDescriptorChoice(&reader, &read);
  reader.finish();
  parameters_ = read;
  configured_ = true;
}

void LbdAssociator::describe(const FrameLines& lines) {
  if (!configured_) {
    throw Error(std::string(kOwner) + ": describe() was called before configure()");
  }
  descriptorsOf(lines);
}

LineMatches LbdAssociator::match(const FrameLines& first, const FrameLines& second) {
  if (!configured_) {
    throw Error(std::string(kOwner) + ": match() was called before configure()");
  }
  return matchDescriptors(descriptorsOf(first), descriptorsOf(second),
                          matchingRules(parameters_, first.lines, second.lines));
}

cv::Mat LbdAssociator::descriptorsOf(const FrameLines& lines) {
  const auto* known = std::any_cast<LbdDescription>(&lines.description);
  if (known != nullptr && known->descriptors.rows == static_cast<int>(lines.lines.size())) {
    return known->descriptors;
  }
  LbdDescription description;
  if (!lines.lines.empty()) {
    description.descriptors = describer_.describe(toGray(lines.frame.image), lines.lines);
  }
  for (std::size_t i = 0; i < lines.lines.size(); ++i) {
    // Without a direction all descriptors are equal; NaN keeps the matcher from pairing them.
    if (!hasLength(lines.lines[i])) {
      description.descriptors.row(static_cast<int>(i))
          .setTo(std::numeric_limits<float>::quiet_NaN());
    }
  }
  const cv::Mat descriptors = description.descriptors;
  lines.description = std::move(description);
  return descriptors;
}

}  // namespace evolin
