// PNG header reading; OpenCV for the rest.
#include "image_size.h"

#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <optional>

#include "evolin_ros/base/error.h"

namespace evolin::cli {

namespace {

/// Signature, length and name of the IHDR chunk, width, height.
constexpr std::size_t kPngHeadLength = 24;
constexpr std::array<unsigned char, 8> kPngSignature = {0x89, 'P',  'N',  'G',
                                                        '\r', '\n', 0x1A, '\n'};

std::uint32_t bigEndian(const unsigned char* bytes) {
  return (std::uint32_t{bytes[0]} << 24U) | (std::uint32_t{bytes[1]} << 16U) |
         (std::uint32_t{bytes[2]} << 8U) | std::uint32_t{bytes[3]};
}

std::optional<ImageSize> readPngSize(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::array<unsigned char, kPngHeadLength> head = {};
  if (!stream.read(reinterpret_cast<char*>(head.data()), head.size()) ||
      std::memcmp(head.data(), kPngSignature.data(), kPngSignature.size()) != 0 ||
      std::memcmp(head.data() + 12, "IHDR", 4) != 0) {
    return std::nullopt;
  }
  constexpr std::uint32_t kLargestSide = 0x7FFFFFFF;
  const std::uint32_t width = bigEndian(head.data() + 16);
  const std::uint32_t height = bigEndian(head.data() + 20);
  if (width == 0 || height == 0 || width > kLargestSide || height > kLargestSide) {
    return std::nullopt;
  }
  return ImageSize{static_cast<int>(width), static_cast<int>(height)};
}

}  // namespace

ImageSize readImageSize(const std::filesystem::path& file) {
  if (const std::optional<ImageSize> size = readPngSize(file)) {
    return *size;
  }
  // Other headers do not tell alone: a JPEG may be stored on its side.
  cv::Mat image;
  try {
    image = cv::imread(file.string(), cv::IMREAD_GRAYSCALE);
  } catch (const cv::Exception& error) {
    throw Error(file.string() + ": not a readable image (" + error.what() + ")");
  }
  if (image.empty()) {
    throw Error(file.string() + ": not a readable image");
  }
  return {image.cols, image.rows};
}

}  // namespace evolin::cli
