// Networks by OpenCV's DNN module: options, checks, the error messages.
#include "evolin_ros/inference/network.h"

#include <algorithm>
#include <utility>

#include "evolin_opencv_features.h"
#include "evolin_ros/base/availability.h"
#include "evolin_ros/base/error.h"
#include "evolin_ros/base/stop_watch.h"
#include "evolin_ros/inference/model_files.h"
#include "network_engine.h"

namespace evolin {
namespace {

std::string toText(const std::vector<TensorInfo>& tensors) {
  std::string text;
  for (const TensorInfo& tensor : tensors) {
    text += (text.empty() ? "" : ", ") + toText(tensor);
  }
  return text;
}

/// Whether a tensor of `actual`'s shape is one of the `declared`; open sides fit everything.
bool fits(const std::vector<int>& actual, const std::vector<int>& declared) {
  return actual.size() == declared.size() &&
         std::equal(actual.begin(), actual.end(), declared.begin(),
                    [](int a, int b) { return a < 0 || b < 0 || a == b; });
}

bool fits(const std::vector<TensorInfo>& actual, const TensorInfo& declared) {
  return std::any_of(actual.begin(), actual.end(), [&](const TensorInfo& tensor) {
    return tensor.name == declared.name && fits(tensor.shape, declared.shape);
  });
}

std::filesystem::path locate(const NetworkInterface& interface, const std::string& model) {
  if (model.empty()) {
    throw ConfigError(interface.owner, "model", "is empty; expected the name of an ONNX file");
  }
  if (const auto file = findModelFile(model)) {
    return *file;
  }
  const std::string where =
      model.find('/') == std::string::npos ? " in " + searchedFolders() : std::string();
  // Like a library that is not there: a matrix of methods goes on with the others.
  throw UnavailableError(interface.owner + ": parameter 'model': there is no file '" + model + "'" +
                         where + ". " + interface.how_to_get);
}

OnnxFile readChecked(const NetworkInterface& interface, const std::filesystem::path& file,
                     bool verify) {
  OnnxFile onnx;
  try {
    onnx = readOnnxFile(file);
  } catch (const ParseError& error) {
    throw Error(interface.owner + ": " + error.what() + ". " + interface.how_to_get);
  }
  const bool known = onnx.isAsRecorded() ||
                     std::find(interface.digests.begin(), interface.digests.end(), onnx.digest) !=
                         interface.digests.end();
  if (verify && !known) {
    throw Error(interface.owner + ": " + file.string() + ": " +
                (onnx.recorded_digest.empty()
                     ? "its SHA-256 " + onnx.digest + " is not that of a published file"
                     : std::string("its content is not what its maker wrote (sum of the graph ") +
                           onnx.graph_digest + ", recorded " + onnx.recorded_digest + ")") +
                ". " + interface.how_to_get +
                " 'verify: false' uses it nevertheless, at your own risk");
  }
  return onnx;
}

}  // namespace

void readNetworkOptions(ParameterReader* reader, NetworkOptions* options) {
  reader->read("model", &options->model);
  reader->read("backend", &options->backend, {"opencv", "cuda", "openvino"});
  reader->read("target", &options->target,
               {"cpu", "opencl", "opencl_fp16", "cuda", "cuda_fp16", "myriad"});
  reader->read("threads", &options->threads, 0, 1024);
  reader->read("verify", &options->verify);
}

std::string whyNoNetworks() {
#if EVOLIN_HAS_DNN
  return {};
#else
  return missingInOpenCv("the module dnn, which runs networks", "3.3, as an optional module");
#endif
}

Network::Network(NetworkInterface interface, const NetworkOptions& options)
    : interface_(std::move(interface)) {
  requireAvailable(interface_.owner, whyNoNetworks());
  file_ = locate(interface_, options.model).string();
  const OnnxFile onnx = readChecked(interface_, file_, options.verify);
  compare(onnx);
  for (const TensorInfo& input : onnx.inputs) {
    if (input.name == interface_.input.name) {
      input_shape_ = input.shape;
    }
  }
  for (std::size_t i = 0; i < input_shape_.size(); ++i) {
    // The file leaves open what the method knows, or it is the batch.
    if (input_shape_[i] < 0) {
      input_shape_[i] = interface_.input.shape[i] > 0 ? interface_.input.shape[i] : 1;
    }
  }
  if (options.threads > 0) {
    cv::setNumThreads(options.threads);
  }
  std::vector<std::string> names;
  for (const TensorInfo& output : interface_.outputs) {
    names.push_back(output.name);
  }
  try {
    engine_ = std::make_unique<Engine>(onnx.bytes, interface_.input.name, names);
  } catch (const cv::Exception& error) {
    throw Error(interface_.owner + ": " + file_ + ": OpenCV " + CV_VERSION +
                " cannot load it: " + error.err + ". " + interface_.how_to_get);
  }
  engine_->use(interface_.owner, options.backend, options.target);
  warmUp();
}

Network::~Network() = default;
Network::Network(Network&&) noexcept = default;
Network& Network::operator=(Network&&) noexcept = default;

void Network::compare(const OnnxFile& onnx) const {
  bool same = fits(onnx.inputs, interface_.input) && onnx.inputs.size() == 1;
  for (const TensorInfo& output : interface_.outputs) {
    same = same && fits(onnx.outputs, output);
  }
  if (!same) {
    throw Error(interface_.owner + ": " + file_ + ": is another network: its input is " +
                toText(onnx.inputs) + " and its output " + toText(onnx.outputs) +
                "; expected the input " + toText(interface_.input) + " and the output " +
                toText(interface_.outputs) + ". " + interface_.how_to_get);
  }
}

void Network::warmUp() {
  const cv::Mat zeros(static_cast<int>(input_shape_.size()), input_shape_.data(), CV_32F,
                      cv::Scalar(0));
  run(zeros);
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    const cv::Mat& output = outputs_[i];
    const std::vector<int> shape(output.size.p, output.size.p + output.dims);
    if (output.depth() != CV_32F || !fits(shape, interface_.outputs[i].shape)) {
      throw Error(interface_.owner + ": " + file_ + ": gives " +
                  toText(TensorInfo{interface_.outputs[i].name, shape}) + "; expected " +
                  toText(interface_.outputs[i]));
    }
  }
}

const std::vector<cv::Mat>& Network::run(const cv::Mat& input) {
  const std::vector<int> shape(input.size.p, input.size.p + input.dims);
  if (input.type() != CV_32F || shape != input_shape_) {
    throw Error(interface_.owner + ": the network got " +
                toText(TensorInfo{interface_.input.name, shape}) + "; expected " +
                toText(TensorInfo{interface_.input.name, input_shape_}));
  }
  const StopWatch watch;
  try {
    engine_->run(input, &outputs_);
  } catch (const cv::Exception& error) {
    throw Error(interface_.owner + ": " + file_ + ": OpenCV " + CV_VERSION +
                " cannot run it: " + error.err);
  }
  last_milliseconds_ = watch.milliseconds();
  return outputs_;
}

}  // namespace evolin
