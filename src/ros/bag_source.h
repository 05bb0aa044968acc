// Messages of one or more bags in order of time, whole bags and cut-off ones.
#pragma once

#include <ros/serialization.h>
#include <rosbag/message_instance.h>

#include <boost/make_shared.hpp>
#include <boost/shared_ptr.hpp>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/stamp.h"

namespace evolin::ros_shell {

struct BagTopic {
  std::string name;
  std::string type;
  std::size_t messages = 0;
};

/// One message, not yet read; valid until the next is asked for.
class BagMessage {
 public:
  explicit BagMessage(const rosbag::MessageInstance& indexed)
      : topic_(&indexed.getTopic()),
        type_(&indexed.getDataType()),
        md5_(&indexed.getMD5Sum()),
        indexed_(&indexed) {}
  BagMessage(const std::string& topic, const std::string& type, const std::string& md5,
             std::uint8_t* bytes, std::uint32_t size)
      : topic_(&topic), type_(&type), md5_(&md5), bytes_(bytes), size_(size) {}

  const std::string& topic() const { return *topic_; }
  const std::string& type() const { return *type_; }

  template <class Message>
  bool isA() const {
    return *type_ == ros::message_traits::DataType<Message>::value();
  }

  /// Throws Error when the message is of another type, or of another version of it.
  template <class Message>
  boost::shared_ptr<Message> read() const {
    if (*md5_ != ros::message_traits::MD5Sum<Message>::value()) {
      throw Error(*topic_ + ": is of " + *type_ + " with checksum " + *md5_ + ", expected " +
                  ros::message_traits::DataType<Message>::value() + " with checksum " +
                  ros::message_traits::MD5Sum<Message>::value());
    }
    try {
      if (indexed_ != nullptr) {
        return indexed_->instantiate<Message>();
      }
      const auto message = boost::make_shared<Message>();
      ros::serialization::IStream stream(bytes_, size_);
      ros::serialization::deserialize(stream, *message);
      return message;
    } catch (const std::exception& error) {
      throw Error(*topic_ + ": a message cannot be read: " + error.what());
    }
  }

 private:
  const std::string* topic_;
  const std::string* type_;
  const std::string* md5_;
  const rosbag::MessageInstance* indexed_ = nullptr;
  std::uint8_t* bytes_ = nullptr;
  std::uint32_t size_ = 0;
};

/// Seconds from the first message, of the time at which messages were recorded.
struct BagWindow {
  double start = 0;
  std::optional<double> duration;  ///< none: to the end
};

class BagSource {
 public:
  BagSource() = default;
  BagSource(const BagSource&) = delete;
  BagSource& operator=(const BagSource&) = delete;
  virtual ~BagSource() = default;

  /// All topics, by name. Counts are of the whole bags.
  virtual const std::vector<BagTopic>& topics() const = 0;

  /// Calls `look` with messages of a topic until it gives false.
  virtual void peek(const std::string& topic,
                    const std::function<bool(const BagMessage&)>& look) = 0;

  /// From now on next() gives the messages of these topics.
  virtual void choose(const std::vector<std::string>& topics, const BagWindow& window) = 0;

  /// None at the end. Throws Error naming the file for a bag that is damaged inside.
  virtual std::optional<BagMessage> next() = 0;

  /// What is wrong with the bag; "" when nothing is.
  virtual std::string problem() const = 0;
};

/// Several bags are pieces of one recording, as 'rosbag record --split' makes them. A single bag
/// without index, which its recorder never closed, is read as far as it goes, and problem() says
/// so. Throws Error naming the file when it cannot be read.
std::unique_ptr<BagSource> openBags(const std::vector<std::filesystem::path>& files);

/// The same for a bag without index; nothing is given out after the last complete chunk.
std::unique_ptr<BagSource> openUnindexedBag(const std::filesystem::path& file);

}  // namespace evolin::ros_shell
