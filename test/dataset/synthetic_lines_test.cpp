// The synthetic sequence's ground truth: lines against geometry and against ray casting.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "test/dataset/synthetic_truth.h"
#include "test/support/expect_error.h"
#include "test/support/random_lines.h"

namespace evolin::synthetic {
namespace {

using test::defaultGroundTruth;
using test::defaultSequence;
using test::edgeOf;
using test::expectError;
using test::pointOfEdge;
using test::Projected;
using test::projectPoint;
using test::RandomLines;
using test::RayOracle;
using test::shareOfEdge;

const LineSegment* findId(const LineSegments& lines, std::int64_t id) {
  const auto found = std::find_if(lines.begin(), lines.end(),
                                  [id](const LineSegment& line) { return line.id == id; });
  return found == lines.end() ? nullptr : &*found;
}

double distanceToLine(const LineSegment& line, double x, double y) {
  return std::abs((line.x2 - line.x1) * (y - line.y1) - (line.y2 - line.y1) * (x - line.x1)) /
         line.length();
}

TEST(SyntheticLines, RoomHasManyDistinctEdges) {
  for (const std::uint64_t seed : {1U, 2U, 3U, 77U}) {
    const Scene scene = makeRoom(seed);
    EXPECT_GE(scene.edges.size(), 120U);
    std::set<std::vector<long>> seen;
    for (const Edge& edge : scene.edges) {
      EXPECT_GT((edge.to - edge.from).norm(), 0.001);
      std::vector<long> key;
      for (const Vector3* end : {&edge.from, &edge.to}) {
        for (int axis = 0; axis < 3; ++axis) {
          key.push_back(std::lround((*end)[axis] * 1e5));
        }
      }
      std::vector<long> turned(key.begin() + 3, key.end());
      turned.insert(turned.end(), key.begin(), key.begin() + 3);
      EXPECT_TRUE(seen.insert(std::min(key, turned)).second)
          << "an edge occurs twice, from " << edge.from.transpose();
      for (const Vector3* end : {&edge.from, &edge.to}) {
        EXPECT_GE(end->z(), 0);
        EXPECT_LE(end->z(), scene.size.z());
      }
    }
  }
}

TEST(SyntheticLines, FramesHaveEnoughLinesWithUniqueIds) {
  std::size_t total = 0;
  std::set<std::size_t> edges;
  const Camera& camera = defaultSequence().camera();
  for (const LineSegments& lines : defaultGroundTruth()) {
    total += lines.size();
    std::int64_t last = -1;
    for (const LineSegment& line : lines) {
      EXPECT_GT(line.id, last);  // rising, so unique
      last = line.id;
      edges.insert(defaultSequence().edgeOf(line.id));
      EXPECT_GE(line.length(), kMinLength);
      EXPECT_GE(std::min({line.x1, line.y1, line.x2, line.y2}), 0);
      EXPECT_LE(std::max(line.x1, line.x2), annotatedArea(camera).right);
      EXPECT_LE(std::max(line.y1, line.y2), annotatedArea(camera).bottom);
      EXPECT_TRUE(line.x1 != line.x2 && line.y1 != line.y2) << "id " << line.id;
    }
  }
  const double mean = static_cast<double>(total) / static_cast<double>(defaultGroundTruth().size());
  EXPECT_GE(mean, 35);
  EXPECT_GE(edges.size(), 120U);
  RecordProperty("mean_lines", std::to_string(mean));
}

TEST(SyntheticLines, EndpointsReprojectOntoTheirLineInOtherFrames) {
  const Camera& camera = defaultSequence().camera();
  double worst = 0;
  std::size_t compared = 0;
  for (std::size_t a = 0; a < defaultGroundTruth().size(); a += 7) {
    for (std::size_t b = 3; b < defaultGroundTruth().size(); b += 11) {
      for (const LineSegment& line : defaultGroundTruth()[a]) {
        for (const auto& [x, y] : {std::pair(line.x1, line.y1), std::pair(line.x2, line.y2)}) {
          const Edge& edge = edgeOf(line);
          const Eigen::Vector3d point =
              pointOfEdge(edge, shareOfEdge(edge, camera, defaultSequence().pose(a), x, y));
          const Projected seen = projectPoint(camera, defaultSequence().pose(a), point);
          EXPECT_NEAR(seen.x, x, 1e-6);
          EXPECT_NEAR(seen.y, y, 1e-6);
          const Projected moved = projectPoint(camera, defaultSequence().pose(b), point);
          if (moved.depth <= Renderer::kNearPlane) {
            continue;
          }
          for (const LineSegment& other : defaultGroundTruth()[b]) {
            if (defaultSequence().edgeOf(other.id) == defaultSequence().edgeOf(line.id)) {
              worst = std::max(worst, distanceToLine(other, moved.x, moved.y));
              ++compared;
            }
          }
        }
      }
    }
  }
  EXPECT_GT(compared, 5000U);
  EXPECT_LT(worst, 0.05);
}

TEST(SyntheticLines, KeepTheirDirectionFromFrameToFrame) {
  // Endpoint 1 stays on the same side, so that lines can be compared end by end.
  for (std::size_t i = 1; i < defaultGroundTruth().size(); ++i) {
    for (const LineSegment& line : defaultGroundTruth()[i]) {
      if (const LineSegment* before = findId(defaultGroundTruth()[i - 1], line.id)) {
        const double dot = (line.x2 - line.x1) * (before->x2 - before->x1) +
                           (line.y2 - line.y1) * (before->y2 - before->y1);
        EXPECT_GT(dot, 0) << "id " << line.id << ", frame " << i;
      }
    }
  }
}

// Points of every edge, inside the image: visible by ray casting exactly where a part says so.
TEST(SyntheticLines, VisiblePartsAgreeWithRayCasting) {
  for (const std::uint64_t seed : {1U, 5U}) {
    SyntheticOptions options;
    options.seed = seed;
    const SyntheticSequence here(options);
    const RayOracle oracle(here.scene());
    const Camera& camera = here.camera();
    RandomLines random(seed);
    std::size_t visible = 0;
    std::size_t hidden = 0;
    for (const std::size_t frame : {0U, 40U, 85U}) {
      const Pose pose = here.pose(frame);
      const auto parts = visibleParts(here.scene(), camera, pose);
      for (std::size_t id = 0; id < parts.size(); ++id) {
        const Edge& edge = here.scene().edges[id];
        for (int k = 0; k < 6; ++k) {
          const double t = random.uniform(0, 1);
          const Eigen::Vector3d point = edge.from + t * (edge.to - edge.from);
          const Projected seen = projectPoint(camera, pose, point);
          const Rectangle area = annotatedArea(camera);
          if (seen.depth < 0.1 || seen.x < 0 || seen.y < 0 || seen.x > area.right ||
              seen.y > area.bottom) {
            continue;
          }
          // Within a hair of a part's end either answer is right.
          constexpr double kHair = 1e-4;
          bool inside = false;
          bool near_end = false;
          for (const EdgePart& part : parts[id]) {
            inside = inside || (t > part.begin && t < part.end);
            near_end =
                near_end || std::abs(t - part.begin) < kHair || std::abs(t - part.end) < kHair;
          }
          if (near_end) {
            continue;
          }
          EXPECT_EQ(inside, !oracle.hides(pose.translation, point))
              << "seed " << seed << ", frame " << frame << ", edge " << id << " at " << t << ", ("
              << point.transpose() << "), pixel " << seen.x << ", " << seen.y;
          (inside ? visible : hidden) += 1;
        }
      }
    }
    EXPECT_GT(visible, 3000U);
    EXPECT_GT(hidden, 3000U);
  }
}

TEST(SyntheticLines, CameraMovesSmoothlyAndStaysInTheRoom) {
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
    SyntheticOptions options;
    options.seed = seed;
    options.frames = 3000;
    const SyntheticSequence here(options);
    double path = 0;
    for (std::size_t i = 0; i < here.size(); ++i) {
      const Pose pose = here.pose(i);
      EXPECT_TRUE((pose.translation.array() > 0.3).all());
      EXPECT_TRUE((pose.translation.array() < here.scene().size.array() - 0.3).all());
      EXPECT_NEAR(pose.rotation.norm(), 1, 1e-12);
      if (i > 0) {
        const Pose before = here.pose(i - 1);
        const double step = (pose.translation - before.translation).norm();
        EXPECT_LT(step, 0.03);
        EXPECT_LT(pose.rotation.angularDistance(before.rotation), 0.02);
        path += step;
      }
    }
    EXPECT_GT(path / 100, 0.1);  // m/s over 100 s
  }
}

TEST(SyntheticLines, RateAndLengthSampleTheSamePath) {
  SyntheticOptions options;
  options.frames = 300;
  options.rate = 60;
  const SyntheticSequence twice(options);
  for (const std::size_t i : {0U, 7U, 89U}) {
    EXPECT_EQ(twice.pose(2 * i).translation, defaultSequence().pose(i).translation);
    EXPECT_EQ(twice.stamp(2 * i), defaultSequence().stamp(i));
  }
  EXPECT_EQ(defaultSequence().stamp(0), kNanosecondsPerSecond);
  EXPECT_EQ(defaultSequence().stamp(1), kNanosecondsPerSecond + 33333333);
}

TEST(SyntheticLines, AnotherSeedMovesFurnitureAndPath) {
  SyntheticOptions options;
  options.seed = 2;
  const SyntheticSequence other(options);
  EXPECT_NE(other.pose(0).translation, defaultSequence().pose(0).translation);
  EXPECT_NE(other.groundTruth(0).size(), 0U);
  bool moved = other.scene().edges.size() != defaultSequence().scene().edges.size();
  for (std::size_t i = 0; !moved && i < other.scene().edges.size(); ++i) {
    moved = other.scene().edges[i].from != defaultSequence().scene().edges[i].from;
  }
  EXPECT_TRUE(moved);
}

TEST(SyntheticLines, RefusesOptionsByName) {
  const auto refuse = [](const auto& change, const std::string& name, const std::string& value) {
    SyntheticOptions options;
    change(&options);
    expectError<ConfigError>([&] { SyntheticSequence bad(options); }, {name, value, "expected"});
  };
  refuse([](SyntheticOptions* o) { o->frames = 0; }, "frames", "0");
  refuse([](SyntheticOptions* o) { o->rate = 0; }, "rate", "0");
  refuse([](SyntheticOptions* o) { o->rate = std::nan(""); }, "rate", "nan");
  refuse([](SyntheticOptions* o) { o->width = 0; }, "width", "0");
  refuse([](SyntheticOptions* o) { o->height = 5000; }, "height", "5000");
  refuse([](SyntheticOptions* o) { o->noise = -1; }, "noise", "-1");
  refuse([](SyntheticOptions* o) { o->blur = 21; }, "blur", "21");
}

}  // namespace
}  // namespace evolin::synthetic
