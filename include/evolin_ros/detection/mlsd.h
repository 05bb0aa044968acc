// M-LSD, a small neural network (Gu, Ko, Go, Lee, Lee, Shin: Towards Light-weight and Real-time
// Line Segment Detection, AAAI 2022).
#pragma once

#include <memory>
#include <string>

#include "evolin_ros/detection/detector_selection.h"
#include "evolin_ros/detection/line_detector.h"
#include "evolin_ros/detection/network_times.h"
#include "evolin_ros/inference/network.h"

namespace evolin {

/// The defaults are those of the benchmark; the authors' own are score_threshold 0.1 and
/// min_grid_length 20.
struct MlsdParameters {
  NetworkOptions network;
  double min_grid_length = 2;  ///< longer segments stay, pixels of the maps, 0 to 10000
  int candidates = 200;        ///< the best centres, before the length is looked at, 1 to 100000
  bool clip = false;           ///< cut at the outer edges of the image's pixels
  DetectorSelection selection;

  MlsdParameters() {
    network.model = "mlsd_tiny_512.onnx";
    selection.score_threshold = 0.01;
  }
};

/// Plug-in `mlsd`, for the tiny and the large network of any input size; lines by falling score,
/// the probability of their centre. Parameters `model`, ... are those of NetworkOptions.
class Mlsd : public LineDetector {
 public:
  Mlsd();
  ~Mlsd() override;

  void configure(const YAML::Node& parameters) override;
  std::string whyUnavailable() const override { return whyNoNetworks(); }
  bool givesScores() const override { return true; }
  LineSegments detect(const Frame& frame) override;

  const MlsdParameters& parameters() const { return parameters_; }
  const NetworkTimes& times() const { return times_; }

 private:
  class Engine;

  MlsdParameters parameters_;
  NetworkTimes times_;
  std::unique_ptr<Engine> engine_;
};

}  // namespace evolin
