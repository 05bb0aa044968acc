// A manager that ends in mid-stream leaves the report of what it had evaluated, less a period of
// saving.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <mutex>

#include "evolin_ros/DetectionMetrics.h"
#include "online_stream.h"
#include "test/support/drawn_sequence.h"

namespace evolin::test {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kSavePeriod = 0.2;
/// What a busy machine may add to the period before a report is on disk, s.
constexpr double kRoom = 1.3;

/// When each frame's figures came.
class EvaluationTimes {
 public:
  explicit EvaluationTimes(const std::string& space)
      : subscriber_(ros::NodeHandle().subscribe<evolin_ros::DetectionMetrics>(
            space + "/metrics/detection/frame", 10000,
            [this](const evolin_ros::DetectionMetrics::ConstPtr&) {
              const std::lock_guard<std::mutex> lock(mutex_);
              times_.push_back(Clock::now());
            })) {}
  ~EvaluationTimes() { subscriber_.shutdown(); }
  EvaluationTimes(const EvaluationTimes&) = delete;
  EvaluationTimes& operator=(const EvaluationTimes&) = delete;

  std::size_t countBefore(Clock::time_point limit) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return static_cast<std::size_t>(
        std::count_if(times_.begin(), times_.end(),
                      [&](const Clock::time_point& time) { return time <= limit; }));
  }

 private:
  mutable std::mutex mutex_;
  std::vector<Clock::time_point> times_;
  ros::Subscriber subscriber_;
};

void endInMidStream(int signal) {
  BenchOptions options;
  options.save_period = kSavePeriod;
  Bench bench(options);
  const EvaluationTimes times(bench.space());
  const auto age = std::chrono::duration_cast<Clock::duration>(
      std::chrono::duration<double>(kSavePeriod + kRoom));
  const Camera30 camera(&bench.publisher());
  ASSERT_TRUE(waitFor("frames that were evaluated longer ago than a period of saving",
                      [&] { return times.countBefore(Clock::now() - age) >= 10; }));

  const std::size_t due = times.countBefore(Clock::now() - age);
  bench.manager().process().send(signal);
  const std::optional<int> status = bench.manager().process().wait(kPatience);
  ASSERT_TRUE(status.has_value()) << "the manager did not end";
  if (signal == SIGKILL) {
    EXPECT_EQ(*status, -SIGKILL);
  }

  const nlohmann::json report = bench.report();
  EXPECT_EQ(report.at("complete"), false);
  const auto evaluated = report.at("coverage").at("evaluated").get<std::size_t>();
  EXPECT_GE(evaluated, due);
  EXPECT_EQ(report.at("detection").at("frames"), evaluated);
  EXPECT_GT(report.at("detection").at("entries")[0].at("counts").at("true_positives"), 0);
  EXPECT_TRUE(std::filesystem::exists(bench.folder() / "summary.md"));
  EXPECT_TRUE(std::filesystem::exists(bench.folder() / "frames.csv"));
}

TEST(OnlineInterrupt, SigintLeavesAReadableReport) { endInMidStream(SIGINT); }

TEST(OnlineInterrupt, SigkillLeavesAReadableReport) { endInMidStream(SIGKILL); }

}  // namespace
}  // namespace evolin::test
