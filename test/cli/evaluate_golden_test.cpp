// `evolin evaluate` against the published implementation's own output: folders in, JSON out.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

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

/// Runs the program with --output and returns what it wrote.
json evaluate(std::vector<std::string> arguments) {
  const test::TemporaryFolder folder;
  const std::string output = (folder.path() / "out").string();
  arguments.insert(arguments.begin(), "evaluate");
  arguments.insert(arguments.end(), {"--output", output, "--output-file", "result.json"});
  ::testing::internal::CaptureStdout();
  const int status = runProgram({evaluateCommand()}, arguments);
  ::testing::internal::GetCapturedStdout();
  EXPECT_EQ(status, kExitDone);
  return status == kExitDone ? readJson(folder.path() / "out" / "result.json") : json();
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

}  // namespace
}  // namespace evolin::cli
