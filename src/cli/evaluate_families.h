// The metric families of `evaluate`: each takes its own arguments and does the whole job.
#pragma once

#include <string>
#include <vector>

namespace evolin::cli {

/// Detection on segments as vectors. Returns the exit status; throws as Command::run may.
int evaluateVectorized(const std::vector<std::string>& arguments);

/// Detection on drawn pixels. Returns the exit status; throws as Command::run may.
int evaluateHeatmap(const std::vector<std::string>& arguments);

/// Association as a classification of index pairs. Returns the exit status; throws as Command::run
/// may.
int evaluateAssociation(const std::vector<std::string>& arguments);

/// Repeatability and localisation error over pairs of frames with depth and poses. Returns the exit
/// status; throws as Command::run may.
int evaluateRepeatability(const std::vector<std::string>& arguments);

/// Relative pose from matched lines with depth. Returns the exit status; throws as Command::run
/// may.
int evaluatePose(const std::vector<std::string>& arguments);

}  // namespace evolin::cli
