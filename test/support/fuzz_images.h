// Images that are hard on detectors and associators, each named and the same in every run.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <opencv2/core/check.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "test/support/random_lines.h"

namespace evolin::test {

struct NamedImage {
  std::string name;
  cv::Mat image;
};

/// Grey values that `value(x, y)` gives.
template <typename Value>
cv::Mat drawImage(cv::Size size, Value value) {
  cv::Mat image(size, CV_8UC1);
  for (int y = 0; y < image.rows; ++y) {
    auto* row = image.ptr<std::uint8_t>(y);
    for (int x = 0; x < image.cols; ++x) row[x] = static_cast<std::uint8_t>(value(x, y));
  }
  return image;
}

inline cv::Mat uniformNoise(cv::Size size, int type, RandomLines* random) {
  cv::Mat image(size, type);
  for (int y = 0; y < image.rows; ++y) {
    auto* row = image.ptr<std::uint8_t>(y);
    std::generate(row, row + static_cast<std::ptrdiff_t>(image.elemSize()) * image.cols,
                  [&] { return static_cast<std::uint8_t>(random->index(256)); });
  }
  return image;
}

/// The same for a size.
inline cv::Mat uniformNoise(cv::Size size, int type) {
  RandomLines random(static_cast<std::uint64_t>(size.height) * 1000 +
                     static_cast<std::uint64_t>(size.width));
  return uniformNoise(size, type, &random);
}

/// Shapes that have made a filter or a table run empty.
inline std::vector<cv::Size> awkwardSizes() {
  return {{1, 1},   {640, 1}, {1, 640}, {2, 2},    {3, 3},    {4, 4},   {5, 5},
          {6, 6},   {7, 7},   {640, 2}, {2, 640},  {640, 3},  {3, 640}, {5, 64},
          {64, 5},  {6, 64},  {64, 6},  {7, 200},  {9, 9},    {13, 8},  {16, 16},
          {31, 33}, {64, 64}, {97, 64}, {203, 97}, {160, 120}};
}

/// Flat, saturated, periodic, steep, smooth and random: one of each kind.
inline std::vector<NamedImage> patterns(cv::Size size) {
  const int w = size.width;
  const int h = size.height;
  RandomLines random(static_cast<std::uint64_t>(w) * 10007 + static_cast<std::uint64_t>(h));
  std::vector<NamedImage> images;
  const auto drawn = [&](const char* name, auto value) {
    images.push_back({name, drawImage(size, value)});
  };
  drawn("black", [](int, int) { return 0; });
  drawn("grey", [](int, int) { return 128; });
  drawn("saturated", [](int, int) { return 255; });
  drawn("checkerboard", [](int x, int y) { return (x + y) % 2 * 255; });
  drawn("coarse checkerboard", [](int x, int y) { return (x / 8 + y / 8) % 2 * 255; });
  drawn("columns of a pixel", [](int x, int) { return x % 2 * 255; });
  drawn("rows of a pixel", [](int, int y) { return y % 2 * 255; });
  drawn("rows of two pixels", [](int, int y) { return y / 2 % 2 * 255; });
  drawn("single columns", [](int x, int) { return x % 11 == 5 ? 255 : 0; });
  drawn("single diagonals", [](int x, int y) { return (x + y) % 11 == 5 ? 255 : 0; });
  drawn("saturated diagonals", [](int x, int y) { return (x + 2 * y) / 16 % 2 * 255; });
  drawn("faint columns", [](int x, int) { return 128 + x % 2; });
  drawn("ramp to the right", [w](int x, int) { return 255 * x / std::max(1, w - 1); });
  drawn("ramp down", [h](int, int y) { return 255 * y / std::max(1, h - 1); });
  drawn("ramp of a level a pixel", [](int x, int y) { return (x + y) % 256; });
  drawn("saw", [](int x, int y) { return (8 * x + 3 * y) % 256; });
  drawn("rings", [](int x, int y) { return (x * x + y * y) / 64 % 256; });
  drawn("frame",
        [w, h](int x, int y) { return x == 0 || y == 0 || x == w - 1 || y == h - 1 ? 255 : 0; });
  drawn("one pixel", [w, h](int x, int y) { return x == w / 2 && y == h / 2 ? 255 : 0; });
  drawn("last corner", [w, h](int x, int y) { return x == w - 1 && y == h - 1 ? 255 : 0; });
  drawn("step", [w](int x, int) { return x < w / 2 ? 0 : 255; });
  images.push_back({"noise", uniformNoise(size, CV_8UC1, &random)});
  images.push_back({"colour noise", uniformNoise(size, CV_8UC3, &random)});
  images.push_back({"binary noise", uniformNoise(size, CV_8UC1, &random) > 127});
  images.push_back({"specks", uniformNoise(size, CV_8UC1, &random) > 253});
  cv::Mat coarse;
  cv::resize(uniformNoise({std::max(1, w / 16), std::max(1, h / 16)}, CV_8UC1, &random), coarse,
             size, 0, 0, cv::INTER_CUBIC);
  images.push_back({"clouds", coarse});
  return images;
}

/// Polygons, strokes and discs of random grey, with blur, noise or hard contrast, or a window into
/// a larger image; sizes up to 240 x 180.
inline NamedImage randomScene(std::uint64_t seed) {
  RandomLines random(seed);
  const cv::Size size(1 + static_cast<int>(random.index(240)),
                      1 + static_cast<int>(random.index(180)));
  const int type = random.index(3) == 0 ? CV_8UC3 : CV_8UC1;
  cv::Mat image(size, type, cv::Scalar::all(static_cast<double>(random.index(256))));
  const auto point = [&] {
    // Also beyond the borders.
    return cv::Point(static_cast<int>(random.uniform(-0.3, 1.3) * size.width),
                     static_cast<int>(random.uniform(-0.3, 1.3) * size.height));
  };
  for (std::size_t left = random.index(25); left > 0; --left) {
    const cv::Scalar colour(static_cast<double>(random.index(256)),
                            static_cast<double>(random.index(256)),
                            static_cast<double>(random.index(256)));
    const int line_type = random.index(2) == 0 ? cv::LINE_AA : cv::LINE_8;
    switch (random.index(3)) {
      case 0:
        cv::fillConvexPoly(image, std::vector<cv::Point>{point(), point(), point()}, colour,
                           line_type);
        break;
      case 1:
        cv::line(image, point(), point(), colour, 1 + static_cast<int>(random.index(5)), line_type);
        break;
      default:
        cv::circle(image, point(), static_cast<int>(random.index(60)), colour, cv::FILLED,
                   line_type);
    }
  }
  switch (random.index(5)) {
    case 0:
      cv::GaussianBlur(image, image, cv::Size(5, 5), 1.5);
      break;
    case 1:
      cv::addWeighted(image, 0.8, uniformNoise(size, type, &random), 0.2, 0, image);
      break;
    case 2:
      image = image > 127;
      break;
    default:
      break;
  }
  if (random.index(4) == 0) {
    const cv::Rect window(size.width / 4, size.height / 4, size.width - size.width / 2,
                          size.height - size.height / 2);
    image = image(window);
  }
  return {"scene " + std::to_string(seed), image};
}

/// The largest image that a detector is asked to take, with a few long edges.
inline cv::Mat hugeImage() {
  constexpr int kSide = 8192;
  cv::Mat image(kSide, kSide, CV_8UC1, cv::Scalar(40));
  cv::fillConvexPoly(image,
                     std::vector<cv::Point>{{600, 400}, {8191, 1100}, {7000, 8191}, {300, 7100}},
                     cv::Scalar(200), cv::LINE_AA);
  return image;
}

/// Every pattern in every awkward size, and random scenes.
inline std::vector<NamedImage> fuzzImages() {
  std::vector<NamedImage> images;
  for (const cv::Size& size : awkwardSizes()) {
    for (NamedImage& one : patterns(size)) {
      one.name += ", " + std::to_string(size.width) + "x" + std::to_string(size.height);
      images.push_back(std::move(one));
    }
  }
  constexpr std::uint64_t kScenes = 60;
  for (std::uint64_t seed = 1; seed <= kScenes; ++seed) images.push_back(randomScene(seed));
  return images;
}

/// Images of a type that no method takes: not 8 bits a channel, or another number of channels.
inline std::vector<NamedImage> foreignImages() {
  std::vector<NamedImage> images = {{"empty", cv::Mat()}};
  const std::vector<int> types = {CV_16UC1, CV_16SC1, CV_32SC1, CV_32FC1, CV_64FC1, CV_8SC1,
                                  CV_8UC2,  CV_8UC4,  CV_16UC3, CV_32FC3, CV_64FC3};
  for (const int type : types) {
    cv::Mat image(48, 64, type, cv::Scalar::all(0));
    image.colRange(20, 40).setTo(cv::Scalar::all(1));
    images.push_back({cv::typeToString(type), image});
  }
  const int cube[] = {16, 16, 16};
  images.push_back({"of three dimensions", cv::Mat(3, cube, CV_8UC1, cv::Scalar(7))});
  return images;
}

}  // namespace evolin::test
