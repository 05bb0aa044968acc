// Image files: structural checks that notice a file cut off in the middle, then OpenCV's decoders.
#include "evolin_ros/dataset/image_file.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "evolin_ros/base/atomic_file.h"
#include "evolin_ros/base/error.h"
#include "evolin_ros/geometry/projection.h"

namespace evolin {

namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes readBytes(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::exists(file, error)) {
    throw ParseError(file.string(), 0, "the image does not exist, expected a readable file");
  }
  std::ifstream stream(file, std::ios::binary);
  if (std::filesystem::is_directory(file, error) || !stream) {
    throw ParseError(file.string(), 0, "the image cannot be opened, expected a readable file");
  }
  Bytes bytes((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  if (bytes.empty()) {
    throw ParseError(file.string(), 0, "the file is empty (0 bytes), expected an image");
  }
  return bytes;
}

constexpr std::array<std::uint8_t, 8> kPngSignature = {0x89, 'P', 'N', 'G', 0x0d, 0x0a, 0x1a, 0x0a};

bool startsAsPng(const Bytes& bytes) {
  return bytes.size() >= kPngSignature.size() &&
         std::equal(kPngSignature.begin(), kPngSignature.end(), bytes.begin());
}

bool startsAsJpeg(const Bytes& bytes) {
  return bytes.size() >= 3 && bytes[0] == 0xff && bytes[1] == 0xd8 && bytes[2] == 0xff;
}

// Walks from chunk to chunk (length, type, data, check sum) until IEND.
bool isWholePng(const Bytes& bytes) {
  constexpr std::size_t kFrame = 12;
  std::size_t position = kPngSignature.size();
  while (bytes.size() - position >= kFrame) {
    const std::uint8_t* chunk = bytes.data() + position;
    const std::size_t length = (std::size_t{chunk[0]} << 24) | (std::size_t{chunk[1]} << 16) |
                               (std::size_t{chunk[2]} << 8) | std::size_t{chunk[3]};
    if (bytes.size() - position - kFrame < length) {
      return false;
    }
    if (std::equal(chunk + 4, chunk + 8, "IEND")) {
      return true;
    }
    position += kFrame + length;
  }
  return false;
}

// Walks over the marker segments and the coded data behind each start of scan until the end
// marker. Looking for the last two bytes alone would refuse files with padding and would accept a
// thumbnail's end marker.
bool isWholeJpeg(const Bytes& bytes) {
  constexpr std::uint8_t kEndOfImage = 0xd9;
  constexpr std::uint8_t kStartOfScan = 0xda;
  const auto stands_alone = [](std::uint8_t code) {
    return code == 0x01 || (code >= 0xd0 && code <= 0xd8);
  };
  std::size_t position = 2;
  while (position + 1 < bytes.size()) {
    if (bytes[position] != 0xff) {
      return false;
    }
    const std::uint8_t code = bytes[position + 1];
    if (code == 0xff) {  // fill byte
      ++position;
      continue;
    }
    position += 2;
    if (code == kEndOfImage) {
      return true;
    }
    if (stands_alone(code)) {
      continue;
    }
    if (position + 1 >= bytes.size()) {
      return false;
    }
    position += (std::size_t{bytes[position]} << 8) | std::size_t{bytes[position + 1]};
    if (code == kStartOfScan) {
      // Within coded data 0xff is followed by 0 (a plain 0xff) or by a restart marker.
      while (position + 1 < bytes.size() &&
             (bytes[position] != 0xff || bytes[position + 1] == 0 ||
              (bytes[position + 1] >= 0xd0 && bytes[position + 1] <= 0xd7))) {
        ++position;
      }
    }
  }
  return false;
}

cv::Mat decode(const std::filesystem::path& file, int flags) {
  const Bytes bytes = readBytes(file);
  if (startsAsPng(bytes) && !isWholePng(bytes)) {
    throw ParseError(file.string(), 0,
                     "the PNG is truncated: its " + std::to_string(bytes.size()) +
                         " bytes end before the closing IEND chunk");
  }
  if (startsAsJpeg(bytes) && !isWholeJpeg(bytes)) {
    throw ParseError(file.string(), 0,
                     "the JPEG is truncated: its " + std::to_string(bytes.size()) +
                         " bytes end before the end-of-image marker");
  }
  cv::Mat image;
  try {
    image = cv::imdecode(bytes, flags);
  } catch (const cv::Exception& error) {
    throw ParseError(file.string(), 0, "the image cannot be decoded: " + error.err);
  }
  if (image.empty()) {
    throw ParseError(file.string(), 0,
                     "the " + std::to_string(bytes.size()) +
                         " bytes cannot be decoded, expected an image (PNG or JPEG)");
  }
  return image;
}

}  // namespace

const std::vector<std::string>& imageExtensions() {
  static const std::vector<std::string> kExtensions = {".png", ".jpg", ".jpeg", ".bmp", ".pgm",
                                                       ".ppm", ".tif", ".tiff", ".webp"};
  return kExtensions;
}

cv::Mat readImage(const std::filesystem::path& file) { return decode(file, cv::IMREAD_ANYCOLOR); }

cv::Mat readStoredDepth(const std::filesystem::path& file) {
  cv::Mat stored = decode(file, cv::IMREAD_UNCHANGED);
  if (stored.type() != CV_16UC1) {
    throw ParseError(file.string(), 0,
                     "the depth image has " + std::to_string(stored.channels()) + " channels of " +
                         std::to_string(8 * stored.elemSize1()) +
                         " bits, expected one channel of 16 bits");
  }
  return stored;
}

cv::Mat readDepthImage(const std::filesystem::path& file, double depth_factor) {
  return DepthMap(readStoredDepth(file), depth_factor).metres();
}

void writeImage(const std::filesystem::path& file, const cv::Mat& image,
                const std::vector<int>& parameters) {
  Bytes bytes;
  bool encoded = false;
  std::string why;
  try {
    encoded = cv::imencode(file.extension().string(), image, bytes, parameters);
  } catch (const cv::Exception& error) {
    why = ": " + error.err;
  }
  if (!encoded) {
    throw Error(file.string() + ": the image cannot be encoded" + why);
  }
  writeFileAtomically(file, std::string(bytes.begin(), bytes.end()));
}

}  // namespace evolin
