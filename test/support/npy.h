// Arrays of floats in NumPy's file format, as the golden maps of networks are stored.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <opencv2/core.hpp>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace evolin::test {

/// A float32 array in C order; throws std::runtime_error naming the file for anything else.
inline cv::Mat readNpy(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string head(10, '\0');
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(head[i]); };
  std::string header(stream ? byte(8) + 256U * byte(9) : 0U, '\0');
  stream.read(header.data(), static_cast<std::streamsize>(header.size()));
  const std::size_t begin = header.find("'shape': (");
  if (!stream || begin == std::string::npos || header.find("'<f4'") == std::string::npos ||
      header.find("'fortran_order': False") == std::string::npos) {
    throw std::runtime_error(file.string() + " is no array of float32");
  }
  std::istringstream text(header.substr(begin + 10));
  std::vector<int> shape;
  for (int side = 0; text >> side; text.ignore(1)) {
    shape.push_back(side);
  }
  cv::Mat array(static_cast<int>(shape.size()), shape.data(), CV_32F);
  stream.read(reinterpret_cast<char*>(array.data),
              static_cast<std::streamsize>(array.total() * sizeof(float)));
  if (!stream) {
    throw std::runtime_error(file.string() + " is cut short");
  }
  return array;
}

}  // namespace evolin::test
