// Precision-recall curves of a report: their points by hand, their thinning, their file.
#include "evolin_ros/evaluation/report_curves.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "evolin_ros/evaluation/pass_evaluation.h"
#include "test/evaluation/sample_frames.h"
#include "test/support/expect_error.h"
#include "test/support/temporary_folder.h"

namespace evolin {
namespace {

using test::detected;
using test::expectError;
using test::handLines;
using test::handTruth;
using test::kSecond;
using test::kStructural10;
using test::line;

PassEvaluation passOf(int frames) {
  PassEvaluation pass;
  for (int frame = 1; frame <= frames; ++frame) {
    pass.addGroundTruth(handTruth(frame * kSecond));
    pass.addLines(handLines(frame * kSecond));
  }
  return pass;
}

Report reportOf(const PassEvaluation& pass, std::size_t points = 400) {
  Report report = pass.report(true);
  addCurves(pass.evaluator().detection(), &report, points);
  return report;
}

std::string contentOf(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

TEST(ReportCurves, HoldThePointsOfEverySetting) {
  const Report report = reportOf(passOf(1));
  ASSERT_EQ(report.curves.size(), report.detection.size());
  const DetectionCurve& curve = report.curves[kStructural10];
  EXPECT_EQ(curve.setting.distance, LineDistance::kStructural);
  EXPECT_EQ(curve.setting.threshold, 10);
  EXPECT_EQ(curve.points.recall, (std::vector<double>{0.5, 1, 1}));
  EXPECT_EQ(curve.points.precision, (std::vector<double>{1, 1, 2.0 / 3}));
}

TEST(ReportCurves, EndAtPrecisionAndRecallOfAllLines) {
  const Report report = reportOf(passOf(7), 5);
  for (std::size_t i = 0; i < report.curves.size(); ++i) {
    EXPECT_EQ(report.curves[i].points.recall.back(), report.detection[i].counts.recall());
    EXPECT_EQ(report.curves[i].points.precision.back(), report.detection[i].counts.precision());
  }
}

TEST(ReportCurves, ThinningKeepsPointsOfTheCurve) {
  const PassEvaluation pass = passOf(20);
  const PrecisionRecallCurve whole = reportOf(pass).curves[kStructural10].points;
  ASSERT_EQ(whole.recall.size(), 60U);
  const PrecisionRecallCurve few = reportOf(pass, 7).curves[kStructural10].points;
  ASSERT_EQ(few.recall.size(), 7U);
  EXPECT_EQ(few.precision.size(), 7U);
  EXPECT_EQ(few.recall.front(), whole.recall.front());
  for (std::size_t i = 0; i < few.recall.size(); ++i) {
    EXPECT_EQ(few.recall[i], whole.recall[i * 59 / 6]);
    EXPECT_EQ(few.precision[i], whole.precision[i * 59 / 6]);
  }
}

TEST(ReportCurves, AreNoneWithoutScores) {
  PassEvaluation pass;
  pass.addGroundTruth(handTruth(kSecond));
  pass.addLines(detected(kSecond, {line(10, 10, 50, 30)}));
  EXPECT_TRUE(reportOf(pass).curves.empty());
}

TEST(ReportCurves, AreNoneWithoutTheFamily) {
  PassOptions options;
  options.families = {MetricFamily::kAssociation};
  PassEvaluation pass(options);
  EXPECT_TRUE(reportOf(pass).curves.empty());
}

TEST(ReportCurves, NeedTwoPoints) {
  const PassEvaluation pass = passOf(1);
  expectError<Error>([&pass] { reportOf(pass, 1); }, {"curves of 1 points", "at least 2"});
}

TEST(ReportCurves, TheirFileGoesWhenTheNextReportHasNone) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "curves.csv";
  writeReport(reportOf(passOf(1)), folder.path());
  EXPECT_EQ(contentOf(file), curvesToCsv(reportOf(passOf(1))));
  EXPECT_NE(contentOf(file).find("\nstructural,10,0.5,1\n"), std::string::npos);
  writeReport(PassEvaluation().report(true), folder.path());
  EXPECT_FALSE(std::filesystem::exists(file));
}

}  // namespace
}  // namespace evolin
