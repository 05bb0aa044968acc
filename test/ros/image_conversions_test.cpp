// Image and depth messages of every encoding as frames, shared where they can be.
#include <gtest/gtest.h>
#include <sensor_msgs/image_encodings.h>
#include <boost/make_shared.hpp>
#include <boost/weak_ptr.hpp>

#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <opencv2/core.hpp>

#include "conversions.h"
#include "evolin_ros/base/error.h"
#include "test/support/expect_error.h"
#include "test/support/fuzz.h"

namespace evolin::ros_shell {
namespace {

namespace encodings = sensor_msgs::image_encodings;
using test::expectError;

constexpr std::uint32_t kWidth = 6;
constexpr std::uint32_t kHeight = 4;

/// Rows of `pixel_bytes` a pixel and `padding` bytes more, filled with 0xEE; the stamp is 3.5 s.
sensor_msgs::ImagePtr makeImage(const std::string& encoding, std::uint32_t pixel_bytes,
                                std::uint32_t padding = 0) {
  const auto message = boost::make_shared<sensor_msgs::Image>();
  message->header.stamp = ros::Time(3, 500000000);
  message->encoding = encoding;
  message->width = kWidth;
  message->height = kHeight;
  message->step = kWidth * pixel_bytes + padding;
  message->data.assign(message->step * kHeight, 0xEE);
  return message;
}

template <typename Value>
void setValue(sensor_msgs::Image* message, std::uint32_t x, std::uint32_t y, Value value) {
  std::memcpy(&message->data[y * message->step + x * sizeof value], &value, sizeof value);
}

/// Writes the colour (blue, green, red) = (10 + x, 100 + y, 200) at every pixel.
void paint(sensor_msgs::Image* message, const std::string& channels) {
  for (std::uint32_t y = 0; y < kHeight; ++y) {
    for (std::uint32_t x = 0; x < kWidth; ++x) {
      std::uint8_t* pixel = &message->data[y * message->step + x * channels.size()];
      for (const char channel : channels) {
        *pixel++ = static_cast<std::uint8_t>(channel == 'b'   ? 10 + x
                                             : channel == 'g' ? 100 + y
                                             : channel == 'r' ? 200
                                                              : 255);
      }
    }
  }
}

TEST(ToFrame, GivesBgrForEveryColourEncodingAndPadding) {
  const std::pair<std::string, std::string> orders[] = {{encodings::BGR8, "bgr"},
                                                        {encodings::RGB8, "rgb"},
                                                        {encodings::BGRA8, "bgra"},
                                                        {encodings::RGBA8, "rgba"}};
  for (const auto& [encoding, channels] : orders) {
    for (const std::uint32_t padding : {0U, 1U, 2U, 7U, 64U}) {
      const auto message =
          makeImage(encoding, static_cast<std::uint32_t>(channels.size()), padding);
      paint(message.get(), channels);
      const Frame frame = toFrame(message);
      ASSERT_EQ(frame.image.type(), CV_8UC3) << encoding;
      ASSERT_EQ(frame.image.size(), cv::Size(kWidth, kHeight));
      EXPECT_EQ(frame.stamp, 3500000000);
      EXPECT_EQ(frame.name, "3.500000");
      for (std::uint32_t y = 0; y < kHeight; ++y) {
        for (std::uint32_t x = 0; x < kWidth; ++x) {
          EXPECT_EQ(
              frame.image.at<cv::Vec3b>(static_cast<int>(y), static_cast<int>(x)),
              cv::Vec3b(static_cast<std::uint8_t>(10 + x), static_cast<std::uint8_t>(100 + y), 200))
              << encoding << " with " << padding << " bytes of padding";
        }
      }
    }
  }
}

TEST(ToFrame, GivesGreyForOneChannelWithPadding) {
  for (const std::uint32_t padding : {0U, 3U, 10U}) {
    const auto message =
        makeImage(padding == 3 ? encodings::TYPE_8UC1 : encodings::MONO8, 1, padding);
    for (std::uint32_t y = 0; y < kHeight; ++y) {
      for (std::uint32_t x = 0; x < kWidth; ++x) {
        setValue(message.get(), x, y, static_cast<std::uint8_t>(10 * y + x));
      }
    }
    const Frame frame = toFrame(message);
    ASSERT_EQ(frame.image.type(), CV_8UC1);
    EXPECT_EQ(frame.image.at<std::uint8_t>(3, 5), 35);
    EXPECT_EQ(frame.image.at<std::uint8_t>(1, 0), 10);
  }
}

TEST(ToFrame, SharesTheMemoryOfBgr8AndMono8) {
  for (const std::uint32_t padding : {0U, 5U}) {
    const auto colour = makeImage(encodings::BGR8, 3, padding);
    EXPECT_EQ(toFrame(colour).image.data, colour->data.data());
    const auto grey = makeImage(encodings::MONO8, 1, padding);
    EXPECT_EQ(toFrame(grey).image.data, grey->data.data());
    const auto other = makeImage(encodings::RGB8, 3, padding);
    EXPECT_NE(toFrame(other).image.data, other->data.data());
  }
}

TEST(ToFrame, AFrameOutlivesItsMessage) {
  auto message = makeImage(encodings::MONO8, 1);
  const boost::weak_ptr<sensor_msgs::Image> watched = message;
  auto frame = std::make_unique<Frame>(toFrame(message));
  message.reset();
  ASSERT_FALSE(watched.expired()) << "the image points into freed memory";
  EXPECT_EQ(cv::sum(frame->image)[0], 0xEE * kWidth * kHeight);
  Frame copy = *frame;
  frame.reset();
  EXPECT_FALSE(watched.expired());
  EXPECT_EQ(copy.image.at<std::uint8_t>(3, 5), 0xEE);
  copy = Frame();
  EXPECT_TRUE(watched.expired()) << "the message is kept for ever";
}

TEST(ToFrame, RefusesWhatIsNoPictureByItsEncoding) {
  for (const auto& [encoding, bytes] :
       {std::pair<std::string, std::uint32_t>{encodings::TYPE_16UC1, 2},
        {encodings::TYPE_32FC1, 4},
        {encodings::TYPE_64FC4, 32},
        {encodings::TYPE_8UC2, 2},
        {"", 1},
        {"yuv", 3},
        {"no such encoding", 3},
        {"BGR8", 3}}) {
    expectError([&, name = encoding, size = bytes] { toFrame(makeImage(name, size)); },
                {"'" + encoding + "'"});
  }
}

TEST(ToFrame, RefusesMessagesThatContradictThemselves) {
  auto message = makeImage(encodings::BGR8, 3);
  message->data.pop_back();
  expectError([&] { toFrame(message); }, {"bgr8"});
  message = makeImage(encodings::BGR8, 3);
  message->step = kWidth * 3 - 1;
  expectError([&] { toFrame(message); }, {"bgr8"});
  message = makeImage(encodings::MONO8, 1);
  message->height = 1000000;
  expectError([&] { toFrame(message); }, {"mono8"});
  message = makeImage(encodings::MONO8, 1);
  message->width = message->height = message->step = 0;
  message->data.clear();
  expectError([&] { toFrame(message); }, {"3.500000", "no pixels"});
}

TEST(ToFrame, AnswersEveryEncodingAndDamageWithAFrameOrOneError) {
  test::Fuzzer fuzzer(11);
  const std::vector<std::string> names = {
      "bgr8",         "rgb8",         "bgra8",        "rgba8",        "mono8",     "mono16",
      "bgr16",        "rgba16",       "8UC1",         "8UC3",         "8SC1",      "16UC1",
      "16SC3",        "32SC1",        "32FC1",        "32FC3",        "64FC1",     "bayer_rggb8",
      "bayer_bggr8",  "bayer_gbrg16", "yuv422",       "yuv422_yuy2",  "nv21",      "8UC",
      "8UC100000000", "32FC0",        "bayer_rggb16", "16UC18446744", "8UC4 junk", "8UC4"};
  test::FuzzCounts frames;
  test::FuzzCounts depths;
  for (int round = 0; round < 4000; ++round) {
    const auto message = makeImage(names[fuzzer.below(names.size())],
                                   static_cast<std::uint32_t>(1 + fuzzer.below(8)));
    if (fuzzer.below(3) == 0) message->encoding = fuzzer.damaged(message->encoding);
    if (fuzzer.below(3) == 0) message->width = static_cast<std::uint32_t>(fuzzer.below(12));
    if (fuzzer.below(3) == 0) message->height = static_cast<std::uint32_t>(fuzzer.below(12));
    if (fuzzer.below(3) == 0) message->step = static_cast<std::uint32_t>(fuzzer.below(60));
    if (fuzzer.below(3) == 0) message->data.resize(message->step * message->height);
    if (fuzzer.below(6) == 0) message->is_bigendian = 1;
    test::countAnswer(
        [&] {
          const Frame frame = toFrame(message);
          EXPECT_FALSE(frame.image.empty());
          EXPECT_TRUE(frame.image.type() == CV_8UC1 || frame.image.type() == CV_8UC3);
        },
        message->encoding, &frames);
    test::countAnswer(
        [&] {
          const cv::Mat depth = toDepthMap(message, 5000).metres();
          EXPECT_FALSE(depth.empty());
          EXPECT_EQ(depth.type(), CV_32FC1);
        },
        message->encoding, &depths);
  }
  EXPECT_GT(frames.values, 100U);
  EXPECT_GT(frames.errors, 100U);
  EXPECT_GT(depths.values, 20U);
  EXPECT_GT(depths.errors, 100U);
}

TEST(ToDepthMap, DividesSixteenBitsByTheFactor) {
  for (const std::string& encoding : {encodings::TYPE_16UC1, encodings::MONO16}) {
    for (const std::uint32_t padding : {0U, 2U, 6U}) {
      const auto message = makeImage(encoding, 2, padding);
      setValue<std::uint16_t>(message.get(), 0, 0, 0);
      setValue<std::uint16_t>(message.get(), 1, 0, 5000);
      setValue<std::uint16_t>(message.get(), 5, 3, 65535);
      const cv::Mat depth = toDepthMap(message, 5000).metres();
      ASSERT_EQ(depth.type(), CV_32FC1);
      ASSERT_EQ(depth.size(), cv::Size(kWidth, kHeight));
      EXPECT_TRUE(std::isnan(depth.at<float>(0, 0))) << "0 says that there is no depth";
      EXPECT_FLOAT_EQ(depth.at<float>(0, 1), 1.0F);
      EXPECT_FLOAT_EQ(depth.at<float>(3, 5), 13.107F);
      EXPECT_FLOAT_EQ(toDepthMap(message, 1000).metres().at<float>(0, 1), 5.0F);
    }
  }
}

TEST(ToDepthMap, TakesMetresAndMakesNanOfWhatIsNone) {
  const auto message = makeImage(encodings::TYPE_32FC1, 4, 8);
  const float infinity = std::numeric_limits<float>::infinity();
  const float none[] = {0.0F,     -0.0F,     std::numeric_limits<float>::quiet_NaN(),
                        infinity, -infinity, -1.5F};
  for (std::uint32_t x = 0; x < kWidth; ++x) {
    setValue(message.get(), x, 0, none[x]);
    setValue(message.get(), x, 1, 0.5F + static_cast<float>(x));
    setValue(message.get(), x, 2, std::numeric_limits<float>::max());
    setValue(message.get(), x, 3, std::numeric_limits<float>::min());
  }
  const cv::Mat depth = toDepthMap(message, 5000).metres();
  for (int x = 0; x < static_cast<int>(kWidth); ++x) {
    EXPECT_TRUE(std::isnan(depth.at<float>(0, x))) << none[x];
    EXPECT_EQ(depth.at<float>(1, x), 0.5F + static_cast<float>(x)) << "metres take no factor";
    EXPECT_EQ(depth.at<float>(2, x), std::numeric_limits<float>::max());
    EXPECT_EQ(depth.at<float>(3, x), std::numeric_limits<float>::min());
  }
}

TEST(ToDepthMap, TakesBigEndianImages) {
  auto message = makeImage(encodings::TYPE_16UC1, 2, 4);
  message->is_bigendian = 1;
  setValue<std::uint16_t>(message.get(), 5, 3, 0x8813);  // 5000 with its bytes exchanged
  EXPECT_FLOAT_EQ(toDepthMap(message, 5000).metres().at<float>(3, 5), 1.0F);
  message = makeImage(encodings::TYPE_32FC1, 4, 4);
  message->is_bigendian = 1;
  setValue<std::uint32_t>(message.get(), 5, 3, 0x0000C03F);  // 1.5
  EXPECT_EQ(toDepthMap(message, 5000).metres().at<float>(3, 5), 1.5F);
}

TEST(ToDepthMap, RefusesOtherEncodingsAndMalformedImages) {
  expectError([] { toDepthMap(makeImage(encodings::BGR8, 3), 5000); },
              {"'bgr8'", "32FC1", "16UC1"});
  expectError([] { toDepthMap(makeImage("", 3), 5000); }, {"''"});
  auto message = makeImage(encodings::TYPE_16UC1, 2);
  message->data.pop_back();
  expectError([&] { toDepthMap(message, 5000); }, {"16UC1", "6x4", "step 12"});
  message = makeImage(encodings::TYPE_32FC1, 4);
  message->step = 3;
  expectError([&] { toDepthMap(message, 5000); }, {"32FC1", "step 3"});
  message = makeImage(encodings::TYPE_32FC1, 4);
  message->width = message->height = message->step = 0;
  message->data.clear();
  expectError([&] { toDepthMap(message, 5000); }, {"no pixels"});
}

}  // namespace
}  // namespace evolin::ros_shell
