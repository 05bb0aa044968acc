// Folders of predicted and true lines, scores and images, paired frame by frame.
#pragma once

#include <boost/program_options/options_description.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "evolin_ros/base/error.h"
#include "evolin_ros/geometry/image_size.h"
#include "evolin_ros/geometry/line_segment.h"

namespace evolin::cli {

struct DetectionFolders {
  std::string predicted;
  std::string ground_truth;
  std::string images;
  std::string scores;            ///< empty: unscored
  std::string score_thresholds;  ///< file; empty: none

  bool scored() const { return !scores.empty(); }
};

/// Adds --pred-lines, --gt-lines, --imgs, --scores and --score-thresholds, bound to `folders`,
/// which must live as long as the description. `thresholds_help` describes the last one.
void addDetectionOptions(const std::string& thresholds_help, DetectionFolders* folders,
                         boost::program_options::options_description* description);

/// One frame's files; nothing is read yet.
struct DetectionFiles {
  std::string stem;
  std::filesystem::path predicted;
  std::filesystem::path ground_truth;
  std::filesystem::path image;
  std::filesystem::path scores;  ///< empty: unscored

  /// With scores where there are any. Throws ParseError and Error as the readers do.
  LineSegments readPredicted() const;
  LineSegments readGroundTruth() const;
  ImageSize readSize() const;

  /// The same with the file and line that the row stands in.
  ParseError locate(const GroundTruthError& error) const;
};

/// Frames by stem: those with ground truth; more images are fine. Throws Error naming the stem when
/// any other file is missing or too many.
std::vector<DetectionFiles> listDetectionFiles(const DetectionFolders& folders);

}  // namespace evolin::cli
