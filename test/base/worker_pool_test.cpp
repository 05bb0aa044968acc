// Every task is done once, whatever the number of workers.
#include "evolin_ros/base/worker_pool.h"

#include <gtest/gtest.h>

#include <atomic>
#include <set>

namespace evolin {
namespace {

TEST(WorkerPool, DoesEveryTaskOnceRoundAfterRound) {
  for (const int workers : {1, 2, 5}) {
    WorkerPool pool(workers);
    ASSERT_EQ(pool.size(), static_cast<std::size_t>(workers));
    for (const std::size_t tasks : {0, 1, 3, 100}) {
      std::vector<std::atomic<int>> done(tasks);
      pool.forEach(tasks, [&](std::size_t task, std::size_t worker) {
        EXPECT_LT(worker, pool.size());
        ++done[task];
      });
      for (const std::atomic<int>& times : done) {
        EXPECT_EQ(times, 1) << workers << " workers, " << tasks << " tasks";
      }
    }
  }
}

TEST(WorkerPool, AWorkerIsNeverInTwoTasksAtATime) {
  WorkerPool pool(4);
  std::vector<std::atomic<int>> inside(pool.size());
  std::atomic<int> overlaps{0};
  pool.forEach(2000, [&](std::size_t /*task*/, std::size_t worker) {
    overlaps += inside[worker]++ == 0 ? 0 : 1;
    --inside[worker];
  });
  EXPECT_EQ(overlaps, 0);
}

TEST(WorkerPool, WorkersWorkAtTheSameTime) {
  WorkerPool pool(2);
  // Each task waits for the other one: a single worker would never come back.
  std::atomic<int> begun{0};
  pool.forEach(2, [&](std::size_t /*task*/, std::size_t /*worker*/) {
    ++begun;
    while (begun < 2) {
      std::this_thread::yield();
    }
  });
  EXPECT_EQ(begun, 2);
}

TEST(WorkerPool, OneWorkerIsTheCaller) {
  WorkerPool pool(1);
  std::set<std::thread::id> threads;
  std::vector<std::size_t> order;
  pool.forEach(5, [&](std::size_t task, std::size_t /*worker*/) {
    threads.insert(std::this_thread::get_id());
    order.push_back(task);
  });
  EXPECT_EQ(threads, std::set<std::thread::id>{std::this_thread::get_id()});
  EXPECT_EQ(order, (std::vector<std::size_t>{0, 1, 2, 3, 4}));
}

}  // namespace
}  // namespace evolin
