// How a nodelet fares, for /diagnostics: input rates, latency, queue, drops by reason, coverage.
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>
#include <ros/time.h>

#include <cstddef>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "evolin_ros/base/parameters.h"

namespace evolin::ros_shell {

/// From which value on a status is a warning or an error. 0 switches a level off.
struct HealthLimits {
  struct Level {
    double warn = 0;
    double error = 0;
  };
  double period = 1;             ///< s of wall time between two messages
  Level silence = {5, 0};        ///< s of wall time without a message on an input
  Level rate = {0, 0};           ///< messages a second on an input; less is worse
  Level latency = {0, 0};        ///< s from an input's arrival to its result, 95 % of the results
  Level drops = {0.001, 0.1};    ///< share of the inputs of the last 10 s
  Level queue = {30, 300};       ///< inputs that wait
  Level coverage = {0.99, 0.5};  ///< share of the frames that were evaluated; less is worse
  int in_flight = 30;  ///< frames that may wait for a part without being counted in that share
};

/// Reads ~diagnostic_period and the map ~diagnostics with the keys silence_warn, silence_error,
/// rate_warn and so on. Throws ConfigError naming the key, the value and the range.
HealthLimits readHealthLimits(ParameterReader* reader, const std::string& owner);

/// Safe for several threads. Counts in wall time, so that a stream that stands still with its
/// clock is seen as well.
class Health {
 public:
  struct Fill {
    std::size_t waiting = 0;
    std::size_t capacity = 0;  ///< 0: no limit
  };
  /// Frames, evaluated or not, without what one family needs: a warning where they are too many to
  /// be covered, but never an error.
  struct Lack {
    std::string name;  ///< of the counter
    std::string what;  ///< "without depth"
    std::size_t count = 0;
    std::size_t waiting = 0;  ///< that may still get it
  };
  /// Frames that have come to an end, and how.
  struct Coverage {
    std::size_t seen = 0;
    std::size_t evaluated = 0;
    std::size_t waiting = 0;
    std::string remark;  ///< "paused" or the like
    std::vector<std::pair<std::string, std::size_t>> reasons;
    std::vector<Lack> lacking;
  };

  /// `owner` is the nodelet's name. Nothing is published before start().
  Health(std::string owner, const HealthLimits& limits);
  ~Health() { stop(); }
  Health(const Health&) = delete;
  Health& operator=(const Health&) = delete;

  /// Before start().
  void setQueue(std::function<Fill()> queue) { queue_ = std::move(queue); }
  void setCoverage(std::function<Coverage()> coverage) { coverage_ = std::move(coverage); }

  /// Publishes on /diagnostics from now on; the timer runs on `handle`'s queue.
  void start(ros::NodeHandle handle, const ros::NodeHandle& private_handle);

  /// No function that was set is called once this has returned.
  void stop();

  /// An input whose silence counts, from now on; `topic` is resolved.
  void expect(const std::string& topic);
  /// Not an input for the moment, for example because nobody listens to what comes of it.
  void forget(const std::string& topic);

  void heard(const std::string& topic);
  /// A result is out, `latency` seconds after its input came in; `processing` of them were work.
  void finished(double latency, double processing);
  void dropped(const std::string& reason, std::size_t count = 1);

  std::size_t finishedCount() const;
  std::map<std::string, std::size_t> drops() const;
  /// "3 dropped to keep up, 1 unusable"; "" when nothing was.
  std::string dropsText() const;

 private:
  using Clock = ros::WallTime;
  struct Input {
    Clock first;  ///< expected since
    Clock since;  ///< expected or last heard of
    std::size_t count = 0;
    std::deque<Clock> recent;
  };
  struct Result {
    Clock when;
    double latency;
    double processing;
  };

  void forgetOld(const Clock& now);
  void tellInputs(diagnostic_updater::DiagnosticStatusWrapper& status);
  void tellLatency(diagnostic_updater::DiagnosticStatusWrapper& status);
  void tellQueue(diagnostic_updater::DiagnosticStatusWrapper& status);
  void tellDrops(diagnostic_updater::DiagnosticStatusWrapper& status);
  void tellCoverage(diagnostic_updater::DiagnosticStatusWrapper& status);

  std::string owner_;
  HealthLimits limits_;
  std::function<Fill()> queue_;
  std::function<Coverage()> coverage_;
  mutable std::mutex mutex_;  ///< guards what follows, up to the blank line
  std::map<std::string, Input> inputs_;
  std::deque<Result> results_;
  std::deque<Clock> recent_drops_;
  std::size_t finished_ = 0;
  std::map<std::string, std::size_t> drops_;

  std::unique_ptr<diagnostic_updater::Updater> updater_;
  ros::WallTimer timer_;
};

}  // namespace evolin::ros_shell
