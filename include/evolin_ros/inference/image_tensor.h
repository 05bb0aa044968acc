// Images as the tensors that networks take.
#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace evolin {

enum class ChannelOrder { kRgb, kBgr };
enum class TensorLayout { kNchw, kNhwc };

/// How a method makes its input. A sample v of the image becomes (v / divisor - mean) / deviation,
/// each step rounded to float.
struct ImageTensorOptions {
  cv::Size size;  ///< of the tensor; the image is stretched to it, each axis by its own factor
  int interpolation = cv::INTER_LINEAR;
  bool resize_as_float = false;  ///< resizes the finished samples, not the 8-bit image
  ChannelOrder order = ChannelOrder::kRgb;
  TensorLayout layout = TensorLayout::kNchw;
  float divisor = 1;
  std::array<float, 3> mean{0, 0, 0};       ///< in the tensor's channel order
  std::array<float, 3> deviation{1, 1, 1};  ///< the same
};

/// Holds the tensor of one image at a time, and the memory on the way to it.
class ImageTensor {
 public:
  ImageTensor() = default;

  /// Throws Error for an empty size or a divisor or deviation of zero.
  explicit ImageTensor(const ImageTensorOptions& options);

  /// The float tensor [1, 3, height, width] or [1, height, width, 3] of a non-empty 8-bit grey
  /// (three equal channels) or BGR image; overwritten by the next call. Throws Error for another
  /// type.
  const cv::Mat& of(const cv::Mat& image);

 private:
  void writePlanes(const cv::Mat& image);
  void writeSamples(const cv::Mat& image, cv::Mat* samples) const;
  void resizeFloat(const cv::Mat& image);

  ImageTensorOptions options_;
  std::array<std::array<float, 256>, 3> values_{};  ///< of channel c of the tensor
  cv::Mat tensor_;
  cv::Mat resized_;
  cv::Mat samples_;
};

}  // namespace evolin
