// Memory is given again only once nobody else holds it.
#include "src/ros/image_pool.h"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "src/ros/image_bytes.h"

namespace evolin::ros_shell {
namespace {

TEST(ImagePool, GivesOnlyWhatNobodyElseHolds) {
  ImagePool pool;
  EXPECT_TRUE(pool.take().empty());
  cv::Mat first(4, 6, CV_8UC3);
  cv::Mat second(4, 6, CV_8UC3);
  const cv::Mat part_of_second = second.rowRange(1, 2);
  const std::uint8_t* const memory = first.data;
  pool.keep(first);
  pool.keep(second);
  EXPECT_TRUE(pool.take().empty());
  second.release();
  EXPECT_TRUE(pool.take().empty()) << "a part of it is still there";
  std::thread([&first] { first.release(); }).join();
  EXPECT_EQ(pool.take().data, memory);
  EXPECT_TRUE(pool.take().empty()) << "it is not kept any more";
}

TEST(ImagePool, KeepsNothingThatHasNoMemoryOfItsOwn) {
  ImagePool pool;
  std::uint8_t pixels[4] = {};
  pool.keep(cv::Mat());
  pool.keep(cv::Mat(2, 2, CV_8UC1, pixels));
  EXPECT_TRUE(pool.take().empty());
}

TEST(ImagePool, FillsWithImagesOfAnySize) {
  ImagePool pool;
  const std::vector<std::uint8_t> pixels = {1, 2, 3, 4, 5, 6};
  ImageBytes bytes;
  bytes.height = 1;
  bytes.encoding = "mono8";
  bytes.data = pixels.data();
  const std::uint8_t* memory = nullptr;
  for (const std::uint32_t width : {6U, 6U, 4U}) {
    bytes.width = width;
    bytes.step = width;
    bytes.size = width;
    const cv::Mat image = copyPixels(bytes, pool.take());
    pool.keep(image);
    ASSERT_EQ(image.cols, static_cast<int>(width));
    EXPECT_EQ(image.at<std::uint8_t>(0, 3), 4);
    if (memory != nullptr && width == 6) {
      EXPECT_EQ(image.data, memory);
    }
    memory = image.data;
  }
}

}  // namespace
}  // namespace evolin::ros_shell
