// The bounds that leave few lines, on every kind of processor that this one can stand for, against
// exact distances of all lines.
#include "src/metrics/near_lines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <opencv2/core/utility.hpp>
#include <set>
#include <vector>

#include "evolin_ros/geometry/distance.h"
#include "test/metrics/mixed_lines.h"

namespace evolin {
namespace {

std::vector<CandidateFinder> finders() {
  std::vector<CandidateFinder> result = {findCandidates, generic::findCandidates};
  if (cv::checkHardwareSupport(CV_CPU_AVX2) && cv::checkHardwareSupport(CV_CPU_FMA3)) {
    result.push_back(wide::findCandidates);
  }
  return result;
}

/// Infinite where the lines cover too little of each other.
double distanceBetween(LineDistance distance, const NearQuestion& question, const LineSegment& a,
                       const LineSegment& b) {
  if (distance == LineDistance::kStructural) {
    return structuralDistance(a, b);
  }
  const bool covered = question.min_overlap == 0 ||
                       (coveredShare(a, b) + coveredShare(b, a)) / 2 >= question.min_overlap;
  return covered ? orthogonalDistance(a, b, false) : std::numeric_limits<double>::infinity();
}

std::set<std::uint32_t> wantedRows(LineDistance distance, const NearQuestion& question,
                                   const LineSegment& query, const LineSegments& lines) {
  std::vector<double> distances;
  double limit = question.reach;
  for (const LineSegment& line : lines) {
    distances.push_back(distanceBetween(distance, question, query, line));
    limit = question.nearest ? std::min(limit, distances.back()) : limit;
  }
  std::set<std::uint32_t> rows;
  for (std::uint32_t row = 0; row < lines.size(); ++row) {
    if (distances[row] <= limit) {
      rows.insert(row);
    }
  }
  return rows;
}

std::size_t expectWanted(const NearLines::Rows& answer, const std::set<std::uint32_t>& wanted,
                         std::size_t count) {
  const std::set<std::uint32_t> rows(answer.begin(), answer.end());
  EXPECT_EQ(rows.size(), static_cast<std::size_t>(answer.end() - answer.begin()));
  EXPECT_TRUE(rows.empty() || *rows.rbegin() < count);
  EXPECT_TRUE(std::includes(rows.begin(), rows.end(), wanted.begin(), wanted.end()));
  return rows.size();
}

/// How many were found for all of the queries, of both distances.
std::size_t expectAllWanted(const NearQuestion& question, CandidateFinder finder,
                            const LineSegments& lines, const LineSegments& queries) {
  NearLines near(lines, finder);
  std::size_t found = 0;
  for (const LineSegment& query : queries) {
    const NearLines::Answer answer = near.find(query, question);
    std::set<std::uint32_t> structural;
    std::set<std::uint32_t> orthogonal;
    if (question.structural) {
      structural = wantedRows(LineDistance::kStructural, question, query, lines);
    }
    if (question.orthogonal) {
      orthogonal = wantedRows(LineDistance::kOrthogonal, question, query, lines);
    }
    found += expectWanted(answer.structural, structural, lines.size());
    found += expectWanted(answer.orthogonal, orthogonal, lines.size());
    EXPECT_TRUE(question.structural || answer.structural.begin() == answer.structural.end());
    EXPECT_TRUE(question.orthogonal || answer.orthogonal.begin() == answer.orthogonal.end());
  }
  return found;
}

TEST(NearLines, FindsAllThatAreWanted) {
  for (const std::size_t count : {0U, 1U, 7U, 8U, 9U, 64U, 65U, 500U}) {
    test::RandomLines random(count + 3);
    const LineSegments lines = test::mixedLines(count, &random);
    const LineSegments queries = test::mixedLines(120, &random);
    for (const CandidateFinder finder : finders()) {
      for (const bool nearest : {false, true}) {
        for (const double reach : {0.0, 0.5, 15.0, 600.0}) {
          expectAllWanted({true, false, reach, 0, nearest}, finder, lines, queries);
          for (const double overlap : {0.0, 0.2, 0.5, 0.9}) {
            expectAllWanted({false, true, reach, overlap, nearest}, finder, lines, queries);
            expectAllWanted({true, true, reach, overlap, nearest}, finder, lines, queries);
          }
        }
      }
    }
  }
}

TEST(NearLines, LeavesFewOthers) {
  test::RandomLines random(5);
  const LineSegments lines = random.anywhere(400, 128, 128);
  LineSegments queries;
  for (LineSegment line : lines) {
    line.x1 += 0.5;
    line.y2 -= 0.5;
    queries.push_back(line);
  }
  for (const CandidateFinder finder : finders()) {
    EXPECT_LT(expectAllWanted({true, false, 15, 0, true}, finder, lines, queries),
              3 * lines.size());
    EXPECT_LT(expectAllWanted({false, true, 15, 0.5, true}, finder, lines, queries),
              2 * lines.size());
  }
}

TEST(NearLines, LinesThatHardlyHaveALengthAreFound) {
  LineSegments lines;
  for (const double length : {1e-12, 1e-20, 1e-30, 1e-42, 1e-160, 1e-170, 0.0, 1.0}) {
    lines.push_back(test::segment(0, 0, length, 0));
    lines.push_back(test::segment(0, 0, length, length));
    lines.push_back(test::segment(0.25 * length, 0, 0.75 * length, length));
  }
  for (const CandidateFinder finder : finders()) {
    for (const bool nearest : {false, true}) {
      for (const double overlap : {0.0, 0.5}) {
        expectAllWanted({false, true, 5, overlap, nearest}, finder, lines, lines);
      }
      EXPECT_GE(expectAllWanted({true, false, 5, 0, nearest}, finder, lines, lines), lines.size());
    }
  }
}

}  // namespace
}  // namespace evolin
