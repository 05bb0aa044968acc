// A sensor_msgs/Image whose pixels stay where the message was serialized, for messages of bags: the
// message proper fills its pixels with zeros, copies them, and is then copied once more.
#pragma once

#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <sensor_msgs/Image.h>
#include <std_msgs/Header.h>

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>

namespace evolin::ros_shell {

struct ImageBytes {
  std_msgs::Header header;
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  std::string encoding;
  std::uint8_t is_bigendian = 0;
  std::uint32_t step = 0;              ///< bytes from row to row
  std::uint32_t size = 0;              ///< of `data`, bytes
  const std::uint8_t* data = nullptr;  ///< valid as long as the bytes that this was read from
};

/// A copy of the pixels as toFrame() has them, CV_8UC1 or BGR CV_8UC3; empty for an image that
/// takes cv_bridge (a rare encoding, or nothing that an image can be), which then says what is
/// wrong with it. It is made in `memory` where that has the size: nobody else may hold it.
cv::Mat copyPixels(const ImageBytes& image, cv::Mat memory = {});

/// The same of depth: CV_16UC1 or CV_32FC1 as stored.
cv::Mat copyDepth(const ImageBytes& image, cv::Mat memory = {});

}  // namespace evolin::ros_shell

namespace ros {

namespace message_traits {

template <>
struct MD5Sum<evolin::ros_shell::ImageBytes> : MD5Sum<sensor_msgs::Image> {};

template <>
struct DataType<evolin::ros_shell::ImageBytes> : DataType<sensor_msgs::Image> {};

}  // namespace message_traits

namespace serialization {

template <>
struct Serializer<evolin::ros_shell::ImageBytes> {
  template <class Stream>
  static void read(Stream& stream, evolin::ros_shell::ImageBytes& image) {
    stream.next(image.header);
    stream.next(image.height);
    stream.next(image.width);
    stream.next(image.encoding);
    stream.next(image.is_bigendian);
    stream.next(image.step);
    stream.next(image.size);
    image.data = stream.advance(image.size);
  }
};

}  // namespace serialization

}  // namespace ros
