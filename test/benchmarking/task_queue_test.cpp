// Tasks begin behind what they wait for, or never.
#include "evolin_ros/benchmarking/task_queue.h"

#include <gtest/gtest.h>

namespace evolin {
namespace {

using Tasks = std::vector<std::size_t>;

TEST(TaskQueue, WithoutDependenciesTasksBeginInTheirOrder) {
  TaskQueue queue;
  EXPECT_FALSE(queue.busy());
  EXPECT_EQ(queue.add({}), 0U);
  EXPECT_EQ(queue.add({}), 1U);
  EXPECT_EQ(queue.next(), 0U);
  EXPECT_EQ(queue.next(), 1U);
  EXPECT_EQ(queue.next(), std::nullopt);
  EXPECT_TRUE(queue.busy()) << "both are begun";
  queue.finish(1);
  queue.finish(0);
  EXPECT_FALSE(queue.busy());
}

TEST(TaskQueue, ATaskBeginsOnceWhatItWaitsForHasEnded) {
  TaskQueue queue;
  const std::size_t first = queue.add({});
  const std::size_t second = queue.add(first);
  const std::size_t third = queue.add(second);
  const std::size_t other = queue.add({});
  EXPECT_EQ(queue.next(), first);
  EXPECT_EQ(queue.next(), other) << "the others do not wait";
  EXPECT_EQ(queue.next(), std::nullopt);
  queue.finish(first);
  EXPECT_EQ(queue.next(), second);
  EXPECT_EQ(queue.next(), std::nullopt);
  queue.finish(second);
  EXPECT_EQ(queue.next(), third);
}

TEST(TaskQueue, BehindAFailureNothingBegins) {
  TaskQueue queue;
  const std::size_t first = queue.add({});
  const std::size_t second = queue.add(first);
  const std::size_t third = queue.add(second);
  const std::size_t beside = queue.add(first);
  const std::size_t other = queue.add({});
  EXPECT_EQ(queue.next(), first);
  EXPECT_EQ(queue.fail(first), (Tasks{second, third, beside}));
  EXPECT_EQ(queue.next(), other);
  queue.finish(other);
  EXPECT_EQ(queue.next(), std::nullopt);
  EXPECT_FALSE(queue.busy());
}

TEST(TaskQueue, ATaskBehindOneThatHasEndedMayBegin) {
  TaskQueue queue;
  const std::size_t first = queue.add({});
  queue.next();
  queue.finish(first);
  EXPECT_EQ(queue.next(), std::nullopt);
  const std::size_t second = queue.add(first);
  EXPECT_EQ(queue.next(), second);
}

}  // namespace
}  // namespace evolin
