// Each finding says what there is and, where that will not do, what would.
#include "evolin_ros/evaluation/recording_check.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "evolin_ros/base/text.h"
#include "evolin_ros/evaluation/inputs.h"

namespace evolin {

namespace {

using Level = Finding::Level;

/// Points of a depth image that are looked at, along each side.
constexpr int kDepthGrid = 16;

/// Indoors and out; what is beyond is a wrong unit.
constexpr float kNearestDepth = 0.1F;
constexpr float kFarthestDepth = 50;

/// An interval longer than this many usual ones lacks images.
constexpr double kGap = 1.5;

template <class Value>
Value medianOf(std::vector<Value> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::string fixed(double value, int digits) {
  const double scale = std::pow(10, digits);
  return formatDouble(std::round(value * scale) / scale);
}

std::string sizeText(int width, int height) {
  return std::to_string(width) + "x" + std::to_string(height);
}

}  // namespace

std::string toString(Finding::Level level) {
  switch (level) {
    case Level::kGood:
      return "ok";
    case Level::kDoubt:
      return "doubt";
    case Level::kMissing:
      break;
  }
  return "missing";
}

void RecordingCheck::add(const StreamPart& part) {
  if (const auto* image = std::get_if<ImagePart>(&part)) {
    addImage(*image);
  } else if (const auto* camera = std::get_if<Camera>(&part)) {
    addCamera(*camera);
  } else if (const auto* depth = std::get_if<DepthPart>(&part)) {
    addDepth(*depth);
  } else if (const auto* pose = std::get_if<StampedPose>(&part)) {
    repeated_poses_ += trajectory_.add(*pose) ? 0 : 1;
  } else {
    addTruth(std::get<LineSet>(part));
  }
}

void RecordingCheck::addImage(const ImagePart& image) {
  image_stamps_.push_back(image.frame.stamp);
  const cv::Mat& pixels = image.frame.image;
  if (pixels.empty()) {
    first_problem_ = unreadable_ == 0 ? image.problem : first_problem_;
    ++unreadable_;
    return;
  }
  ++image_kinds_[sizeText(pixels.cols, pixels.rows) +
                 (pixels.channels() == 1 ? " grey" : " colour")];
  image_size_ = image_size_.value_or(std::pair(pixels.cols, pixels.rows));
}

void RecordingCheck::addCamera(const Camera& camera) {
  if (!camera_) {
    camera_ = camera;
  } else if (!sameIntrinsics(*camera_, camera)) {
    ++other_cameras_;
  }
}

void RecordingCheck::addDepth(const DepthPart& depth) {
  depth_stamps_.push_back(depth.stamp);
  const ImageSize size = depth.depth.size();
  for (int row = 0; row < kDepthGrid; ++row) {
    for (int column = 0; column < kDepthGrid; ++column) {
      const double metres = depth.depth.at((2 * column + 1) * size.width / (2 * kDepthGrid),
                                           (2 * row + 1) * size.height / (2 * kDepthGrid));
      ++depth_samples_;
      if (DepthMap::isDepth(metres)) {
        depths_.push_back(static_cast<float>(metres));
      }
    }
  }
}

void RecordingCheck::addTruth(const LineSet& truth) {
  Truth& entry = truths_[truth.stamp];
  entry.lines = truth.lines.size();
  entry.ids = hasIds(truth.lines);
  for (std::size_t row = 0; row < truth.lines.size() && entry.fault.empty(); ++row) {
    const LineSegment& line = truth.lines[row];
    const bool outside = !(std::max(line.x1, line.x2) <= truth.width) ||
                         !(std::max(line.y1, line.y2) <= truth.height);
    if (!line.isFinite() || !(line.length() > 0) || outside) {
      entry.fault = "row " + std::to_string(row) + " at " + formatStamp(truth.stamp) +
                    (outside ? " lies outside the image" : " has no length");
    }
  }
}

std::string RecordingCheck::ofImages(std::size_t count) const {
  return std::to_string(count) + " of " + std::to_string(image_stamps_.size()) + " images";
}

std::vector<Finding> RecordingCheck::findings() const {
  std::vector<Finding> findings;
  checkImages(&findings);
  checkCamera(&findings);
  checkDepth(&findings);
  checkPoses(&findings);
  checkTruth(&findings);
  return findings;
}

void RecordingCheck::checkImages(std::vector<Finding>* findings) const {
  const std::string subject = "images";
  if (image_stamps_.empty()) {
    findings->push_back({Level::kMissing, subject, "none", "name their topic or folder"});
    return;
  }
  std::string kinds;
  for (const auto& [kind, count] : image_kinds_) {
    kinds += ", " + kind + (image_kinds_.size() > 1 ? " (" + std::to_string(count) + ")" : "");
  }
  std::vector<Stamp> steps;
  std::size_t backwards = 0;
  for (std::size_t i = 1; i < image_stamps_.size(); ++i) {
    const Stamp step = image_stamps_[i] - image_stamps_[i - 1];
    backwards += step <= 0 ? 1 : 0;
    if (step > 0) {
      steps.push_back(step);
    }
  }
  std::string text = std::to_string(image_stamps_.size()) + kinds;
  if (!steps.empty()) {
    text += ", " + fixed(1 / toSeconds(medianOf(steps)), 2) + " Hz";
  }
  findings->push_back({Level::kGood, subject, text, ""});
  if (image_kinds_.size() > 1) {
    findings->push_back({Level::kDoubt, subject, "their size or colour changes",
                         "expected one camera: name its topic, or cut with --start, --duration"});
  }
  if (backwards > 0) {
    findings->push_back(
        {Level::kDoubt, subject, std::to_string(backwards) + " stamps repeat or go back in time",
         "each jump begins a pass of its own: cut one out with --start, --duration"});
  }
  if (!steps.empty()) {
    const double usual = kGap * toSeconds(medianOf(steps));
    const auto is_gap = [usual](Stamp step) { return toSeconds(step) > usual; };
    const auto gaps = std::count_if(steps.begin(), steps.end(), is_gap);
    if (gaps > 0) {
      findings->push_back({Level::kDoubt, subject,
                           std::to_string(gaps) + " gaps, the longest " +
                               fixed(toSeconds(*std::max_element(steps.begin(), steps.end())), 3) +
                               " s",
                           "frame steps count images: across a gap they are longer in time"});
    }
  }
  if (unreadable_ > 0) {
    findings->push_back({Level::kDoubt, subject,
                         ofImages(unreadable_) + " cannot be read: " + first_problem_,
                         "they count as unmatched"});
  }
}

void RecordingCheck::checkCamera(std::vector<Finding>* findings) const {
  const std::string subject = "camera";
  if (!camera_) {
    findings->push_back({Level::kMissing, subject, "no intrinsics",
                         "give --camera (a preset or a YAML file), or --camera-info-topic"});
    return;
  }
  findings->push_back({Level::kGood, subject,
                       sizeText(camera_->width, camera_->height) + ", fx " +
                           formatDouble(camera_->fx) + ", fy " + formatDouble(camera_->fy) +
                           ", cx " + formatDouble(camera_->cx) + ", cy " +
                           formatDouble(camera_->cy),
                       ""});
  if (image_size_ && *image_size_ != std::pair(camera_->width, camera_->height)) {
    findings->push_back({Level::kDoubt, subject,
                         "the images are " + sizeText(image_size_->first, image_size_->second) +
                             ", the camera's " + sizeText(camera_->width, camera_->height),
                         "it is another camera's: give --camera or --camera-info-topic"});
  }
  if (other_cameras_ > 0) {
    findings->push_back({Level::kDoubt, subject,
                         std::to_string(other_cameras_) + " messages have other intrinsics",
                         "the first ones are taken: give --camera where they are wrong"});
  }
  if (hasDistortion(*camera_)) {
    findings->push_back(
        {Level::kDoubt, subject,
         "has distortion (" + camera_->distortion_model + "), which the metrics do not look at",
         "rectify the images for repeatability and relative pose"});
  }
}

std::size_t RecordingCheck::imagesWithDepth() const {
  std::vector<Stamp> sorted = depth_stamps_;
  std::sort(sorted.begin(), sorted.end());
  return static_cast<std::size_t>(
      std::count_if(image_stamps_.begin(), image_stamps_.end(), [&](Stamp image) {
        const auto found =
            std::lower_bound(sorted.begin(), sorted.end(), image - max_time_difference_);
        return found != sorted.end() && *found <= image + max_time_difference_;
      }));
}

void RecordingCheck::checkDepth(std::vector<Finding>* findings) const {
  const std::string subject = "depth";
  if (depth_stamps_.empty()) {
    findings->push_back({Level::kMissing, subject, "none", "name its topic with --depth-topic"});
    return;
  }
  const std::size_t with_depth = imagesWithDepth();
  findings->push_back(
      {Level::kGood, subject,
       std::to_string(depth_stamps_.size()) + " depth images, " +
           fixed(100.0 * static_cast<double>(depths_.size()) / static_cast<double>(depth_samples_),
                 1) +
           " % of their pixels measured",
       ""});
  if (with_depth < image_stamps_.size()) {
    findings->push_back({Level::kDoubt, subject,
                         ofImages(with_depth) + " have a depth image within " +
                             fixed(toSeconds(max_time_difference_), 3) + " s",
                         "--set max_time_difference=S takes farther ones"});
  }
  if (depths_.empty()) {
    findings->push_back({Level::kDoubt, subject, "no pixel is measured", "look at the images"});
    return;
  }
  const float median = medianOf(depths_);
  const bool plausible = median >= kNearestDepth && median <= kFarthestDepth;
  findings->push_back({plausible ? Level::kGood : Level::kDoubt, subject,
                       "median " + fixed(static_cast<double>(median), 4) + " m",
                       plausible ? ""
                                 : "a wrong unit? --depth-factor of a bag is 1000 for "
                                   "millimetres, 5000 for TUM's files; of a folder it is the "
                                   "camera's depth_factor"});
}

std::size_t RecordingCheck::imagesWithPose() const {
  return static_cast<std::size_t>(
      std::count_if(image_stamps_.begin(), image_stamps_.end(),
                    [this](Stamp image) { return trajectory_.at(image).has_value(); }));
}

void RecordingCheck::checkPoses(std::vector<Finding>* findings) const {
  const std::string subject = "poses";
  const std::vector<StampedPose>& poses = trajectory_.poses();
  if (poses.empty()) {
    findings->push_back({Level::kMissing, subject, "none",
                         "name their topic with --pose-topic (/tf with --world-frame)"});
    return;
  }
  double path = 0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    path += (poses[i].pose.translation - poses[i - 1].pose.translation).norm();
  }
  findings->push_back({Level::kGood, subject,
                       std::to_string(poses.size()) + " poses, a path of " + fixed(path, 3) + " m",
                       ""});
  const std::size_t with_pose = imagesWithPose();
  if (with_pose < image_stamps_.size()) {
    findings->push_back({Level::kDoubt, subject,
                         ofImages(with_pose) + " have one, between neighbours at most " +
                             fixed(toSeconds(Trajectory::kMaxGap), 3) + " s away",
                         "the others count as no_pose"});
  }
  if (repeated_poses_ > 0) {
    findings->push_back({Level::kDoubt, subject,
                         std::to_string(repeated_poses_) + " repeat the stamp of another",
                         "the first of a stamp is taken"});
  }
}

std::size_t RecordingCheck::imagesWithTruth() const {
  return static_cast<std::size_t>(
      std::count_if(image_stamps_.begin(), image_stamps_.end(),
                    [this](Stamp image) { return truths_.count(image) != 0; }));
}

void RecordingCheck::checkTruth(std::vector<Finding>* findings) const {
  const std::string subject = "ground truth";
  if (truths_.empty()) {
    findings->push_back({Level::kMissing, subject, "no annotated lines",
                         "give --ground-truth DIR or --ground-truth-topic"});
    return;
  }
  std::size_t lines = 0;
  std::size_t with_ids = 0;
  std::size_t faulty = 0;
  std::string fault;
  for (const auto& [stamp, truth] : truths_) {
    lines += truth.lines;
    with_ids += truth.ids || truth.lines == 0 ? 1 : 0;
    faulty += truth.fault.empty() ? 0 : 1;
    fault = fault.empty() ? truth.fault : fault;
  }
  findings->push_back(
      {Level::kGood, subject,
       std::to_string(truths_.size()) + " frames, " + std::to_string(lines) + " lines", ""});
  const std::size_t with_truth = imagesWithTruth();
  if (with_truth < image_stamps_.size()) {
    findings->push_back({Level::kDoubt, subject, ofImages(with_truth) + " have annotated lines",
                         with_truth == 0 ? "its stamps must be those of the images"
                                         : "the others count as no_ground_truth"});
  }
  if (faulty > 0) {
    findings->push_back({Level::kDoubt, subject,
                         std::to_string(faulty) +
                             " frames have a line that is no valid ground "
                             "truth, first " +
                             fault,
                         "they count as bad_ground_truth"});
  }
  if (with_ids < truths_.size()) {
    findings->push_back({Level::kDoubt, subject,
                         std::to_string(truths_.size() - with_ids) +
                             " frames have lines without ids, so that true matches are not known",
                         "gt_associations*/ carry them; --same-rows where equal rows are the same "
                         "line"});
  }
}

std::vector<FamilyReadiness> RecordingCheck::readiness() const {
  const bool truth = imagesWithTruth() > 0;
  const bool ids = std::any_of(truths_.begin(), truths_.end(),
                               [](const auto& entry) { return entry.second.ids; });
  std::string motion;
  const auto need = [&motion](bool there, const char* what) {
    if (!there) {
      motion += (motion.empty() ? "" : ", ") + std::string(what);
    }
  };
  need(camera_.has_value(), "intrinsics");
  need(imagesWithDepth() > 0, "depth");
  need(imagesWithPose() > 0, "poses");
  std::vector<FamilyReadiness> families;
  for (const MetricFamily family : allMetricFamilies()) {
    std::string lacks;
    switch (family) {
      case MetricFamily::kDetection:
      case MetricFamily::kHeatmap:
        lacks = truth ? "" : "ground-truth lines";
        break;
      case MetricFamily::kRepeatability:
      case MetricFamily::kPose:
        lacks = motion;
        break;
      case MetricFamily::kAssociation:
        lacks = !truth ? "ground-truth lines" : (ids ? "" : "ids of the ground-truth lines");
        break;
      case MetricFamily::kTracks:
        break;  // what it needs comes with the lines, or from an associator
    }
    families.push_back({family, image_stamps_.empty() ? "images" : lacks});
  }
  return families;
}

}  // namespace evolin
