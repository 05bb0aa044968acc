// `evolin evaluate` against the published implementation's own output: folders in, JSON out.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>
#include <utility>

#include "evaluate_command.h"
#include "test/support/shared_data.h"
#include "test/support/temporary_folder.h"

namespace evolin::cli {
namespace {

using nlohmann::json;

constexpr double kTolerance = 1e-9;

json readJson(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return json::parse(stream);
}

std::string readText(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Runs the program with --output and returns the text that it wrote.
std::string evaluateText(std::vector<std::string> arguments) {
  const test::TemporaryFolder folder;
  const std::string output = (folder.path() / "out").string();
  arguments.insert(arguments.begin(), "evaluate");
  arguments.insert(arguments.end(), {"--output", output, "--output-file", "result.json"});
  ::testing::internal::CaptureStdout();
  const int status = runProgram({evaluateCommand()}, arguments);
  ::testing::internal::GetCapturedStdout();
  EXPECT_EQ(status, kExitDone);
  return status == kExitDone ? readText(folder.path() / "out" / "result.json") : "null";
}

json evaluate(const std::vector<std::string>& arguments) {
  return json::parse(evaluateText(arguments));
}

void expectNear(const json& actual, const json& expected, const std::string& where) {
  ASSERT_EQ(actual.size(), expected.size()) << where;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    ASSERT_NEAR(actual[i].get<double>(), expected[i].get<double>(), kTolerance)
        << where << ", point " << i;
  }
}

/// Same entries in the same order, every value and every point of every curve.
void expectGolden(const json& actual, const std::filesystem::path& file) {
  const json expected = readJson(file);
  ASSERT_EQ(actual.size(), expected.size()) << file;
  ASSERT_FALSE(expected.empty()) << file;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const std::string where = file.string() + ", entry " + std::to_string(i);
    ASSERT_EQ(actual[i]["name"], expected[i]["name"]) << where;
    ASSERT_EQ(actual[i]["additional_information"], expected[i]["additional_information"]) << where;
    ASSERT_EQ(actual[i].size(), expected[i].size()) << where;
    if (expected[i].contains("value")) {
      ASSERT_NEAR(actual[i]["value"].get<double>(), expected[i]["value"].get<double>(), kTolerance)
          << where;
    } else {
      expectNear(actual[i]["values"]["x"], expected[i]["values"]["x"], where + ", x");
      expectNear(actual[i]["values"]["y"], expected[i]["values"]["y"], where + ", y");
    }
  }
}

std::filesystem::path data() { return test::sharedFolder() / "data"; }

void checkVectorized(const std::filesystem::path& unscored, const std::filesystem::path& scored,
                     const std::filesystem::path& truth, const std::filesystem::path& images,
                     const std::filesystem::path& expected) {
  expectGolden(evaluate({"vectorized", "-p", unscored.string(), "-g", truth.string(), "-i",
                         images.string(), "-d", "5", "10", "15"}),
               expected / "vectorized_unscored.json");
  expectGolden(evaluate({"vectorized", "--pred-lines", (scored / "lines").string(), "--gt-lines",
                         truth.string(), "--imgs", images.string(), "--scores",
                         (scored / "scores").string(), "--score-thresholds",
                         (scored / "score_thresholds.txt").string(), "--threads", "3"}),
               expected / "vectorized_scored.json");
}

TEST(EvaluateVectorized, EqualsThePublishedFiguresOnTheLivingRoom) {
  EVOLIN_REQUIRE_SHARED_DATA();
  const std::filesystem::path sample = data() / "icl_nuim_lr_sample";
  checkVectorized(sample / "predictions" / "unscored", sample / "predictions" / "scored",
                  sample / "gt_lines", sample / "rgb", data() / "golden" / "icl");
}

class GoldenSet : public ::testing::TestWithParam<std::string> {};

TEST_P(GoldenSet, VectorizedEqualsThePublishedFigures) {
  EVOLIN_REQUIRE_SHARED_DATA();
  const std::filesystem::path set = data() / "golden" / "sets" / GetParam();
  checkVectorized(set / "scored_lines" / "lines", set / "scored_lines", set / "gt_lines",
                  set / "images", set / "expected");
}

INSTANTIATE_TEST_SUITE_P(EvaluateVectorized, GoldenSet,
                         ::testing::Values("basic", "edge", "timing"),
                         [](const auto& info) { return info.param; });

void checkHeatmap(const std::filesystem::path& unscored, const std::filesystem::path& scored,
                  const std::filesystem::path& thresholds, const std::filesystem::path& truth,
                  const std::filesystem::path& images, const std::filesystem::path& expected) {
  expectGolden(
      evaluate({"heatmap", "-p", unscored.string(), "-g", truth.string(), "-i", images.string()}),
      expected / "heatmap_unscored.json");
  expectGolden(
      evaluate({"heatmap", "--pred-lines", (scored / "lines").string(), "--gt-lines",
                truth.string(), "--imgs", images.string(), "--scores", (scored / "scores").string(),
                "--score-thresholds", thresholds.string(), "--threads", "3"}),
      expected / "heatmap_scored.json");
}

TEST(EvaluateHeatmap, EqualsThePublishedFiguresOnTheLivingRoom) {
  EVOLIN_REQUIRE_SHARED_DATA();
  const std::filesystem::path sample = data() / "icl_nuim_lr_sample";
  const std::filesystem::path predictions = sample / "predictions";
  checkHeatmap(predictions / "unscored", predictions / "scored",
               predictions / "heatmap_score_thresholds.txt", sample / "gt_lines", sample / "rgb",
               data() / "golden" / "icl");
}

class GoldenHeatmap : public ::testing::TestWithParam<std::string> {};

TEST_P(GoldenHeatmap, EqualsThePublishedFigures) {
  EVOLIN_REQUIRE_SHARED_DATA();
  const std::filesystem::path set = data() / "golden" / "sets" / GetParam();
  checkHeatmap(set / "scored_lines" / "lines", set / "scored_lines",
               set / "scored_lines" / "score_thresholds.txt", set / "gt_lines", set / "images",
               set / "expected");
}

INSTANTIATE_TEST_SUITE_P(EvaluateHeatmap, GoldenHeatmap, ::testing::Values("basic", "edge"),
                         [](const auto& info) { return info.param; });

void checkAssociation(const std::filesystem::path& folder, const std::filesystem::path& expected) {
  expectGolden(evaluate({"association", "-p", (folder / "pred_associations").string(), "-g",
                         (folder / "gt_associations").string()}),
               expected);
}

TEST(EvaluateAssociation, EqualsThePublishedFiguresOnTheExample) {
  EVOLIN_REQUIRE_SHARED_DATA();
  checkAssociation(data() / "association_example",
                   data() / "golden" / "icl" / "association_classification.json");
}

class GoldenAssociations : public ::testing::TestWithParam<std::string> {};

TEST_P(GoldenAssociations, EqualThePublishedFigures) {
  EVOLIN_REQUIRE_SHARED_DATA();
  const std::filesystem::path set = data() / "golden" / "sets" / GetParam();
  checkAssociation(set, set / "expected" / "association_classification.json");
}

INSTANTIATE_TEST_SUITE_P(EvaluateAssociation, GoldenAssociations,
                         ::testing::Values("basic", "edge", "association/plain",
                                           "association/duplicates", "association/empty_pred",
                                           "association/single_pred"),
                         [](const auto& info) {
                           return info.param.substr(info.param.find('/') + 1);
                         });

/// With every value's number replaced and without white space at the ends.
std::string formOf(const std::string& text) {
  static const std::regex kValue(R"("value": [-+.0-9e]+)");
  const std::string form = std::regex_replace(text, kValue, R"("value": #)");
  return form.substr(0, form.find_last_not_of(" \n") + 1);
}

std::vector<std::string> repeatabilityArguments(const std::filesystem::path& sequence,
                                                const std::filesystem::path& lines) {
  return {"repeatability",
          "--pred-lines",
          lines.string(),
          "--depths",
          (sequence / "depth").string(),
          "--poses",
          (sequence / "poses.txt").string(),
          "--depth-associations",
          (sequence / "depth_associations.txt").string(),
          "--calibration-matrix",
          (sequence / "calibration_matrix.txt").string()};
}

/// Also the names, their order and the order of keys, by the text itself.
void checkRepeatability(std::vector<std::string> arguments, const std::vector<std::string>& more,
                        const std::filesystem::path& expected) {
  arguments.insert(arguments.end(), more.begin(), more.end());
  const std::string text = evaluateText(arguments);
  EXPECT_EQ(formOf(text), formOf(readText(expected)));
  expectGolden(json::parse(text), expected);
}

void checkScoredRepeatability(const std::filesystem::path& sequence,
                              const std::filesystem::path& scored, std::vector<std::string> more,
                              const std::filesystem::path& expected) {
  more.insert(more.end(), {"--scores", (scored / "scores").string(), "--score-thresholds",
                           (scored / "score_thresholds.txt").string()});
  checkRepeatability(repeatabilityArguments(sequence, scored / "lines"), more, expected);
}

TEST(EvaluateRepeatability, EqualsThePublishedFiguresOnTheLivingRoom) {
  EVOLIN_REQUIRE_SHARED_DATA();
  const std::filesystem::path sample = data() / "icl_nuim_lr_sample";
  const std::filesystem::path expected = data() / "golden" / "icl";
  checkRepeatability(repeatabilityArguments(sample, sample / "predictions" / "unscored"),
                     {"-f", "1"}, expected / "repeatability_unscored.json");
  checkScoredRepeatability(sample, sample / "predictions" / "scored", {"-f", "1"},
                           expected / "repeatability_scored.json");
}

class GoldenRepeatability
    : public ::testing::TestWithParam<std::pair<std::string, std::vector<std::string>>> {};

TEST_P(GoldenRepeatability, EqualsThePublishedFigures) {
  EVOLIN_REQUIRE_SHARED_DATA();
  const auto& [name, steps] = GetParam();
  const std::filesystem::path set = data() / "golden" / "sets" / name;
  std::vector<std::string> more = {"--frames-steps"};
  more.insert(more.end(), steps.begin(), steps.end());
  checkRepeatability(repeatabilityArguments(set, set / "scored_lines" / "lines"), more,
                     set / "expected" / "repeatability_unscored.json");
  checkScoredRepeatability(set, set / "scored_lines", more,
                           set / "expected" / "repeatability_scored.json");
}

INSTANTIATE_TEST_SUITE_P(EvaluateRepeatability, GoldenRepeatability,
                         ::testing::Values(std::make_pair("basic",
                                                          std::vector<std::string>{"1", "2"}),
                                           std::make_pair("edge", std::vector<std::string>{"1"})),
                         [](const auto& info) { return info.param.first; });

TEST(EvaluateRepeatability, EqualsThePublishedHeadlinesOfTheTimingSet) {
  EVOLIN_REQUIRE_SHARED_DATA();
  const std::filesystem::path set = data() / "golden" / "sets" / "timing";
  const test::TemporaryFolder folder;
  std::vector<std::string> arguments = repeatabilityArguments(set, set / "scored_lines" / "lines");
  arguments.insert(arguments.end(),
                   {"--scores", (set / "scored_lines" / "scores").string(), "--score-thresholds",
                    folder.write("threshold.txt", "0.4\n").string(), "-f", "1"});
  const json entries = evaluate(arguments);
  ASSERT_EQ(entries.size(), 12U);
  const json expected =
      readJson(set / "expected" / "summary.json")["repeatability_step1_score_gt_0.4 (rep, loc)"];
  ASSERT_EQ(expected.size(), 6U);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const json& about = entries[i]["additional_information"]["distance_information"];
    const std::string key =
        about["distance"].get<std::string>() + "_" +
        std::to_string(static_cast<int>(about["distance_threshold"].get<double>()));
    EXPECT_NEAR(entries[i]["value"].get<double>(), expected[key][i % 2].get<double>(), kTolerance)
        << key << ", " << entries[i]["name"];
  }
}

}  // namespace
}  // namespace evolin::cli
