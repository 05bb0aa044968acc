// What the tests of running nodelets share: bounded waits, and the figures that an evaluation of
// the same frames inside this process gives.
#pragma once

#include <gtest/gtest.h>
#include <ros/service.h>
#include <std_srvs/Trigger.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "evolin_ros/dataset/sequence_reader.h"
#include "evolin_ros/evaluation/sequence_evaluator.h"

namespace evolin::test {

/// Seconds of wall time after which a wait is a failure: far more than a busy machine needs.
constexpr double kPatience = 40;

/// Polls `condition`; the failure says what was waited for, and how long.
::testing::AssertionResult waitFor(const std::string& what, const std::function<bool()>& condition,
                                   double seconds = kPatience);

/// The answer of a service, or none when it is not there or its handler refused (roscpp tells them
/// not apart); throws std::runtime_error naming it when nothing comes in time.
template <class Service>
std::optional<typename Service::Response> tryService(const std::string& name,
                                                     const typename Service::Request& request,
                                                     double seconds = kPatience) {
  // The call itself knows no limit, so it is left behind on a thread of its own when it hangs.
  struct Call {
    Service service;
    std::promise<bool> done;
  };
  const auto call = std::make_shared<Call>();
  call->service.request = request;
  std::future<bool> answered = call->done.get_future();
  std::thread([call, name] {
    call->done.set_value(ros::service::call(name, call->service));
  }).detach();
  if (answered.wait_for(std::chrono::duration<double>(seconds)) != std::future_status::ready) {
    throw std::runtime_error(name + " did not answer within " + std::to_string(seconds) + " s");
  }
  if (!answered.get()) {
    return std::nullopt;
  }
  return call->service.response;
}

/// ~save_report, ~reset or ~finish; a refusal throws, too.
std::string callTrigger(const std::string& name, double seconds = kPatience);

/// A namespace of the running test case's own, "/suite_case".
std::string testNamespace();

/// Why this build cannot run a detector plug-in; "" when it can.
std::string whyUnavailable(const std::string& detector);

/// The detector nodelet's own choice, for tests of what holds with any.
constexpr const char* kDefaultDetector = "lsd";

struct Methods {
  std::string detector = kDefaultDetector;
  std::string associator = "lbd";
  int frame_step = 1;
};

/// All figures of a sequence, without any topic between.
struct Expected {
  std::size_t seen = 0;
  std::vector<LineSet> lines;  ///< detected, of every frame
  std::vector<FrameRecord> frames;
  std::vector<PairRecord> pairs;
  std::vector<DetectionEntry> detection;
  Classification association;
};

/// The lines that a detector plug-in with default parameters finds.
std::vector<LineSet> detectLines(const std::vector<SequenceFrame>& frames,
                                 const std::string& detector);

/// Matches of frames a step apart by an associator plug-in with default parameters; `lines` of
/// every frame.
std::vector<MatchSet> associateLines(const std::vector<SequenceFrame>& frames,
                                     const std::vector<LineSet>& lines, const Methods& methods);

/// The annotated lines of a frame that has some.
LineSet groundTruthOf(const SequenceFrame& frame);

/// Detection of given lines (one set a frame) on the frames that have ground truth; association of
/// ground-truth lines by the associator, unless its name is "".
Expected evaluateLines(const std::vector<SequenceFrame>& frames, std::vector<LineSet> lines,
                       const Methods& methods = {});

/// The same with the lines of `methods.detector`.
Expected evaluateInProcess(const std::vector<SequenceFrame>& frames, const Methods& methods = {});

/// report.json, read strictly; throws naming the file when it is not there or no JSON.
nlohmann::json readReport(const std::filesystem::path& file);

/// Counts equal, average precision and ratios within 1e-12.
void expectDetection(const nlohmann::json& report, const Expected& expected);
void expectAssociation(const nlohmann::json& report, const Expected& expected);

/// `evaluated` of `seen` frames and nothing under any other reason than those given; frames without
/// depth or pose are looked at only where given.
void expectCoverage(const nlohmann::json& report, std::size_t seen, std::size_t evaluated,
                    const std::map<std::string, std::size_t>& reasons = {});

/// Nothing pretends: a figure without a value is null, and the object that holds it, or one around
/// it, says why.
void expectReasons(const nlohmann::json& report);

/// A complete report of all frames that equals `expected` in detection, association and coverage.
void expectWholeReport(const nlohmann::json& report, const Expected& expected);

}  // namespace evolin::test
