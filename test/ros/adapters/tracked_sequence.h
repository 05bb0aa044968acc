// Lines of a front-end that follows them by ids, over the built-in sequence: what it says and what
// is true, with the figures that follow from them.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "evolin_ros/dataset/synthetic/synthetic_sequence.h"
#include "evolin_ros/evaluation/inputs.h"
#include "evolin_ros/evaluation/pass_evaluation.h"
#include "test/support/random_lines.h"

namespace evolin::test {

struct TrackedFrame {
  LineSet truth;
  LineSet found;  ///< with track ids, without scores
};

/// The annotated lines, and those of an imperfect tracker: some are missed, some moved by up to 2
/// pixels, some invented, and some tracks jump to another line. With a camera, coordinates are
/// moved to the nearest ones that single precision holds exactly on the plane z = 1.
inline std::vector<TrackedFrame> trackedSequence(std::size_t frames, const std::string& source,
                                                 const Camera* exact = nullptr) {
  constexpr std::int64_t kFirstTrack = 1000;
  const synthetic::SyntheticSequence sequence({});
  std::vector<TrackedFrame> result;
  for (std::size_t number = 0; number < frames; ++number) {
    RandomLines random(number + 1);
    TrackedFrame frame;
    for (LineSet* set : {&frame.truth, &frame.found}) {
      set->stamp = sequence.stamp(number);
      set->width = sequence.camera().width;
      set->height = sequence.camera().height;
      set->frame_id = "cam0";
    }
    frame.truth.source = "ground_truth";
    frame.truth.lines = sequence.groundTruth(number);
    frame.found.source = source;
    for (const LineSegment& truth : frame.truth.lines) {
      LineSegment line = truth;
      const std::size_t chance = random.index(20);
      if (chance < 4) {
        continue;
      }
      for (double* value : {&line.x1, &line.y1, &line.x2, &line.y2}) {
        *value += random.uniform(-2, 2);
      }
      line.id = kFirstTrack + truth.id + (chance == 4 ? 50000 : 0);
      frame.found.lines.push_back(line);
    }
    for (LineSegment& line : random.anywhere(10, 600, 400)) {
      line.x1 += 20;
      line.id = static_cast<std::int64_t>(100000 + random.index(50000));
      frame.found.lines.push_back(line);
    }
    if (exact != nullptr) {
      constexpr double kGrid = 65536;
      const auto snap = [&](double* value, double focal, double centre) {
        *value = std::nearbyint((*value - centre) / focal * kGrid) / kGrid * focal + centre;
      };
      for (LineSegment& line : frame.found.lines) {
        snap(&line.x1, exact->fx, exact->cx);
        snap(&line.y1, exact->fy, exact->cy);
        snap(&line.x2, exact->fx, exact->cx);
        snap(&line.y2, exact->fy, exact->cy);
      }
    }
    result.push_back(std::move(frame));
  }
  return result;
}

/// The report of the same lines without any topic between.
inline Report directReport(const std::vector<TrackedFrame>& frames, int frame_step) {
  PassOptions options;
  options.families = {MetricFamily::kDetection, MetricFamily::kAssociation, MetricFamily::kTracks};
  options.matches_from_ids = true;
  options.frame_step = frame_step;
  PassEvaluation pass(options);
  for (const TrackedFrame& frame : frames) {
    pass.addGroundTruth(frame.truth);
    pass.addLines(frame.found);
  }
  return pass.report(true);
}

}  // namespace evolin::test
