// A neural network from an ONNX file, run by OpenCV's DNN module.
#pragma once

#include <memory>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "evolin_ros/base/parameters.h"
#include "evolin_ros/inference/onnx_file.h"

namespace evolin {

/// What a method asks of its network's file. Sides of -1 may be anything; the order of the outputs
/// is that of Network::run()'s answers, not of the file.
struct NetworkInterface {
  std::string owner;  ///< at the head of every message, "detector mlsd"
  TensorInfo input;
  std::vector<TensorInfo> outputs;
  std::vector<std::string> digests;  ///< SHA-256 of published files, without a sum of their own
  std::string how_to_get;            ///< one sentence for who has no such file
};

/// How a network is run. The parameters of a plug-in have the same names.
struct NetworkOptions {
  std::string model;               ///< file, or a name that is looked for among the model files
  std::string backend = "opencv";  ///< opencv, cuda, openvino
  std::string target = "cpu";      ///< cpu, opencl, opencl_fp16, cuda, cuda_fp16, myriad
  int threads = 0;                 ///< of OpenCV in the whole process, 0 to 1024; 0: as they are
  bool verify = true;              ///< refuses a file whose sum is neither recorded in it nor known
};

/// The parameters `model`, `backend`, `target`, `threads` and `verify` of a plug-in.
void readNetworkOptions(ParameterReader* reader, NetworkOptions* options);

/// Why no network can run in this build ("" when they can).
std::string whyNoNetworks();

/// One loaded network. One thread at a time; two instances share nothing but OpenCV's threads.
class Network {
 public:
  /// Loads the file, compares its inputs and outputs with the interface and runs it once on zeros,
  /// which also warms it up. Throws UnavailableError where OpenCV lacks the DNN module, the backend
  /// or the target, or the file is not there, saying how to get it; ConfigError for an empty model;
  /// Error, naming the file, both sides of what differs and where to get the right one, for a file
  /// that is damaged, not verified or of another network.
  Network(NetworkInterface interface, const NetworkOptions& options);
  ~Network();
  Network(Network&&) noexcept;
  Network& operator=(Network&&) noexcept;
  Network(const Network&) = delete;
  Network& operator=(const Network&) = delete;

  /// The input as the file has it, with a batch of one where that is open.
  const std::vector<int>& inputShape() const { return input_shape_; }

  /// Runs on one float tensor of the input's shape. The answers, in the interface's order, are the
  /// network's own memory until the next call. Throws Error when OpenCV does.
  const std::vector<cv::Mat>& run(const cv::Mat& input);

  /// Time of the last run(), milliseconds.
  double lastMilliseconds() const { return last_milliseconds_; }

 private:
  struct Engine;

  void compare(const OnnxFile& onnx) const;
  void warmUp();

  NetworkInterface interface_;
  std::string file_;
  std::vector<int> input_shape_;
  std::vector<cv::Mat> outputs_;
  std::unique_ptr<Engine> engine_;
  double last_milliseconds_ = 0;
};

}  // namespace evolin
