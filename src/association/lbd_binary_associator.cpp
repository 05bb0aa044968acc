// Associates lines by the binary line band descriptor.
#include "evolin_ros/association/lbd_binary_associator.h"

#include <any>
#include <string>
#include <utility>

#include "evolin_ros/association/descriptor_matching.h"
#include "evolin_ros/association/opencv_lbd_binary.h"
#include "evolin_ros/base/availability.h"
#include "evolin_ros/base/error.h"
#include "evolin_ros/base/parameters.h"

namespace evolin {
namespace {

// What FrameLines::description holds; a type of its own, so that another method's cache is not
// mistaken for this one.
struct LbdBinaryDescription {
  std::string owner;  ///< own descriptors are not OpenCV's
  BinaryDescriptors descriptors;
};

}  // namespace

LbdBinaryAssociator::LbdBinaryAssociator()
    : LbdBinaryAssociator("associator lbd_binary", &describeLbdBinary) {}

LbdBinaryAssociator::LbdBinaryAssociator(std::string owner, Describe describe_lines)
    : owner_(std::move(owner)), describe_lines_(describe_lines) {}

void LbdBinaryAssociator::configure(const YAML::Node& parameters) {
  requireAvailable(owner_, whyUnavailable());
  LbdBinaryParameters read(kLbdBinaryLargestDistance);
  ParameterReader reader(parameters, owner_);
  readDescriptorChoice(&reader, &read);
  reader.finish();
  parameters_ = read;
  configured_ = true;
}

void LbdBinaryAssociator::requireConfigured(const char* function) const {
  if (!configured_) {
    throw Error(owner_ + ": " + function + "() was called before configure()");
  }
}

BinaryDescriptors LbdBinaryAssociator::descriptorsOf(const FrameLines& lines) const {
  const auto* known = std::any_cast<LbdBinaryDescription>(&lines.description);
  if (known != nullptr && known->owner == owner_ &&
      known->descriptors.valid.size() == lines.lines.size()) {
    return known->descriptors;
  }
  LbdBinaryDescription description;
  description.owner = owner_;
  if (!lines.lines.empty()) {
    try {
      description.descriptors = describe_lines_(toGray(lines.frame.image), lines.lines);
    } catch (const Error& error) {
      throw Error(owner_ + ": frame '" + lines.frame.name + "': " + error.what());
    }
  }
  const BinaryDescriptors descriptors = description.descriptors;
  lines.description = std::move(description);
  return descriptors;
}

void LbdBinaryAssociator::describe(const FrameLines& lines) {
  requireConfigured("describe");
  descriptorsOf(lines);
}

LineMatches LbdBinaryAssociator::match(const FrameLines& first, const FrameLines& second) {
  requireConfigured("match");
  return matchBinaryDescriptors(descriptorsOf(first), descriptorsOf(second),
                                matchingRules(parameters_, first.lines, second.lines));
}

OpenCvLbdBinaryAssociator::OpenCvLbdBinaryAssociator()
    : LbdBinaryAssociator("associator opencv_lbd_binary", &describeOpenCvLbdBinary) {}

std::string OpenCvLbdBinaryAssociator::whyUnavailable() const { return whyNoOpenCvLbdBinary(); }

}  // namespace evolin
