// Golden lines and maps of networks, and how far lines are from them.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "test/support/golden.h"
#include "test/support/npy.h"

namespace evolin::test {

inline std::filesystem::path networkFolder() {
  return sharedFolder() / "data" / "golden" / "networks";
}

/// Frames that have golden maps.
constexpr int kGoldenMaps = 2;

/// Lines with scores of golden/networks/`name`.
inline LineSegments networkLines(const std::string& name, int frame) {
  const std::string file = goldenStem(frame) + ".csv";
  LineSegments lines = readLinesCsv(networkFolder() / name / "lines" / file);
  const std::vector<double> scores = readScoresCsv(networkFolder() / name / "scores" / file);
  EXPECT_EQ(lines.size(), scores.size());
  for (std::size_t i = 0; i < std::min(lines.size(), scores.size()); ++i) {
    lines[i].score = scores[i];
  }
  return lines;
}

/// Same count, same order, ends and scores within the tolerances.
inline void expectSameLines(const LineSegments& lines, const LineSegments& golden, double pixels,
                            double score) {
  ASSERT_TRUE(linesNear(lines, golden, pixels));
  for (std::size_t i = 0; i < lines.size(); ++i) {
    EXPECT_NEAR(lines[i].score, golden[i].score, score) << i;
  }
}

/// Of the golden lines, how many have a line of their own with ends within `pixels` and a score
/// within `score`.
inline std::size_t countSame(const LineSegments& lines, const LineSegments& golden, double pixels,
                             double score) {
  std::vector<bool> taken(lines.size(), false);
  std::size_t same = 0;
  for (const LineSegment& wanted : golden) {
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const LineSegment& line = lines[i];
      if (!taken[i] && std::abs(line.score - wanted.score) <= score &&
          std::max({std::abs(line.x1 - wanted.x1), std::abs(line.y1 - wanted.y1),
                    std::abs(line.x2 - wanted.x2), std::abs(line.y2 - wanted.y2)}) <= pixels) {
        taken[i] = true;
        ++same;
        break;
      }
    }
  }
  return same;
}

}  // namespace evolin::test
