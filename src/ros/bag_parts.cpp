// Each message becomes what the nodelets make of it.
#include "bag_parts.h"

#include <evolin_ros/LineArray.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <nav_msgs/Odometry.h>
#include <sensor_msgs/CompressedImage.h>
#include <tf2_msgs/TFMessage.h>

#include <deque>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <set>
#include <utility>

#include "bag_source.h"
#include "bag_topic_choice.h"
#include "compressed_depth.h"
#include "conversions.h"
#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"
#include "evolin_ros/dataset/annotation_folder.h"
#include "evolin_ros/dataset/camera_file.h"
#include "evolin_ros/dataset/evolin_writer.h"
#include "image_bytes.h"
#include "image_pool.h"
#include "pose_source.h"
#include "topics.h"

namespace evolin {

namespace {

namespace shell = ros_shell;

/// Enough to tell what is wrong with a recording, not a line a message.
constexpr std::size_t kMostNotes = 10;

cv::Mat decode(const sensor_msgs::CompressedImage& message) {
  cv::Mat image;
  try {
    image = cv::imdecode(message.data, cv::IMREAD_ANYCOLOR);
  } catch (const std::exception& error) {  // OpenCV's own
    throw Error(error.what());
  }
  if (image.empty() || (image.type() != CV_8UC1 && image.type() != CV_8UC3)) {
    throw Error("compressed image of format " + quote(message.format) + " and " +
                std::to_string(message.data.size()) +
                " bytes: no 8-bit picture comes of it, expected JPEG or PNG");
  }
  return image;
}

template <class Message>
StampedPose poseOf(const Message& message) {
  return {shell::fromRos(message.header.stamp),
          shell::fromMessage(message.pose.pose, message.header.stamp)};
}

StampedPose poseOf(const geometry_msgs::PoseStamped& message) {
  return {shell::fromRos(message.header.stamp), shell::fromMessage(message)};
}

class BagParts : public PartReader {
 public:
  BagParts(const std::vector<std::filesystem::path>& files, BagPartsOptions options,
           const WantedParts& wanted)
      : files_(files), options_(std::move(options)), bag_(shell::openBags(files)) {
    if (!bag_->problem().empty()) {
      notes_.push_back(bag_->problem());
    }
    try {
      topics_ = shell::chooseTopics(bag_.get(), options_, wanted);
    } catch (const Error& error) {
      throw Error(files.front().string() + ": " + error.what());
    }
    if (!options_.camera.empty()) {
      camera_ = loadCamera(options_.camera, options_.camera_folder);
    }
    if (wanted.ground_truth && !options_.ground_truth.empty()) {
      annotations_.emplace(options_.ground_truth, options_.stamps, options_.same_rows);
      if (!annotations_->hasStamps()) {
        throw Error(annotations_->folder().string() +
                    ": which file belongs to which image is unknown: there is no stamps.txt in it; "
                    "--stamps names one ('evolin bag' writes NAME.stamps.txt beside a bag)");
      }
    }
    if (topics_.tf) {
      tf_ = std::make_unique<shell::TfPoses>(options_.world_frame);
    }
    choose();
  }

  std::optional<StreamPart> next() override {
    while (parts_.empty()) {
      const std::optional<shell::BagMessage> message = bag_->next();
      if (!message) {
        return std::nullopt;
      }
      take(*message);
    }
    StreamPart part = std::move(parts_.front());
    parts_.pop_front();
    return part;
  }

  std::size_t images() const override { return topics_.images; }

  Needs offers() const override {
    return {!topics_.depth.empty(), camera_ || !topics_.camera_info.empty(),
            tf_ || !topics_.pose.empty()};
  }

  std::vector<std::string> notes() const override {
    std::vector<std::string> notes = notes_;
    if (notes_left_out_ > 0) {
      notes.push_back("and " + std::to_string(notes_left_out_) + " more messages of the bag");
    }
    if (tf_ && tf_->pending() > 0) {
      notes.push_back("tf knows no pose for " + std::to_string(tf_->pending()) +
                      " frames: " + tf_->whyWaiting());
    }
    return notes;
  }

  std::string provenance() const override {
    using Json = nlohmann::ordered_json;
    Json bags = Json::array();
    for (const std::filesystem::path& file : files_) {
      bags.push_back({{"bag", std::filesystem::absolute(file).string()},
                      {"bytes", std::filesystem::file_size(file)}});
    }
    const auto name = [](const std::string& topic) {
      return topic.empty() ? Json(nullptr) : Json(topic);
    };
    return Json{{"bags", bags},
                {"image_topic", topics_.image},
                {"camera_info_topic", name(topics_.camera_info)},
                {"depth_topic", name(topics_.depth)},
                {"pose_topic", name(topics_.tf ? shell::topics::kTf : topics_.pose)},
                {"ground_truth_topic", name(topics_.ground_truth)}}
        .dump(-1, ' ', false, Json::error_handler_t::replace);
  }

 private:
  void choose() {
    std::vector<std::string> names;
    for (const std::string& topic :
         {topics_.image, topics_.camera_info, topics_.depth, topics_.pose, topics_.ground_truth}) {
      if (!topic.empty()) {
        names.push_back(topic);
      }
    }
    if (tf_) {
      names.emplace_back(shell::topics::kTf);
      names.emplace_back(shell::topics::kTfStatic);
    }
    bag_->choose(names, {options_.start, options_.duration});
  }

  /// A message that cannot be used is named and left out, as the nodelets do.
  void take(const shell::BagMessage& message) {
    const std::string& topic = message.topic();
    if (topic == topics_.image) {
      takeImage(message);
      return;
    }
    try {
      if (topic == topics_.camera_info) {
        takeCameraInfo(*message.read<sensor_msgs::CameraInfo>());
      } else if (topic == topics_.depth) {
        takeDepth(message);
      } else if (topic == topics_.pose) {
        takePose(message);
      } else if (topic == topics_.ground_truth) {
        const auto lines = message.read<evolin_ros::LineArray>();
        parts_.emplace_back(shell::fromMessage(*lines));
        askTf(lines->header);
      } else {
        give(tf_->add(*message.read<tf2_msgs::TFMessage>(), topic == shell::topics::kTfStatic));
      }
    } catch (const std::exception& error) {  // tf2's, OpenCV's and roscpp's own among them
      note(topic + ": " + error.what());
    }
  }

  void takeImage(const shell::BagMessage& message) {
    ImagePart part;
    std_msgs::Header header;
    try {
      if (message.isA<sensor_msgs::CompressedImage>()) {
        const auto compressed = message.read<sensor_msgs::CompressedImage>();
        header = compressed->header;
        part.frame.stamp = shell::fromRos(header.stamp);
        part.frame.image = decode(*compressed);
      } else {
        const auto image = message.read<shell::ImageBytes>();
        header = image->header;
        part.frame.stamp = shell::fromRos(header.stamp);
        part.frame.image = shell::copyPixels(*image, image_pool_.take());
        image_pool_.keep(part.frame.image);
        if (part.frame.image.empty()) {
          part.frame = shell::toFrame(message.read<sensor_msgs::Image>());
        }
      }
    } catch (const std::exception& error) {
      part.problem =
          topics_.image + ": image at " + formatStamp(part.frame.stamp) + ": " + error.what();
    }
    part.frame.name = EvolinWriter::stem(images_read_++);
    if (annotations_ && !part.frame.image.empty()) {
      takeAnnotation(part.frame);
    }
    if (camera_ && !camera_told_) {
      camera_told_ = true;
      parts_.emplace_back(*camera_);
    }
    parts_.emplace_back(std::move(part));
    askTf(header);
  }

  void takeDepth(const shell::BagMessage& message) {
    const auto take = [this](const auto& depth, DepthMap map) {
      parts_.emplace_back(DepthPart{shell::fromRos(depth->header.stamp), std::move(map)});
    };
    if (message.isA<sensor_msgs::CompressedImage>()) {
      const auto depth = message.read<sensor_msgs::CompressedImage>();
      take(depth, shell::toDepthMap(*depth, options_.depth_factor));
    } else {
      const auto depth = message.read<shell::ImageBytes>();
      cv::Mat stored = shell::copyDepth(*depth, depth_pool_.take());
      depth_pool_.keep(stored);
      take(depth, stored.empty()
                      ? shell::toDepthMap(message.read<sensor_msgs::Image>(), options_.depth_factor)
                      : DepthMap(std::move(stored), options_.depth_factor));
    }
  }

  void takeAnnotation(const Frame& frame) {
    std::optional<LineSegments> lines = annotations_->at(frame.stamp);
    if (!lines) {
      return;
    }
    LineSet truth;
    truth.stamp = frame.stamp;
    truth.source = "ground_truth";
    truth.width = frame.image.cols;
    truth.height = frame.image.rows;
    truth.scored = annotations_->hasScores();
    truth.lines = std::move(*lines);
    parts_.emplace_back(std::move(truth));
  }

  void takeCameraInfo(const sensor_msgs::CameraInfo& message) {
    parts_.emplace_back(shell::fromMessage(message));
    askTf(message.header);
  }

  void takePose(const shell::BagMessage& message) {
    if (message.isA<geometry_msgs::PoseStamped>()) {
      parts_.emplace_back(poseOf(*message.read<geometry_msgs::PoseStamped>()));
    } else if (message.isA<nav_msgs::Odometry>()) {
      parts_.emplace_back(poseOf(*message.read<nav_msgs::Odometry>()));
    } else {
      parts_.emplace_back(poseOf(*message.read<geometry_msgs::PoseWithCovarianceStamped>()));
    }
  }

  void askTf(const std_msgs::Header& header) {
    if (tf_ && !header.stamp.isZero()) {
      give(tf_->ask(shell::fromRos(header.stamp), header.frame_id));
    }
  }

  void give(const std::vector<StampedPose>& poses) {
    for (const StampedPose& pose : poses) {
      parts_.emplace_back(pose);
    }
  }

  void note(const std::string& text) {
    if (told_.count(text) != 0) {
      return;
    }
    if (told_.size() < kMostNotes) {
      told_.insert(text);
      notes_.push_back(text);
    } else {
      ++notes_left_out_;
    }
  }

  std::vector<std::filesystem::path> files_;
  BagPartsOptions options_;
  std::unique_ptr<shell::BagSource> bag_;
  shell::BagTopicChoice topics_;
  std::unique_ptr<shell::TfPoses> tf_;
  std::optional<AnnotationFolder> annotations_;
  std::optional<Camera> camera_;
  bool camera_told_ = false;
  std::size_t images_read_ = 0;
  std::deque<StreamPart> parts_;
  shell::ImagePool image_pool_;
  shell::ImagePool depth_pool_;
  std::vector<std::string> notes_;
  std::set<std::string> told_;
  std::size_t notes_left_out_ = 0;
};

}  // namespace

std::unique_ptr<PartReader> openBagParts(const std::vector<std::filesystem::path>& files,
                                         const BagPartsOptions& options,
                                         const WantedParts& wanted) {
  return std::make_unique<BagParts>(files, options, wanted);
}

}  // namespace evolin
