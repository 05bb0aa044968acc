// The accumulator of KHT: kernels vote for lines, and its peaks are lines.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <opencv2/core.hpp>
#include <vector>

#include "kht_kernels.h"

namespace evolin::kht {

/// x cos(theta) + y sin(theta) = rho, from the image's middle.
struct PolarLine {
  double rho = 0;    ///< pixels
  double theta = 0;  ///< degrees
};

/// Votes for one image after the other, in buffers that it keeps.
class Accumulator {
 public:
  explicit Accumulator(double delta) : delta_(delta) {}

  /// Lines by falling number of votes. The result is valid until the next call.
  const std::vector<PolarLine>& vote(const std::vector<Kernel>& kernels, cv::Size size);

 private:
  /// A bin that has votes, and those of its neighbourhood.
  struct Peak {
    std::int64_t votes = 0;
    std::size_t bin = 0;
  };

  /// Bins [begin, end) of one theta, by rho.
  struct Span {
    int begin = std::numeric_limits<int>::max();
    int end = 0;
  };

  void clear(cv::Size size);
  void voteQuarter(const Kernel& kernel, double scale, int rho_step, int theta_step);
  void findPeaks();

  std::size_t binAt(int rho, int theta) const {
    return static_cast<std::size_t>(theta) * static_cast<std::size_t>(rhos_ + 2) +
           static_cast<std::size_t>(rho);
  }

  double delta_ = 0;
  double greatest_rho_ = 0;
  int rhos_ = 0;    // bins are from 1 to rhos_, and
  int thetas_ = 0;  // from 1 to thetas_; those around stay empty
  std::vector<std::int32_t> votes_;
  std::vector<Span> spans_;  // of the bins with votes, by theta
  std::vector<std::uint8_t> visited_;
  std::vector<Peak> peaks_;
  std::vector<PolarLine> lines_;
};

}  // namespace evolin::kht
