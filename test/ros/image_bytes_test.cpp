// Pixels copied out of a serialized image are those of the message itself, or are left to it.
#include "image_bytes.h"

#include <gtest/gtest.h>
#include <sensor_msgs/image_encodings.h>

#include <boost/make_shared.hpp>
#include <cstring>
#include <vector>

#include "conversions.h"
#include "evolin_ros/base/error.h"

namespace evolin::ros_shell {
namespace {

namespace encodings = sensor_msgs::image_encodings;

constexpr std::uint32_t kWidth = 6;
constexpr std::uint32_t kHeight = 4;

/// Every byte another one, those behind the rows too.
sensor_msgs::ImagePtr makeImage(const std::string& encoding, std::uint32_t pixel_bytes,
                                std::uint32_t padding) {
  const auto message = boost::make_shared<sensor_msgs::Image>();
  message->header.stamp = ros::Time(3, 5);
  message->header.frame_id = "cam";
  message->encoding = encoding;
  message->width = kWidth;
  message->height = kHeight;
  message->step = kWidth * pixel_bytes + padding;
  for (std::uint32_t i = 0; i < message->step * kHeight; ++i) {
    message->data.push_back(static_cast<std::uint8_t>(1 + i));
  }
  return message;
}

/// An image as it lies in a bag.
class Stored {
 public:
  explicit Stored(const sensor_msgs::Image& message)
      : bytes_(ros::serialization::serializationLength(message)) {
    ros::serialization::OStream out(bytes_.data(), static_cast<std::uint32_t>(bytes_.size()));
    ros::serialization::serialize(out, message);
    ros::serialization::IStream in(bytes_.data(), static_cast<std::uint32_t>(bytes_.size()));
    ros::serialization::deserialize(in, image_);
    EXPECT_EQ(in.getLength(), 0U) << "all of it is read";
  }

  const ImageBytes& image() const { return image_; }

 private:
  std::vector<std::uint8_t> bytes_;
  ImageBytes image_;
};

bool areEqual(const cv::Mat& first, const cv::Mat& second) {
  return first.type() == second.type() && first.size() == second.size() &&
         cv::norm(first, second, cv::NORM_INF) == 0;
}

TEST(ImageBytes, HasTheMessagesFields) {
  const auto message = makeImage(encodings::BGR8, 3, 2);
  message->is_bigendian = 1;
  const Stored stored(*message);
  const ImageBytes& image = stored.image();
  EXPECT_EQ(image.header.stamp, message->header.stamp);
  EXPECT_EQ(image.header.frame_id, "cam");
  EXPECT_EQ(image.width, kWidth);
  EXPECT_EQ(image.height, kHeight);
  EXPECT_EQ(image.encoding, "bgr8");
  EXPECT_EQ(image.is_bigendian, 1);
  EXPECT_EQ(image.step, message->step);
  ASSERT_EQ(image.size, message->data.size());
  EXPECT_EQ(std::memcmp(image.data, message->data.data(), image.size), 0);
}

TEST(ImageBytes, PixelsAreTheMessagesWithAndWithoutPadding) {
  const std::pair<std::string, std::uint32_t> kinds[] = {
      {encodings::MONO8, 1}, {encodings::TYPE_8UC1, 1}, {encodings::BGR8, 3}, {encodings::RGB8, 3}};
  for (const auto& [encoding, bytes] : kinds) {
    for (const std::uint32_t padding : {0U, 1U, 7U, 64U}) {
      const auto message = makeImage(encoding, bytes, padding);
      const Stored stored(*message);
      EXPECT_TRUE(areEqual(copyPixels(stored.image()), toFrame(message).image))
          << encoding << " with " << padding << " bytes of padding";
    }
  }
}

TEST(ImageBytes, PixelsAreACopyOfTheirOwn) {
  cv::Mat copy;
  {
    const Stored stored(*makeImage(encodings::MONO8, 1, 3));
    copy = copyPixels(stored.image());
  }
  EXPECT_EQ(copy.at<std::uint8_t>(1, 0), 1 + kWidth + 3);
  EXPECT_TRUE(copy.isContinuous());
}

TEST(ImageBytes, DepthIsTheMessagesValueByValue) {
  const std::pair<std::string, std::uint32_t> kinds[] = {
      {encodings::TYPE_16UC1, 2}, {encodings::MONO16, 2}, {encodings::TYPE_32FC1, 4}};
  for (const auto& [encoding, bytes] : kinds) {
    for (const std::uint32_t padding : {0U, 4U, 12U}) {
      const auto message = makeImage(encoding, bytes, padding);
      if (bytes == 4) {
        for (std::uint32_t i = 0; i + 4 <= message->data.size(); i += 4) {
          const float metres = 0.25F * static_cast<float>(1 + i);
          std::memcpy(&message->data[i], &metres, sizeof metres);
        }
      }
      const Stored stored(*message);
      const cv::Mat copy = copyDepth(stored.image());
      ASSERT_EQ(copy.type(), bytes == 4 ? CV_32FC1 : CV_16UC1) << encoding;
      EXPECT_TRUE(areEqual(DepthMap(copy, 1000).metres(), toDepthMap(message, 1000).metres()))
          << encoding << " with " << padding << " bytes of padding";
    }
  }
  const auto message = makeImage(encodings::TYPE_16UC1, 2, 2);
  const std::uint16_t units = 40000;
  std::memcpy(&message->data[2 * message->step + 2 * 5], &units, sizeof units);
  const Stored stored(*message);
  EXPECT_EQ(copyDepth(stored.image()).at<std::uint16_t>(2, 5), 40000);
}

/// The message itself has an answer, or words for what is wrong.
TEST(ImageBytes, WhatIsNotUsualIsLeftToTheMessage) {
  const auto expectLeft = [](const sensor_msgs::ImagePtr& message, const char* why) {
    const Stored stored(*message);
    EXPECT_TRUE(copyPixels(stored.image()).empty()) << why;
    EXPECT_TRUE(copyDepth(stored.image()).empty()) << why;
  };
  expectLeft(makeImage(encodings::BGRA8, 4, 0), "a rare encoding");
  for (const auto& [encoding, bytes] : {std::pair<std::string, std::uint32_t>{encodings::MONO8, 1},
                                        {encodings::BGR8, 3},
                                        {encodings::RGB8, 3},
                                        {encodings::TYPE_16UC1, 2},
                                        {encodings::TYPE_32FC1, 4}}) {
    SCOPED_TRACE(encoding);
    auto message = makeImage(encoding, bytes, 2);
    message->data.pop_back();
    expectLeft(message, "a byte too few");
    message = makeImage(encoding, bytes, 2);
    message->data.push_back(0);
    expectLeft(message, "a byte too many");
    message = makeImage(encoding, bytes, 0);
    --message->step;
    message->data.resize(message->step * kHeight);
    expectLeft(message, "rows that are too short");
    message = makeImage(encoding, bytes, 0);
    message->width = 0;
    expectLeft(message, "no columns");
    message = makeImage(encoding, bytes, 0);
    message->height = 0;
    message->data.clear();
    expectLeft(message, "no rows");
  }
}

TEST(ImageBytes, BigEndianDepthIsLeftToTheMessage) {
  for (const auto& [encoding, bytes] :
       {std::pair<std::string, std::uint32_t>{encodings::TYPE_16UC1, 2},
        {encodings::TYPE_32FC1, 4}}) {
    const auto message = makeImage(encoding, bytes, 0);
    EXPECT_FALSE(copyDepth(Stored(*message).image()).empty()) << encoding;
    message->is_bigendian = 1;
    EXPECT_TRUE(copyDepth(Stored(*message).image()).empty()) << encoding;
  }
  const auto message = makeImage(encodings::TYPE_16UC1, 2, 0);
  message->is_bigendian = 1;
  EXPECT_EQ(toDepthMap(message, 1).at(0, 0), 0x0102) << "the bytes 1 and 2";
  const auto grey = makeImage(encodings::MONO8, 1, 0);
  grey->is_bigendian = 1;
  EXPECT_FALSE(copyPixels(Stored(*grey).image()).empty()) << "single bytes have no order";
}

}  // namespace
}  // namespace evolin::ros_shell
