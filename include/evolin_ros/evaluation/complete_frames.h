// Images of a recording with the depth, pose and camera that belong to them, for plug-ins that ask.
#pragma once

#include <memory>

#include "evolin_ros/dataset/needs.h"
#include "evolin_ros/evaluation/part_reader.h"

namespace evolin {

/// Throws UnavailableError naming what `needs` has and PartReader::offers() has not.
void requireOffered(const PartReader& reader, const Needs& needs);

/// The parts of `reader` in their order, with what `needs` names in the frames of the images: the
/// depth image nearest in time within MotionOptions::max_time_difference, the pose at the image's
/// stamp (see Trajectory::at()), the newest camera. It reads ahead, by 64 images at most,
/// as all of that may be recorded behind the image. A frame for which the recording has none goes
/// without it. Where the time of the images jumps back, a pass begins whose images get nothing of
/// the one before it. Depth and poses go on as parts of their own only where `wanted` has them.
///
/// Throws as requireOffered().
std::unique_ptr<PartReader> completeFrames(std::unique_ptr<PartReader> reader, const Needs& needs,
                                           const WantedParts& wanted);

}  // namespace evolin
