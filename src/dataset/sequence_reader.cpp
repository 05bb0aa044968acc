// The reader behind openSequence(): finds the layout, then opens the planned frames one at a time.
#include "evolin_ros/dataset/sequence_reader.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"
#include "evolin_ros/dataset/annotation_folder.h"
#include "evolin_ros/dataset/camera_file.h"
#include "evolin_ros/dataset/image_file.h"
#include "sequence_plan.h"

namespace evolin {

namespace fs = std::filesystem;

namespace {

std::string sizeText(int width, int height) {
  return std::to_string(width) + " x " + std::to_string(height);
}

// The line of `list` that names `file`, for messages; 0 when it cannot be told. Lists have the name
// as a word among others (ICL-NUIM) or as all that follows the stamp.
int lineNaming(const fs::path& list, const std::string& file) {
  const auto is_file = [&](std::string_view text) {
    return fs::path(text).lexically_normal() == fs::path(file).lexically_normal();
  };
  int number = 0;
  for (const std::string& line : readLines(list)) {
    ++number;
    const std::vector<std::string_view> words = splitWords(line);
    const std::size_t gap = trim(line).find_first_of(" \t");
    if (std::any_of(words.begin(), words.end(), is_file) ||
        (gap != std::string_view::npos && is_file(trim(trim(line).substr(gap))))) {
      return number;
    }
  }
  return 0;
}

class PlannedSequence : public SequenceReader {
 public:
  PlannedSequence(SequencePlan plan, const SequenceOptions& options)
      : plan_(std::move(plan)),
        allow_missing_(options.allow_missing),
        read_depth_(options.read_depth) {
    openCamera(options);
    openAnnotations(options);
    cutToWindow(options);
  }

  std::optional<SequenceFrame> next() override {
    while (position_ < plan_.frames.size()) {
      const PlannedFrame& planned = plan_.frames[position_++];
      SequenceFrame result;
      result.frame.image = open(planned.image, plan_.image_list, "image",
                                [](const fs::path& file) { return readImage(file); });
      if (result.frame.image.empty()) {
        ++counts_.missing_images;
        continue;
      }
      result.frame.stamp = planned.stamp;
      result.frame.name = fs::path(planned.image).stem().string();
      result.frame.pose = planned.pose;
      result.image_file = planned.image;
      addDepth(planned, &result);
      addCamera(planned, &result.frame);
      if (annotations_) {
        result.ground_truth = linesOf(planned);
      }
      ++counts_.frames;
      counts_.missing_depths += result.frame.depth.empty() ? 1 : 0;
      counts_.missing_poses += result.frame.pose ? 0 : 1;
      counts_.missing_ground_truth += result.ground_truth ? 0 : 1;
      return result;
    }
    return std::nullopt;
  }

  std::size_t size() const override { return plan_.frames.size(); }
  Needs offers() const override {
    Needs offers;
    offers.camera = camera_.has_value();
    for (const PlannedFrame& frame : plan_.frames) {
      offers.depth = offers.depth || (read_depth_ && !frame.depth.empty());
      offers.pose = offers.pose || frame.pose;
    }
    return offers;
  }

  const SequenceCounts& counts() const override { return counts_; }
  Layout layout() const override { return plan_.layout; }
  std::string poseRule() const override { return plan_.pose_rule; }

 private:
  void openCamera(const SequenceOptions& options) {
    if (!options.camera.empty()) {
      camera_ = loadCamera(options.camera, options.camera_folder);
    } else if (fs::exists(plan_.folder / "calibration_matrix.txt")) {
      camera_ = readCalibrationMatrix(plan_.folder / "calibration_matrix.txt");
    }
  }

  void openAnnotations(const SequenceOptions& options) {
    if (!options.ground_truth.empty()) {
      annotations_.emplace(options.ground_truth, fs::path(), options.same_rows);
    } else if (fs::is_directory(plan_.folder / "gt_lines")) {
      annotations_.emplace(plan_.folder / "gt_lines", fs::path(), options.same_rows);
    } else {
      return;
    }
    const bool any =
        std::any_of(plan_.frames.begin(), plan_.frames.end(),
                    [&](const PlannedFrame& frame) { return linesOf(frame).has_value(); });
    if (!any) {
      const PlannedFrame& first = plan_.frames.front();
      throw Error(annotations_->folder().string() + ": no line file belongs to any image of " +
                  plan_.folder.string() + "; " + annotations_->matchingRule() +
                  ", the first image is " + quote(first.image) + " at " + formatStamp(first.stamp));
    }
  }

  void cutToWindow(const SequenceOptions& options) {
    if (!std::isfinite(options.start) || options.start < 0) {
      throw Error("start is " + formatDouble(options.start) + ", expected 0 or more seconds");
    }
    if (options.duration && !(std::isfinite(*options.duration) && *options.duration > 0)) {
      throw Error("duration is " + formatDouble(*options.duration) +
                  ", expected more than 0 seconds");
    }
    std::vector<PlannedFrame>& frames = plan_.frames;
    const Stamp origin = frames.front().stamp;
    const Stamp length = frames.back().stamp - origin;
    const Stamp skip = fromSeconds(options.start);
    if (skip > length) {
      throw Error(plan_.folder.string() + ": start is " + formatDouble(options.start) +
                  " s, expected at most " + formatDouble(toSeconds(length)) +
                  " s, where the last image is");
    }
    if (options.duration) {
      const Stamp take = fromSeconds(*options.duration);
      frames.erase(std::find_if(frames.begin(), frames.end(),
                                [&](const PlannedFrame& frame) {
                                  return frame.stamp - origin - skip >= take;
                                }),
                   frames.end());
    }
    frames.erase(frames.begin(),
                 std::find_if(frames.begin(), frames.end(), [&](const PlannedFrame& frame) {
                   return frame.stamp - origin >= skip;
                 }));
    if (frames.empty()) {
      throw Error(plan_.folder.string() + ": no image between " + formatDouble(options.start) +
                  " s and " + formatDouble(options.start + options.duration.value_or(0)) +
                  " s, expected at least one");
    }
  }

  // Empty when the file is absent or unreadable and that is allowed.
  template <typename Read>
  cv::Mat open(const std::string& file, const std::string& list, const std::string& kind,
               const Read& read) const {
    const fs::path path = plan_.folder / file;
    if (!list.empty() && !fs::exists(path)) {
      if (allow_missing_) {
        return {};
      }
      const fs::path list_file = plan_.folder / list;
      throw ParseError(list_file.string(), lineNaming(list_file, file),
                       kind + " " + quote(file) +
                           " does not exist, expected a readable file (--allow-missing leaves out "
                           "what is missing and counts it)");
    }
    try {
      return read(path);
    } catch (const ParseError&) {
      if (allow_missing_) {
        return {};
      }
      throw;
    }
  }

  void addDepth(const PlannedFrame& planned, SequenceFrame* result) const {
    if (planned.depth.empty() || !read_depth_) {
      return;
    }
    const double factor = camera_ ? camera_->depth_factor : Camera().depth_factor;
    cv::Mat depth = open(planned.depth, plan_.depth_list, "depth image",
                         [factor](const fs::path& file) { return readDepthImage(file, factor); });
    if (depth.empty()) {
      return;
    }
    const cv::Mat& image = result->frame.image;
    if (depth.size() != image.size()) {
      throw ParseError((plan_.folder / planned.depth).string(), 0,
                       "the depth image is " + sizeText(depth.cols, depth.rows) + ", expected " +
                           sizeText(image.cols, image.rows) + " as image " + quote(planned.image));
    }
    result->frame.depth = std::move(depth);
    result->depth_stamp = planned.depth_stamp;
  }

  void addCamera(const PlannedFrame& planned, Frame* frame) const {
    if (!camera_) {
      return;
    }
    frame->camera = camera_;
    Camera& camera = *frame->camera;
    if (camera.width == 0 && camera.height == 0) {  // a calibration matrix tells no size
      camera.width = frame->image.cols;
      camera.height = frame->image.rows;
    } else if (camera.width != frame->image.cols || camera.height != frame->image.rows) {
      throw ParseError((plan_.folder / planned.image).string(), 0,
                       "the image is " + sizeText(frame->image.cols, frame->image.rows) +
                           ", expected " + sizeText(camera.width, camera.height) + " as camera " +
                           quote(camera.name) + " says");
    }
  }

  std::optional<LineSegments> linesOf(const PlannedFrame& planned) const {
    return annotations_->hasStamps()
               ? annotations_->at(planned.stamp)
               : annotations_->byName(fs::path(planned.image).stem().string());
  }

  SequencePlan plan_;
  bool allow_missing_;
  bool read_depth_;
  std::optional<Camera> camera_;
  std::optional<AnnotationFolder> annotations_;
  std::size_t position_ = 0;
  SequenceCounts counts_;
};

Layout detectLayout(const fs::path& folder) {
  if (fs::exists(folder / "rgb.txt")) {
    return Layout::kTum;
  }
  if (!findAssociationLists(folder).empty()) {
    return Layout::kIcl;
  }
  const std::vector<fs::path> trajectories = findFreiburgTrajectories(folder);
  if (trajectories.empty() && !findImageFolder(folder).empty()) {
    return Layout::kEvolin;
  }
  const std::string what =
      fs::is_empty(folder)
          ? "the folder is empty"
          : (trajectories.empty()
                 ? "the layout is unknown"
                 : "has " + trajectories.front().filename().string() + " but no associations*.txt");
  throw Error(folder.string() + ": " + what +
              ", expected rgb.txt (TUM RGB-D), associations*.txt (ICL-NUIM), or images in images/ "
              "or rgb/ (EVOLIN)");
}

}  // namespace

std::string toString(Layout layout) {
  switch (layout) {
    case Layout::kTum:
      return "tum";
    case Layout::kIcl:
      return "icl";
    case Layout::kEvolin:
      return "evolin";
    case Layout::kAuto:
      break;
  }
  return "auto";
}

Layout parseLayout(const std::string& text) {
  for (const Layout layout : {Layout::kAuto, Layout::kTum, Layout::kIcl, Layout::kEvolin}) {
    if (text == toString(layout)) {
      return layout;
    }
  }
  throw Error("layout is " + quote(text) + ", expected auto, tum, icl or evolin");
}

std::unique_ptr<SequenceReader> openSequence(const fs::path& folder,
                                             const SequenceOptions& options) {
  if (!fs::is_directory(folder)) {
    throw Error(folder.string() + ": not a folder, expected one with a sequence in it");
  }
  const Layout layout = options.layout == Layout::kAuto ? detectLayout(folder) : options.layout;
  SequencePlan plan;
  switch (layout) {
    case Layout::kTum:
      plan = planTumSequence(folder, options);
      break;
    case Layout::kIcl:
      plan = planIclSequence(folder, options);
      break;
    case Layout::kAuto:
    case Layout::kEvolin:
      plan = planEvolinSequence(folder, options);
      break;
  }
  return std::make_unique<PlannedSequence>(std::move(plan), options);
}

}  // namespace evolin
