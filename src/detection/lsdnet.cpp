// LSDNet: the network's interface, parameters, one frame's way through it.
#include "evolin_ros/detection/lsdnet.h"

#include <utility>

#include "evolin_ros/base/availability.h"
#include "evolin_ros/base/error.h"
#include "evolin_ros/base/stop_watch.h"
#include "evolin_ros/inference/image_tensor.h"
#include "lsdnet_decoding.h"

namespace evolin {
namespace {

const char* const kOwner = "detector lsdnet";
constexpr int kSide = 288;

NetworkInterface interface() {
  NetworkInterface lsdnet;
  lsdnet.owner = kOwner;
  lsdnet.input = {"input_1:0", {1, kSide, kSide, 3}};
  lsdnet.outputs = {{"Identity:0", {1, kSide, kSide, 2}}};
  lsdnet.digests = {"175f2f84430f5c1b22b253afb15526abea80a83284e78edf50deac5a9bd80dc3"};
  lsdnet.how_to_get = "lsdnet.onnx is in the authors' repository (docs/NETWORKS.md).";
  return lsdnet;
}

ImageTensorOptions inputOf(const LsdNetParameters& parameters) {
  ImageTensorOptions options;
  options.size = cv::Size(kSide, kSide);
  options.resize_as_float = true;
  options.order = parameters.channel_order == "rgb" ? ChannelOrder::kRgb : ChannelOrder::kBgr;
  options.layout = TensorLayout::kNhwc;
  options.divisor = 255;
  return options;
}

lsdnet::DecodingOptions decodingOf(const LsdNetParameters& parameters) {
  lsdnet::DecodingOptions options;
  options.compatible = parameters.compatible;
  options.single_pass = parameters.single_pass;
  return options;
}

}  // namespace

/// The stages behind LsdNet.
class LsdNet::Engine {
 public:
  explicit Engine(const LsdNetParameters& parameters)
      : clip_(parameters.clip),
        filter_(parameters.selection),
        decoder_(decodingOf(parameters)),
        network_(interface(), parameters.network),
        tensor_(inputOf(parameters)) {}

  LineSegments detect(const Frame& frame, NetworkTimes* times) {
    StopWatch watch;
    const cv::Mat& input = tensor_.of(frame.image);
    times->preparing = watch.milliseconds();
    const cv::Mat& maps = network_.run(input).front();
    times->forward = network_.lastMilliseconds();
    watch.restart();
    LineSegments lines = decoder_.decode(maps, frame.image.size());
    lines = clip_ ? filter_.apply(std::move(lines), frame.image.size(), kOwner)
                  : filter_.applyUncut(std::move(lines), frame.image.size(), kOwner);
    times->decoding = watch.milliseconds();
    return lines;
  }

 private:
  bool clip_;
  LineFilter filter_;
  lsdnet::Decoder decoder_;
  Network network_;
  ImageTensor tensor_;
};

LsdNet::LsdNet() = default;
LsdNet::~LsdNet() = default;

void LsdNet::configure(const YAML::Node& parameters) {
  requireAvailable(kOwner, whyUnavailable());
  LsdNetParameters read;
  ParameterReader reader(parameters, kOwner);
  readNetworkOptions(&reader, &read.network);
  reader.read("channel_order", &read.channel_order, {"rgb", "bgr"});
  reader.read("compatible", &read.compatible);
  reader.read("single_pass", &read.single_pass);
  reader.read("clip", &read.clip);
  readSelection(&reader, &read.selection);
  reader.finish();
  engine_ = std::make_unique<Engine>(read);
  parameters_ = read;
}

LineSegments LsdNet::detect(const Frame& frame) {
  if (!engine_) {
    throw Error(std::string(kOwner) + ": detect() was called before configure()");
  }
  return engine_->detect(frame, &times_);
}

}  // namespace evolin
