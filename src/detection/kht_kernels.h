// Clusters of collinear edge pixels, and the Gaussian with which each votes.
#pragma once

#include <vector>

#include "canny_edges.h"
#include "evolin_ros/detection/kht.h"
#include "pixel_chains.h"

namespace evolin::kht {

/// A Gaussian over lines x cos(theta) + y sin(theta) = rho, from the image's middle.
struct Kernel {
  double rho = 0;             ///< pixels
  double theta = 0;           ///< degrees, 0 to 180
  double rho_variance = 0;    ///< square pixels
  double theta_variance = 0;  ///< square degrees
  double covariance = 0;      ///< pixels times degrees

  /// Its density at an offset from its middle.
  double at(double rho_offset, double theta_offset) const;
};

/// Makes kernels of one image after the other, in buffers that it keeps.
class KernelFinder {
 public:
  explicit KernelFinder(const KhtParameters& parameters) : parameters_(parameters) {}

  /// Takes the edge pixels away. The result is valid until the next call.
  const std::vector<Kernel>& find(CannyEdges* edges);

 private:
  struct Cluster {
    std::size_t begin = 0;
    std::size_t end = 0;
  };

  void link(CannyEdges* edges);
  void follow(CannyEdges* edges, EdgePixel from);
  double split(std::size_t first, std::size_t last);
  Kernel kernelOf(const Cluster& cluster, double middle_x, double middle_y) const;

  KhtParameters parameters_;
  PixelChains chains_;
  std::vector<Cluster> clusters_;
  std::vector<Kernel> kernels_;
};

}  // namespace evolin::kht
