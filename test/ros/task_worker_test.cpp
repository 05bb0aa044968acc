// Tasks in order on a thread of their own, broken off where nobody waits for them any more.
#include "src/ros/task_worker.h"

#include <gtest/gtest.h>

#include <chrono>
#include <future>
#include <mutex>
#include <vector>

#include "test/support/random_lines.h"

namespace evolin::ros_shell {
namespace {

/// Far more than breaking off takes on a busy machine, far less than the task itself.
constexpr std::chrono::seconds kPatience{20};

EvaluationTask heatmapOf(int side, std::size_t lines, Stamp stamp) {
  test::RandomLines random(7);
  HeatmapTask task;
  task.stamp = stamp;
  task.size = {side, side};
  task.ground_truth = random.anywhere(lines, side - 1.0, side - 1.0);
  task.lines = random.anywhere(4 * lines, side - 1.0, side - 1.0);
  return {1, 1, task};
}

/// Takes minutes.
EvaluationTask hugeHeatmap(Stamp stamp) { return heatmapOf(6000, 1000, stamp); }

EvaluationTask smallHeatmap(Stamp stamp) { return heatmapOf(64, 3, stamp); }

class Results {
 public:
  TaskWorker::Done done() {
    return [this](const EvaluationResult& result) {
      const std::lock_guard<std::mutex> lock(mutex_);
      records_.push_back(std::get<HeatmapRecord>(result.record));
    };
  }

  std::vector<HeatmapRecord> records() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return records_;
  }

  bool waitForCount(std::size_t count) const {
    const auto end = std::chrono::steady_clock::now() + kPatience;
    while (records().size() < count && std::chrono::steady_clock::now() < end) {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return records().size() >= count;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<HeatmapRecord> records_;
};

TEST(TaskWorker, DoesTasksInOrder) {
  Results results;
  TaskWorker worker({}, 10, results.done());
  for (Stamp stamp = 1; stamp <= 5; ++stamp) ASSERT_TRUE(worker.add(smallHeatmap(stamp)));
  ASSERT_TRUE(results.waitForCount(5));
  const std::vector<HeatmapRecord> records = results.records();
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(records[i].stamp, static_cast<Stamp>(i + 1));
    EXPECT_EQ(records[i].reason, "");
  }
}

TEST(TaskWorker, CancelBreaksTheRunningTaskOffAndGivesTheRestBack) {
  Results results;
  TaskWorker worker({}, 10, results.done());
  ASSERT_TRUE(worker.add(smallHeatmap(1)));
  ASSERT_TRUE(worker.add(hugeHeatmap(2)));
  ASSERT_TRUE(worker.add(smallHeatmap(3)));
  ASSERT_TRUE(worker.add(smallHeatmap(4)));
  ASSERT_TRUE(results.waitForCount(1));
  const auto begin = std::chrono::steady_clock::now();
  std::vector<EvaluationTask> left = worker.cancel();
  EXPECT_LT(std::chrono::steady_clock::now() - begin, kPatience);
  // The huge one may not have begun yet.
  std::vector<HeatmapRecord> records = results.records();
  EXPECT_EQ(records.size() + left.size(), 4U);
  EXPECT_EQ(std::get<HeatmapTask>(left.back().work).stamp, 4);
  if (records.size() == 2) {
    EXPECT_EQ(records[1].stamp, 2);
    EXPECT_NE(records[1].reason.find("still being measured"), std::string::npos)
        << records[1].reason;
    EXPECT_TRUE(records[1].counts.empty());
  }
  // It goes on with what comes next.
  ASSERT_TRUE(worker.add(smallHeatmap(5)));
  ASSERT_TRUE(results.waitForCount(records.size() + 1));
  EXPECT_EQ(results.records().back().stamp, 5);
  EXPECT_EQ(results.records().back().reason, "");
  EXPECT_TRUE(worker.cancel().empty());
}

TEST(TaskWorker, ItsEndWaitsForNoLongTask) {
  Results results;
  const auto begin = std::chrono::steady_clock::now();
  {
    TaskWorker worker({}, 10, results.done());
    ASSERT_TRUE(worker.add(hugeHeatmap(1)));
    ASSERT_TRUE(worker.add(hugeHeatmap(2)));
  }
  EXPECT_LT(std::chrono::steady_clock::now() - begin, kPatience);
  EXPECT_LE(results.records().size(), 1U);
}

TEST(TaskWorker, AFullQueueTakesNothing) {
  Results results;
  TaskWorker worker({}, 1, results.done());
  std::size_t taken = 0;
  for (Stamp stamp = 1; stamp <= 5; ++stamp) taken += worker.add(hugeHeatmap(stamp)) ? 1 : 0;
  // One runs at most, one waits.
  EXPECT_GE(taken, 1U);
  EXPECT_LE(taken, 2U);
}

}  // namespace
}  // namespace evolin::ros_shell
