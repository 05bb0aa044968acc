// rosbag's writer behind a header without ROS.
#include "bag_writer.h"

#include <cv_bridge/cv_bridge.h>
#include <rosbag/bag.h>
#include <sensor_msgs/image_encodings.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <cstdint>
#include <map>

#include "conversions.h"
#include "evolin_ros/base/error.h"
#include "topics.h"

namespace evolin {

namespace {

namespace names = ros_shell::bag_topics;

std_msgs::Header headerAt(Stamp stamp, const char* frame_id) {
  std_msgs::Header header;
  header.stamp = ros_shell::toRosTime(stamp);
  header.frame_id = frame_id;
  return header;
}

}  // namespace

struct BagWriter::Bag {
  std::string file;
  std::map<std::string, std::uint32_t> next_numbers;  ///< by topic
  std::unique_ptr<rosbag::Bag> bag = std::make_unique<rosbag::Bag>();

  Bag() = default;
  Bag(const Bag&) = delete;
  Bag& operator=(const Bag&) = delete;

  /// A bag that nobody closed is closed here. rosbag's own destructor would do that too, but ends
  /// the program when the disk is full; a bag that cannot be closed is therefore left behind.
  ~Bag() {
    try {
      bag->close();
    } catch (const std::exception&) {
      bag.release();  // NOLINT(bugprone-unused-return-value)
    }
  }

  /// Numbers the messages of each topic as a publisher does (rosbag plays the numbers as they are),
  /// so that a listener notices what it lost. `header` is the one in `message`.
  template <class Message>
  void write(const char* topic, std_msgs::Header* header, const Message& message) {
    if (header->stamp < ros::TIME_MIN) {
      throw Error(file + ": a bag cannot hold stamp 0 s; give the sequence stamps after 0");
    }
    header->seq = next_numbers[topic]++;
    bag->write(topic, header->stamp, message);
  }

  template <class Message>
  void write(const char* topic, Message message) {
    write(topic, &message.header, message);
  }

  void writeImage(const Frame& frame, const std_msgs::Header& header) {
    namespace encodings = sensor_msgs::image_encodings;
    const char* encoding =
        frame.image.channels() == 1 ? encodings::MONO8.c_str() : encodings::BGR8.c_str();
    write(names::kImage, *cv_bridge::CvImage(header, encoding, frame.image).toImageMsg());
    if (frame.camera) {
      write(names::kCameraInfo, ros_shell::toMessage(*frame.camera, header));
    }
  }

  void writeDepth(const SequenceFrame& sequence_frame) {
    const Frame& frame = sequence_frame.frame;
    if (frame.depth.empty()) {
      return;
    }
    const std_msgs::Header header =
        headerAt(sequence_frame.depth_stamp.value_or(frame.stamp), names::kCameraFrame);
    write(names::kDepth,
          *cv_bridge::CvImage(header, sensor_msgs::image_encodings::TYPE_32FC1, frame.depth)
               .toImageMsg());
    if (frame.camera) {
      write(names::kDepthCameraInfo, ros_shell::toMessage(*frame.camera, header));
    }
  }

  void writePose(const Pose& pose, Stamp stamp) {
    const std_msgs::Header header = headerAt(stamp, names::kWorldFrame);
    geometry_msgs::PoseStamped stamped;
    stamped.header = header;
    stamped.pose = ros_shell::toMessage(pose);
    write(names::kGroundTruthPose, stamped);

    geometry_msgs::TransformStamped transform;
    transform.header = header;
    transform.child_frame_id = names::kCameraFrame;
    transform.transform.translation.x = stamped.pose.position.x;
    transform.transform.translation.y = stamped.pose.position.y;
    transform.transform.translation.z = stamped.pose.position.z;
    transform.transform.rotation = stamped.pose.orientation;
    tf2_msgs::TFMessage tf;
    tf.transforms.push_back(transform);
    write(names::kTf, &tf.transforms.front().header, tf);
  }

  void writeGroundTruth(const LineSegments& lines, const Frame& frame,
                        const std_msgs::Header& header) {
    LineSet set;
    set.stamp = frame.stamp;
    set.frame_id = header.frame_id;
    set.source = "ground_truth";
    set.width = frame.image.cols;
    set.height = frame.image.rows;
    set.scored = !lines.empty() && std::all_of(lines.begin(), lines.end(),
                                               [](const LineSegment& l) { return l.hasScore(); });
    set.lines = lines;
    write(names::kGroundTruthLines, ros_shell::toMessage(set));
  }
};

BagWriter::BagWriter(const std::filesystem::path& file, BagCompression compression)
    : bag_(std::make_unique<Bag>()) {
  bag_->file = file.string();
  try {
    bag_->bag->open(bag_->file, rosbag::bagmode::Write);
    bag_->bag->setCompression(compression == BagCompression::kLz4
                                  ? rosbag::compression::LZ4
                                  : rosbag::compression::Uncompressed);
  } catch (const rosbag::BagException& error) {
    throw Error(bag_->file + ": cannot be written: " + error.what());
  }
}

BagWriter::~BagWriter() = default;

void BagWriter::add(const SequenceFrame& frame) {
  const std_msgs::Header header = headerAt(frame.frame.stamp, names::kCameraFrame);
  try {
    bag_->writeImage(frame.frame, header);
    bag_->writeDepth(frame);
    if (frame.frame.pose) {
      bag_->writePose(*frame.frame.pose, frame.frame.stamp);
    }
    if (frame.ground_truth) {
      bag_->writeGroundTruth(*frame.ground_truth, frame.frame, header);
    }
  } catch (const rosbag::BagException& error) {
    throw Error(bag_->file + ": cannot be written: " + error.what());
  }
}

void BagWriter::close() {
  try {
    bag_->bag->close();
  } catch (const rosbag::BagException& error) {
    throw Error(bag_->file + ": cannot be closed: " + error.what());
  }
}

}  // namespace evolin
