// OpenCV's DNN module, or its absence.
#include "network_engine.h"

#include <algorithm>
#include <array>
#include <utility>

#include "evolin_ros/base/error.h"

namespace evolin {

#if EVOLIN_HAS_DNN

namespace {

template <typename Value>
struct Named {
  const char* name;
  Value value;
};

using Backend = Named<cv::dnn::Backend>;
using Target = Named<cv::dnn::Target>;

/// CUDA came with OpenCV 4.2.
std::vector<Backend> backends() {
  return {
    {"opencv", cv::dnn::DNN_BACKEND_OPENCV}, {"openvino", cv::dnn::DNN_BACKEND_INFERENCE_ENGINE},
#if CV_VERSION_MAJOR > 4 || (CV_VERSION_MAJOR == 4 && CV_VERSION_MINOR >= 2)
    {
      "cuda", cv::dnn::DNN_BACKEND_CUDA
    }
#endif
  };
}

std::vector<Target> targets() {
  return {
    {"cpu", cv::dnn::DNN_TARGET_CPU}, {"opencl", cv::dnn::DNN_TARGET_OPENCL},
        {"opencl_fp16", cv::dnn::DNN_TARGET_OPENCL_FP16}, {"myriad", cv::dnn::DNN_TARGET_MYRIAD},
#if CV_VERSION_MAJOR > 4 || (CV_VERSION_MAJOR == 4 && CV_VERSION_MINOR >= 2)
        {"cuda", cv::dnn::DNN_TARGET_CUDA}, {
      "cuda_fp16", cv::dnn::DNN_TARGET_CUDA_FP16
    }
#endif
  };
}

}  // namespace

Network::Engine::Engine(const std::vector<std::uint8_t>& onnx, std::string input,
                        const std::vector<std::string>& outputs)
    : input_(std::move(input)),
      outputs_(outputs.begin(), outputs.end()),
      net_(cv::dnn::readNetFromONNX(onnx)) {}

void Network::Engine::use(const std::string& owner, const std::string& backend,
                          const std::string& target) {
  std::string available;
  for (const Backend& one : backends()) {
    std::vector<cv::dnn::Target> known;
    try {
      known = cv::dnn::getAvailableTargets(one.value);
    } catch (const cv::Exception&) {
      continue;  // some versions throw for a backend that they were built without
    }
    for (const Target& other : targets()) {
      if (std::find(known.begin(), known.end(), other.value) == known.end()) {
        continue;
      }
      if (backend == one.name && target == other.name) {
        net_.setPreferableBackend(one.value);
        net_.setPreferableTarget(other.value);
        return;
      }
      available += (available.empty() ? "" : ", ") + std::string(one.name) + " on " + other.name;
    }
  }
  throw UnavailableError(owner + ": OpenCV " + CV_VERSION + " here does not run networks by '" +
                         backend + "' on '" + target + "'; available: " + available);
}

void Network::Engine::run(const cv::Mat& input, std::vector<cv::Mat>* outputs) {
  net_.setInput(input, input_);
  net_.forward(*outputs, outputs_);
}

#else

Network::Engine::Engine(const std::vector<std::uint8_t>& /*onnx*/, std::string input,
                        const std::vector<std::string>& /*outputs*/)
    : input_(std::move(input)) {}

void Network::Engine::use(const std::string& owner, const std::string& /*backend*/,
                          const std::string& /*target*/) {
  throw UnavailableError(owner + ": " + whyNoNetworks());
}

void Network::Engine::run(const cv::Mat& /*input*/, std::vector<cv::Mat>* outputs) {
  outputs->clear();
}

#endif

}  // namespace evolin
