// Figures of frames come back as they were kept, and a pass keeps little besides them.
#include "evolin_ros/evaluation/frame_figures.h"

#include <gtest/gtest.h>
#include <malloc.h>

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>
#include <vector>

#include "test/evaluation/sample_frames.h"
#include "test/support/random_lines.h"

namespace {

std::atomic<std::ptrdiff_t> bytes_in_use{0};

void release(void* memory) {
  bytes_in_use -= memory == nullptr ? 0 : static_cast<std::ptrdiff_t>(malloc_usable_size(memory));
  std::free(memory);
}

}  // namespace

// All memory of this program is counted, that of the libraries too.
void* operator new(std::size_t size) {
  void* const memory = std::malloc(size);
  if (memory == nullptr) {
    throw std::bad_alloc();
  }
  bytes_in_use += static_cast<std::ptrdiff_t>(malloc_usable_size(memory));
  return memory;
}

void operator delete(void* memory) noexcept { release(memory); }

void operator delete(void* memory, std::size_t) noexcept { release(memory); }

namespace evolin {
namespace {

using test::annotated;
using test::detected;
using test::kSecond;

constexpr std::size_t kLines = 100;
constexpr std::size_t kThresholds = 20;

/// As many frames, one after the other, with every result that is asked for.
class LongPass {
 public:
  LongPass() : pass_(options()), runner_({options().evaluation.heatmap, {}}) {}

  void addFrames(int count) {
    for (int i = 0; i < count; ++i, stamp_ += kSecond / 30) {
      LineSegments truth = random_.anywhere(20, 120, 120);
      for (std::size_t row = 0; row < truth.size(); ++row) {
        truth[row].id = static_cast<std::int64_t>(row);
      }
      const LineSegments lines = random_.detectionsOf(truth, static_cast<int>(kLines), 3);
      run(pass_.addGroundTruth(annotated(stamp_, truth)));
      run(pass_.addLines(detected(stamp_, lines)));
    }
  }

  const PassEvaluation& pass() const { return pass_; }
  const std::vector<FrameRecord>& published() const { return published_; }
  void forgetPublished() { published_ = std::vector<FrameRecord>(); }

 private:
  static PassOptions options() {
    PassOptions options;
    options.buffer = 40;
    for (std::size_t i = 0; i < kThresholds; ++i) {
      options.evaluation.heatmap.score_thresholds.push_back(0.05 * static_cast<double>(i));
    }
    return options;
  }

  void run(const EvaluationUpdate& update) {
    published_.insert(published_.end(), update.frames.begin(), update.frames.end());
    for (const EvaluationTask& task : update.tasks) {
      const EvaluationResult result = runner_.run(task);
      published_.back().heatmap = std::get<HeatmapRecord>(result.record).counts;
      pass_.addResult(result);
    }
  }

  test::RandomLines random_{7};
  PassEvaluation pass_;
  TaskRunner runner_;
  Stamp stamp_ = kSecond;
  std::vector<FrameRecord> published_;
};

void expectEqual(const Classification& a, const Classification& b) {
  EXPECT_EQ(a.true_positives, b.true_positives);
  EXPECT_EQ(a.predicted, b.predicted);
  EXPECT_EQ(a.ground_truth, b.ground_truth);
}

TEST(FrameFigures, ComeBackAsTheyWerePublished) {
  LongPass pass;
  pass.addFrames(5);
  const std::vector<FrameRecord> kept = pass.pass().report(true).frames;
  ASSERT_EQ(kept.size(), 5U);
  ASSERT_EQ(pass.published().size(), 5U);
  for (std::size_t frame = 0; frame < kept.size(); ++frame) {
    const FrameRecord& published = pass.published()[frame];
    ASSERT_EQ(kept[frame].entries.size(), 6U);
    ASSERT_EQ(published.entries.size(), 6U);
    for (std::size_t i = 0; i < published.entries.size(); ++i) {
      EXPECT_EQ(kept[frame].entries[i].setting.distance, published.entries[i].setting.distance);
      EXPECT_EQ(kept[frame].entries[i].setting.threshold, published.entries[i].setting.threshold);
      EXPECT_EQ(kept[frame].entries[i].average_precision, published.entries[i].average_precision);
      EXPECT_TRUE(published.entries[i].average_precision.has_value());
      expectEqual(kept[frame].entries[i].counts, published.entries[i].counts);
    }
    ASSERT_EQ(kept[frame].heatmap.size(), kThresholds);
    for (std::size_t i = 0; i < kThresholds; ++i) {
      expectEqual(kept[frame].heatmap[i], published.heatmap[i]);
    }
  }
}

TEST(FrameFigures, KeepTheLackOfAnAveragePrecision) {
  FrameRecord record;
  record.entries.resize(2);
  record.entries[0].average_precision = 0;
  FrameFigures figures;
  figures.keepDetection(&record);
  EXPECT_TRUE(record.entries.empty());
  figures.restore(std::vector<VectorizedSetting>(2), &record);
  EXPECT_EQ(record.entries[0].average_precision, 0.0);
  EXPECT_FALSE(record.entries[1].average_precision.has_value());
  EXPECT_TRUE(record.heatmap.empty());
}

TEST(FrameFigures, AreMostOfWhatAPassKeepsOfAFrame) {
  constexpr int kFrames = 400;
  LongPass pass;
  pass.addFrames(100);  // the buffers are full
  pass.forgetPublished();
  const std::ptrdiff_t before = bytes_in_use;
  pass.addFrames(kFrames);
  pass.forgetPublished();
  const double bytes_a_frame = static_cast<double>(bytes_in_use - before) / kFrames;
  // 16 a prediction, in a vector that may have as much to spare; figures, state and map node.
  const double most = 2.0 * 16 * kLines + 16 * 6 + 8 * kThresholds + 600;
  EXPECT_LT(bytes_a_frame, most);
  EXPECT_GT(bytes_a_frame, 16 * kLines) << "the frames are not counted";
  RecordProperty("bytes_a_frame", static_cast<int>(bytes_a_frame));
}

}  // namespace
}  // namespace evolin
