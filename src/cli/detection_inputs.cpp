// Pairing files by stem, and reading them.
#include "detection_inputs.h"

#include <boost/program_options/value_semantic.hpp>

#include "evolin_ros/dataset/csv.h"
#include "evolin_ros/dataset/image_file.h"
#include "file_pairing.h"
#include "image_size.h"

namespace evolin::cli {

namespace po = boost::program_options;

void addDetectionOptions(const std::string& thresholds_help, DetectionFolders* folders,
                         po::options_description* description) {
  auto add = description->add_options();
  add("pred-lines,p", po::value(&folders->predicted)->value_name("DIR")->required(),
      "predicted lines, one CSV (rows x1,y1,x2,y2 in pixels) a frame");
  add("gt-lines,g", po::value(&folders->ground_truth)->value_name("DIR")->required(),
      "true lines, under the same names");
  add("imgs,i", po::value(&folders->images)->value_name("DIR")->required(),
      "images of the same names, for their sizes");
  add("scores,s", po::value(&folders->scores)->value_name("DIR"),
      "scores of the predicted lines, one CSV (a score a row) a frame");
  add("score-thresholds,S", po::value(&folders->score_thresholds)->value_name("FILE"),
      thresholds_help.c_str());
}

LineSegments DetectionFiles::readPredicted() const {
  return scores.empty() ? readLinesCsv(predicted) : readScoredLinesCsv(predicted, scores);
}

LineSegments DetectionFiles::readGroundTruth() const { return readLinesCsv(ground_truth); }

ImageSize DetectionFiles::readSize() const { return readImageSize(image); }

ParseError DetectionFiles::locate(const GroundTruthError& error) const {
  // Readers refuse blank rows before the last line, so rows are lines.
  return {ground_truth.string(), static_cast<int>(error.row()) + 1, error.what()};
}

std::vector<DetectionFiles> listDetectionFiles(const DetectionFolders& folders) {
  const FileSet truth = listByStem("true lines", folders.ground_truth, {".csv"});
  const FileSet predicted = listByStem("predicted lines", folders.predicted, {".csv"});
  requireSameStems(truth, predicted);
  FileSet scores;
  if (folders.scored()) {
    scores = listByStem("scores", folders.scores, {".csv"});
    requireSameStems(predicted, scores);
  }
  // More images than annotated frames are usual.
  const FileSet images = listByStem("image", folders.images, imageExtensions());
  std::vector<DetectionFiles> frames;
  for (const auto& [stem, file] : truth.files) {
    frames.push_back({stem, predicted.at(stem), file, images.at(stem),
                      folders.scored() ? scores.at(stem) : std::filesystem::path()});
  }
  return frames;
}

}  // namespace evolin::cli
