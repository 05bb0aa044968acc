// Colour and depth share a type, so that images are told apart by their encoding.
#include "bag_topic_choice.h"

#include <evolin_ros/LineArray.h>
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <nav_msgs/Odometry.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/image_encodings.h>

#include <algorithm>
#include <set>

#include "compressed_depth.h"
#include "evolin_ros/base/text.h"
#include "topics.h"

namespace evolin::ros_shell {

namespace {

template <class Message>
std::string typeOf() {
  return ros::message_traits::DataType<Message>::value();
}

const std::set<std::string>& poseTypes() {
  static const std::set<std::string> kTypes = {typeOf<geometry_msgs::PoseStamped>(),
                                               typeOf<geometry_msgs::PoseWithCovarianceStamped>(),
                                               typeOf<nav_msgs::Odometry>()};
  return kTypes;
}

enum class Content { kNone, kImage, kDepth };

/// What the first message of a topic says.
Content contentOf(BagSource* bag, const BagTopic& topic) {
  Content content = Content::kNone;
  if (topic.type == typeOf<sensor_msgs::Image>()) {
    bag->peek(topic.name, [&](const BagMessage& message) {
      const bool depth = isDepthEncoding(message.read<sensor_msgs::Image>()->encoding);
      content = depth ? Content::kDepth : Content::kImage;
      return false;
    });
  } else if (topic.type == typeOf<sensor_msgs::CompressedImage>()) {
    bag->peek(topic.name, [&](const BagMessage& message) {
      const std::string format = message.read<sensor_msgs::CompressedImage>()->format;
      content = isCompressedDepth(format) ? Content::kDepth : Content::kImage;
      return false;
    });
  }
  return content;
}

std::string parentOf(const std::string& topic) {
  const std::size_t slash = topic.rfind('/');
  return slash == std::string::npos ? "" : topic.substr(0, slash);
}

/// Finds topics of one bag, with words for what went wrong.
class Chooser {
 public:
  explicit Chooser(BagSource* bag) : bag_(bag), topics_(bag->topics()) {}

  /// The topic that the user named, of one of these types.
  std::string named(const std::string& option, const std::string& name,
                    const std::set<std::string>& types) const {
    const auto found = std::find_if(topics_.begin(), topics_.end(),
                                    [&](const BagTopic& topic) { return topic.name == name; });
    if (found == topics_.end()) {
      throw Error(option + ": the bag has no topic " + quote(name) +
                  "; it has: " + listTopics(topics_));
    }
    if (types.count(found->type) == 0) {
      std::string expected;
      for (const std::string& type : types) {
        expected += (expected.empty() ? "" : " or ") + type;
      }
      throw Error(option + ": topic " + quote(name) + " is of " + found->type + ", expected " +
                  expected);
    }
    return name;
  }

  /// The only candidate; "" when there is none.
  static std::string only(const std::string& option, const std::string& what,
                          const std::vector<std::string>& candidates) {
    if (candidates.size() <= 1) {
      return candidates.empty() ? "" : candidates.front();
    }
    std::string names;
    for (const std::string& name : candidates) {
      names += (names.empty() ? "" : ", ") + name;
    }
    throw Error("the bag has " + std::to_string(candidates.size()) + " topics with " + what + ": " +
                names + "; name one with " + option);
  }

  std::vector<std::string> ofType(const std::set<std::string>& types) const {
    std::vector<std::string> names;
    for (const BagTopic& topic : topics_) {
      if (types.count(topic.type) != 0 && topic.messages > 0) {
        names.push_back(topic.name);
      }
    }
    return names;
  }

  std::vector<std::string> withContent(Content content) const {
    std::vector<const BagTopic*> found;
    std::set<std::string> found_names;
    for (const BagTopic& topic : topics_) {
      if (topic.messages > 0 && contentOf(bag_, topic) == content) {
        found.push_back(&topic);
        found_names.insert(topic.name);
      }
    }
    // What a transport made of another candidate (/depth/compressedDepth of /depth) shows the same;
    // a raw topic below another one (/cam/left of /cam) does not.
    std::vector<std::string> names;
    for (const BagTopic* topic : found) {
      const bool compressed = topic->type == typeOf<sensor_msgs::CompressedImage>();
      if (!compressed || found_names.count(parentOf(topic->name)) == 0) {
        names.push_back(topic->name);
      }
    }
    return names;
  }

  std::size_t messagesOf(const std::string& name) const {
    const auto found = std::find_if(topics_.begin(), topics_.end(),
                                    [&](const BagTopic& topic) { return topic.name == name; });
    return found == topics_.end() ? 0 : found->messages;
  }

 private:
  BagSource* bag_;
  const std::vector<BagTopic>& topics_;
};

/// Beside its images, as image_transport expects it.
std::string cameraInfoOf(const Chooser& chooser, const std::string& image_topic) {
  const std::vector<std::string> candidates = chooser.ofType({typeOf<sensor_msgs::CameraInfo>()});
  // A transport's topic lies below that of the images: .../image_raw/compressed.
  for (const std::string& place : {parentOf(image_topic), parentOf(parentOf(image_topic))}) {
    const auto beside = std::find(candidates.begin(), candidates.end(), place + "/camera_info");
    if (beside != candidates.end()) {
      return *beside;
    }
  }
  return Chooser::only("--camera-info-topic", "camera_info, none of them beside " + image_topic,
                       candidates);
}

void choosePoses(const Chooser& chooser, const BagPartsOptions& options, BagTopicChoice* choice) {
  if (options.pose_topic == topics::kTf) {
    chooser.named("--pose-topic", topics::kTf, {"tf2_msgs/TFMessage", "tf/tfMessage"});
    choice->tf = true;
  } else if (!options.pose_topic.empty()) {
    choice->pose = chooser.named("--pose-topic", options.pose_topic, poseTypes());
  } else {
    choice->pose = Chooser::only("--pose-topic", "poses", chooser.ofType(poseTypes()));
    choice->tf = choice->pose.empty() && chooser.messagesOf(topics::kTf) > 0;
  }
}

}  // namespace

std::string listTopics(const std::vector<BagTopic>& topics) {
  std::string text;
  for (const BagTopic& topic : topics) {
    text += (text.empty() ? "" : ", ") + topic.name + " (" + topic.type + ")";
  }
  return text.empty() ? "none" : text;
}

BagTopicChoice chooseTopics(BagSource* bag, const BagPartsOptions& options,
                            const WantedParts& wanted) {
  const std::set<std::string> images = {typeOf<sensor_msgs::Image>(),
                                        typeOf<sensor_msgs::CompressedImage>()};
  const Chooser chooser(bag);
  BagTopicChoice choice;
  choice.image =
      options.image_topic.empty()
          ? Chooser::only("--image-topic", "images", chooser.withContent(Content::kImage))
          : chooser.named("--image-topic", options.image_topic, images);
  if (choice.image.empty()) {
    throw Error(
        "the bag has no topic with images (sensor_msgs/Image or CompressedImage); it has: " +
        listTopics(bag->topics()));
  }
  choice.images = chooser.messagesOf(choice.image);
  if (options.camera.empty()) {
    choice.camera_info = options.camera_info_topic.empty()
                             ? cameraInfoOf(chooser, choice.image)
                             : chooser.named("--camera-info-topic", options.camera_info_topic,
                                             {typeOf<sensor_msgs::CameraInfo>()});
  }
  if (wanted.motion) {
    choice.depth =
        options.depth_topic.empty()
            ? Chooser::only("--depth-topic", "depth images", chooser.withContent(Content::kDepth))
            : chooser.named("--depth-topic", options.depth_topic, images);
    choosePoses(chooser, options, &choice);
  }
  if (wanted.ground_truth && options.ground_truth.empty()) {
    choice.ground_truth = options.ground_truth_topic.empty()
                              ? Chooser::only("--ground-truth-topic", "lines",
                                              chooser.ofType({typeOf<evolin_ros::LineArray>()}))
                              : chooser.named("--ground-truth-topic", options.ground_truth_topic,
                                              {typeOf<evolin_ros::LineArray>()});
  }
  return choice;
}

}  // namespace evolin::ros_shell
