// The synthetic sequence's visible parts: all of them annotated, by ray casting, and followed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <regex>
#include <string>
#include <thread>

#include "evolin_ros/base/text.h"
#include "evolin_ros/geometry/clipping.h"
#include "test/dataset/synthetic_truth.h"

namespace evolin::synthetic {
namespace {

using test::defaultGroundTruth;
using test::defaultSequence;
using test::distanceToSegment;
using test::edgeOf;
using test::pointOfEdge;
using test::Projected;
using test::projectPoint;
using test::RayOracle;
using test::shareOfEdge;

constexpr double kWalk = 0.5;  // px

struct Step {
  double x = 0;
  double y = 0;
  bool hidden = false;
};

/// Along all of an edge that is before the camera and in the annotated area, what the oracle sees.
std::vector<Step> walkAlong(const Edge& edge, const RayOracle& oracle, const Pose& pose) {
  const Camera& camera = defaultSequence().camera();
  const double z1 = projectPoint(camera, pose, edge.from).depth - Renderer::kNearPlane;
  const double z2 = projectPoint(camera, pose, edge.to).depth - Renderer::kNearPlane;
  std::vector<Step> steps;
  if (z1 <= 0 && z2 <= 0) {
    return steps;
  }
  const Projected a = projectPoint(camera, pose, pointOfEdge(edge, z1 < 0 ? z1 / (z1 - z2) : 0));
  const Projected b = projectPoint(camera, pose, pointOfEdge(edge, z2 < 0 ? z1 / (z1 - z2) : 1));
  LineSegment whole;
  whole.x1 = a.x;
  whole.y1 = a.y;
  whole.x2 = b.x;
  whole.y2 = b.y;
  if (const auto inside = clipToRectangle(whole, annotatedArea(camera))) {
    const double length = inside->length();
    for (double along = kWalk / 2; along < length; along += kWalk) {
      Step step;
      step.x = inside->x1 + along / length * (inside->x2 - inside->x1);
      step.y = inside->y1 + along / length * (inside->y2 - inside->y1);
      step.hidden = oracle.hides(
          pose.translation, pointOfEdge(edge, shareOfEdge(edge, camera, pose, step.x, step.y)));
      steps.push_back(step);
    }
  }
  return steps;
}

// A visible stretch of at least 10 px is annotated, but for twins, which run beside a line of
// another edge, and for rests below 10 px that they leave.
TEST(SyntheticParts, EveryVisibleStretchIsAnnotatedAndNoHiddenOne) {
  const RayOracle oracle(defaultSequence().scene());
  std::size_t annotated = 0;
  std::size_t hidden = 0;
  std::size_t twins = 0;
  std::size_t rests = 0;
  std::size_t split = 0;
  for (const std::size_t frame : {0U, 45U, 80U}) {
    for (std::size_t edge = 0; edge < defaultSequence().scene().edges.size(); ++edge) {
      const auto near_a_line = [&](const Step& step, bool own, double reach) {
        return std::any_of(defaultGroundTruth()[frame].begin(), defaultGroundTruth()[frame].end(),
                           [&](const LineSegment& line) {
                             return (defaultSequence().edgeOf(line.id) == edge) == own &&
                                    distanceToSegment(step.x, step.y, line) < reach;
                           });
      };
      // Where a part ends either answer is right.
      const auto near_an_end = [frame](const Step& step) {
        return std::any_of(defaultGroundTruth()[frame].begin(), defaultGroundTruth()[frame].end(),
                           [&step](const LineSegment& line) {
                             return std::min(std::hypot(step.x - line.x1, step.y - line.y1),
                                             std::hypot(step.x - line.x2, step.y - line.y2)) < 0.01;
                           });
      };
      // What the walk meets: h hidden, H hidden and annotated, A annotated, T twin, M missing.
      std::string met = "h";
      for (const Step& step : walkAlong(defaultSequence().scene().edges[edge], oracle,
                                        defaultSequence().pose(frame))) {
        const bool own = near_a_line(step, true, 1e-3);
        if (step.hidden) {
          met += own && !near_an_end(step) ? 'H' : 'h';
        } else {
          met += own ? 'A' : near_a_line(step, false, kTwinDistance + 1e-3) ? 'T' : 'M';
        }
      }
      met += 'h';
      hidden += static_cast<std::size_t>(std::count(met.begin(), met.end(), 'h')) - 2;
      split += std::regex_search(met, std::regex("A+[^A]+A")) ? 1 : 0;
      EXPECT_EQ(met.find('H'), std::string::npos)
          << "frame " << frame << ", edge " << edge << ": " << met;
      for (std::size_t begin = met.find_first_not_of('h'); begin != std::string::npos;) {
        const std::size_t end = met.find('h', begin);
        const std::string run = met.substr(begin, end - begin);
        begin = met.find_first_not_of('h', end);
        if (static_cast<double>(run.size() - 1) * kWalk < kMinLength) {
          continue;
        }
        annotated += static_cast<std::size_t>(std::count(run.begin(), run.end(), 'A'));
        twins += static_cast<std::size_t>(std::count(run.begin(), run.end(), 'T'));
        for (std::size_t from = run.find('M'); from != std::string::npos;) {
          const std::size_t to = std::min(run.find_first_not_of('M', from), run.size());
          const bool beside_twin =
              (from > 0 && run[from - 1] == 'T') || (to < run.size() && run[to] == 'T');
          EXPECT_TRUE(beside_twin && static_cast<double>(to - from - 1) * kWalk < kMinLength)
              << "frame " << frame << ", edge " << edge << ": " << run;
          ++rests;
          from = run.find('M', to);
        }
      }
    }
  }
  EXPECT_GT(annotated, 50000U);
  EXPECT_GT(hidden, 50000U);
  EXPECT_GT(split, 20U);  // edges in several parts
  EXPECT_GT(twins, 500U);
  EXPECT_LT(twins, annotated / 5);
  RecordProperty("steps", std::to_string(annotated) + " annotated, " + std::to_string(hidden) +
                              " hidden, " + std::to_string(twins) + " twins, " +
                              std::to_string(rests) + " rests, " + std::to_string(split) +
                              " edges in parts");
}

TEST(SyntheticParts, NoLineRunsBesideAnotherFor10Pixels) {
  constexpr double kSample = 0.25;
  const auto longest_run = [](const LineSegment& line, const LineSegment& other) {
    double longest = 0;
    double run = 0;
    for (double along = 0; along <= line.length(); along += kSample) {
      const double share = along / line.length();
      const double x = line.x1 + share * (line.x2 - line.x1);
      const double y = line.y1 + share * (line.y2 - line.y1);
      run = distanceToSegment(x, y, other) < kTwinDistance ? run + kSample : 0;
      longest = std::max(longest, run);
    }
    return longest;
  };
  for (const std::size_t frame : {0U, 45U, 80U}) {
    const LineSegments& lines = defaultGroundTruth()[frame];
    for (std::size_t i = 0; i < lines.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        // Lines farther apart than their lengths need no walk.
        const double gap = std::hypot(lines[i].x1 - lines[j].x1, lines[i].y1 - lines[j].y1);
        if (gap < lines[i].length() + lines[j].length() + 2 * kTwinDistance) {
          EXPECT_LT(std::min(longest_run(lines[i], lines[j]), longest_run(lines[j], lines[i])),
                    kMinLength + 2 * kSample)
              << lines[i].id << " and " << lines[j].id << ", frame " << frame;
        }
      }
    }
  }
}

/// What a line shows of its edge.
EdgePart shown(const LineSegment& line, std::size_t frame) {
  const Camera& camera = defaultSequence().camera();
  const Pose pose = defaultSequence().pose(frame);
  return {shareOfEdge(edgeOf(line), camera, pose, line.x1, line.y1),
          shareOfEdge(edgeOf(line), camera, pose, line.x2, line.y2)};
}

/// Of the lines whose edge goes on being seen there `step` frames later, the share whose id is
/// given to the line that shows most of the same.
double shareOfKeptIds(std::size_t step) {
  std::size_t followed = 0;
  std::size_t kept = 0;
  for (std::size_t i = 0; i + step < defaultGroundTruth().size(); ++i) {
    for (const LineSegment& line : defaultGroundTruth()[i]) {
      const EdgePart before = shown(line, i);
      double most = 0;
      std::int64_t successor = kNoId;
      for (const LineSegment& other : defaultGroundTruth()[i + step]) {
        if (defaultSequence().edgeOf(other.id) == defaultSequence().edgeOf(line.id)) {
          const EdgePart after = shown(other, i + step);
          const double common =
              std::min(before.end, after.end) - std::max(before.begin, after.begin);
          if (common > most) {
            most = common;
            successor = other.id;
          }
        }
      }
      followed += successor == kNoId ? 0 : 1;
      kept += successor == line.id ? 1 : 0;
    }
  }
  return static_cast<double>(kept) / static_cast<double>(followed);
}

TEST(SyntheticParts, PartsKeepTheirIds) {
  const double next = shareOfKeptIds(1);
  const double later = shareOfKeptIds(10);
  EXPECT_GT(next, 0.9995);
  EXPECT_GT(later, 0.998);
  RecordProperty("kept", formatDouble(next) + " to the next frame, " + formatDouble(later) +
                             " over ten frames");
}

TEST(SyntheticParts, IdsDoNotDependOnWhichFrameIsAskedFirst) {
  const SyntheticSequence other{SyntheticOptions{}};
  std::vector<std::size_t> frames = {89, 3, 60, 0};
  std::vector<LineSegments> shown(frames.size());
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    threads.emplace_back([&, i] { shown[i] = other.groundTruth(frames[i]); });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const LineSegments& expected = defaultGroundTruth()[frames[i]];
    ASSERT_EQ(shown[i].size(), expected.size());
    for (std::size_t row = 0; row < expected.size(); ++row) {
      EXPECT_EQ(shown[i][row].id, expected[row].id);
      EXPECT_EQ(shown[i][row].x1, expected[row].x1);
    }
  }
}

}  // namespace
}  // namespace evolin::synthetic
