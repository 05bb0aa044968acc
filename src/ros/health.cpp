// A window of ten seconds, and totals.
#include "health.h"

#include <diagnostic_msgs/DiagnosticStatus.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "evolin_ros/base/error.h"

namespace evolin::ros_shell {

namespace {

using diagnostic_msgs::DiagnosticStatus;
using diagnostic_updater::DiagnosticStatusWrapper;

constexpr double kWindow = 10;  ///< s
/// Enough for a percentile; a fast stream must not cost memory.
constexpr std::size_t kMostKept = 5000;
constexpr double kMilliseconds = 1000;

std::string shortText(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

/// How bad `value` is where more is worse.
unsigned char levelAbove(double value, const HealthLimits::Level& level) {
  if (level.error > 0 && value >= level.error) {
    return DiagnosticStatus::ERROR;
  }
  return level.warn > 0 && value >= level.warn ? DiagnosticStatus::WARN : DiagnosticStatus::OK;
}

/// How bad `value` is where less is worse.
unsigned char levelBelow(double value, const HealthLimits::Level& level) {
  if (value < level.error) {
    return DiagnosticStatus::ERROR;
  }
  return value < level.warn ? DiagnosticStatus::WARN : DiagnosticStatus::OK;
}

/// The value that `share` of the sorted ones do not exceed.
double percentile(const std::vector<double>& sorted, double share) {
  const double rank = std::ceil(share * static_cast<double>(sorted.size())) - 1;
  return sorted[static_cast<std::size_t>(std::max(rank, 0.0))];
}

template <class Times>
void dropOlder(const ros::WallTime& oldest, Times* times) {
  while (!times->empty() && (times->front() < oldest || times->size() > kMostKept)) {
    times->pop_front();
  }
}

}  // namespace

HealthLimits readHealthLimits(ParameterReader* reader, const std::string& owner) {
  constexpr double kMost = 1e6;
  HealthLimits limits;
  reader->read("diagnostic_period", &limits.period, 0.05, 3600);
  ParameterReader levels(reader->readMap("diagnostics"), owner + "/diagnostics");
  const auto read = [&](const std::string& name, HealthLimits::Level* level, double most) {
    levels.read(name + "_warn", &level->warn, 0, most);
    levels.read(name + "_error", &level->error, 0, most);
  };
  read("silence", &limits.silence, kMost);
  read("rate", &limits.rate, kMost);
  read("latency", &limits.latency, kMost);
  read("drops", &limits.drops, 1);
  read("queue", &limits.queue, kMost);
  read("coverage", &limits.coverage, 1);
  levels.read("in_flight", &limits.in_flight, 0, 1000000);
  levels.finish();
  return limits;
}

Health::Health(std::string owner, const HealthLimits& limits)
    : owner_(std::move(owner)), limits_(limits) {}

void Health::start(ros::NodeHandle handle, const ros::NodeHandle& private_handle) {
  updater_ = std::make_unique<diagnostic_updater::Updater>(handle, private_handle, owner_);
  updater_->setHardwareID("none");
  updater_->add("inputs", this, &Health::tellInputs);
  updater_->add("latency", this, &Health::tellLatency);
  if (queue_) {
    updater_->add("queue", this, &Health::tellQueue);
  }
  updater_->add("drops", this, &Health::tellDrops);
  if (coverage_) {
    updater_->add("coverage", this, &Health::tellCoverage);
  }
  timer_ = handle.createWallTimer(ros::WallDuration(limits_.period),
                                  [this](const ros::WallTimerEvent&) { updater_->force_update(); });
}

void Health::stop() { timer_.stop(); }

void Health::expect(const std::string& topic) {
  const std::lock_guard<std::mutex> lock(mutex_);
  Input& input = inputs_[topic];
  input.first = input.since = Clock::now();
}

void Health::forget(const std::string& topic) {
  const std::lock_guard<std::mutex> lock(mutex_);
  inputs_.erase(topic);
}

void Health::heard(const std::string& topic) {
  const Clock now = Clock::now();
  const std::lock_guard<std::mutex> lock(mutex_);
  Input& input = inputs_[topic];
  if (input.first.isZero()) {
    input.first = now;
  }
  input.since = now;
  input.recent.push_back(now);
  ++input.count;
  dropOlder(now - ros::WallDuration(kWindow), &input.recent);
}

void Health::finished(double latency, double processing) {
  const Clock now = Clock::now();
  const std::lock_guard<std::mutex> lock(mutex_);
  results_.push_back({now, latency, processing});
  if (results_.size() > kMostKept) {
    results_.pop_front();
  }
  ++finished_;
}

void Health::dropped(const std::string& reason, std::size_t count) {
  if (count == 0) {
    return;
  }
  const Clock now = Clock::now();
  const std::lock_guard<std::mutex> lock(mutex_);
  drops_[reason] += count;
  recent_drops_.insert(recent_drops_.end(), std::min(count, kMostKept), now);
  dropOlder(now - ros::WallDuration(kWindow), &recent_drops_);
}

std::size_t Health::finishedCount() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return finished_;
}

std::map<std::string, std::size_t> Health::drops() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return drops_;
}

std::string Health::dropsText() const {
  std::string text;
  for (const auto& [reason, count] : drops()) {
    text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + reason;
  }
  return text;
}

void Health::forgetOld(const Clock& now) {
  const Clock oldest = now - ros::WallDuration(kWindow);
  for (auto& [topic, input] : inputs_) {
    dropOlder(oldest, &input.recent);
  }
  dropOlder(oldest, &recent_drops_);
  while (!results_.empty() && results_.front().when < oldest) {
    results_.pop_front();
  }
}

void Health::tellInputs(DiagnosticStatusWrapper& status) {
  const Clock now = Clock::now();
  const std::lock_guard<std::mutex> lock(mutex_);
  forgetOld(now);
  status.summary(DiagnosticStatus::OK, inputs_.empty() ? "nobody listens to the results; no input "
                                                         "is subscribed"
                                                       : "messages come in");
  for (const auto& [topic, input] : inputs_) {
    const double silent = (now - input.since).toSec();
    // A stream that has just begun does not look slow.
    const double span = std::clamp((now - input.first).toSec(), 1.0, kWindow);
    const double rate = static_cast<double>(input.recent.size()) / span;
    status.add(topic + " rate (Hz)", rate);
    status.add(topic + " messages", input.count);
    status.add(topic + " silent for (s)", silent);
    if (const unsigned char level = levelAbove(silent, limits_.silence); level > 0) {
      status.mergeSummary(level, "no message on " + topic + " for " + shortText(silent) + " s");
    } else if (const unsigned char slow = levelBelow(rate, limits_.rate); slow > 0) {
      status.mergeSummary(slow, topic + " comes at " + shortText(rate) + " Hz");
    }
  }
}

void Health::tellLatency(DiagnosticStatusWrapper& status) {
  std::vector<double> latencies;
  std::vector<double> processing;
  std::size_t finished = 0;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    forgetOld(Clock::now());
    for (const Result& result : results_) {
      latencies.push_back(result.latency);
      processing.push_back(result.processing);
    }
    finished = finished_;
  }
  status.add("results", finished);
  status.add("rate of results (Hz)", static_cast<double>(latencies.size()) / kWindow);
  if (latencies.empty()) {
    status.summary(DiagnosticStatus::OK, "no result in the last 10 s");
    return;
  }
  std::sort(latencies.begin(), latencies.end());
  std::sort(processing.begin(), processing.end());
  const double late = percentile(latencies, 0.95);
  status.add("latency, median (ms)", percentile(latencies, 0.5) * kMilliseconds);
  status.add("latency, 95 % (ms)", late * kMilliseconds);
  status.add("processing, median (ms)", percentile(processing, 0.5) * kMilliseconds);
  status.add("processing, 95 % (ms)", percentile(processing, 0.95) * kMilliseconds);
  status.summary(levelAbove(late, limits_.latency),
                 "95 % of the results within " + shortText(late * kMilliseconds) + " ms");
}

void Health::tellQueue(DiagnosticStatusWrapper& status) {
  const Fill fill = queue_();
  status.add("waiting", fill.waiting);
  status.add("capacity", fill.capacity == 0 ? "no limit" : std::to_string(fill.capacity));
  status.summary(levelAbove(static_cast<double>(fill.waiting), limits_.queue),
                 std::to_string(fill.waiting) + " inputs wait");
}

void Health::tellDrops(DiagnosticStatusWrapper& status) {
  const std::lock_guard<std::mutex> lock(mutex_);
  forgetOld(Clock::now());
  std::size_t total = 0;
  for (const auto& [reason, count] : drops_) {
    status.add(reason, count);
    total += count;
  }
  const auto recent = static_cast<double>(recent_drops_.size());
  const double all = recent + static_cast<double>(results_.size());
  const double share = all > 0 ? recent / all : 0;
  status.add("share of the last 10 s", share);
  status.summary(levelAbove(share, limits_.drops),
                 total == 0 ? "nothing was dropped" : std::to_string(total) + " dropped so far");
}

void Health::tellCoverage(DiagnosticStatusWrapper& status) {
  const Coverage coverage = coverage_();
  status.add("seen", coverage.seen);
  status.add("evaluated", coverage.evaluated);
  status.add("waiting", coverage.waiting);
  for (const auto& [reason, count] : coverage.reasons) {
    status.add(reason, count);
  }
  for (const Lack& lack : coverage.lacking) {
    status.add(lack.name, lack.count);
  }
  const auto may_wait = static_cast<std::size_t>(limits_.in_flight);
  const std::size_t in_flight = std::min(coverage.waiting, may_wait);
  const std::size_t settled = coverage.seen - std::min(in_flight, coverage.seen);
  if (settled == 0) {
    status.summary(DiagnosticStatus::OK, "no frame is due yet");
    return;
  }
  const auto levelOf = [&](std::size_t count) {
    return levelBelow(static_cast<double>(count) / static_cast<double>(settled), limits_.coverage);
  };
  unsigned char level = levelOf(coverage.evaluated);
  std::string text = std::to_string(coverage.evaluated) + " of " + std::to_string(settled) +
                     " frames that are due were evaluated";
  for (const Lack& lack : coverage.lacking) {
    const std::size_t due = lack.count + lack.waiting - std::min(lack.waiting, may_wait);
    if (due > 0) {
      text += "; " + std::to_string(due) + " " + lack.what;
      const unsigned char warning = DiagnosticStatus::WARN;
      level = std::max(level, std::min(warning, levelOf(settled - std::min(due, settled))));
    }
  }
  status.summary(level, text + (coverage.remark.empty() ? "" : "; " + coverage.remark));
}

}  // namespace evolin::ros_shell
