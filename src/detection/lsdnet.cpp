// LSDNet: the network's interface, parameters, one frame's way through it.
#include "evolin_ros/detection/lsdnet.h"

#include <utility>

#include "evolin_ros/base/availability.h"
#include "evolin_ros/base/error.h"
#include "lsdnet_decoding.h"
#include "network_detector.h"

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
class LsdNet::Engine : public NetworkDetector<lsdnet::Decoder> {
 public:
  using NetworkDetector::NetworkDetector;
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
  Network network(interface(), read.network);
  const ImageTensorOptions input = inputOf(read);
  engine_ = std::make_unique<Engine>(kOwner, read, std::move(network), input,
                                     lsdnet::Decoder(decodingOf(read)));
  parameters_ = read;
}

LineSegments LsdNet::detect(const Frame& frame) {
  if (!engine_) {
    throw Error(std::string(kOwner) + ": detect() was called before configure()");
  }
  return engine_->detect(frame, &times_);
}

}  // namespace evolin
