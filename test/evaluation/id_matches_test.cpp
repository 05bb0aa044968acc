// Matches from track ids: steps, repeated and missing ids, jumps, and what an evaluation makes of
// them.
#include "evolin_ros/evaluation/id_matches.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "evolin_ros/evaluation/stream_evaluator.h"
#include "test/evaluation/sample_frames.h"
#include "test/support/expect_error.h"

namespace evolin::test {
namespace {

LineSet tracked(int second, const std::vector<std::int64_t>& ids,
                const std::string& source = "tracker") {
  LineSegments lines;
  for (const std::int64_t id : ids) {
    const auto place = static_cast<double>(lines.size());
    lines.push_back(line(10 * place, 5, 10 * place + 3, 40, kNoScore, id));
  }
  return lineSet(second * kSecond, source, lines);
}

using Rows = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

Rows rowsOf(const std::optional<MatchSet>& set) {
  Rows rows;
  if (set) {
    for (const LineMatch& match : set->matches) {
      rows.emplace_back(match.first, match.second);
    }
  }
  return rows;
}

TEST(IdMatcher, PairsEqualIds) {
  IdMatcher matcher(1);
  EXPECT_FALSE(matcher.add(tracked(1, {7, 3, -1, 5})).matches);
  const IdMatcher::Result result = matcher.add(tracked(2, {5, -1, 9, 7}));
  EXPECT_EQ(rowsOf(result.matches), (Rows{{3, 0}, {0, 3}})) << "-1 is no id";
  EXPECT_EQ(result.matches->first_stamp, 1 * kSecond);
  EXPECT_EQ(result.matches->stamp, 2 * kSecond);
  EXPECT_EQ(result.matches->source, "ids");
  EXPECT_EQ(result.matches->lines_source, "tracker");
  EXPECT_FALSE(result.jumped_back);
}

TEST(IdMatcher, CountsStepsInFramesThatCome) {
  IdMatcher matcher(2, "PL-VINS");
  matcher.add(tracked(1, {1, 2}));
  EXPECT_FALSE(matcher.add(tracked(2, {1, 2})).matches);
  // The front-end left out three images.
  const IdMatcher::Result result = matcher.add(tracked(6, {2, 1}));
  EXPECT_EQ(rowsOf(result.matches), (Rows{{1, 0}, {0, 1}}));
  EXPECT_EQ(result.matches->first_stamp, 1 * kSecond);
  EXPECT_EQ(result.matches->stamp, 6 * kSecond);
  EXPECT_EQ(result.matches->source, "PL-VINS");
}

TEST(IdMatcher, ReportsRepeatedIds) {
  IdMatcher matcher(1);
  EXPECT_EQ(matcher.add(tracked(1, {4, 4, 4, -1, -1})).repeated, 2U);
  const IdMatcher::Result result = matcher.add(tracked(2, {8, 4, 4}));
  EXPECT_EQ(result.repeated, 1U);
  EXPECT_EQ(rowsOf(result.matches), (Rows{{0, 1}})) << "the first of each frame";
}

TEST(IdMatcher, DoesNotTakeLinesWithoutIdsForUnmatched) {
  IdMatcher matcher(1);
  matcher.add(tracked(1, {1}));
  IdMatcher::Result result = matcher.add(tracked(2, {-1, -1}));
  EXPECT_TRUE(result.without_ids);
  EXPECT_FALSE(result.matches);
  result = matcher.add(tracked(3, {1}));
  EXPECT_TRUE(result.without_ids) << "the frame before has none";
  EXPECT_FALSE(result.matches);
  result = matcher.add(tracked(4, {}));
  EXPECT_FALSE(result.without_ids);
  EXPECT_TRUE(result.matches) << "a frame without lines has nothing to match";
  EXPECT_TRUE(rowsOf(result.matches).empty());
}

TEST(IdMatcher, BeginsAnewAtJumpsAndOtherSources) {
  IdMatcher matcher(1);
  matcher.add(tracked(5, {1}));
  IdMatcher::Result result = matcher.add(tracked(2, {1}));
  EXPECT_TRUE(result.jumped_back);
  EXPECT_FALSE(result.matches);
  EXPECT_TRUE(matcher.add(tracked(3, {1})).matches);
  result = matcher.add(tracked(4, {1}, "another"));
  EXPECT_FALSE(result.matches);
  EXPECT_FALSE(result.jumped_back);
  EXPECT_TRUE(matcher.add(tracked(5, {1}, "another")).matches);
  matcher.startSequence();
  EXPECT_FALSE(matcher.add(tracked(6, {1}, "another")).matches);
  expectError([] { IdMatcher(0); }, {"step of 0"});
}

/// Three annotated lines that stay where they are; what the front-end follows as 10, 11, 12 are
/// they, but in the last frame it has taken the second for the third and the other way round.
std::vector<Part> trackedPass(bool with_ids, bool with_matches) {
  std::vector<Part> parts;
  const LineSegments places = {line(10, 10, 50, 30), line(60, 60, 100, 90), line(20, 100, 90, 120)};
  for (int frame = 1; frame <= 4; ++frame) {
    LineSegments truth = places;
    LineSegments found = places;
    const std::vector<std::int64_t> ids =
        frame < 4 ? std::vector<std::int64_t>{10, 11, 12} : std::vector<std::int64_t>{10, 12, 11};
    for (std::size_t row = 0; row < places.size(); ++row) {
      truth[row].id = static_cast<std::int64_t>(row);
      found[row].id = with_ids ? ids[row] : kNoId;
    }
    Part part;
    part.stamp = frame * kSecond;
    part.kind = Part::kGroundTruth;
    part.lines = annotated(part.stamp, truth);
    parts.push_back(part);
    part.kind = Part::kLines;
    part.lines = detected(part.stamp, found);
    parts.push_back(part);
    if (with_matches && frame > 1) {
      LineMatches matches(3);
      for (std::uint32_t row = 0; row < 3; ++row) {
        matches[row].first = row;
        matches[row].second = frame < 4 || row == 0 ? row : 3 - row;
      }
      part.kind = Part::kMatches;
      part.matches = matchSet((frame - 1) * kSecond, frame * kSecond, "detector", matches);
      parts.push_back(part);
    }
  }
  return parts;
}

nlohmann::json reportOf(const std::vector<Part>& parts, bool from_ids) {
  PassOptions options;
  options.matches_from_ids = from_ids;
  StreamEvaluator evaluator(options);
  for (const Part& part : parts) {
    give(part, &evaluator);
  }
  EXPECT_FALSE(evaluator.waiting());
  return nlohmann::json::parse(toJson(evaluator.report(true)));
}

std::string notesOf(const nlohmann::json& report) { return report.at("notes").dump(); }

TEST(MatchesFromIds, CountAsMatchesDo) {
  const nlohmann::json by_ids = reportOf(trackedPass(true, false), true);
  const nlohmann::json by_matches = reportOf(trackedPass(false, true), false);
  EXPECT_EQ(by_ids.at("association_detected").at("counts"),
            by_matches.at("association_detected").at("counts"));
  EXPECT_EQ(by_ids.at("association_detected").at("counts").at("true_pairs"), 7);
  EXPECT_EQ(by_ids.at("association_detected").at("counts").at("predicted_pairs"), 9);
  EXPECT_EQ(by_ids.at("association_detected").at("pairs"), 3);
  EXPECT_EQ(by_ids.at("association").at("source"), "ids");
}

TEST(MatchesFromIds, AreWhatRelativePoseIsEstimatedFrom) {
  const auto poseOf = [](bool from_ids) {
    PassOptions options;
    options.matches_from_ids = from_ids;
    StreamEvaluator evaluator(options);
    Camera camera;
    camera.width = camera.height = kSide;
    camera.fx = camera.fy = 100;
    camera.cx = camera.cy = 63.5;
    evaluator.setCamera(camera);
    for (int frame = 1; frame <= 4; ++frame) {
      const cv::Mat flat(kSide, kSide, CV_32FC1, cv::Scalar(2));
      EvaluationUpdate update = evaluator.addDepth(frame * kSecond, DepthMap(flat));
      update.append(evaluator.addPose({frame * kSecond, Pose()}));
      runTasks({}, &evaluator, &update);
    }
    for (const Part& part : trackedPass(from_ids, !from_ids)) {
      give(part, &evaluator);
    }
    return nlohmann::json::parse(toJson(evaluator.report(true))).at("pose");
  };
  const nlohmann::json by_ids = poseOf(true);
  EXPECT_EQ(by_ids.at("pairs"), 3);
  EXPECT_EQ(by_ids, poseOf(false));
}

TEST(MatchesFromIds, LeaveTheMatchesTopicOut) {
  const nlohmann::json report = reportOf(trackedPass(true, true), true);
  EXPECT_EQ(report.at("association_detected").at("pairs"), 3) << "none twice";
  EXPECT_EQ(report.at("association").at("not_evaluated").at("skipped"), 3);
  EXPECT_NE(notesOf(report).find("matches_from is ids"), std::string::npos) << report.at("notes");
  EXPECT_EQ(notesOf(report).find("matches_from is ids"),
            notesOf(report).rfind("matches_from is ids"))
      << "said once";
}

TEST(MatchesFromIds, SayWhereIdsAreMissingOrRepeated) {
  nlohmann::json report = reportOf(trackedPass(false, false), true);
  EXPECT_EQ(report.at("association_detected").at("pairs"), 0);
  EXPECT_EQ(report.at("association").at("not_evaluated").at("skipped"), 3);
  EXPECT_NE(notesOf(report).find("no line with an id"), std::string::npos) << report.at("notes");
  std::vector<Part> parts = trackedPass(true, false);
  parts[1].lines.lines[2].id = 10;
  report = reportOf(parts, true);
  EXPECT_NE(notesOf(report).find("repeat an id"), std::string::npos) << report.at("notes");
  EXPECT_EQ(report.at("association_detected").at("pairs"), 3);
}

TEST(MatchesFromIds, TakeTheFrameStep) {
  PassOptions options;
  options.matches_from_ids = true;
  options.frame_step = 2;
  StreamEvaluator evaluator(options);
  for (const Part& part : trackedPass(true, false)) {
    give(part, &evaluator);
  }
  const Report report = evaluator.report(true);
  ASSERT_EQ(report.detected_pair_records.size(), 2U);
  EXPECT_EQ(report.detected_pair_records[0].first_stamp, 1 * kSecond);
  EXPECT_EQ(report.detected_pair_records[0].stamp, 3 * kSecond);
}

}  // namespace
}  // namespace evolin::test
