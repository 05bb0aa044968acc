// The header of compressed_depth_image_transport, and PNG behind it.
#include "compressed_depth.h"

#include <sensor_msgs/image_encodings.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <opencv2/imgcodecs.hpp>
#include <vector>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"

namespace evolin::ros_shell {

namespace {

namespace encodings = sensor_msgs::image_encodings;

/// As the transport writes it: an integer of 4 bytes for the kind of quantisation, then a and b of
/// pixel = a / depth + b as floats, little-endian.
struct Quantisation {
  static constexpr std::size_t kHeader = 12;
  float a = 0;
  float b = 0;
};

bool hasHeader(const std::string& format) {
  return format.find("compressedDepth") != std::string::npos;
}

std::string encodingOf(const std::string& format) { return format.substr(0, format.find(';')); }

std::string describe(const sensor_msgs::CompressedImage& message) {
  return "compressed depth of format " + quote(message.format) + " and " +
         std::to_string(message.data.size()) + " bytes: ";
}

Quantisation readQuantisation(const sensor_msgs::CompressedImage& message) {
  if (message.data.size() <= Quantisation::kHeader) {
    throw Error(describe(message) + "no picture behind a header of " +
                std::to_string(Quantisation::kHeader) + " bytes");
  }
  Quantisation quantisation;
  std::memcpy(&quantisation.a, message.data.data() + 4, sizeof(float));
  std::memcpy(&quantisation.b, message.data.data() + 8, sizeof(float));
  return quantisation;
}

cv::Mat decode(const sensor_msgs::CompressedImage& message, std::size_t header) {
  cv::Mat stored;
  try {
    const auto begin = message.data.begin() + static_cast<std::ptrdiff_t>(header);
    stored =
        cv::imdecode(std::vector<std::uint8_t>(begin, message.data.end()), cv::IMREAD_UNCHANGED);
  } catch (const std::exception& error) {  // OpenCV's own
    throw Error(describe(message) + error.what());
  }
  if (stored.empty() || stored.type() != CV_16UC1) {
    throw Error(describe(message) + "no picture of one channel of 16 bits, expected PNG");
  }
  return stored;
}

cv::Mat metresOf(const cv::Mat& stored, const Quantisation& quantisation) {
  cv::Mat metres(stored.size(), CV_32FC1);
  for (int y = 0; y < stored.rows; ++y) {
    const auto* const from = stored.ptr<std::uint16_t>(y);
    auto* const to = metres.ptr<float>(y);
    for (int x = 0; x < stored.cols; ++x) {
      to[x] = from[x] == 0 ? std::numeric_limits<float>::quiet_NaN()
                           : quantisation.a / (static_cast<float>(from[x]) - quantisation.b);
    }
  }
  return metres;
}

}  // namespace

bool isDepthEncoding(const std::string& encoding) {
  return encoding == encodings::TYPE_16UC1 || encoding == encodings::MONO16 ||
         encoding == encodings::TYPE_32FC1;
}

bool isCompressedDepth(const std::string& format) {
  return hasHeader(format) || isDepthEncoding(encodingOf(format));
}

DepthMap toDepthMap(const sensor_msgs::CompressedImage& message, double depth_factor) {
  if (!hasHeader(message.format)) {
    return DepthMap(decode(message, 0), depth_factor);
  }
  const Quantisation quantisation = readQuantisation(message);
  const cv::Mat stored = decode(message, Quantisation::kHeader);
  if (encodingOf(message.format) != encodings::TYPE_32FC1) {
    return DepthMap(stored, depth_factor);
  }
  if (!(quantisation.a > 0) || !std::isfinite(quantisation.a) || !std::isfinite(quantisation.b)) {
    throw Error(describe(message) + "quantised with a " + formatDouble(quantisation.a) + " and b " +
                formatDouble(quantisation.b) + ", expected a finite b and a finite a above 0");
  }
  return DepthMap(metresOf(stored, quantisation), depth_factor);
}

}  // namespace evolin::ros_shell
