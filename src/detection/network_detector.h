// One frame's way through a detector that is a network: preparing, forward pass, decoding, choice.
#pragma once

#include <string>
#include <utility>

#include "evolin_ros/base/stop_watch.h"
#include "evolin_ros/dataset/frame.h"
#include "evolin_ros/detection/detector_selection.h"
#include "evolin_ros/detection/network_times.h"
#include "evolin_ros/inference/image_tensor.h"
#include "evolin_ros/inference/network.h"

namespace evolin {

/// `Decoder` has LineSegments decode(const cv::Mat& maps, cv::Size size): the network's first
/// output to lines in pixels of an image of that size, not cut.
template <typename Decoder>
class NetworkDetector {
 public:
  /// `parameters` are a plug-in's, with `clip` (lines are cut at the image) and `selection`.
  template <typename Parameters>
  NetworkDetector(std::string owner, const Parameters& parameters, Network network,
                  const ImageTensorOptions& input, Decoder decoder)
      : owner_(std::move(owner)),
        clip_(parameters.clip),
        filter_(parameters.selection),
        network_(std::move(network)),
        tensor_(input),
        decoder_(std::move(decoder)) {}

  LineSegments detect(const Frame& frame, NetworkTimes* times) {
    StopWatch watch;
    const cv::Mat& input = tensor_.of(frame.image);
    times->preparing = watch.milliseconds();
    const cv::Mat& maps = network_.run(input).front();
    times->forward = network_.lastMilliseconds();
    watch.restart();
    LineSegments lines = decoder_.decode(maps, frame.image.size());
    lines = clip_ ? filter_.apply(std::move(lines), frame.image.size(), owner_)
                  : filter_.applyUncut(std::move(lines), frame.image.size(), owner_);
    times->decoding = watch.milliseconds();
    return lines;
  }

 private:
  std::string owner_;
  bool clip_;
  LineFilter filter_;
  Network network_;
  ImageTensor tensor_;
  Decoder decoder_;
};

}  // namespace evolin
