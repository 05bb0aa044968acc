// Images to tensors: order of channels, layout, normalising, resizing.
#include "evolin_ros/inference/image_tensor.h"

#include <gtest/gtest.h>

#include "evolin_ros/base/error.h"

namespace evolin {
namespace {

/// Blue, green and red of the pixel at (x, y) are different everywhere.
cv::Mat colours() {
  cv::Mat image(3, 4, CV_8UC3);
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 4; ++x) {
      image.at<cv::Vec3b>(y, x) = cv::Vec3b(static_cast<std::uint8_t>(10 * x + y),
                                            static_cast<std::uint8_t>(60 + 10 * x + y),
                                            static_cast<std::uint8_t>(120 + 10 * x + y));
    }
  }
  return image;
}

ImageTensorOptions optionsFor(const cv::Mat& image) {
  ImageTensorOptions options;
  options.size = image.size();
  return options;
}

TEST(ImageTensor, PutsChannelsWhereTheLayoutWantsThem) {
  const cv::Mat image = colours();
  for (const ChannelOrder order : {ChannelOrder::kRgb, ChannelOrder::kBgr}) {
    for (const bool as_float : {false, true}) {
      ImageTensorOptions options = optionsFor(image);
      options.order = order;
      options.resize_as_float = as_float;
      ImageTensor planar(options);
      options.layout = TensorLayout::kNhwc;
      ImageTensor interleaved(options);
      const cv::Mat& planes = planar.of(image);
      const cv::Mat& samples = interleaved.of(image);
      ASSERT_EQ(planes.dims, 4);
      ASSERT_EQ(planes.size[1], 3);
      ASSERT_EQ(samples.size[3], 3);
      for (int c = 0; c < 3; ++c) {
        for (int y = 0; y < 3; ++y) {
          for (int x = 0; x < 4; ++x) {
            const int source = order == ChannelOrder::kRgb ? 2 - c : c;
            const float value = image.at<cv::Vec3b>(y, x)[source];
            EXPECT_EQ(planes.ptr<float>(0, c)[4 * y + x], value);
            EXPECT_EQ(samples.ptr<float>(0, y)[3 * x + c], value);
          }
        }
      }
    }
  }
}

TEST(ImageTensor, Normalises) {
  cv::Mat image(1, 1, CV_8UC3, cv::Scalar(0, 51, 255));
  ImageTensorOptions options = optionsFor(image);
  options.divisor = 255;
  options.mean = {0.5F, 0.1F, 0};
  options.deviation = {0.5F, 0.2F, 1};
  ImageTensor tensor(options);
  const float* values = tensor.of(image).ptr<float>();
  EXPECT_FLOAT_EQ(values[0], 1);
  EXPECT_FLOAT_EQ(values[1], 0.5F);
  EXPECT_FLOAT_EQ(values[2], 0);
}

TEST(ImageTensor, GreyIsThreeEqualChannels) {
  const cv::Mat image(5, 7, CV_8UC1, cv::Scalar(77));
  ImageTensor tensor(optionsFor(image));
  const cv::Mat& values = tensor.of(image);
  EXPECT_EQ(
      cv::norm(values, cv::Mat(values.dims, values.size.p, CV_32F, cv::Scalar(77)), cv::NORM_INF),
      0);
}

// Half of 0 and 255 is 127.5: in 8 bits it is rounded, as floats it is not.
TEST(ImageTensor, ResizesBytesOrFloats) {
  cv::Mat image(1, 2, CV_8UC1, cv::Scalar(0));
  image.at<std::uint8_t>(0, 1) = 255;
  ImageTensorOptions options;
  options.size = cv::Size(1, 1);
  ImageTensor bytes(options);
  EXPECT_EQ(bytes.of(image).ptr<float>()[0], 128);
  options.resize_as_float = true;
  for (const TensorLayout layout : {TensorLayout::kNchw, TensorLayout::kNhwc}) {
    options.layout = layout;
    ImageTensor floats(options);
    const float* values = floats.of(image).ptr<float>();
    for (int c = 0; c < 3; ++c) {
      EXPECT_EQ(values[c], 127.5F);
    }
  }
}

TEST(ImageTensor, OneInstanceTakesImagesOfAllSizesAndWindows) {
  ImageTensorOptions options;
  options.size = cv::Size(16, 8);
  options.interpolation = cv::INTER_AREA;
  ImageTensor tensor(options);
  const cv::Mat large(64, 64, CV_8UC3, cv::Scalar(1, 2, 3));
  for (const cv::Rect& part : {cv::Rect(0, 0, 64, 64), cv::Rect(5, 7, 16, 8), cv::Rect(9, 9, 1, 1),
                               cv::Rect(3, 3, 2, 50)}) {
    const float* values = tensor.of(large(part)).ptr<float>();
    EXPECT_EQ(values[0], 3);
    EXPECT_EQ(values[16 * 8 * 3 - 1], 1);
  }
}

TEST(ImageTensor, RefusesOtherImagesAndOptions) {
  ImageTensor tensor(optionsFor(colours()));
  EXPECT_THROW(tensor.of(cv::Mat()), Error);
  EXPECT_THROW(tensor.of(cv::Mat(2, 2, CV_16UC1)), Error);
  EXPECT_THROW(ImageTensor(ImageTensorOptions{}), Error);
  ImageTensorOptions options = optionsFor(colours());
  options.deviation[1] = 0;
  EXPECT_THROW(ImageTensor{options}, Error);
}

}  // namespace
}  // namespace evolin
