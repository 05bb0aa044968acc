// The nodelet evolin_ros/Evaluator: lines, ground truth and matches in; metrics, coverage and a
// report on disk out.
#include <ros/callback_queue.h>
#include <ros/spinner.h>
#include <std_msgs/Header.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>
#include <pluginlib/class_list_macros.hpp>

#include <atomic>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <utility>

#include "conversions.h"
#include "evaluation_session.h"
#include "evaluator_options.h"
#include "evolin_ros/base/error.h"
#include "health.h"
#include "motion_inputs.h"
#include "node_parameters.h"
#include "safe_nodelet.h"
#include "topic_watchdog.h"
#include "topics.h"
#include "wall_throttle.h"

namespace evolin::ros_shell {

class EvaluatorNodelet : public SafeNodelet {
 public:
  EvaluatorNodelet() = default;
  /// A ~finish that waits is broken off and writes what there is.
  ~EvaluatorNodelet() override {
    stopping_ = true;
    service_spinner_.stop();
    if (health_) {
      health_->stop();
    }
  }
  EvaluatorNodelet(const EvaluatorNodelet&) = delete;
  EvaluatorNodelet& operator=(const EvaluatorNodelet&) = delete;
  EvaluatorNodelet(EvaluatorNodelet&&) = delete;
  EvaluatorNodelet& operator=(EvaluatorNodelet&&) = delete;

 private:
  using Trigger = std_srvs::Trigger;

  /// Of the cumulative topics, s of wall time.
  static constexpr double kPublishPeriod = 0.5;

  /// An evaluator before this one may still hold the folder.
  void prepare() override {
    options_ = readEvaluatorOptions(privateParameters(getPrivateNodeHandle()), getName());
    session_ = std::make_unique<EvaluationSession>(
        getNodeHandle(), getPrivateNodeHandle(), options_, getName(),
        EvaluationSession::Log{
            [this](const std::string& text) { warn(text); },
            [this](const std::string& text) { NODELET_ERROR("%s", text.c_str()); }});
  }

  void start() override {
    const ReportKeeper& keeper = session_->keeper();
    if (keeper.replacesEarlier()) {
      NODELET_WARN("the report of an earlier run in %s will be replaced, its pass_N with it",
                   keeper.folder().c_str());
    }
    watchdog_ = std::make_unique<TopicWatchdog>(getMTNodeHandle(), getName(), options_.warn_after);
    watchHealth();
    subscribe();
    offerServices();
    NODELET_INFO("protocol %s, report in %s",
                 toString(options_.pass.evaluation.vectorized.protocol).c_str(),
                 keeper.folder().c_str());
  }

  void watchHealth() {
    health_ = std::make_unique<Health>(getName(), options_.health);
    health_->setQueue([this] {
      return Health::Fill{session_->tasksWaiting(), session_->taskCapacity()};
    });
    health_->setCoverage([this] { return coverage(); });
    health_->start(getMTNodeHandle(), getPrivateNodeHandle());
  }

  Health::Coverage coverage() const {
    const auto [counts, paused] = session_->coverage();
    return {counts.seen,
            counts.evaluated,
            counts.waiting,
            paused ? "paused" : "",
            {{"unmatched", counts.unmatched},
             {"dropped", counts.dropped},
             {"no_ground_truth", counts.no_ground_truth},
             {"bad_ground_truth", counts.bad_ground_truth},
             {"skipped", counts.skipped}},
            {{"no_depth", "without depth", counts.no_depth, counts.waiting_depth},
             {"no_pose", "without a pose", counts.no_pose, counts.waiting_pose},
             {"bad_lines", "with lines that are not finite", counts.bad_lines, 0},
             {"heatmap_skipped", "without a heatmap", counts.heatmap_skipped, 0},
             {"pose_skipped", "without a relative pose", counts.pose_skipped, 0}}};
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
    lines_left_out_ = subscribeToLeftOut(topics::kLines, &StreamEvaluator::leaveOutLines);
    matches_left_out_ = subscribeToLeftOut(topics::kMatches, &StreamEvaluator::leaveOutMatches);
    camera_info_ =
        handle.subscribe(topics::kCameraInfo, kResultQueue, &EvaluatorNodelet::onCameraInfo, this);
    const MetricFamilies& families = options_.pass.families;
    if (families.count(MetricFamily::kRepeatability) + families.count(MetricFamily::kPose) > 0) {
      motion_inputs_ = std::make_unique<MotionInputs>(
          handle, options_,
          MotionInputs::Callbacks{[this](const std_msgs::Header& header, const DepthMap& depth) {
                                    takeBeside(topics::kDepth, [&](StreamEvaluator* evaluator) {
                                      return evaluator->addDepth(fromRos(header.stamp), depth);
                                    });
                                  },
                                  [this](const StampedPose& pose) {
                                    takeBeside(topics::kGroundTruthPose,
                                               [&](StreamEvaluator* evaluator) {
                                                 return evaluator->addPose(pose);
                                               });
                                  },
                                  [this](const std::string& text) { warn(text); }});
    }
  }

  /// What a method of ours tells of the frames for which `topic` will bring nothing.
  ros::Subscriber subscribeToLeftOut(const std::string& topic,
                                     void (StreamEvaluator::*leave_out)(Stamp)) {
    const boost::function<void(const std_msgs::HeaderConstPtr&)> on_header =
        [this, leave_out](const std_msgs::HeaderConstPtr& header) {
          session_->leaveOut(
              [&](StreamEvaluator* evaluator) { (evaluator->*leave_out)(fromRos(header->stamp)); });
        };
    ros::NodeHandle& handle = getNodeHandle();
    return handle.subscribe<std_msgs::Header>(handle.resolveName(topic) + topics::kLeftOutSuffix,
                                              kResultQueue, on_header);
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
                               [this](const ros::WallTimerEvent&) { session_->saveChanges(); });
    idle_timer_ = handle.createWallTimer(
        ros::WallDuration(0.1), [this](const ros::WallTimerEvent&) { session_->saveWhenIdle(); });
    publish_timer_ = handle.createWallTimer(
        ros::WallDuration(kPublishPeriod),
        [this](const ros::WallTimerEvent&) { session_->publishSums(false); });
    handle.setCallbackQueue(&service_queue_);
    save_ = handle.advertiseService(services::kSaveReport, &EvaluatorNodelet::onSave, this);
    pause_ = handle.advertiseService(services::kPause, &EvaluatorNodelet::onPause, this);
    get_report_ =
        handle.advertiseService(services::kGetReport, &EvaluatorNodelet::onGetReport, this);
    reset_ = handle.advertiseService(services::kReset, &EvaluatorNodelet::onReset, this);
    // Last: whoever sees ~finish may start to send.
    finish_ = handle.advertiseService(services::kFinish, &EvaluatorNodelet::onFinish, this);
    service_spinner_.start();
  }

  void expect(const std::string& topic, const std::string& type, const std::string& hint) {
    const std::string name = getNodeHandle().resolveName(topic);
    watchdog_->expect(name, type, hint);
    health_->expect(name);
  }

  void onLines(const evolin_ros::LineArrayConstPtr& message) {
    lines_heard_ = true;
    take(topics::kLines, lines_, message->header,
         [&](StreamEvaluator* evaluator) { return evaluator->addLines(fromMessage(*message)); });
    wantPose(message->header);
  }

  void onGroundTruth(const evolin_ros::LineArrayConstPtr& message) {
    take(topics::kGroundTruthLines, ground_truth_, message->header,
         [&](StreamEvaluator* evaluator) {
           return evaluator->addGroundTruth(fromMessage(*message));
         });
    wantPose(message->header);
  }

  void onMatches(const evolin_ros::LineMatchArrayConstPtr& message) {
    matches_heard_ = true;
    take(topics::kMatches, matches_, message->header,
         [&](StreamEvaluator* evaluator) { return evaluator->addMatches(fromMessage(*message)); });
  }

  void onCameraInfo(const sensor_msgs::CameraInfoConstPtr& message) {
    take(topics::kCameraInfo, camera_info_, message->header, [&](StreamEvaluator* evaluator) {
      return evaluator->addImage(fromRos(message->header.stamp));
    });
    takeCamera(*message);
    wantPose(message->header);
  }

  void takeCamera(const sensor_msgs::CameraInfo& message) {
    if (!motion_inputs_) {
      return;
    }
    try {
      const Camera camera = fromMessage(message);
      camera_problem_.clear();
      takeBeside(topics::kCameraInfo,
                 [&](StreamEvaluator* evaluator) { return evaluator->setCamera(camera); });
    } catch (const Error& error) {
      std::string text = getNodeHandle().resolveName(topics::kCameraInfo);
      text.append(": ").append(error.what());
      text.append("; without intrinsics, repeatability and relative pose are not evaluated");
      // Once: it comes with every image.
      if (std::exchange(camera_problem_, text) != text) {
        NODELET_WARN("%s", text.c_str());
      }
    }
  }

  /// Once the image, lines or ground truth of this header are known.
  void wantPose(const std_msgs::Header& header) {
    if (motion_inputs_) {
      motion_inputs_->wantPose(header);
    }
  }

  template <class Add>
  void takeBeside(const std::string& topic, const Add& add) {
    tell(getNodeHandle().resolveName(topic), session_->takeBeside(add));
  }

  template <class Add>
  void take(const std::string& topic, const ros::Subscriber& subscriber,
            const std_msgs::Header& header, const Add& add) {
    const std::string name = getNodeHandle().resolveName(topic);
    const unsigned publishers = subscriber.getNumPublishers();
    watchdog_->heard(name);
    health_->heard(name);
    const ros::WallTime begin = ros::WallTime::now();
    const EvaluationSession::Told told = session_->take(header, add);
    const double seconds = (ros::WallTime::now() - begin).toSec();
    health_->finished(seconds, seconds);
    std::string described = name;
    described.append(" (publishers: ").append(std::to_string(publishers)).append(")");
    tell(described, told);
    if (told.finished_pass && told.changed_settings.empty() && publishers > 1 &&
        crowded_.insert(name).second) {
      NODELET_WARN(
          "%s has %u publishers and time jumped back to %.6f: where their stamps interleave, "
          "every jump begins a pass; keep one of them",
          name.c_str(), publishers, header.stamp.toSec());
    }
  }

  void tell(const std::string& topic, const EvaluationSession::Told& told) {
    for (const std::string& warning : told.warnings) {
      NODELET_WARN("%s: %s", topic.c_str(), warning.c_str());
    }
    for (const std::string& note : told.notes) {
      if (warnings_.due()) {
        NODELET_WARN("%s: %s", topic.c_str(), note.c_str());
      }
    }
    if (told.image_offset) {
      NODELET_WARN(
          "%s: its stamps are not those of lines and ground truth, the nearest is %.6f s away, "
          "expected the stamp of its image; it tells of no images then, its intrinsics are taken "
          "all the same",
          getNodeHandle().resolveName(topics::kCameraInfo).c_str(), toSeconds(*told.image_offset));
    }
    if (told.finished_pass && !told.changed_settings.empty()) {
      NODELET_INFO("%s: %s: pass %d begins", topic.c_str(), told.changed_settings.c_str(),
                   *told.finished_pass + 1);
    } else if (told.finished_pass) {
      if (motion_inputs_) {
        motion_inputs_->startPass();
      }
      NODELET_INFO("%s: time jumped back, pass %d begins", topic.c_str(), *told.finished_pass + 1);
    }
  }

  bool onSave(Trigger::Request& /*request*/, Trigger::Response& response) {
    return answer(&response, [this] { return session_->save(false, true); });
  }

  bool onPause(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response) {
    session_->pause(request.data != 0);
    response.success = 1;
    response.message =
        request.data != 0 ? "paused: what comes is counted as skipped" : "the evaluation goes on";
    NODELET_INFO("%s", response.message.c_str());
    return true;
  }

  bool onGetReport(Trigger::Request& /*request*/, Trigger::Response& response) {
    return answer(&response, [this] { return session_->reportAsJson(); });
  }

  bool onFinish(Trigger::Request& /*request*/, Trigger::Response& response) {
    const bool complete =
        session_->drain([this] { return !ros::ok() || stopping_; }, [this] { return mayCome(); });
    session_->publishSums(true);
    return answer(&response, [this, complete] { return session_->save(complete, true); });
  }

  /// Whoever has sent and is gone sends nothing any more.
  MayCome mayCome() const {
    MayCome may_come;
    may_come.lines = !lines_heard_ || lines_.getNumPublishers() > 0;
    may_come.matches = !options_.pass.matches_from_ids && matches_.getNumPublishers() > 0;
    may_come.first_matches = may_come.matches && !matches_heard_;
    return may_come;
  }

  bool onReset(Trigger::Request& /*request*/, Trigger::Response& response) {
    session_->reset();
    lines_heard_ = false;
    matches_heard_ = false;
    response.success = true;
    response.message = "all figures are forgotten; the next message begins pass 1";
    NODELET_INFO("%s", response.message.c_str());
    return true;
  }

  static std::string textOf(const std::filesystem::path& path) { return path.string(); }
  static std::string textOf(const std::string& text) { return text; }

  template <class Save>
  bool answer(Trigger::Response* response, const Save& save_now) {
    try {
      response->message = textOf(save_now());
      response->success = true;
    } catch (const std::exception& error) {
      response->message = error.what();
      response->success = false;
      NODELET_ERROR("%s", error.what());
    }
    return true;
  }

  ros::CallbackQueue service_queue_;  ///< outlives the services
  ros::AsyncSpinner service_spinner_{1, &service_queue_};
  std::atomic<bool> stopping_{false};

  std::atomic<bool> lines_heard_{false};
  std::atomic<bool> matches_heard_{false};

  EvaluatorOptions options_;
  std::set<std::string> crowded_;  ///< topics of several publishers that a warning has named
  std::string camera_problem_;     ///< of the newest camera_info, when it cannot be used
  WallThrottle warnings_;
  std::unique_ptr<EvaluationSession> session_;
  std::unique_ptr<TopicWatchdog> watchdog_;
  std::unique_ptr<Health> health_;
  std::unique_ptr<MotionInputs> motion_inputs_;
  ros::Subscriber lines_;
  ros::Subscriber ground_truth_;
  ros::Subscriber matches_;
  ros::Subscriber lines_left_out_;
  ros::Subscriber matches_left_out_;
  ros::Subscriber camera_info_;
  ros::WallTimer save_timer_;
  ros::WallTimer idle_timer_;
  ros::WallTimer publish_timer_;
  ros::ServiceServer save_;
  ros::ServiceServer pause_;
  ros::ServiceServer get_report_;
  ros::ServiceServer reset_;
  ros::ServiceServer finish_;
};

}  // namespace evolin::ros_shell

PLUGINLIB_EXPORT_CLASS(evolin::ros_shell::EvaluatorNodelet, nodelet::Nodelet)
