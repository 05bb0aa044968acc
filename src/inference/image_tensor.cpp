// Resizing and normalising by tables: a sample has 256 values only.
#include "evolin_ros/inference/image_tensor.h"

#include "evolin_ros/base/error.h"

namespace evolin {
namespace {

/// Channel of a BGR image that is channel `c` of the tensor.
int sourceChannel(ChannelOrder order, int c) { return order == ChannelOrder::kRgb ? 2 - c : c; }

}  // namespace

ImageTensor::ImageTensor(const ImageTensorOptions& options) : options_(options) {
  if (options.size.width < 1 || options.size.height < 1 || options.divisor == 0) {
    throw Error("a network's input needs a size and a divisor other than 0");
  }
  for (std::size_t c = 0; c < values_.size(); ++c) {
    if (options.deviation[c] == 0) {
      throw Error("a network's input needs a deviation other than 0");
    }
    for (std::size_t v = 0; v < values_[c].size(); ++v) {
      const float scaled = static_cast<float>(v) / options.divisor;
      const float centred = scaled - options.mean[c];
      values_[c][v] = centred / options.deviation[c];
    }
  }
  const int height = options.size.height;
  const int width = options.size.width;
  const bool planar = options.layout == TensorLayout::kNchw;
  const std::array<int, 4> shape =
      planar ? std::array<int, 4>{1, 3, height, width} : std::array<int, 4>{1, height, width, 3};
  tensor_.create(static_cast<int>(shape.size()), shape.data(), CV_32F);
}

const cv::Mat& ImageTensor::of(const cv::Mat& image) {
  if (image.empty() || image.dims != 2 || (image.type() != CV_8UC1 && image.type() != CV_8UC3)) {
    throw Error("a network takes 8-bit grey or BGR images; got one of OpenCV's type " +
                std::to_string(image.type()) + " and " + std::to_string(image.cols) + "x" +
                std::to_string(image.rows) + " pixels");
  }
  if (options_.resize_as_float) {
    resizeFloat(image);
    return tensor_;
  }
  const cv::Mat* fitting = &image;
  if (image.size() != options_.size) {
    cv::resize(image, resized_, options_.size, 0, 0, options_.interpolation);
    fitting = &resized_;
  }
  if (options_.layout == TensorLayout::kNchw) {
    writePlanes(*fitting);
  } else {
    cv::Mat samples(options_.size, CV_32FC3, tensor_.ptr<float>());
    writeSamples(*fitting, &samples);
  }
  return tensor_;
}

void ImageTensor::writePlanes(const cv::Mat& image) {
  const int channels = image.channels();
  float* out = tensor_.ptr<float>();
  for (int c = 0; c < 3; ++c) {
    const std::array<float, 256>& values = values_[static_cast<std::size_t>(c)];
    const int source = channels == 1 ? 0 : sourceChannel(options_.order, c);
    for (int y = 0; y < image.rows; ++y) {
      const std::uint8_t* row = image.ptr<std::uint8_t>(y) + source;
      for (int x = 0; x < image.cols; ++x) {
        *out++ = values[row[x * channels]];
      }
    }
  }
}

void ImageTensor::writeSamples(const cv::Mat& image, cv::Mat* samples) const {
  const int channels = image.channels();
  for (int y = 0; y < image.rows; ++y) {
    const std::uint8_t* row = image.ptr<std::uint8_t>(y);
    float* out = samples->ptr<float>(y);
    for (int x = 0; x < image.cols; ++x, row += channels) {
      for (int c = 0; c < 3; ++c) {
        const int source = channels == 1 ? 0 : sourceChannel(options_.order, c);
        *out++ = values_[static_cast<std::size_t>(c)][row[source]];
      }
    }
  }
}

void ImageTensor::resizeFloat(const cv::Mat& image) {
  samples_.create(image.size(), CV_32FC3);
  writeSamples(image, &samples_);
  if (options_.layout == TensorLayout::kNhwc) {
    // The result lies where the tensor does.
    cv::Mat samples(options_.size, CV_32FC3, tensor_.ptr<float>());
    cv::resize(samples_, samples, options_.size, 0, 0, options_.interpolation);
    return;
  }
  cv::resize(samples_, resized_, options_.size, 0, 0, options_.interpolation);
  std::vector<cv::Mat> planes;
  for (int c = 0; c < 3; ++c) {
    planes.emplace_back(options_.size, CV_32FC1, tensor_.ptr<float>(0, c));
  }
  cv::split(resized_, planes);
}

}  // namespace evolin
