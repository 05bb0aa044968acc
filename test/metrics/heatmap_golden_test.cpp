// Pixel counts of single frames against those of the published implementation.
#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "evolin_ros/dataset/csv.h"
#include "evolin_ros/metrics/heatmap.h"
#include "test/support/shared_data.h"

namespace evolin {
namespace {

using nlohmann::json;

constexpr ImageSize kSize{640, 480};

json readJson(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return json::parse(stream);
}

std::filesystem::path setFolder(const std::string& name) {
  return test::sharedFolder() / "data" / "golden" / "sets" / name;
}

/// Adds frame `number` of a set whose images are all 640 x 480.
void addFrame(const std::filesystem::path& set, std::uint32_t number, HeatmapMetrics* metrics) {
  const std::string digits = std::to_string(number);
  const std::string file = std::string(4 - digits.size(), '0') + digits + ".csv";
  metrics->addFrame(number, file, kSize,
                    readScoredLinesCsv(set / "scored_lines" / "lines" / file,
                                       set / "scored_lines" / "scores" / file),
                    readLinesCsv(set / "gt_lines" / file));
}

void expectCounts(const Classification& counts, const json& expected, const json& ground_truth,
                  const std::string& where) {
  EXPECT_EQ(counts.true_positives, expected["tp"].get<std::uint64_t>()) << where;
  EXPECT_EQ(counts.predicted, expected["pred_pixels"].get<std::uint64_t>()) << where;
  EXPECT_EQ(counts.ground_truth, ground_truth.get<std::uint64_t>()) << where;
}

class HeatmapDetail : public ::testing::TestWithParam<std::string> {};

TEST_P(HeatmapDetail, EveryFrameHasThePublishedCounts) {
  EVOLIN_REQUIRE_SHARED_DATA();
  const std::filesystem::path set = setFolder(GetParam());
  const json frames = readJson(set / "expected" / "detail_heatmap.json")["frames"];
  ASSERT_FALSE(frames.empty());
  for (std::size_t number = 0; number < frames.size(); ++number) {
    for (const json& expected : frames[number]["thresholds"]) {
      const json& threshold = expected["threshold"];
      HeatmapOptions options;
      options.score_thresholds = {threshold.is_null() ? std::numeric_limits<double>::lowest()
                                                      : threshold.get<double>()};
      HeatmapMetrics metrics(options);
      addFrame(set, static_cast<std::uint32_t>(number), &metrics);
      expectCounts(metrics.classification(), expected, frames[number]["gt_pixels"],
                   "frame " + std::to_string(number) + ", threshold " + threshold.dump());
    }
  }
}

INSTANTIATE_TEST_SUITE_P(HeatmapGolden, HeatmapDetail, ::testing::Values("basic", "edge"),
                         [](const auto& info) { return info.param; });

TEST(HeatmapGolden, DenseFramesHaveThePublishedCountsAtEveryThreshold) {
  EVOLIN_REQUIRE_SHARED_DATA();
  const std::filesystem::path set = setFolder("timing");
  HeatmapOptions options;
  options.score_thresholds = readNumbers(set / "scored_lines" / "score_thresholds.txt");
  HeatmapMetrics metrics(options);
  addFrame(set, 0, &metrics);
  addFrame(set, 1, &metrics);
  const json rows = readJson(set / "expected" / "heatmap_rows_frames_0_1.json");
  ASSERT_EQ(rows.size(), 2 * metrics.settings());
  for (const json& row : rows) {
    std::size_t setting = 0;
    while (setting < metrics.settings() &&
           metrics.scoreThresholds()[setting] != row["threshold"].get<double>()) {
      ++setting;
    }
    ASSERT_LT(setting, metrics.settings()) << row;
    const auto frame = row["frame"].get<std::size_t>();
    expectCounts(metrics.frameClassifications(setting)[frame], row, row["gt_pixels"], row.dump());
  }
}

}  // namespace
}  // namespace evolin
