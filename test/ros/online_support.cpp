// Bounded waits, and the in-process evaluation that online figures are compared with.
#include "online_support.h"

#include <ros/time.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <fstream>
#include <set>

#include "plugin_loader.h"

namespace evolin::test {

namespace {

void expectCounts(const nlohmann::json& counts, const Classification& expected) {
  EXPECT_EQ(counts.at("true_positives"), expected.true_positives);
  EXPECT_EQ(counts.at("predicted"), expected.predicted);
  EXPECT_EQ(counts.at("ground_truth"), expected.ground_truth);
}

void expectRatios(const nlohmann::json& row, const Classification& expected) {
  EXPECT_NEAR(row.at("precision").get<double>(), expected.precision(), 1e-12);
  EXPECT_NEAR(row.at("recall").get<double>(), expected.recall(), 1e-12);
  EXPECT_NEAR(row.at("f_score").get<double>(), expected.fScore(), 1e-12);
}

}  // namespace

::testing::AssertionResult waitFor(const std::string& what, const std::function<bool()>& condition,
                                   double seconds) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) {
      return ::testing::AssertionFailure() << "waited " << seconds << " s for " << what;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return ::testing::AssertionSuccess();
}

std::string callTrigger(const std::string& name, double seconds) {
  const auto answer = tryService<std_srvs::Trigger>(name, {}, seconds);
  if (!answer) {
    throw std::runtime_error(name + " is not there or broke off");
  }
  if (answer->success == 0) {
    throw std::runtime_error(name + " refused: " + answer->message);
  }
  return answer->message;
}

std::string testNamespace() {
  const ::testing::TestInfo* info = ::testing::UnitTest::GetInstance()->current_test_info();
  std::string name = std::string("/") + info->test_suite_name() + "_" + info->name();
  std::replace_if(
      name.begin() + 1, name.end(), [](unsigned char letter) { return std::isalnum(letter) == 0; },
      '_');
  return name;
}

std::string whyUnavailable(const std::string& detector) {
  PluginLoader loader;
  return loader.loadDetector(detector)->whyUnavailable();
}

std::vector<LineSet> detectLines(const std::vector<SequenceFrame>& frames,
                                 const std::string& detector_name) {
  PluginLoader loader;
  const std::shared_ptr<LineDetector> detector = loader.loadDetector(detector_name);
  detector->configure(YAML::Node());
  std::vector<LineSet> all;
  for (const SequenceFrame& sequence_frame : frames) {
    const Frame& frame = sequence_frame.frame;
    LineSet set;
    set.stamp = frame.stamp;
    set.source = detector_name;
    set.width = frame.image.cols;
    set.height = frame.image.rows;
    set.lines = detector->detect(frame);
    set.scored = detector->givesScores();
    all.push_back(std::move(set));
  }
  return all;
}

std::vector<MatchSet> associateLines(const std::vector<SequenceFrame>& frames,
                                     const std::vector<LineSet>& lines, const Methods& methods) {
  PluginLoader loader;
  const std::shared_ptr<LineAssociator> associator = loader.loadAssociator(methods.associator);
  associator->configure(YAML::Node());
  std::vector<FrameLines> described;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    described.push_back({frames[i].frame, lines[i].lines, {}});
  }
  std::vector<MatchSet> all;
  const auto step = static_cast<std::size_t>(methods.frame_step);
  for (std::size_t i = 0; i + step < frames.size(); ++i) {
    MatchSet set;
    set.first_stamp = frames[i].frame.stamp;
    set.stamp = frames[i + step].frame.stamp;
    set.source = methods.associator;
    set.lines_source = lines[i].source;
    set.matches = associator->match(described[i], described[i + step]);
    all.push_back(std::move(set));
  }
  return all;
}

LineSet groundTruthOf(const SequenceFrame& frame) {
  LineSet set;
  set.stamp = frame.frame.stamp;
  set.source = "ground_truth";
  set.width = frame.frame.image.cols;
  set.height = frame.frame.image.rows;
  set.lines = frame.ground_truth.value();
  return set;
}

Expected evaluateLines(const std::vector<SequenceFrame>& frames, std::vector<LineSet> lines,
                       const Methods& methods) {
  Expected expected;
  SequenceEvaluator evaluator;
  expected.seen = frames.size();
  std::vector<SequenceFrame> annotated;
  std::vector<LineSet> ground_truth;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (!frames[i].ground_truth) {
      continue;
    }
    annotated.push_back(frames[i]);
    ground_truth.push_back(groundTruthOf(frames[i]));
    expected.frames.push_back(
        evaluator.addFrame(static_cast<std::uint32_t>(i), lines[i], ground_truth.back()));
  }
  if (!methods.associator.empty()) {
    const std::vector<MatchSet> matches = associateLines(annotated, ground_truth, methods);
    for (std::size_t i = 0; i < matches.size(); ++i) {
      const std::size_t second = i + static_cast<std::size_t>(methods.frame_step);
      expected.pairs.push_back(
          evaluator.addPair(matches[i], ground_truth[i].lines, ground_truth[second].lines));
    }
  }
  expected.lines = std::move(lines);
  expected.detection = evaluator.detectionEntries();
  expected.association = evaluator.association().classification();
  return expected;
}

Expected evaluateInProcess(const std::vector<SequenceFrame>& frames, const Methods& methods) {
  return evaluateLines(frames, detectLines(frames, methods.detector), methods);
}

nlohmann::json readReport(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) {
    throw std::runtime_error(path.string() + ": no such report");
  }
  try {
    return nlohmann::json::parse(file);
  } catch (const nlohmann::json::exception& error) {
    throw std::runtime_error(path.string() + ": not strict JSON: " + error.what());
  }
}

void expectDetection(const nlohmann::json& report, const Expected& expected) {
  const nlohmann::json& detection = report.at("detection");
  EXPECT_EQ(detection.at("frames"), expected.frames.size());
  const nlohmann::json& entries = detection.at("entries");
  ASSERT_EQ(entries.size(), expected.detection.size());
  for (std::size_t i = 0; i < entries.size(); ++i) {
    SCOPED_TRACE("detection entry " + std::to_string(i));
    const DetectionEntry& entry = expected.detection[i];
    EXPECT_EQ(entries[i].at("distance"), toString(entry.setting.distance));
    EXPECT_EQ(entries[i].at("threshold"), entry.setting.threshold);
    expectCounts(entries[i].at("counts"), entry.counts);
    expectRatios(entries[i], entry.counts);
    const nlohmann::json& precision = entries[i].at("average_precision");
    ASSERT_EQ(precision.is_number(), entry.average_precision.has_value()) << precision;
    if (entry.average_precision) {
      EXPECT_NEAR(precision.get<double>(), *entry.average_precision, 1e-12);
    }
  }
}

void expectAssociation(const nlohmann::json& report, const Expected& expected) {
  const nlohmann::json& association = report.at("association");
  ASSERT_EQ(association.at("pairs"), expected.pairs.size()) << association;
  expectCounts(association.at("counts"), expected.association);
  if (!expected.pairs.empty()) {
    expectRatios(association, expected.association);
  }
}

void expectCoverage(const nlohmann::json& report, std::size_t seen, std::size_t evaluated,
                    const std::map<std::string, std::size_t>& reasons) {
  const nlohmann::json& coverage = report.at("coverage");
  EXPECT_EQ(coverage.at("seen"), seen);
  EXPECT_EQ(coverage.at("evaluated"), evaluated);
  for (const auto& [name, value] : coverage.items()) {
    if (name == "seen" || name == "evaluated" || name == "input_images" || name == "reason") {
      continue;
    }
    const auto reason = reasons.find(name);
    // Outside the sum: most streams of the tests have neither.
    static const std::set<std::string> kOutside = {"no_depth", "no_pose", "waiting_depth",
                                                   "waiting_pose"};
    if (reason == reasons.end() && kOutside.count(name) > 0) {
      continue;
    }
    EXPECT_EQ(value, reason == reasons.end() ? 0 : reason->second) << name;
  }
}

namespace {

/// `reason`: there is one here or around; `of_nothing`: no frame or pair is in the figures.
void expectReasonsIn(const nlohmann::json& value, const std::string& path, bool reason,
                     bool of_nothing) {
  static const std::set<std::string> kFigures = {"precision",
                                                 "recall",
                                                 "f_score",
                                                 "average_precision",
                                                 "repeatability",
                                                 "localization_error",
                                                 "rotation_median_deg",
                                                 "success_rate",
                                                 "translation_median_m",
                                                 "translation_angle_median_deg",
                                                 "spatial_spread"};
  if (value.is_object()) {
    reason = reason || (value.contains("reason") && !value.at("reason").get<std::string>().empty());
    for (const char* count : {"frames", "pairs"}) {
      of_nothing = of_nothing || (value.contains(count) && value.at(count) == 0);
    }
    for (const auto& [name, member] : value.items()) {
      const std::string below = path + "/" + name;
      EXPECT_TRUE(!member.is_null() || reason) << below << " is null without a reason";
      EXPECT_TRUE(member.is_null() || !of_nothing || kFigures.count(name) == 0)
          << below << " is a figure of nothing: " << member;
      expectReasonsIn(member, below, reason, of_nothing);
    }
  } else if (value.is_array()) {
    for (std::size_t i = 0; i < value.size(); ++i) {
      expectReasonsIn(value[i], path + "/" + std::to_string(i), reason, of_nothing);
    }
  }
}

}  // namespace

void expectReasons(const nlohmann::json& report) { expectReasonsIn(report, "", false, false); }

void expectWholeReport(const nlohmann::json& report, const Expected& expected) {
  EXPECT_EQ(report.at("complete"), true);
  expectCoverage(report, expected.seen, expected.frames.size());
  expectDetection(report, expected);
  expectAssociation(report, expected);
}

}  // namespace evolin::test
