// The one place that talks to OpenCV's DNN module, so that the rest compiles without it.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "evolin_opencv_features.h"
#include "evolin_ros/inference/network.h"

#if EVOLIN_HAS_DNN
#include <opencv2/dnn.hpp>
#endif

namespace evolin {

/// Throws cv::Exception as OpenCV does.
struct Network::Engine {
 public:
  Engine(const std::vector<std::uint8_t>& onnx, std::string input,
         const std::vector<std::string>& outputs);

  /// Throws UnavailableError naming what this OpenCV and machine have.
  void use(const std::string& owner, const std::string& backend, const std::string& target);

  void run(const cv::Mat& input, std::vector<cv::Mat>* outputs);

 private:
  std::string input_;
#if EVOLIN_HAS_DNN
  std::vector<cv::String> outputs_;
  cv::dnn::Net net_;
#endif
};

}  // namespace evolin
