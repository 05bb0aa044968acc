// Associates lines by the binary line band descriptor of OpenCV.
#include "evolin_ros/association/lbd_binary_associator.h"

#include <any>
#include <string>
#include <utility>

#include "evolin_ros/association/descriptor_matching.h"
#include "evolin_ros/association/lbd_binary_descriptor.h"
#include "evolin_ros/base/availability.h"
#include "evolin_ros/base/error.h"
#include "evolin_ros/base/parameters.h"

namespace evolin {
namespace {

const char* const kOwner = "associator lbd_binary";

// What FrameLines::description holds; a type of its own, so that another method's cache is not
// mistaken for this one.
struct LbdBinaryDescription {
  BinaryDescriptors descriptors;
};

BinaryDescriptors descriptorsOf(const FrameLines& lines) {
  const auto* known = std::any_cast<LbdBinaryDescription>(&lines.description);
  if (known != nullptr && known->descriptors.valid.size() == lines.lines.size()) {
    return known->descriptors;
  }
  LbdBinaryDescription description;
  if (!lines.lines.empty()) {
    try {
      description.descriptors = describeLbdBinary(toGray(lines.frame.image), lines.lines);
    } catch (const Error& error) {
      throw Error(std::string(kOwner) + ": frame '" + lines.frame.name + "': " + error.what());
    }
  }
  const BinaryDescriptors descriptors = description.descriptors;
  lines.description = std::move(description);
  return descriptors;
}

}  // namespace

std::string LbdBinaryAssociator::whyUnavailable() const { return whyNoLbdBinary(); }

void LbdBinaryAssociator::configure(const YAML::Node& parameters) {
  requireAvailable(kOwner, whyUnavailable());
  LbdBinaryParameters read;
  ParameterReader reader(parameters, kOwner);
  reader.read("cross_check", &read.cross_check);
  reader.read("max_distance", &read.max_distance, 0, 8 * kLbdBinaryBytes);
  reader.finish();
  parameters_ = read;
  configured_ = true;
}

void LbdBinaryAssociator::describe(const FrameLines& lines) {
  if (!configured_) {
    throw Error(std::string(kOwner) + ": describe() was called before configure()");
  }
  descriptorsOf(lines);
}

LineMatches LbdBinaryAssociator::match(const FrameLines& first, const FrameLines& second) {
  if (!configured_) {
    throw Error(std::string(kOwner) + ": match() was called before configure()");
  }
  return matchBinaryDescriptors(descriptorsOf(first), descriptorsOf(second),
                                parameters_.cross_check, parameters_.max_distance);
}

}  // namespace evolin
