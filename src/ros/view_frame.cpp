// Verdicts by the metrics' own matching; trails along matches or ids.
#include "view_frame.h"

#include "conversions.h"
#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"

namespace evolin::ros_shell {

namespace {

std::string sizeText(int width, int height) {
  return std::to_string(width) + " x " + std::to_string(height);
}

}  // namespace

ViewFrames::ViewFrames(const ViewFrameOptions& options)
    : options_(options),
      detected_(static_cast<std::size_t>(options.trail_length), kReach),
      true_(static_cast<std::size_t>(options.trail_length), kReach) {}

void ViewFrames::clear() {
  detected_.clear();
  true_.clear();
}

EvaluatedFrame ViewFrames::make(const ViewParts& parts) {
  problems_.clear();
  if (parts.begins_pass) {
    clear();
  }
  EvaluatedFrame frame;
  frame.image = toFrame(parts.image).image;
  frame.lines = fromMessage(*parts.lines).lines;
  frame.title = parts.lines->source + "  " + formatStamp(fromRos(parts.lines->header.stamp));
  frame.judged_by = "structural distance " +
                    std::string(options_.protocol == Protocol::kEvolin ? "< " : "<= ") +
                    formatDouble(options_.threshold);
  judge(parts, &frame);
  const LineSegments ground_truth =
      parts.ground_truth ? fromMessage(*parts.ground_truth).lines : LineSegments();
  frame.trails = follow(parts, frame.lines, ground_truth);
  return frame;
}

void ViewFrames::judge(const ViewParts& parts, EvaluatedFrame* frame) {
  if (!parts.ground_truth) {
    frame->no_verdicts = "no ground truth of this image";
    return;
  }
  const ImageSize size{frame->image.cols, frame->image.rows};
  try {
    for (const evolin_ros::LineArrayConstPtr& lines : {parts.lines, parts.ground_truth}) {
      const auto width = static_cast<int>(lines->width);
      const auto height = static_cast<int>(lines->height);
      if (width != size.width || height != size.height) {
        throw Error("lines of '" + lines->source + "' are of an image of " +
                    sizeText(width, height) + " pixels; expected the image's " +
                    sizeText(size.width, size.height));
      }
    }
    LineSegments ground_truth = fromMessage(*parts.ground_truth).lines;
    frame->verdicts = judgeLines({LineDistance::kStructural, options_.threshold}, options_.protocol,
                                 size, frame->lines, ground_truth, parts.lines->has_scores);
    frame->ground_truth = std::move(ground_truth);
  } catch (const Error& error) {
    frame->no_verdicts = std::string("not judged: ") + error.what();
    problems_.emplace_back(frame->no_verdicts);
  }
}

std::vector<LineTrail> ViewFrames::follow(const ViewParts& parts, const LineSegments& lines,
                                          const LineSegments& ground_truth) {
  const Stamp stamp = fromRos(parts.lines->header.stamp);
  if (options_.trails_from == TrailsFrom::kIds) {
    try {
      return detected_.addById(stamp, lines);
    } catch (const Error& error) {
      problems_.emplace_back(std::string("no trails: ") + error.what());
      detected_.clear();
      return {};
    }
  }
  if (options_.trails_from == TrailsFrom::kNone) {
    return {};
  }
  const bool of_detected = parts.matches && parts.matches->lines_source == parts.lines->source;
  const bool of_true = parts.matches && parts.ground_truth && !of_detected &&
                       parts.matches->lines_source == parts.ground_truth->source;
  if (parts.matches && !of_detected && !of_true) {
    problems_.emplace_back("matches at " + formatStamp(stamp) + " are of lines of '" +
                           parts.matches->lines_source + "', which are not shown; expected '" +
                           parts.lines->source + "'" +
                           (parts.ground_truth ? " or '" + parts.ground_truth->source + "'" : ""));
  }
  const auto add = [&](LineTrails* trails, const LineSegments& of, bool matched) {
    if (!matched) {
      trails->add(stamp, of);
      return std::vector<LineTrail>();
    }
    const MatchSet set = fromMessage(*parts.matches);
    return trails->add(stamp, of, set.first_stamp, set.matches);
  };
  std::vector<LineTrail> followed = add(&detected_, lines, of_detected);
  std::vector<LineTrail> followed_true = add(&true_, ground_truth, of_true);
  return of_true ? followed_true : followed;
}

}  // namespace evolin::ros_shell
