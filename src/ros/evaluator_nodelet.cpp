// The nodelet evolin_ros/Evaluator: lines, ground truth and matches in; metrics, coverage and a
// report on disk out.
#include <ros/callback_queue.h>
#include <ros/spinner.h>
#include <std_srvs/Trigger.h>
#include <pluginlib/class_list_macros.hpp>

#include <algorithm>
#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>

#include "conversions.h"
#include "evaluator_options.h"
#include "evolin_ros/base/error.h"
#include "evolin_ros/evaluation/stream_evaluator.h"
#include "metric_publishers.h"
#include "motion_inputs.h"
#include "node_parameters.h"
#include "report_keeper.h"
#include "safe_nodelet.h"
#include "task_worker.h"
#include "topic_watchdog.h"
#include "topics.h"
#include "wall_throttle.h"

namespace evolin::ros_shell {

class EvaluatorNodelet : public SafeNodelet {
 public:
  /// A ~finish that waits is broken off and writes what there is.
  ~EvaluatorNodelet() override {
    stopping_ = true;
    service_spinner_.stop();
  }

 private:
  using Trigger = std_srvs::Trigger;

  /// Of the cumulative topics, s of wall time.
  static constexpr double kPublishPeriod = 0.5;

  void start() override {
    options_ = readEvaluatorOptions(privateParameters(getPrivateNodeHandle()), getName());
    evaluator_ = std::make_unique<StreamEvaluator>(options_.pass);
    keeper_ = std::make_unique<ReportKeeper>(options_.output_dir, getName());
    if (keeper_->replacesEarlier()) {
      NODELET_WARN("the report of an earlier run in %s will be replaced, its pass_N with it",
                   keeper_->folder().c_str());
    }
    watchdog_ = std::make_unique<TopicWatchdog>(getMTNodeHandle(), getName(), options_.warn_after);
    last_input_ = ros::WallTime::now();
    metrics_ = std::make_unique<MetricPublishers>(getNodeHandle(), options_.pass);
    worker_ = std::make_unique<TaskWorker>(
        TaskOptions{options_.pass.evaluation.heatmap, options_.pass.motion.pose_method},
        static_cast<std::size_t>(options_.task_queue),
        [this](const EvaluationResult& result) { onResult(result); });
    subscribe();
    offerServices();
    NODELET_INFO("protocol %s, report in %s",
                 toString(options_.pass.evaluation.vectorized.protocol).c_str(),
                 keeper_->folder().c_str());
  }

  /// All inputs share the single-threaded queue, so that each stays in its own order.
  void subscribe() {
    ros::NodeHandle& handle = getNodeHandle();
    expect(topics::kLines, "evolin_ros/LineArray", "Remap 'lines' to the front-end's topic.");
    expect(topics::kGroundTruthLines, "evolin_ros/LineArray",
           "Play a bag that has it, or load evolin_ros/GroundTruth on an annotation folder.");
    lines_ = handle.subscribe(topics::kLines, kResultQueue, &EvaluatorNodelet::onLines, this);
    ground_truth_ = handle.subscribe(topics::kGroundTruthLines, kResultQueue,
                                     &EvaluatorNodelet::onGroundTruth, this);
    matches_ = handle.subscribe(topics::kMatches, kResultQueue, &EvaluatorNodelet::onMatches, this);
    camera_info_ =
        handle.subscribe(topics::kCameraInfo, kResultQueue, &EvaluatorNodelet::onCameraInfo, this);
    const MetricFamilies& families = options_.pass.families;
    if (families.count(MetricFamily::kRepeatability) + families.count(MetricFamily::kPose) > 0) {
      motion_inputs_ = std::make_unique<MotionInputs>(
          handle, options_,
          MotionInputs::Callbacks{[this](const std_msgs::Header& header, DepthMap depth) {
                                    takeBeside([&] {
                                      return evaluator_->addDepth(fromRos(header.stamp),
                                                                  std::move(depth));
                                    });
                                  },
                                  [this](const StampedPose& pose) {
                                    takeBeside([&] { return evaluator_->addPose(pose); });
                                  },
                                  [this](const std::string& text) { warn(text); }});
    }
  }

  void warn(const std::string& text) {
    if (warnings_.due()) {
      NODELET_WARN("%s", text.c_str());
    }
  }

  /// Services have a thread of their own: ~finish waits while messages come in, however few threads
  /// the manager has.
  void offerServices() {
    ros::NodeHandle handle = getMTPrivateNodeHandle();
    save_timer_ =
        handle.createWallTimer(ros::WallDuration(options_.save_period),
                               [this](const ros::WallTimerEvent&) { saveQuietly(false); });
    idle_timer_ = handle.createWallTimer(ros::WallDuration(0.1),
                                         [this](const ros::WallTimerEvent&) { saveWhenIdle(); });
    publish_timer_ =
        handle.createWallTimer(ros::WallDuration(kPublishPeriod),
                               [this](const ros::WallTimerEvent&) { publishSums(false); });
    handle.setCallbackQueue(&service_queue_);
    save_ = handle.advertiseService(services::kSaveReport, &EvaluatorNodelet::onSave, this);
    reset_ = handle.advertiseService(services::kReset, &EvaluatorNodelet::onReset, this);
    // Last: whoever sees ~finish may start to send.
    finish_ = handle.advertiseService(services::kFinish, &EvaluatorNodelet::onFinish, this);
    service_spinner_.start();
  }

  void expect(const std::string& topic, const std::string& type, const std::string& hint) {
    watchdog_->expect(getNodeHandle().resolveName(topic), type, hint);
  }

  void onLines(const evolin_ros::LineArrayConstPtr& message) {
    take(topics::kLines, lines_, message->header,
         [&] { return evaluator_->addLines(fromMessage(*message)); });
    wantPose(message->header);
  }

  void onGroundTruth(const evolin_ros::LineArrayConstPtr& message) {
    take(topics::kGroundTruthLines, ground_truth_, message->header,
         [&] { return evaluator_->addGroundTruth(fromMessage(*message)); });
    wantPose(message->header);
  }

  void onMatches(const evolin_ros::LineMatchArrayConstPtr& message) {
    take(topics::kMatches, matches_, message->header, [&] {
      matches_heard_ = true;
      return evaluator_->addMatches(fromMessage(*message));
    });
  }

  void onCameraInfo(const sensor_msgs::CameraInfoConstPtr& message) {
    take(topics::kCameraInfo, camera_info_, message->header,
         [&] { return evaluator_->addImage(fromRos(message->header.stamp)); });
    takeCamera(*message);
    wantPose(message->header);
  }

  void takeCamera(const sensor_msgs::CameraInfo& message) {
    if (!motion_inputs_ || camera_refused_) {
      return;
    }
    try {
      const Camera camera = fromMessage(message);
      takeBeside([&] { return evaluator_->setCamera(camera); });
    } catch (const Error& error) {
      camera_refused_ = true;
      NODELET_WARN("%s: %s; repeatability and relative pose are not evaluated",
                   getNodeHandle().resolveName(topics::kCameraInfo).c_str(), error.what());
    }
  }

  /// Once the image, lines or ground truth of this header are known.
  void wantPose(const std_msgs::Header& header) {
    if (motion_inputs_) {
      motion_inputs_->wantPose(header);
    }
  }

  /// Depth and poses belong to frames, they are none: a stream of them that goes on does not keep
  /// ~finish waiting.
  template <class Add>
  void takeBeside(const Add& add) {
    EvaluationUpdate update;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      ++inputs_;
      update = add();
      handOut(&update);
      metrics_->publish(update, last_header_);
    }
    for (const std::string& note : update.notes) {
      warn(note);
    }
  }

  void onResult(const EvaluationResult& result) {
    EvaluationUpdate update;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      last_input_ = ros::WallTime::now();
      ++inputs_;
      update = evaluator_->addResult(result);
      metrics_->publish(update, last_header_);
    }
    for (const std::string& note : update.notes) {
      warn(note);
    }
  }

  /// Gives the update's tasks to the worker; what does not fit is counted.
  void handOut(EvaluationUpdate* update) {
    for (EvaluationTask& task : update->tasks) {
      if (!worker_->add(task)) {
        evaluator_->skip(task);
        if (!queue_told_) {
          queue_told_ = true;
          NODELET_WARN(
              "%d heatmaps and pose estimates wait already: what comes is left out and counted in "
              "coverage; play slower, or raise ~task_queue, or take them out of ~metrics",
              options_.task_queue);
        }
      }
    }
    update->tasks.clear();
  }

  template <class Add>
  void take(const std::string& topic, const ros::Subscriber& subscriber,
            const std_msgs::Header& header, const Add& add) {
    const std::string name = getNodeHandle().resolveName(topic);
    const unsigned publishers = subscriber.getNumPublishers();
    watchdog_->heard(name);
    std::optional<Report> released;
    std::optional<Report> finished;
    EvaluationUpdate update;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      const ros::WallTime now = ros::WallTime::now();
      if (inputs_ > 0) {
        longest_gap_ = std::max(longest_gap_, (now - last_input_).toSec());
      }
      last_input_ = now;
      ++inputs_;
      update = add();
      if (update.new_pass) {
        released = evaluator_->takeReleasedReport();
        finished = evaluator_->previousReport();
      }
      handOut(&update);
      metrics_->publish(update, header);
      last_header_ = header;
    }
    for (const std::string& warning : update.warnings) {
      NODELET_WARN("%s (publishers: %u): %s", name.c_str(), publishers, warning.c_str());
    }
    for (const std::string& note : update.notes) {
      if (warnings_.due()) {
        NODELET_WARN("%s: %s", name.c_str(), note.c_str());
      }
    }
    if (released) {
      writeQuietly(std::move(*released));
    }
    if (finished) {
      NODELET_INFO("%s: time jumped back to %.6f, pass %d begins", name.c_str(),
                   header.stamp.toSec(), finished->pass + 1);
      if (publishers > 1 && crowded_.insert(name).second) {
        NODELET_WARN(
            "%s has %u publishers and time jumped back to %.6f: where their stamps interleave, "
            "every jump begins a pass; keep one of them",
            name.c_str(), publishers, header.stamp.toSec());
      }
      writeQuietly(std::move(*finished));
    }
  }

  /// Sums cost more than a frame's own figures (average precision sorts all predictions), so they
  /// go out at a period of their own.
  void publishSums(bool now) {
    const std::lock_guard<std::mutex> lock(mutex_);
    const ros::WallTime begin = ros::WallTime::now();
    if (inputs_ == published_inputs_ || (!now && begin < next_sums_)) {
      return;
    }
    published_inputs_ = inputs_;
    metrics_->publishSums(*evaluator_, last_header_);
    // On a long run the sums must not take the inputs' time.
    constexpr double kShare = 20;
    next_sums_ = ros::WallTime::now() + (ros::WallTime::now() - begin) * kShare;
  }

  /// What a report must carry to be understood later; asks the parameter server, so not under the
  /// lock.
  void addProvenance(Report* report) {
    int images = 0;
    if (getPrivateNodeHandle().getParam("input/images", images) && images >= 0) {
      report->input_images = static_cast<std::size_t>(images);
    }
    report->provenance["parameters"] = parametersAsJson(getPrivateNodeHandle().getNamespace());
    for (const std::string& name : options_.record_parameters) {
      const std::string resolved = getNodeHandle().resolveName(name);
      report->provenance["parameters of " + resolved] = parametersAsJson(resolved);
    }
  }

  std::filesystem::path write(Report report) {
    addProvenance(&report);
    int newest = 0;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      newest = evaluator_->pass();
    }
    return keeper_->write(std::move(report), newest);
  }

  /// The parts of the pass before may still have changed it; both are written.
  std::filesystem::path save(bool complete) {
    // Written in the order in which they are built: a snapshot must not land on a final report.
    const std::lock_guard<std::mutex> one_at_a_time(save_mutex_);
    std::optional<Report> earlier;
    Report report;
    std::size_t inputs = 0;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      earlier = evaluator_->previousReport();
      report = evaluator_->report(complete);
      inputs = inputs_;
    }
    if (earlier) {
      write(std::move(*earlier));
    }
    std::filesystem::path file = write(std::move(report));
    const std::lock_guard<std::mutex> lock(mutex_);
    saved_inputs_ = inputs;
    return file;
  }

  void writeQuietly(Report report) {
    try {
      write(std::move(report));
    } catch (const std::exception& error) {
      if (errors_.due()) {
        NODELET_ERROR("%s", error.what());
      }
    }
  }

  void saveQuietly(bool complete) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (inputs_ == saved_inputs_) {
        return;
      }
    }
    try {
      save(complete);
    } catch (const std::exception& error) {
      if (errors_.due()) {
        NODELET_ERROR("%s", error.what());
      }
    }
  }

  void saveWhenIdle() {
    double idle = 0;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      idle = (ros::WallTime::now() - last_input_).toSec();
    }
    if (idle > options_.idle_timeout) {
      saveQuietly(false);
    }
  }

  bool onSave(Trigger::Request& /*request*/, Trigger::Response& response) {
    return answer(&response, [this] { return save(false); });
  }

  bool onFinish(Trigger::Request& /*request*/, Trigger::Response& response) {
    const bool complete = drain();
    publishSums(true);
    return answer(&response, [this, complete] { return save(complete); });
  }

  bool onReset(Trigger::Request& /*request*/, Trigger::Response& response) {
    {
      const std::scoped_lock lock(save_mutex_, mutex_);
      evaluator_->reset();
      keeper_->startOver();
      longest_gap_ = 0;
      matches_heard_ = false;
      last_header_ = {};
      published_inputs_.reset();
    }
    // What is latched is of figures that are forgotten.
    publishSums(true);
    response.success = true;
    response.message = "all figures are forgotten; the next message begins pass 1";
    NODELET_INFO("%s", response.message.c_str());
    return true;
  }

  template <class Save>
  bool answer(Trigger::Response* response, const Save& save_now) {
    try {
      response->message = save_now().string();
      response->success = true;
    } catch (const std::exception& error) {
      response->message = error.what();
      response->success = false;
      NODELET_ERROR("%s", error.what());
    }
    return true;
  }

  /// Returns once every frame that was heard of has its lines and matches, or nothing has come for
  /// so long that nothing will; false when the node is being stopped before that.
  bool drain() {
    constexpr double kSettled = 0.3;
    // A slow method's next result may be a few of its longest pauses away.
    constexpr double kPauses = 4;
    constexpr double kLongest = 30;
    while (ros::ok() && !stopping_) {
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        const double idle = (ros::WallTime::now() - last_input_).toSec();
        const double patience =
            std::max(options_.drain_timeout, std::min(kPauses * longest_gap_, kLongest));
        const bool first_match_due = !matches_heard_ && matches_.getNumPublishers() > 0;
        if (idle > (evaluator_->waiting() || first_match_due ? patience : kSettled)) {
          return true;
        }
      }
      ros::WallDuration(0.02).sleep();
    }
    return false;
  }

  ros::CallbackQueue service_queue_;  ///< outlives the services
  ros::AsyncSpinner service_spinner_{1, &service_queue_};
  std::atomic<bool> stopping_{false};

  EvaluatorOptions options_;
  std::mutex save_mutex_;  ///< taken before mutex_
  std::mutex mutex_;       ///< guards what follows, up to the blank line
  std::unique_ptr<StreamEvaluator> evaluator_;
  ros::WallTime last_input_;
  double longest_gap_ = 0;  ///< between two inputs, s of wall time
  bool matches_heard_ = false;
  std::size_t inputs_ = 0;
  std::size_t saved_inputs_ = 0;
  std::optional<std::size_t> published_inputs_ = 0;  ///< none: the sums must go out
  ros::WallTime next_sums_;
  std_msgs::Header last_header_;
  bool queue_told_ = false;

  bool camera_refused_ = false;
  std::set<std::string> crowded_;  ///< topics of several publishers that a warning has named
  std::unique_ptr<ReportKeeper> keeper_;
  WallThrottle warnings_;
  WallThrottle errors_;
  std::unique_ptr<TopicWatchdog> watchdog_;
  std::unique_ptr<MetricPublishers> metrics_;
  std::unique_ptr<MotionInputs> motion_inputs_;
  ros::Subscriber lines_;
  ros::Subscriber ground_truth_;
  ros::Subscriber matches_;
  ros::Subscriber camera_info_;
  ros::WallTimer save_timer_;
  ros::WallTimer idle_timer_;
  ros::WallTimer publish_timer_;
  ros::ServiceServer save_;
  ros::ServiceServer reset_;
  ros::ServiceServer finish_;
  std::unique_ptr<TaskWorker> worker_;  ///< last: its thread uses all of the above
};

}  // namespace evolin::ros_shell

PLUGINLIB_EXPORT_CLASS(evolin::ros_shell::EvaluatorNodelet, nodelet::Nodelet)
