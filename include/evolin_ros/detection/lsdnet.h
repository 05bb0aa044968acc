// LSDNet, a small neural network that finds line pixels and their angles, with growing of regions
// behind it (Teplyakov, Erlygin, Shvets: LSDNet: Trainable Modification of LSD Algorithm for
// Real-Time Line Segment Detection, IEEE Access 10, 2022).
#pragma once

#include <memory>
#include <string>

#include "evolin_ros/detection/detector_selection.h"
#include "evolin_ros/detection/line_detector.h"
#include "evolin_ros/detection/network_times.h"
#include "evolin_ros/inference/network.h"

namespace evolin {

/// The benchmark ran it with `compatible` and `channel_order: bgr`.
struct LsdNetParameters {
  NetworkOptions network;
  std::string channel_order = "rgb";  ///< of the network's input: rgb (the authors') or bgr
  bool compatible = false;   ///< as in the authors' code, lines along rows or columns of the
                             ///< network's grid become several of no length
  bool single_pass = false;  ///< regions grow in the whole image, not in quarters that are stitched
  bool clip = false;         ///< cut at the outer edges of the image's pixels
  DetectorSelection selection;

  LsdNetParameters() { network.model = "lsdnet.onnx"; }
};

/// Plug-in `lsdnet`; lines by falling score, the mean probability of their pixels. Ends are whole
/// pixels of the network's grid of 288 x 288. Parameters `model`, ... are those of NetworkOptions.
class LsdNet : public LineDetector {
 public:
  LsdNet();
  ~LsdNet() override;

  void configure(const YAML::Node& parameters) override;
  std::string whyUnavailable() const override { return whyNoNetworks(); }
  bool givesScores() const override { return true; }
  LineSegments detect(const Frame& frame) override;

  const LsdNetParameters& parameters() const { return parameters_; }
  const NetworkTimes& times() const { return times_; }

 private:
  class Engine;

  LsdNetParameters parameters_;
  NetworkTimes times_;
  std::unique_ptr<Engine> engine_;
};

}  // namespace evolin
