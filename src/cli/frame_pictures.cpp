// Joining by stamp; verdicts by the metrics' own matching.
#include "frame_pictures.h"

#include <cstdio>
#include <utility>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"
#include "evolin_ros/drawing/overlay.h"
#include "evolin_ros/metrics/line_verdicts.h"

namespace evolin::cli {

namespace {

/// Images that may wait for their lines or their ground truth.
constexpr std::size_t kPatience = 64;

std::string percentText(double ratio) {
  char text[16];
  std::snprintf(text, sizeof text, "%.1f", 100 * ratio);
  return text;
}

ViewSection sectionOf(const std::string& title, const Classification& counts) {
  ViewSection section;
  section.title = title;
  section.rows = {{"precision", percentText(counts.precision())},
                  {"recall", percentText(counts.recall())},
                  {"F-score", percentText(counts.fScore())}};
  return section;
}

}  // namespace

FramePictures::FramePictures(PictureOptions options, TakePicture take)
    : options_(std::move(options)), take_(std::move(take)) {}

void FramePictures::takeImage(const ImagePart& image) {
  if (!image.frame.image.empty()) {
    waiting_[image.frame.stamp].frame = image.frame;
  }
  flush(kPatience);
}

void FramePictures::takeGroundTruth(const LineSet& ground_truth) {
  waiting_[ground_truth.stamp].ground_truth = ground_truth;
  flush(kPatience);
}

void FramePictures::takeLines(const LineSet& lines, const ImagePart& image) {
  Waiting& waiting = waiting_[lines.stamp];
  waiting.frame = image.frame;
  waiting.lines = lines;
  flush(kPatience);
}

void FramePictures::flush(std::size_t most) {
  while (!waiting_.empty()) {
    const Waiting& oldest = waiting_.begin()->second;
    const bool complete = !oldest.frame.image.empty() && oldest.lines && oldest.ground_truth;
    if (!complete && waiting_.size() <= most) {
      return;
    }
    if (!oldest.frame.image.empty()) {
      draw(oldest);
    }
    waiting_.erase(waiting_.begin());
  }
}

void FramePictures::draw(const Waiting& waiting) {
  EvaluatedFrame frame;
  frame.image = waiting.frame.image;
  frame.title = formatStamp(waiting.frame.stamp);
  if (waiting.lines) {
    frame.lines = waiting.lines->lines;
    frame.title = waiting.lines->source + "  " + frame.title;
  }
  frame.judged_by = toString(options_.setting.distance) + " distance " +
                    (options_.protocol == Protocol::kEvolin ? "< " : "<= ") +
                    formatDouble(options_.setting.threshold);
  judge(waiting, &frame);
  take_(waiting.frame.name, drawEvaluatedFrame(frame, options_.view));
  ++pictures_;
}

void FramePictures::judge(const Waiting& waiting, EvaluatedFrame* frame) {
  if (!waiting.lines || !waiting.ground_truth) {
    frame->no_verdicts = waiting.lines ? "no ground truth of this image" : "no lines of this image";
    return;
  }
  try {
    frame->verdicts =
        judgeLines(options_.setting, options_.protocol, {frame->image.cols, frame->image.rows},
                   frame->lines, waiting.ground_truth->lines, waiting.lines->scored);
  } catch (const Error& error) {
    frame->no_verdicts = std::string("not judged: ") + error.what();
    return;
  }
  frame->ground_truth = waiting.ground_truth->lines;
  const Classification counts = frame->verdicts.counts();
  sums_ += counts;
  frame->sections = {sectionOf("This frame, %", counts), sectionOf("So far, %", sums_)};
}

MatchPictures::MatchPictures(std::size_t reach, TakePicture take)
    : reach_(reach), take_(std::move(take)) {}

void MatchPictures::keep(const LineSet& lines) {
  std::map<Stamp, LineSet>& kept = lines_[lines.source];
  kept[lines.stamp] = lines;
  while (kept.size() > reach_ + kPatience) {
    kept.erase(kept.begin());
  }
}

const LineSet* MatchPictures::find(Stamp stamp, const std::string& source) const {
  const auto of_source = lines_.find(source);
  if (of_source == lines_.end()) {
    return nullptr;
  }
  const auto found = of_source->second.find(stamp);
  return found == of_source->second.end() ? nullptr : &found->second;
}

void MatchPictures::takeMatches(const MatchSet& matches, const Frame& first, const Frame& second) {
  const LineSet* first_lines = find(matches.first_stamp, matches.lines_source);
  const LineSet* second_lines = find(matches.stamp, matches.lines_source);
  if (first_lines == nullptr || second_lines == nullptr) {
    notes_.push_back("no picture of the pair " + first.name + ", " + second.name +
                     ": its lines are not there any more");
    return;
  }
  take_(first.name + "_" + second.name, drawMatches(first.image, first_lines->lines, second.image,
                                                    second_lines->lines, matches.matches));
  ++pictures_;
}

}  // namespace evolin::cli
