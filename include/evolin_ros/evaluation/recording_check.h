// What a recording has and lacks, metric by metric, before anything is evaluated.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "evolin_ros/dataset/trajectory.h"
#include "evolin_ros/evaluation/metric_family.h"
#include "evolin_ros/evaluation/part_reader.h"

namespace evolin {

struct Finding {
  enum class Level { kGood, kDoubt, kMissing };
  Level level = Level::kGood;
  std::string subject;  ///< "images", "camera", "depth", "poses", "ground truth", "agreement"
  std::string text;
  std::string advice;  ///< what to do; "" where nothing needs doing
};

/// "ok", "doubt" or "missing".
std::string toString(Finding::Level level);

/// Whether a family can be measured.
struct FamilyReadiness {
  MetricFamily family = MetricFamily::kDetection;
  std::string lacks;  ///< "" when it can
};

/// Takes the parts of a recording one by one; keeps numbers of each, no pixels.
class RecordingCheck {
 public:
  /// `max_time_difference`: of a depth image to its image, ns.
  explicit RecordingCheck(Stamp max_time_difference = kNanosecondsPerSecond / 50)
      : max_time_difference_(max_time_difference) {}

  void add(const StreamPart& part);

  std::size_t images() const { return image_stamps_.size(); }

  std::vector<Finding> findings() const;

  /// In the order of allMetricFamilies().
  std::vector<FamilyReadiness> readiness() const;

 private:
  struct Truth {
    std::size_t lines = 0;
    bool ids = false;
    std::string fault;  ///< "" when every line is valid ground truth
  };

  void addImage(const ImagePart& image);
  void addCamera(const Camera& camera);
  void addDepth(const DepthPart& depth);
  void addTruth(const LineSet& truth);
  void checkImages(std::vector<Finding>* findings) const;
  void checkCamera(std::vector<Finding>* findings) const;
  void checkDepth(std::vector<Finding>* findings) const;
  void checkPoses(std::vector<Finding>* findings) const;
  void checkTruth(std::vector<Finding>* findings) const;
  std::size_t imagesWithDepth() const;
  std::size_t imagesWithPose() const;
  std::size_t imagesWithTruth() const;
  std::string ofImages(std::size_t count) const;

  Stamp max_time_difference_;
  std::vector<Stamp> image_stamps_;
  std::map<std::string, std::size_t> image_kinds_;  ///< "640x480 colour"
  std::optional<std::pair<int, int>> image_size_;   ///< of the first
  std::size_t unreadable_ = 0;
  std::string first_problem_;
  std::optional<Camera> camera_;
  std::size_t other_cameras_ = 0;
  std::vector<Stamp> depth_stamps_;
  std::size_t depth_samples_ = 0;
  std::vector<float> depths_;  ///< measured ones among the samples, metres
  Trajectory trajectory_;
  std::size_t repeated_poses_ = 0;
  std::map<Stamp, Truth> truths_;
};

}  // namespace evolin
