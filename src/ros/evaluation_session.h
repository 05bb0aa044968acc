// What the evaluator nodelet keeps between its callbacks: the evaluation under its lock, the worker
// of heavy tasks, the metric topics and the report on disk.
#pragma once

#include <ros/node_handle.h>
#include <ros/time.h>
#include <std_msgs/Header.h>

#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "evaluator_options.h"
#include "evolin_ros/evaluation/stream_evaluator.h"
#include "metric_publishers.h"
#include "report_keeper.h"
#include "task_worker.h"
#include "wall_throttle.h"

namespace evolin::ros_shell {

/// Safe for several threads.
class EvaluationSession {
 public:
  struct Log {
    std::function<void(const std::string&)> warning;
    std::function<void(const std::string&)> error;
  };

  /// What an input brought about that the log should tell.
  struct Told {
    std::vector<std::string> notes;
    std::vector<std::string> warnings;
    std::optional<int> finished_pass;   ///< time jumped back or settings changed: it is over
    std::string changed_settings;       ///< as EvaluationUpdate's
    std::optional<Stamp> image_offset;  ///< as EvaluationUpdate's
  };

  /// `handle` advertises the topics, `private_handle` names the parameters that reports carry;
  /// `owner` is the nodelet's name. Throws as ReportKeeper.
  EvaluationSession(ros::NodeHandle& handle, const ros::NodeHandle& private_handle,
                    const EvaluatorOptions& options, const std::string& owner, Log log);

  /// Writes what passes that are over have not on disk yet.
  ~EvaluationSession();
  EvaluationSession(const EvaluationSession&) = delete;
  EvaluationSession& operator=(const EvaluationSession&) = delete;
  EvaluationSession(EvaluationSession&&) = delete;
  EvaluationSession& operator=(EvaluationSession&&) = delete;

  const ReportKeeper& keeper() const { return keeper_; }

  /// Takes a part of a frame or of a pair: `add` is called with the evaluator under the lock.
  template <class Add>
  Told take(const std_msgs::Header& header, const Add& add) {
    return takeIn(&header, add);
  }

  /// Takes what belongs beside a frame, as depth and poses: a stream of them that goes on does not
  /// keep drain() waiting.
  template <class Add>
  Told takeBeside(const Add& add) {
    return takeIn(nullptr, add);
  }

  /// No lines, or no matches, of a frame will come: `leave_out` is called with the evaluator under
  /// the lock.
  template <class LeaveOut>
  void leaveOut(const LeaveOut& leave_out) {
    const std::lock_guard<std::mutex> lock(mutex_);
    noteInput(true);
    leave_out(&evaluator_);
  }

  /// Sums cost more than a frame's own figures (average precision sorts all predictions), so they
  /// go out at a period of their own, unless `now`.
  void publishSums(bool now);

  /// Writes the report, and those of passes that are over and changed since they were written.
  /// Returns the path of report.json; throws Error naming the file. `confidence`: whether its
  /// figures get their intervals, which may take seconds (the evaluation goes on meanwhile).
  std::filesystem::path save(bool complete, bool confidence);

  /// The report as it would be written now, as JSON.
  std::string reportAsJson();

  /// While paused, what comes is counted as skipped.
  void pause(bool paused);

  /// Of the newest pass, and whether it is paused.
  std::pair<CoverageCounts, bool> coverage() const;

  std::size_t tasksWaiting() const { return worker_.waiting(); }
  std::size_t taskCapacity() const { return worker_.capacity(); }

  /// A snapshot where something new came in; errors go to the log.
  void saveChanges();

  /// The same once nothing has come for the idle timeout; a pass that is over is written at once.
  void saveWhenIdle();

  /// Returns once every frame that was heard of has its lines and matches, or will get none, and
  /// every task is done, or nothing has come for so long that nothing will; false when `stopped`
  /// says so before. Tasks that are left then are broken off and counted as skipped.
  bool drain(const std::function<bool()>& stopped, const std::function<MayCome()>& may_come);

  /// Forgets all figures and sends empty sums.
  void reset();

 private:
  template <class Add>
  Told takeIn(const std_msgs::Header* header, const Add& add) {
    EvaluationUpdate update;
    std::optional<int> finished;
    int pass = 0;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      noteInput(header != nullptr);
      update = add(&evaluator_);
      handOut(&update);
      if (update.new_pass) {
        if (auto released = evaluator_.takeReleased()) {
          released_.push_back(std::move(*released));
        }
        finished = evaluator_.pass() - 1;
      }
      if (header != nullptr) {
        last_header_ = *header;
      }
      metrics_.publish(update, last_header_);
      pass = evaluator_.pass();
      if (header != nullptr) {
        last_input_ = ros::WallTime::now();  // a long add is no silence
      }
    }
    if (header != nullptr) {
      keepParameters(pass);
    }
    return {std::move(update.notes), std::move(update.warnings), finished,
            std::move(update.changed_settings), update.image_offset};
  }

  void noteInput(bool of_frame);
  /// With save_mutex_ held.
  std::filesystem::path saveNewest(bool complete, bool confidence);
  void handOut(EvaluationUpdate* update);
  void onResult(const EvaluationResult& result);
  bool waitForTheRest(const std::function<bool()>& stopped,
                      const std::function<MayCome()>& may_come);
  void giveUpTasks();
  void keepParameters(int pass);
  void addProvenance(Report* report) const;
  std::filesystem::path write(Report report);
  void writeFinished();

  EvaluatorOptions options_;
  ros::NodeHandle handle_;
  ros::NodeHandle private_handle_;
  Log log_;
  ReportKeeper keeper_;
  MetricPublishers metrics_;
  WallThrottle errors_;
  std::mutex save_mutex_;  ///< taken before mutex_
  std::mutex sums_mutex_;  ///< taken before mutex_
  mutable std::mutex parameters_mutex_;
  /// Of the methods, by pass, as they were when it began: guarded by parameters_mutex_.
  std::map<int, std::map<std::string, std::string>> parameters_;
  mutable std::mutex mutex_;  ///< guards what follows, up to the blank line
  StreamEvaluator evaluator_;
  std::deque<std::pair<int, PassEvaluation>> released_;  ///< passes that wait to be written
  bool previous_unwritten_ = false;
  int written_passes_ = 0;  ///< passes that are over, at least once on disk
  ros::WallTime last_input_;
  double longest_gap_ = 0;  ///< between two inputs, s of wall time
  std::size_t inputs_ = 0;
  std::size_t saved_inputs_ = 0;
  std::optional<std::size_t> published_inputs_ = 0;  ///< none: the sums must go out
  ros::WallTime next_sums_;
  std_msgs::Header last_header_;
  bool queue_told_ = false;

  TaskWorker worker_;  ///< last: its thread uses all of the above
};

}  // namespace evolin::ros_shell
