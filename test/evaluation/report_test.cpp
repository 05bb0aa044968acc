// The report's forms: strict JSON with a reason beside every null, tables that never show a figure
// for what was not evaluated, and files that are there as a whole.
#include "evolin_ros/evaluation/report.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "test/evaluation/sample_frames.h"
#include "test/support/expect_error.h"
#include "test/support/temporary_folder.h"

namespace evolin {
namespace {

using nlohmann::json;
using test::annotated;
using test::detected;
using test::expectError;
using test::expectSeenIsTheSum;
using test::handLines;
using test::handTruth;
using test::kSecond;
using test::line;
using test::matchSet;

constexpr FrameState kStates[] = {FrameState::kWaiting,       FrameState::kEvaluated,
                                  FrameState::kUnmatched,     FrameState::kDropped,
                                  FrameState::kNoGroundTruth, FrameState::kBadGroundTruth,
                                  FrameState::kSkipped};

/// One report for every way in which figures may be missing.
std::vector<Report> sampleReports() {
  std::vector<Report> reports;
  const auto keep = [&reports](const PassEvaluation& pass) {
    reports.push_back(pass.report(false));
    reports.push_back(pass.report(true));
  };
  keep(PassEvaluation());
  PassEvaluation only_lines;
  only_lines.addLines(handLines(kSecond));
  only_lines.addMatches(matchSet(0, kSecond, "detector", {}));
  keep(only_lines);
  PassEvaluation unscored;
  unscored.addLines(detected(kSecond, {line(10, 10, 50, 30)}));
  unscored.addGroundTruth(handTruth(kSecond));
  keep(unscored);
  PassEvaluation nothing_detected;
  nothing_detected.addLines(detected(kSecond, {}));
  nothing_detected.addGroundTruth(handTruth(kSecond));
  keep(nothing_detected);
  PassEvaluation nothing_annotated;
  nothing_annotated.addLines(handLines(kSecond));
  nothing_annotated.addGroundTruth(annotated(kSecond, {}));
  nothing_annotated.addMatches(matchSet(kSecond, 2 * kSecond, "ground_truth", {{0, 0}}));
  keep(nothing_annotated);
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    PassEvaluation pass;
    for (const test::Part& part : test::randomPass(seed, 10)) give(part, &pass);
    // The last matches are of another family: no number of pairs is expected any more.
    if (seed % 2 == 1) pass.addMatches(matchSet(kSecond, 20 * kSecond, "detector", {}));
    keep(pass);
  }
  reports.push_back(reports.back());
  reports.back().input_images = 12;
  return reports;
}

/// Every null below `value` must have a reason in its own object.
void expectReasons(const json& value, const std::string& path) {
  if (value.is_object()) {
    for (const auto& [key, element] : value.items()) {
      if (element.is_null()) {
        EXPECT_TRUE(value.contains("reason") && value["reason"].is_string() &&
                    !value["reason"].get<std::string>().empty())
            << path << "." << key << " is null without a reason";
      }
      expectReasons(element, path + "." + key);
    }
  } else if (value.is_array()) {
    for (std::size_t i = 0; i < value.size(); ++i) {
      EXPECT_FALSE(value[i].is_null());
      expectReasons(value[i], path + "[" + std::to_string(i) + "]");
    }
  }
}

std::vector<std::string> linesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::vector<std::string> cellsOf(const std::string& row) {
  std::vector<std::string> cells(1);
  for (const char c : row) {
    if (c == ',') {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  return cells;
}

std::string contentOf(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

TEST(Coverage, SeenIsTheSumThroughEveryChangeOfState) {
  CoverageCounts counts;
  std::set<std::string> names;
  for (const FrameState state : kStates) {
    counts.add(state);
    EXPECT_EQ(counts.of(state), 1U);
    expectSeenIsTheSum(counts);
    names.insert(toString(state));
  }
  EXPECT_EQ(counts.seen, 7U);
  EXPECT_EQ(names, (std::set<std::string>{"waiting", "evaluated", "unmatched", "dropped",
                                          "no_ground_truth", "bad_ground_truth", "skipped"}));
  for (const FrameState state : kStates) {
    counts.remove(state);
    EXPECT_EQ(counts.of(state), 0U);
    expectSeenIsTheSum(counts);
  }
  EXPECT_EQ(counts.seen, 0U);
}

TEST(SummarizeTimes, IsThatOfTheSortedTimes) {
  const TimingSummary summary = summarizeTimes({4, 1, 3, 2});
  EXPECT_EQ(summary.frames, 4U);
  EXPECT_DOUBLE_EQ(summary.mean, 2.5);
  EXPECT_DOUBLE_EQ(summary.median, 2.5);
  EXPECT_DOUBLE_EQ(summary.p95, 3.85);
  EXPECT_DOUBLE_EQ(summary.max, 4);
  EXPECT_DOUBLE_EQ(summary.rate, 0.4);
  const TimingSummary one = summarizeTimes({0.5});
  EXPECT_EQ(one.median, 0.5);
  EXPECT_EQ(one.p95, 0.5);
  EXPECT_EQ(summarizeTimes({}).frames, 0U);
  EXPECT_EQ(summarizeTimes({}).rate, 0);
}

TEST(ReportJson, IsStrictAndGivesAReasonForEveryNull) {
  for (const Report& report : sampleReports()) {
    json root;
    ASSERT_NO_THROW(root = json::parse(toJson(report)));
    expectReasons(root, "");
    EXPECT_EQ(root["coverage"]["seen"], report.frames.size());
    EXPECT_EQ(root["complete"], report.complete);
    EXPECT_EQ(root["detection"]["entries"].size(), 6U);
    for (const json& entry : root["detection"]["entries"]) {
      EXPECT_EQ(entry["precision"].is_null(), report.detection_frames == 0);
    }
    EXPECT_EQ(root["association"]["f_score"].is_null(), report.pairs.evaluated == 0);
  }
}

TEST(ReportJson, HoldsTheHandComputedFigures) {
  PassEvaluation pass;
  for (const Stamp stamp : {kSecond, 2 * kSecond}) {
    LineSet lines = handLines(stamp);
    lines.processing_time = 0.02;
    pass.addLines(lines);
    pass.addGroundTruth(handTruth(stamp));
  }
  pass.addMatches(matchSet(kSecond, 2 * kSecond, "ground_truth", {{0, 0}, {1, 0}}));
  const json root = json::parse(toJson(pass.report(true)));
  const json& entry = root["detection"]["entries"][test::kStructural5];
  EXPECT_EQ(entry["distance"], "structural");
  EXPECT_EQ(entry["threshold"], 5);
  EXPECT_DOUBLE_EQ(entry["precision"], 1.0 / 3);
  EXPECT_DOUBLE_EQ(entry["recall"], 0.5);
  EXPECT_DOUBLE_EQ(entry["f_score"], 0.4);
  EXPECT_EQ(entry["counts"]["true_positives"], 2);
  EXPECT_EQ(entry["counts"]["predicted"], 6);
  EXPECT_EQ(entry["counts"]["ground_truth"], 4);
  EXPECT_DOUBLE_EQ(root["association"]["precision"], 0.5);
  EXPECT_DOUBLE_EQ(root["association"]["recall"], 0.5);
  EXPECT_EQ(root["association"]["pairs_expected"], 1);
  EXPECT_DOUBLE_EQ(root["timing"]["detector"]["latency_ms"]["p95"], 20);
  EXPECT_DOUBLE_EQ(root["timing"]["detector"]["rate_hz"], 50);
  EXPECT_TRUE(root["timing"]["associator"]["rate_hz"].is_null());
  EXPECT_EQ(root["protocol"], "evolin");
}

TEST(ReportJson, EmbedsProvenanceAndKeepsWhatIsNoJson) {
  Report report;
  report.provenance["input"] = R"({"bag": "a.bag", "images": 10})";
  report.provenance["broken"] = "{\"a\": NaN}";
  report.provenance["bytes"] = "caf\xE9";
  report.notes = {"bad \xFF byte"};
  const json root = json::parse(toJson(report));
  EXPECT_EQ(root["provenance"]["input"]["images"], 10);
  EXPECT_EQ(root["provenance"]["broken"], "{\"a\": NaN}");
  EXPECT_EQ(root["provenance"]["bytes"], "caf\xEF\xBF\xBD");
  EXPECT_EQ(root["notes"][0], "bad \xEF\xBF\xBD byte");
}

TEST(ReportCsv, HasTheSameColumnsInEveryRow) {
  std::size_t blank_rows = 0;
  for (const Report& report : sampleReports()) {
    const std::vector<std::string> frames = linesOf(framesToCsv(report));
    ASSERT_EQ(frames.size(), report.frames.size() + 1);
    const std::size_t columns = 6 + 6 * 6 + 6;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const std::vector<std::string> cells = cellsOf(frames[i]);
      ASSERT_EQ(cells.size(), columns) << frames[i];
      if (i == 0) continue;
      const FrameRecord& frame = report.frames[i - 1];
      EXPECT_EQ(cells[0], formatStamp(frame.stamp));
      EXPECT_EQ(cells[1], toString(frame.state));
      const bool evaluated = frame.state == FrameState::kEvaluated;
      EXPECT_EQ(cells[5].empty(), !evaluated);
      for (std::size_t column = 6; column < columns; ++column) {
        const bool heatmap = column >= columns - 6;
        // The sixth of a setting's columns is the average precision, which may be undefined.
        if (!heatmap && evaluated && column % 6 == 5) continue;
        EXPECT_EQ(cells[column].empty(), heatmap ? frame.heatmap.empty() : !evaluated) << column;
      }
      blank_rows += evaluated ? 0 : 1;
    }
    const std::vector<std::string> pairs = linesOf(pairsToCsv(report));
    ASSERT_EQ(pairs.size(), report.pairs.evaluated + 1);
    for (const std::string& row : pairs) EXPECT_EQ(cellsOf(row).size(), 9U) << row;
  }
  EXPECT_GT(blank_rows, 0U);
}

TEST(ReportCsv, HoldsAFramesOwnFigures) {
  PassEvaluation pass;
  LineSet lines = handLines(kSecond);
  lines.processing_time = 0.0125;
  pass.addLines(lines);
  pass.addGroundTruth(handTruth(kSecond));
  const std::vector<std::string> rows = linesOf(framesToCsv(pass.report(true)));
  const std::vector<std::string> names = cellsOf(rows[0]);
  const std::vector<std::string> cells = cellsOf(rows[1]);
  std::map<std::string, std::string> row;
  for (std::size_t i = 0; i < names.size(); ++i) row[names[i]] = cells[i];
  EXPECT_EQ(row.size(), names.size()) << "a column's name occurs twice";
  EXPECT_EQ(row.at("stamp"), "1.000000");
  EXPECT_EQ(row.at("lines"), "3");
  EXPECT_EQ(row.at("ground_truth"), "2");
  EXPECT_EQ(row.at("detector_ms"), "12.50");
  EXPECT_EQ(row.at("structural_5_true_positives"), "1");
  EXPECT_EQ(row.at("structural_5_predicted"), "3");
  EXPECT_EQ(row.at("structural_5_recall"), "0.5");
  EXPECT_EQ(row.at("structural_5_f_score"), "0.4");
  EXPECT_EQ(row.at("orthogonal_5_true_positives"), "2");
  EXPECT_EQ(row.at("structural_10_average_precision"), "0.5");
}

TEST(ReportMarkdown, ShowsReasonsInsteadOfFigures) {
  const std::string empty = toMarkdown(PassEvaluation().report(true));
  EXPECT_NE(empty.find("not evaluated: no frame had both lines and ground truth"),
            std::string::npos);
  EXPECT_NE(empty.find("not evaluated: no matches were received"), std::string::npos);
  EXPECT_EQ(empty.find("0.0"), std::string::npos) << empty;
  EXPECT_NE(empty.find("| detector | - | - | - | 0 |"), std::string::npos);

  for (const Report& report : sampleReports()) {
    const std::string text = toMarkdown(report);
    EXPECT_EQ(text.find("nan"), std::string::npos);
    EXPECT_EQ(text.find("inf"), std::string::npos);
    const std::string reason = whyNoAssociation(report);
    EXPECT_EQ(reason.empty(), report.pairs.evaluated > 0);
    EXPECT_NE(text.find(reason), std::string::npos) << text;
    for (const DetectionEntry& entry : report.detection) {
      const std::string why = whyNoAveragePrecision(report, entry);
      EXPECT_EQ(why.empty(), entry.average_precision.has_value());
      EXPECT_TRUE(report.detection_frames == 0 || text.find(why) != std::string::npos);
    }
    EXPECT_EQ(text.find("snapshot") == std::string::npos, report.complete);
  }
}

TEST(ReportMarkdown, SaysWhyThereIsNoAveragePrecision) {
  const auto first_reason = [](LineSegments lines, LineSegments truth) {
    PassEvaluation pass;
    pass.addLines(detected(kSecond, std::move(lines)));
    pass.addGroundTruth(annotated(kSecond, std::move(truth)));
    const Report report = pass.report(true);
    return whyNoAveragePrecision(report, report.detection[0]);
  };
  EXPECT_EQ(first_reason({line(10, 10, 50, 30)}, handTruth(0).lines), "the lines carry no scores");
  EXPECT_EQ(first_reason({}, handTruth(0).lines), "no lines were detected");
  EXPECT_EQ(first_reason({line(10, 10, 50, 10), line(20, 10, 20, 60)}, handTruth(0).lines),
            "the protocol drops all 2 detected lines (see docs/METRICS.md)");
  EXPECT_EQ(first_reason(handLines(0).lines, {}), "no lines are annotated");
  const Report empty = PassEvaluation().report(true);
  EXPECT_EQ(whyNoAveragePrecision(empty, empty.detection[0]), "no frame was evaluated");
}

TEST(ReportMarkdown, NamesEveryReasonOfCoverage) {
  Report report;
  for (const FrameState state : kStates) report.coverage.add(state);
  report.input_images = 9;
  report.frames.resize(7);
  const std::string text = toMarkdown(report);
  for (const char* part :
       {"1 of 7 frames evaluated", "1 still waiting", "unmatched", "full buffer",
        "1 without ground truth", "1 with bad ground truth", "1 skipped", "2 of the 9 images"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << " is not in\n" << text;
  }
}

TEST(WhyNoAssociation, AFrontEndWithoutANameHasSentMatchesAllTheSame) {
  PassEvaluation pass;
  MatchSet matches = matchSet(kSecond, 2 * kSecond, "ground_truth", {});
  matches.source.clear();
  pass.addMatches(matches);
  EXPECT_EQ(whyNoAssociation(pass.report(true)),
            "not evaluated: no ground truth for the matched frames");
}

TEST(WriteReport, WritesAllFormsAndNothingElse) {
  const test::TemporaryFolder folder;
  const std::filesystem::path output = folder.path() / "new" / "deeper";
  for (const Report& report : sampleReports()) {
    EXPECT_EQ(writeReport(report, output), output / "report.json");
    EXPECT_EQ(contentOf(output / "report.json"), toJson(report));
    EXPECT_EQ(contentOf(output / "summary.md"), toMarkdown(report));
    EXPECT_EQ(contentOf(output / "frames.csv"), framesToCsv(report));
    EXPECT_EQ(contentOf(output / "pairs.csv"), pairsToCsv(report));
    EXPECT_EQ(contentOf(output / "repeatability.csv"), repeatabilityToCsv(report));
    EXPECT_EQ(contentOf(output / "poses.csv"), posesToCsv(report));
    EXPECT_EQ(contentOf(output / "relative_motion_ground_truth.tum"), motionsToTum(report, false));
    EXPECT_EQ(contentOf(output / "relative_motion_estimate.tum"), motionsToTum(report, true));
  }
  const std::size_t files = static_cast<std::size_t>(std::distance(
      std::filesystem::directory_iterator(output), std::filesystem::directory_iterator()));
  EXPECT_EQ(files, 8U) << "temporary files are left";
}

TEST(WriteReport, NamesAFolderThatCannotBeMade) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.write("taken", "no folder");
  expectError([&] { writeReport(Report(), file / "report"); },
              {(file / "report" / "frames.csv").string(), "folder"});
  EXPECT_EQ(contentOf(file), "no folder");
}

TEST(WriteReport, LeavesTheEarlierReportWhenItFails) {
  const test::TemporaryFolder folder;
  const Report first = sampleReports().front();
  writeReport(first, folder.path());
  std::filesystem::remove(folder.path() / "summary.md");
  std::filesystem::create_directory(folder.path() / "summary.md");
  expectError([&] { writeReport(sampleReports().back(), folder.path()); },
              {(folder.path() / "summary.md").string()});
  EXPECT_EQ(contentOf(folder.path() / "report.json"), toJson(first));
}

}  // namespace
}  // namespace evolin
