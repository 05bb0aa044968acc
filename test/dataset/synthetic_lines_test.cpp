// The synthetic sequence's ground truth: lines against geometry and against ray casting.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "evolin_ros/dataset/synthetic/synthetic_sequence.h"
#include "test/dataset/ray_oracle.h"
#include "test/support/expect_error.h"
#include "test/support/random_lines.h"

namespace evolin::synthetic {
namespace {

using test::expectError;
using test::Projected;
using test::projectPoint;
using test::RandomLines;
using test::RayOracle;

const SyntheticSequence& sequence() {
  static const SyntheticSequence kSequence{SyntheticOptions{}};
  return kSequence;
}

/// Of all 90 frames.
const std::vector<LineSegments>& groundTruth() {
  static const std::vector<LineSegments> kLines = [] {
    std::vector<LineSegments> frames;
    for (std::size_t i = 0; i < sequence().size(); ++i) {
      frames.push_back(sequence().groundTruth(i).lines);
    }
    return frames;
  }();
  return kLines;
}

const LineSegment* findId(const LineSegments& lines, std::int64_t id) {
  const auto found = std::find_if(lines.begin(), lines.end(),
                                  [id](const LineSegment& line) { return line.id == id; });
  return found == lines.end() ? nullptr : &*found;
}

double distanceToLine(const LineSegment& line, double x, double y) {
  return std::abs((line.x2 - line.x1) * (y - line.y1) - (line.y2 - line.y1) * (x - line.x1)) /
         line.length();
}

/// The point of a physical edge that is seen at a pixel: where the edge comes nearest to the sight
/// line.
Eigen::Vector3d pointOfEdge(const Edge& edge, const Camera& camera, const Pose& pose, double x,
                            double y) {
  const Eigen::Vector3d d = test::sightLine(camera, pose, x, y).normalized();
  const Eigen::Vector3d span = edge.to - edge.from;
  const Eigen::Vector3d offset = edge.from - pose.translation;
  const Eigen::Vector3d across = span - span.dot(d) * d;
  return edge.from - (offset - offset.dot(d) * d).dot(across) / across.squaredNorm() * span;
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
  std::set<std::int64_t> all;
  const Camera& camera = sequence().camera();
  for (const LineSegments& lines : groundTruth()) {
    total += lines.size();
    std::int64_t last = -1;
    for (const LineSegment& line : lines) {
      EXPECT_GT(line.id, last);  // rising, so unique
      last = line.id;
      all.insert(line.id);
      EXPECT_GE(line.length(), kMinLength);
      EXPECT_GE(std::min({line.x1, line.y1, line.x2, line.y2}), 0);
      EXPECT_LE(std::max(line.x1, line.x2), annotatedArea(camera).right);
      EXPECT_LE(std::max(line.y1, line.y2), annotatedArea(camera).bottom);
      EXPECT_TRUE(line.x1 != line.x2 && line.y1 != line.y2) << "id " << line.id;
    }
    EXPECT_LT(last, static_cast<std::int64_t>(sequence().scene().edges.size()));
  }
  const double mean = static_cast<double>(total) / static_cast<double>(groundTruth().size());
  EXPECT_GE(mean, 35);
  EXPECT_GE(all.size(), 120U);
  RecordProperty("mean_lines", std::to_string(mean));
}

TEST(SyntheticLines, EndpointsReprojectOntoTheirLineInOtherFrames) {
  const Camera& camera = sequence().camera();
  double worst = 0;
  std::size_t compared = 0;
  for (std::size_t a = 0; a < groundTruth().size(); a += 7) {
    for (std::size_t b = 3; b < groundTruth().size(); b += 11) {
      for (const LineSegment& line : groundTruth()[a]) {
        const LineSegment* other = findId(groundTruth()[b], line.id);
        if (other == nullptr) {
          continue;
        }
        const Edge& edge = sequence().scene().edges[static_cast<std::size_t>(line.id)];
        for (const auto& [x, y] : {std::pair(line.x1, line.y1), std::pair(line.x2, line.y2)}) {
          const Eigen::Vector3d point = pointOfEdge(edge, camera, sequence().pose(a), x, y);
          const Projected seen = projectPoint(camera, sequence().pose(a), point);
          EXPECT_NEAR(seen.x, x, 1e-6);
          EXPECT_NEAR(seen.y, y, 1e-6);
          const Projected moved = projectPoint(camera, sequence().pose(b), point);
          if (moved.depth > Renderer::kNearPlane) {
            worst = std::max(worst, distanceToLine(*other, moved.x, moved.y));
            ++compared;
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
  for (std::size_t i = 1; i < groundTruth().size(); ++i) {
    for (const LineSegment& line : groundTruth()[i]) {
      if (const LineSegment* before = findId(groundTruth()[i - 1], line.id)) {
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

TEST(SyntheticLines, OfAnEdgeInSeveralPartsTheLongestIsTaken) {
  const Pose pose = sequence().pose(30);
  const Camera& camera = sequence().camera();
  const auto parts = visibleParts(sequence().scene(), camera, pose);
  const VisibleLines lines = visibleLines(sequence().scene(), camera, pose);
  EXPECT_GT(lines.parts_left_out, 0U);
  std::size_t several = 0;
  for (const LineSegment& line : lines.lines) {
    const Edge& edge = sequence().scene().edges[static_cast<std::size_t>(line.id)];
    double longest = 0;
    for (const EdgePart& part : parts[static_cast<std::size_t>(line.id)]) {
      const Eigen::Vector3d span = edge.to - edge.from;
      const Projected a = projectPoint(camera, pose, edge.from + part.begin * span);
      const Projected b = projectPoint(camera, pose, edge.from + part.end * span);
      longest = std::max(longest, std::hypot(a.x - b.x, a.y - b.y));
    }
    several += parts[static_cast<std::size_t>(line.id)].size() > 1 ? 1 : 0;
    EXPECT_NEAR(line.length(), longest, 1e-6) << "id " << line.id;
  }
  EXPECT_GT(several, 0U);
}

TEST(SyntheticLines, NoLineRunsBesideALongerOneAllItsWay) {
  const auto distance = [](double x, double y, const LineSegment& line) {
    const double dx = (line.x2 - line.x1) / line.length();
    const double dy = (line.y2 - line.y1) / line.length();
    const double along = std::clamp((x - line.x1) * dx + (y - line.y1) * dy, 0.0, line.length());
    return std::hypot(x - line.x1 - along * dx, y - line.y1 - along * dy);
  };
  std::size_t left_out = 0;
  for (const std::size_t frame : {0U, 45U, 80U}) {
    left_out += sequence().groundTruth(frame).twins_left_out;
    for (const LineSegment& line : groundTruth()[frame]) {
      for (const LineSegment& other : groundTruth()[frame]) {
        if (other.length() > line.length()) {
          EXPECT_GE(std::max(distance(line.x1, line.y1, other), distance(line.x2, line.y2, other)),
                    kTwinDistance)
              << line.id << " beside " << other.id;
        }
      }
    }
  }
  EXPECT_GT(left_out, 0U);
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
    EXPECT_EQ(twice.pose(2 * i).translation, sequence().pose(i).translation);
    EXPECT_EQ(twice.stamp(2 * i), sequence().stamp(i));
  }
  EXPECT_EQ(sequence().stamp(0), kNanosecondsPerSecond);
  EXPECT_EQ(sequence().stamp(1), kNanosecondsPerSecond + 33333333);
}

TEST(SyntheticLines, AnotherSeedMovesFurnitureAndPath) {
  SyntheticOptions options;
  options.seed = 2;
  const SyntheticSequence other(options);
  EXPECT_NE(other.pose(0).translation, sequence().pose(0).translation);
  EXPECT_NE(other.groundTruth(0).lines.size(), 0U);
  bool moved = other.scene().edges.size() != sequence().scene().edges.size();
  for (std::size_t i = 0; !moved && i < other.scene().edges.size(); ++i) {
    moved = other.scene().edges[i].from != sequence().scene().edges[i].from;
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
