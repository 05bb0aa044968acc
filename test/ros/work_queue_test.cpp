// Order, capacity and end of the queue with a thread of its own.
#include "work_queue.h"

#include <gtest/gtest.h>

#include <chrono>
#include <future>
#include <numeric>
#include <vector>

namespace evolin::ros_shell {
namespace {

constexpr std::chrono::seconds kPatience(20);

/// Works on one item until it is let go, so that others have to wait.
struct Gate {
  std::promise<void> entered;
  std::promise<void> open;
  std::vector<int> done;

  void work(int item) {
    if (item == 0) {
      entered.set_value();
      open.get_future().wait_for(kPatience);
    }
    done.push_back(item);
  }
};

TEST(WorkQueue, WorksInOrderAndDropsNothingWithoutALimit) {
  std::vector<int> done;
  std::promise<void> last;
  WorkQueue<int> queue(0, [&](int item) {
    done.push_back(item);
    if (item == 999) {
      last.set_value();
    }
  });
  std::size_t dropped = 0;
  for (int i = 0; i < 1000; ++i) {
    dropped += queue.push(i).size();
  }
  ASSERT_EQ(last.get_future().wait_for(kPatience), std::future_status::ready);
  queue.stop();
  EXPECT_EQ(dropped, 0U);
  std::vector<int> expected(1000);
  std::iota(expected.begin(), expected.end(), 0);
  EXPECT_EQ(done, expected);
}

TEST(WorkQueue, DropsTheOldestThatWait) {
  Gate gate;
  std::promise<void> last;
  WorkQueue<int> queue(2, [&](int item) {
    gate.work(item);
    if (item == 5) {
      last.set_value();
    }
  });
  EXPECT_TRUE(queue.push(0).empty());
  ASSERT_EQ(gate.entered.get_future().wait_for(kPatience), std::future_status::ready);
  EXPECT_TRUE(queue.push(1).empty());
  EXPECT_TRUE(queue.push(2).empty());
  EXPECT_EQ(queue.waiting(), 2U);
  for (int i = 3; i <= 5; ++i) {
    EXPECT_EQ(queue.push(i), std::vector<int>{i - 2});
  }
  EXPECT_EQ(queue.waiting(), 2U);
  gate.open.set_value();
  ASSERT_EQ(last.get_future().wait_for(kPatience), std::future_status::ready);
  queue.stop();
  EXPECT_EQ(gate.done, (std::vector<int>{0, 4, 5}));
}

TEST(WorkQueue, EndsWithTheItemThatIsWorkedOn) {
  Gate gate;
  {
    WorkQueue<int> queue(0, [&](int item) { gate.work(item); });
    queue.push(0);
    ASSERT_EQ(gate.entered.get_future().wait_for(kPatience), std::future_status::ready);
    queue.push(1);
    auto stopped = std::async(std::launch::async, [&] { queue.stop(); });
    EXPECT_EQ(stopped.wait_for(std::chrono::milliseconds(50)), std::future_status::timeout);
    gate.open.set_value();
    ASSERT_EQ(stopped.wait_for(kPatience), std::future_status::ready);
    queue.push(2);
    EXPECT_EQ(queue.waiting(), 1U) << "what waited is left, and nothing more is taken";
  }
  EXPECT_EQ(gate.done, std::vector<int>{0});
}

TEST(WorkQueue, ForgetsWhatWaits) {
  Gate gate;
  std::promise<void> last;
  WorkQueue<int> queue(0, [&](int item) {
    gate.work(item);
    if (item == 3) {
      last.set_value();
    }
  });
  queue.push(0);
  ASSERT_EQ(gate.entered.get_future().wait_for(kPatience), std::future_status::ready);
  queue.push(1);
  queue.push(2);
  EXPECT_EQ(queue.clear(), 2U);
  queue.push(3);
  gate.open.set_value();
  ASSERT_EQ(last.get_future().wait_for(kPatience), std::future_status::ready);
  queue.stop();
  EXPECT_EQ(gate.done, (std::vector<int>{0, 3}));
}

}  // namespace
}  // namespace evolin::ros_shell
