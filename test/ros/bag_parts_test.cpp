// Bags as people have them: topics found by type, compressed images, TUM's own layout, pieces of a
// recording, recordings that were cut off.
#include "bag_parts.h"

#include <cv_bridge/cv_bridge.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <sensor_msgs/CompressedImage.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <cstring>
#include <opencv2/imgcodecs.hpp>
#include <vector>

#include "bag_writer.h"
#include "conversions.h"
#include "test/support/drawn_sequence.h"
#include "test/support/expect_error.h"
#include "test/support/temporary_folder.h"

namespace evolin {
namespace {

namespace fs = std::filesystem;
using test::expectError;

struct Parts {
  std::vector<ImagePart> images;
  std::vector<Camera> cameras;
  std::vector<DepthPart> depths;
  std::vector<StampedPose> poses;
  std::vector<LineSet> truths;
  std::vector<std::string> notes;
};

Parts readAll(const std::vector<fs::path>& files, const BagPartsOptions& options = {},
              const WantedParts& wanted = {}) {
  const auto reader = openBagParts(files, options, wanted);
  Parts parts;
  while (std::optional<StreamPart> part = reader->next()) {
    if (auto* image = std::get_if<ImagePart>(&*part)) {
      parts.images.push_back(std::move(*image));
    } else if (auto* camera = std::get_if<Camera>(&*part)) {
      parts.cameras.push_back(std::move(*camera));
    } else if (auto* depth = std::get_if<DepthPart>(&*part)) {
      parts.depths.push_back(std::move(*depth));
    } else if (auto* pose = std::get_if<StampedPose>(&*part)) {
      parts.poses.push_back(*pose);
    } else {
      parts.truths.push_back(std::move(std::get<LineSet>(*part)));
    }
  }
  parts.notes = reader->notes();
  return parts;
}

bool equalPixels(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0;
}

class BagPartsTest : public ::testing::Test {
 protected:
  BagPartsTest() : frames_(test::drawSequence()) {}

  fs::path path(const std::string& name) const { return folder_.path() / name; }

  fs::path write(const std::string& name, std::size_t begin = 0, std::size_t end = 12) const {
    BagWriter writer(path(name));
    for (std::size_t i = begin; i < end; ++i) {
      writer.add(frames_[i]);
    }
    writer.close();
    return path(name);
  }

  std_msgs::Header headerOf(std::size_t frame) const {
    std_msgs::Header header;
    header.stamp = ros_shell::toRosTime(frames_[frame].frame.stamp);
    header.frame_id = "/openni_rgb_optical_frame";
    return header;
  }

  sensor_msgs::ImagePtr imageOf(std::size_t frame, const std::string& encoding) const {
    const cv::Mat& image =
        encoding == "32FC1" ? frames_[frame].frame.depth : frames_[frame].frame.image;
    return cv_bridge::CvImage(headerOf(frame), encoding, image).toImageMsg();
  }

  std::vector<SequenceFrame> frames_;
  test::TemporaryFolder folder_;
};

TEST_F(BagPartsTest, AWrittenBagComesBackWhole) {
  const Parts parts = readAll({write("a.bag")});
  ASSERT_EQ(parts.images.size(), 12U);
  EXPECT_EQ(parts.cameras.size(), 12U);
  ASSERT_EQ(parts.depths.size(), 12U);
  ASSERT_EQ(parts.poses.size(), 12U);
  ASSERT_EQ(parts.truths.size(), 12U);
  EXPECT_TRUE(parts.notes.empty());
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    const Frame& frame = frames_[i].frame;
    EXPECT_EQ(parts.images[i].frame.stamp, frame.stamp);
    EXPECT_EQ(parts.images[i].frame.name, frame.name);
    EXPECT_TRUE(equalPixels(parts.images[i].frame.image, frame.image));
    EXPECT_EQ(parts.depths[i].stamp, frame.stamp);
    ASSERT_TRUE(DepthMap::isDepth(static_cast<double>(frame.depth.at<float>(60, 80))));
    EXPECT_EQ(parts.depths[i].depth.at(80, 60), static_cast<double>(frame.depth.at<float>(60, 80)));
    EXPECT_EQ(parts.poses[i].pose.translation, frame.pose->translation);
    EXPECT_EQ(parts.truths[i].source, "ground_truth");
    EXPECT_EQ(parts.truths[i].lines.size(), frames_[i].ground_truth->size());
    EXPECT_EQ(parts.truths[i].lines[3].id, (*frames_[i].ground_truth)[3].id);
  }
}

TEST_F(BagPartsTest, PartsOfOneTimeComeInTheOrderOfTheirTopics) {
  const auto reader = openBagParts({write("a.bag")}, {}, {true, true});
  std::vector<std::size_t> kinds;  // of StreamPart's alternatives
  while (const std::optional<StreamPart> part = reader->next()) kinds.push_back(part->index());
  const auto kindOf = [](const StreamPart& part) { return part.index(); };
  const std::vector<std::size_t> of_a_frame = {
      kindOf(ImagePart()), kindOf(Camera()), kindOf(DepthPart{0, DepthMap(frames_[0].frame.depth)}),
      kindOf(StampedPose()), kindOf(LineSet())};
  ASSERT_EQ(kinds.size(), 12 * of_a_frame.size());
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    EXPECT_EQ(kinds[i], of_a_frame[i % of_a_frame.size()]) << i;
  }
}

TEST_F(BagPartsTest, OnlyWhatIsWantedIsRead) {
  const Parts parts = readAll({write("a.bag")}, {}, {false, false});
  EXPECT_EQ(parts.images.size(), 12U);
  EXPECT_TRUE(parts.depths.empty() && parts.poses.empty() && parts.truths.empty());
}

TEST_F(BagPartsTest, PiecesOfARecordingAreOne) {
  const Parts whole = readAll({write("a.bag")});
  const Parts pieces = readAll({write("1.bag", 0, 5), write("2.bag", 5, 12)});
  ASSERT_EQ(pieces.images.size(), whole.images.size());
  for (std::size_t i = 0; i < whole.images.size(); ++i) {
    EXPECT_EQ(pieces.images[i].frame.stamp, whole.images[i].frame.stamp);
    EXPECT_EQ(pieces.images[i].frame.name, whole.images[i].frame.name);
  }
}

TEST_F(BagPartsTest, AWindowIsCutOut) {
  BagPartsOptions options;
  options.start = 0.09;
  options.duration = 0.1;
  const Parts parts = readAll({write("a.bag")}, options);
  ASSERT_EQ(parts.images.size(), 3U);  // 0.1, 0.133 and 0.167 s
  EXPECT_EQ(parts.images[0].frame.stamp, frames_[3].frame.stamp);
}

TEST_F(BagPartsTest, TwoCandidatesAreListed) {
  rosbag::Bag bag(path("two.bag").string(), rosbag::bagmode::Write);
  for (std::size_t i = 0; i < 2; ++i) {
    bag.write("/left/image", headerOf(i).stamp, *imageOf(i, "bgr8"));
    bag.write("/right/image", headerOf(i).stamp, *imageOf(i, "bgr8"));
    bag.write("/depth", headerOf(i).stamp, *imageOf(i, "32FC1"));
  }
  bag.close();
  expectError([&] { readAll({path("two.bag")}); },
              {"two.bag", "2 topics with images", "/left/image, /right/image", "--image-topic"});
  BagPartsOptions options;
  options.image_topic = "/right/image";
  EXPECT_EQ(readAll({path("two.bag")}, options).depths.size(), 2U);
  options.image_topic = "/rigth/image";
  expectError([&] { readAll({path("two.bag")}, options); },
              {"no topic '/rigth/image'", "/right/image (sensor_msgs/Image)"});
  options.image_topic = "/right/image";
  options.ground_truth_topic = "/depth";
  expectError([&] { readAll({path("two.bag")}, options); },
              {"'/depth' is of sensor_msgs/Image", "expected evolin_ros/LineArray"});
}

TEST_F(BagPartsTest, ABagWithoutImagesSaysWhatItHas) {
  rosbag::Bag bag(path("depth.bag").string(), rosbag::bagmode::Write);
  bag.write("/depth", headerOf(0).stamp, *imageOf(0, "32FC1"));
  bag.close();
  expectError([&] { readAll({path("depth.bag")}); },
              {"no topic with images", "/depth (sensor_msgs/Image)"});
}

TEST_F(BagPartsTest, CompressedImagesAreDecoded) {
  rosbag::Bag bag(path("jpeg.bag").string(), rosbag::bagmode::Write);
  for (std::size_t i = 0; i < 3; ++i) {
    sensor_msgs::CompressedImage message;
    message.header = headerOf(i);
    message.format = "bgr8; png compressed bgr8";
    cv::imencode(".png", frames_[i].frame.image, message.data);
    if (i == 1) {
      message.data.resize(20);
    }
    bag.write("/camera/image_raw/compressed", message.header.stamp, message);
    bag.write("/camera/camera_info", message.header.stamp,
              ros_shell::toMessage(*frames_[i].frame.camera, message.header));
    bag.write("/other/camera_info", message.header.stamp,
              ros_shell::toMessage(*frames_[i].frame.camera, message.header));
  }
  bag.close();
  const Parts parts = readAll({path("jpeg.bag")});
  ASSERT_EQ(parts.images.size(), 3U);
  EXPECT_EQ(parts.cameras.size(), 3U) << "of the topic beside the images";
  EXPECT_TRUE(equalPixels(parts.images[2].frame.image, frames_[2].frame.image));
  EXPECT_TRUE(parts.images[1].frame.image.empty());
  EXPECT_EQ(parts.images[1].frame.stamp, frames_[1].frame.stamp);
  EXPECT_NE(parts.images[1].problem.find("expected JPEG or PNG"), std::string::npos)
      << parts.images[1].problem;
}

/// compressed_depth_image_transport's header before `png`: kind of quantisation, a and b.
std::vector<std::uint8_t> withHeader(float a, float b, const std::vector<std::uint8_t>& png) {
  constexpr std::size_t kHeader = 12;
  std::vector<std::uint8_t> data(kHeader + png.size());
  std::memcpy(data.data() + 4, &a, sizeof(a));
  std::memcpy(data.data() + 8, &b, sizeof(b));
  std::copy(png.begin(), png.end(), data.begin() + kHeader);
  return data;
}

TEST_F(BagPartsTest, CompressedDepthIsRead) {
  cv::Mat stored(480, 640, CV_16UC1, cv::Scalar(0));
  stored.at<std::uint16_t>(20, 10) = 1500;
  std::vector<std::uint8_t> png;
  cv::imencode(".png", stored, png);
  // With a = 250 and b = 1000, 1500 stands for 0.5 m.
  const struct {
    const char* format;
    std::vector<std::uint8_t> data;
    double metres;
  } kinds[] = {
      {"16UC1; compressedDepth", withHeader(0, 0, png), 1.5},
      {"16UC1; compressedDepth png", withHeader(0, 0, png), 1.5},
      {"32FC1; compressedDepth png", withHeader(250, 1000, png), 0.5},
      {"16UC1; png compressed ", png, 1.5},
  };
  BagPartsOptions options;
  options.depth_factor = 1000;
  for (const auto& kind : kinds) {
    rosbag::Bag bag(path("depth.bag").string(), rosbag::bagmode::Write);
    sensor_msgs::CompressedImage message;
    message.header = headerOf(0);
    message.format = kind.format;
    message.data = kind.data;
    bag.write("/camera/image", message.header.stamp, *imageOf(0, "bgr8"));
    bag.write("/camera/depth/image_raw/compressedDepth", message.header.stamp, message);
    bag.close();
    const Parts parts = readAll({path("depth.bag")}, options);
    ASSERT_EQ(parts.depths.size(), 1U) << kind.format;
    EXPECT_EQ(parts.depths[0].stamp, frames_[0].frame.stamp);
    EXPECT_EQ(parts.depths[0].depth.size().width, 640) << kind.format;
    EXPECT_FLOAT_EQ(static_cast<float>(parts.depths[0].depth.at(10, 20)),
                    static_cast<float>(kind.metres))
        << kind.format;
    EXPECT_FALSE(DepthMap::isDepth(parts.depths[0].depth.at(11, 20))) << kind.format;
  }
}

TEST_F(BagPartsTest, WhatATransportMadeOfATopicIsNoSecondTopic) {
  rosbag::Bag bag(path("both.bag").string(), rosbag::bagmode::Write);
  const cv::Mat stored(480, 640, CV_16UC1, cv::Scalar(1500));
  const std_msgs::Header header = headerOf(0);
  const cv_bridge::CvImage depth(header, "16UC1", stored);
  sensor_msgs::CompressedImage compressed;
  compressed.header = header;
  compressed.format = "16UC1; png compressed ";
  cv::imencode(".png", stored, compressed.data);
  bag.write("/camera/image", header.stamp, *imageOf(0, "bgr8"));
  bag.write("/camera/depth", header.stamp, *depth.toImageMsg());
  bag.write("/camera/depth/compressedDepth", header.stamp, compressed);
  bag.close();
  EXPECT_EQ(readAll({path("both.bag")}, BagPartsOptions()).depths.size(), 1U);
}

TEST_F(BagPartsTest, ARawTopicBelowAnotherIsASecondTopic) {
  rosbag::Bag bag(path("two.bag").string(), rosbag::bagmode::Write);
  for (const char* const topic : {"/cam", "/cam/left"}) {
    bag.write(topic, headerOf(0).stamp, *imageOf(0, "bgr8"));
  }
  bag.close();
  expectError([&] { readAll({path("two.bag")}, BagPartsOptions()); },
              {"2 topics with images", "/cam, /cam/left", "--image-topic"});
}

TEST_F(BagPartsTest, CompressedDepthThatCannotBeReadIsNamed) {
  std::vector<std::uint8_t> grey;
  cv::imencode(".png", cv::Mat(4, 4, CV_8UC1, cv::Scalar(9)), grey);
  std::vector<std::uint8_t> depth;
  cv::imencode(".png", cv::Mat(4, 4, CV_16UC1, cv::Scalar(9)), depth);
  const struct {
    const char* format;
    std::vector<std::uint8_t> data;
    const char* problem;
  } kinds[] = {
      {"16UC1; compressedDepth", std::vector<std::uint8_t>(12), "header of 12 bytes"},
      {"16UC1; compressedDepth rvl", std::vector<std::uint8_t>(40), "expected PNG"},
      {"16UC1; compressedDepth png", withHeader(0, 0, grey), "16 bits"},
      {"32FC1; compressedDepth png", withHeader(0, 0, depth), "expected a finite b"},
  };
  for (const auto& kind : kinds) {
    rosbag::Bag bag(path("depth.bag").string(), rosbag::bagmode::Write);
    sensor_msgs::CompressedImage message;
    message.header = headerOf(0);
    message.format = kind.format;
    message.data = kind.data;
    bag.write("/camera/image", message.header.stamp, *imageOf(0, "bgr8"));
    bag.write("/depth/compressedDepth", message.header.stamp, message);
    bag.close();
    const Parts parts = readAll({path("depth.bag")});
    EXPECT_TRUE(parts.depths.empty()) << kind.format;
    ASSERT_EQ(parts.notes.size(), 1U) << kind.format;
    for (const char* words : {"/depth/compressedDepth", kind.format, kind.problem}) {
      EXPECT_NE(parts.notes[0].find(words), std::string::npos) << parts.notes[0];
    }
  }
}

/// As the benchmark's own bags: frames with a leading slash, poses in tf, rgb8 and 32FC1.
TEST_F(BagPartsTest, TumsOwnLayout) {
  rosbag::Bag bag(path("tum.bag").string(), rosbag::bagmode::Write);
  const auto transform = [&](std::size_t i, const char* from, const char* to, double x) {
    geometry_msgs::TransformStamped stamped;
    stamped.header = headerOf(i);
    stamped.header.frame_id = from;
    stamped.child_frame_id = to;
    stamped.transform.translation.x = x;
    stamped.transform.rotation.w = 1;
    return stamped;
  };
  for (std::size_t i = 0; i < 4; ++i) {
    const ros::Time stamp = headerOf(i).stamp;
    tf2_msgs::TFMessage tf;
    tf.transforms.push_back(transform(i, "/world", "/kinect", 0.5 * static_cast<double>(i)));
    tf.transforms.push_back(transform(i, "/kinect", "/openni_camera", 0.25));
    tf.transforms.push_back(transform(i, "/openni_camera", "/openni_rgb_optical_frame", 0));
    bag.write("/tf", stamp, tf);
    bag.write("/camera/rgb/image_color", stamp,
              *cv_bridge::cvtColor(cv_bridge::toCvCopy(imageOf(i, "bgr8")), "rgb8")->toImageMsg());
    bag.write("/camera/rgb/camera_info", stamp,
              ros_shell::toMessage(*frames_[i].frame.camera, headerOf(i)));
    bag.write("/camera/depth/image", stamp, *imageOf(i, "32FC1"));
    bag.write("/camera/depth/camera_info", stamp,
              ros_shell::toMessage(*frames_[i].frame.camera, headerOf(i)));
  }
  bag.close();
  test::writeAnnotations(frames_, path("gt"));
  BagPartsOptions options;
  options.ground_truth = path("gt");
  const Parts parts = readAll({path("tum.bag")}, options);
  ASSERT_EQ(parts.images.size(), 4U);
  EXPECT_TRUE(equalPixels(parts.images[2].frame.image, frames_[2].frame.image));
  EXPECT_EQ(parts.depths.size(), 4U);
  EXPECT_EQ(parts.cameras.size(), 4U);
  ASSERT_EQ(parts.truths.size(), 4U);
  EXPECT_EQ(parts.truths[3].stamp, frames_[3].frame.stamp);
  ASSERT_EQ(parts.poses.size(), 4U);
  EXPECT_EQ(parts.poses[3].stamp, frames_[3].frame.stamp);
  EXPECT_DOUBLE_EQ(parts.poses[3].pose.translation.x(), 1.75);
  options.world_frame = "map";
  const Parts lost = readAll({path("tum.bag")}, options);
  EXPECT_TRUE(lost.poses.empty());
  ASSERT_EQ(lost.notes.size(), 1U);
  EXPECT_NE(lost.notes[0].find("no pose for 4 frames"), std::string::npos) << lost.notes[0];
}

TEST_F(BagPartsTest, AnnotationsNeedStamps) {
  test::writeAnnotations(frames_, path("gt"), false);
  BagPartsOptions options;
  options.ground_truth = path("gt");
  const fs::path bag = write("a.bag");
  expectError([&] { readAll({bag}, options); }, {"no stamps.txt", "--stamps"});
}

/// Takes the index away, as a recorder that was killed never wrote it: the file ends within its
/// last chunk, and its head says that there is no index.
class CutBagTest : public BagPartsTest, public ::testing::WithParamInterface<const char*> {
 protected:
  fs::path cutOff() const {
    const fs::path file = path("cut.bag");
    rosbag::Bag bag;
    bag.open(file.string(), rosbag::bagmode::Write);
    const std::string compression = GetParam();
    bag.setCompression(compression == "none"  ? rosbag::compression::Uncompressed
                       : compression == "bz2" ? rosbag::compression::BZ2
                                              : rosbag::compression::LZ4);
    bag.setChunkThreshold(300000);  // one or two images a chunk
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      bag.write("/image", headerOf(i).stamp, *imageOf(i, "bgr8"));
    }
    bag.close();
    std::fstream stream(file, std::ios::binary | std::ios::in | std::ios::out);
    std::string head(4096, ' ');
    stream.read(head.data(), 4096);
    const std::size_t at = head.find("index_pos=");
    EXPECT_NE(at, std::string::npos);
    stream.seekp(static_cast<std::streamoff>(at + 10));
    stream.write("\0\0\0\0\0\0\0\0", 8);
    stream.close();
    fs::resize_file(file, fs::file_size(file) * 2 / 3);
    return file;
  }
};

TEST_P(CutBagTest, IsReadAsFarAsItGoes) {
  const fs::path file = cutOff();
  const Parts parts = readAll({file});
  EXPECT_GE(parts.images.size(), 6U);
  EXPECT_LT(parts.images.size(), 12U);
  for (std::size_t i = 0; i < parts.images.size(); ++i) {
    EXPECT_EQ(parts.images[i].frame.stamp, frames_[i].frame.stamp);
    EXPECT_TRUE(equalPixels(parts.images[i].frame.image, frames_[i].frame.image));
  }
  ASSERT_EQ(parts.notes.size(), 1U);
  for (const std::string& word :
       {std::string("cut.bag"), std::string("no index"), std::string("rosbag reindex"),
        std::to_string(parts.images.size()) + " messages"}) {
    EXPECT_NE(parts.notes[0].find(word), std::string::npos) << parts.notes[0];
  }
  BagPartsOptions options;
  options.start = 0.05;
  EXPECT_EQ(readAll({file}, options).images.size(), parts.images.size() - 2);
}

INSTANTIATE_TEST_SUITE_P(Compressions, CutBagTest, ::testing::Values("none", "lz4", "bz2"));

TEST_F(BagPartsTest, WhatIsNoBagIsNamed) {
  expectError([&] { readAll({path("none.bag")}); }, {"none.bag", "no such file"});
  folder_.write("text.bag", "not a bag, but longer than its head would be\n");
  expectError([&] { readAll({path("text.bag")}); }, {"text.bag", "cannot be read as a bag"});
  folder_.write("empty.bag", "");
  expectError([&] { readAll({path("empty.bag")}); }, {"empty.bag"});
}

}  // namespace
}  // namespace evolin
