// Associates lines by where they should have gone.
#include "evolin_ros/association/geometric_associator.h"

#include <opencv2/imgproc.hpp>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/parameters.h"

namespace evolin {

namespace {

const char* const kOwner = "associator geometric";

std::vector<std::optional<LineSegment>> moved(const LineSegments& lines, cv::Point2d by) {
  std::vector<std::optional<LineSegment>> expected;
  expected.reserve(lines.size());
  for (LineSegment line : lines) {
    line.x1 += by.x;
    line.y1 += by.y;
    line.x2 += by.x;
    line.y2 += by.y;
    expected.emplace_back(line);
  }
  return expected;
}

cv::Point2d translationBetween(const Frame& first, const Frame& second) {
  const cv::Mat a = toGray(first.image);
  const cv::Mat b = toGray(second.image);
  if (a.size() != b.size()) {
    throw Error(std::string(kOwner) + ": the images are " + std::to_string(a.cols) + "x" +
                std::to_string(a.rows) + " and " + std::to_string(b.cols) + "x" +
                std::to_string(b.rows) + ", expected one size");
  }
  // Half the size is exact enough for a gate of pixels.
  cv::Mat small_a;
  cv::Mat small_b;
  const cv::Size half((a.cols + 1) / 2, (a.rows + 1) / 2);
  if (half.width < 2 || half.height < 2) {
    return {};  // OpenCV's phase correlation fails on a single row or column
  }
  cv::resize(a, small_a, half, 0, 0, cv::INTER_AREA);
  cv::resize(b, small_b, half, 0, 0, cv::INTER_AREA);
  small_a.convertTo(small_a, CV_32F);
  small_b.convertTo(small_b, CV_32F);
  cv::Mat window;
  cv::createHanningWindow(window, half, CV_32F);
  double response = 0;
  const cv::Point2d shift = cv::phaseCorrelate(small_a, small_b, window, &response);
  // Images without texture correlate with nothing.
  const bool found = response > 0.03 && std::abs(shift.x) < half.width / 2.0 &&
                     std::abs(shift.y) < half.height / 2.0;
  return found ? 2 * shift : cv::Point2d();
}

}  // namespace

void GeometricAssociator::configure(const YAML::Node& parameters) {
  GeometricParameters read;
  std::string prediction = "translation";
  ParameterReader reader(parameters, kOwner);
  reader.read("prediction", &prediction, {"none", "translation", "pose"});
  readGates(&reader, &read.gates);
  reader.finish();
  read.prediction = prediction == "none"   ? MotionPrediction::kNone
                    : prediction == "pose" ? MotionPrediction::kPose
                                           : MotionPrediction::kTranslation;
  parameters_ = read;
  configured_ = true;
}

Needs GeometricAssociator::needs() const {
  const bool pose = parameters_.prediction == MotionPrediction::kPose;
  return {pose, pose, pose};
}

LineMatches GeometricAssociator::match(const FrameLines& first, const FrameLines& second) {
  if (!configured_) {
    throw Error(std::string(kOwner) + ": match() was called before configure()");
  }
  if (parameters_.prediction == MotionPrediction::kPose) {
    const SpatialSegments lifted = liftIntoSpace(first, kOwner);
    const Eigen::Isometry3d motion = motionOf(first, second, kOwner);
    return matchGeometrically(expectIn(second, *first.frame.camera, lifted, motion), second.lines,
                              parameters_.gates);
  }
  const cv::Point2d shift = parameters_.prediction == MotionPrediction::kNone
                                ? cv::Point2d()
                                : translationBetween(first.frame, second.frame);
  return matchGeometrically(moved(first.lines, shift), second.lines, parameters_.gates);
}

}  // namespace evolin
