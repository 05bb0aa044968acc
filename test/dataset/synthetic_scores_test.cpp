// Recorded predictions on the synthetic sequence: its own ground truth scores full marks, disturbed
// ground truth less and less.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "evolin_ros/dataset/annotation_folder.h"
#include "evolin_ros/dataset/csv.h"
#include "evolin_ros/dataset/evolin_writer.h"
#include "evolin_ros/dataset/synthetic/synthetic_sequence.h"
#include "evolin_ros/evaluation/sequence_evaluator.h"
#include "test/support/random_lines.h"
#include "test/support/temporary_folder.h"

namespace evolin::synthetic {
namespace {

using test::RandomLines;
using test::TemporaryFolder;

/// The whole sequence's annotations on disk, as `evolin synth` writes them, under images of one
/// pixel: the scores depend on lines alone.
class SyntheticScores : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder();
    const SyntheticSequence sequence{SyntheticOptions{}};
    EvolinWriter writer(folder_->path());
    for (std::size_t i = 0; i < sequence.size(); ++i) {
      SequenceFrame frame;
      frame.frame.stamp = sequence.stamp(i);
      frame.frame.image = cv::Mat(1, 1, CV_8UC1, cv::Scalar(0));
      frame.ground_truth = sequence.groundTruth(i);
      writer.addFrame(i, frame);
    }
    writer.finish();
  }

  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }

  static LineSet lineSet(LineSegments lines, bool scored) {
    LineSet set;
    set.width = 640;
    set.height = 480;
    set.scored = scored;
    set.lines = std::move(lines);
    return set;
  }

  /// Scores the lines of the folder `predictions` against the sequence's own.
  static SequenceEvaluator scored(const AnnotationFolder& predictions, Protocol protocol) {
    const AnnotationFolder truth(folder_->path());
    EvaluationOptions options;
    options.vectorized.protocol = protocol;
    SequenceEvaluator evaluator(options);
    std::uint32_t number = 0;
    for (const std::string& name : truth.names()) {
      evaluator.addFrame(number++, lineSet(*predictions.byName(name), predictions.hasScores()),
                         lineSet(*truth.byName(name), false));
    }
    return evaluator;
  }

  static TemporaryFolder* folder_;
};

TemporaryFolder* SyntheticScores::folder_ = nullptr;

TEST_F(SyntheticScores, GroundTruthAsPredictionsIsPerfect) {
  const AnnotationFolder truth(folder_->path());
  for (const Protocol protocol : {Protocol::kEvolin, Protocol::kPaper}) {
    const SequenceEvaluator evaluator = scored(truth, protocol);
    for (const DetectionEntry& entry : evaluator.detectionEntries()) {
      EXPECT_EQ(entry.counts.predicted, entry.counts.ground_truth);
      EXPECT_EQ(entry.counts.precision(), 1.0) << entry.setting.threshold;
      EXPECT_EQ(entry.counts.recall(), 1.0) << entry.setting.threshold;
      EXPECT_EQ(entry.counts.fScore(), 1.0) << entry.setting.threshold;
      EXPECT_FALSE(entry.average_precision.has_value());  // no scores
    }
  }
}

TEST_F(SyntheticScores, PerfectScoredPredictionsMissTheFirstStepOfTheUnanchoredArea) {
  const AnnotationFolder truth(folder_->path());
  std::filesystem::create_directories(folder_->path() / "perfect" / "lines");
  std::size_t total = 0;
  for (const std::string& name : truth.names()) {
    LineSegments lines = *truth.byName(name);
    for (LineSegment& line : lines) {
      line.score = line.length();
    }
    total += lines.size();
    writeLinesCsv(folder_->path() / "perfect" / "lines" / (name + ".csv"), lines);
    writeScoresCsv(folder_->path() / "perfect" / "scores" / (name + ".csv"), lines);
  }
  const AnnotationFolder predictions(folder_->path() / "perfect");
  // The curve begins at the first prediction, whose recall is one line of all.
  for (const DetectionEntry& entry : scored(predictions, Protocol::kEvolin).detectionEntries()) {
    EXPECT_NEAR(entry.average_precision.value(), 1 - 1.0 / static_cast<double>(total), 1e-9);
  }
  for (const DetectionEntry& entry : scored(predictions, Protocol::kPaper).detectionEntries()) {
    EXPECT_NEAR(entry.average_precision.value(), 1, 1e-9);
  }
}

TEST_F(SyntheticScores, IdsOfTheSequenceMatchThoseReadBack) {
  const SyntheticSequence sequence{SyntheticOptions{}};
  const AnnotationFolder truth(folder_->path());
  ASSERT_TRUE(truth.hasIds());
  for (const std::size_t step : {1U, 10U}) {
    SequenceEvaluator evaluator;
    for (std::size_t i = 0; i + step < sequence.size(); ++i) {
      MatchSet matches;  // by the renderer's ids
      for (const auto& [first, second] :
           pairsOfEqualIds(sequence.groundTruth(i), sequence.groundTruth(i + step))) {
        matches.matches.push_back(
            {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(second), 0});
      }
      EXPECT_GT(matches.matches.size(), 35U);
      evaluator.addPair(matches, *truth.byName(EvolinWriter::stem(i)),
                        *truth.byName(EvolinWriter::stem(i + step)));  // by ids chained on disk
    }
    const Classification& counts = evaluator.association().classification();
    EXPECT_EQ(counts.precision(), 1.0) << "step " << step;
    EXPECT_EQ(counts.recall(), 1.0) << "step " << step;
    EXPECT_EQ(counts.fScore(), 1.0) << "step " << step;
  }
}

TEST_F(SyntheticScores, FallWithDisturbance) {
  const AnnotationFolder truth(folder_->path());
  std::vector<double> last;
  for (const double disturbance : {0.0, 1.0, 2.0, 4.0, 8.0}) {
    const std::filesystem::path lines =
        folder_->path() / ("disturbed_" + std::to_string(disturbance)) / "lines";
    RandomLines random(11);
    const auto normal = [&random] {
      return std::sqrt(-2 * std::log(1 - random.uniform(0, 1))) *
             std::cos(random.uniform(0, 6.283185307179586));
    };
    for (const std::string& name : truth.names()) {
      LineSegments moved = *truth.byName(name);
      for (LineSegment& line : moved) {
        for (double* value : {&line.x1, &line.y1, &line.x2, &line.y2}) {
          *value += disturbance * normal();
        }
      }
      writeLinesCsv(lines / (name + ".csv"), moved);
    }
    const std::vector<DetectionEntry> entries =
        scored(AnnotationFolder(lines), Protocol::kEvolin).detectionEntries();
    std::vector<double> scores;
    scores.reserve(entries.size());
    for (const DetectionEntry& entry : entries) {
      scores.push_back(entry.counts.fScore());
    }
    for (std::size_t i = 0; i < last.size(); ++i) {
      EXPECT_LT(scores[i], last[i]) << toString(entries[i].setting.distance) << " within "
                                    << entries[i].setting.threshold << ", " << disturbance << " px";
    }
    RecordProperty("f_" + std::to_string(disturbance),
                   std::to_string(scores[0]) + " " + std::to_string(scores[3]));
    last = scores;
  }
}

}  // namespace
}  // namespace evolin::synthetic
