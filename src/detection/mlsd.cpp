// M-LSD: the network's interface, parameters, one frame's way through it.
#include "evolin_ros/detection/mlsd.h"

#include <utility>

#include "evolin_ros/base/availability.h"
#include "evolin_ros/base/error.h"
#include "mlsd_decoding.h"
#include "network_detector.h"

namespace evolin {
namespace {

const char* const kOwner = "detector mlsd";

NetworkInterface interface() {
  NetworkInterface mlsd;
  mlsd.owner = kOwner;
  mlsd.input = {"image", {1, 3, -1, -1}};
  mlsd.outputs = {{"maps", {1, 5, -1, -1}}};
  mlsd.how_to_get =
      "'scripts/models/convert mlsd' makes it of the authors' weights (docs/NETWORKS.md).";
  return mlsd;
}

ImageTensorOptions inputOf(const std::vector<int>& shape) {
  ImageTensorOptions options;
  options.size = cv::Size(shape[3], shape[2]);
  options.interpolation = cv::INTER_AREA;
  options.divisor = 127.5F;
  options.mean = {1, 1, 1};
  return options;
}

mlsd::DecodingOptions decodingOf(const MlsdParameters& parameters) {
  mlsd::DecodingOptions options;
  options.score_threshold = parameters.selection.score_threshold;
  options.min_grid_length = parameters.min_grid_length;
  options.candidates = parameters.candidates;
  return options;
}

}  // namespace

/// The stages behind Mlsd.
class Mlsd::Engine : public NetworkDetector<mlsd::Decoder> {
 public:
  using NetworkDetector::NetworkDetector;
};

Mlsd::Mlsd() = default;
Mlsd::~Mlsd() = default;

void Mlsd::configure(const YAML::Node& parameters) {
  requireAvailable(kOwner, whyUnavailable());
  MlsdParameters read;
  ParameterReader reader(parameters, kOwner);
  readNetworkOptions(&reader, &read.network);
  reader.read("min_grid_length", &read.min_grid_length, 0.0, 10000.0);
  reader.read("candidates", &read.candidates, 1, 100000);
  reader.read("clip", &read.clip);
  readSelection(&reader, &read.selection);
  reader.finish();
  Network network(interface(), read.network);
  const ImageTensorOptions input = inputOf(network.inputShape());
  engine_ = std::make_unique<Engine>(kOwner, read, std::move(network), input,
                                     mlsd::Decoder(decodingOf(read)));
  parameters_ = read;
}

LineSegments Mlsd::detect(const Frame& frame) {
  if (!engine_) {
    throw Error(std::string(kOwner) + ": detect() was called before configure()");
  }
  return engine_->detect(frame, &times_);
}

}  // namespace evolin
