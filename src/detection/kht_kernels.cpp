// Linking, subdivision (Lowe, Artificial Intelligence 31, 1987), propagation of uncertainty.
#include "kht_kernels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>

#include "marked_pixels.h"

namespace evolin::kht {
namespace {

constexpr std::array<EdgePixel, 8> kNeighbours = {
    {{0, 1}, {1, 0}, {0, -1}, {-1, 0}, {1, 1}, {-1, 1}, {-1, -1}, {1, -1}}};
constexpr double kDegrees = 180 / CV_PI;
constexpr double kThetaVarianceOfExact = 0.1;  // square degrees

}  // namespace

double Kernel::at(double rho_offset, double theta_offset) const {
  const double determinant = rho_variance * theta_variance - covariance * covariance;
  const double squared =
      (theta_variance * rho_offset * rho_offset - 2 * covariance * rho_offset * theta_offset +
       rho_variance * theta_offset * theta_offset) /
      determinant;
  return std::exp(-squared / 2) / (2 * CV_PI * std::sqrt(determinant));
}

const std::vector<Kernel>& KernelFinder::find(CannyEdges* edges) {
  link(edges);
  clusters_.clear();
  for (std::size_t i = 0; i < chains_.size(); ++i) {
    split(chains_.begin(i), chains_.ends[i] - 1);
  }
  kernels_.clear();
  double highest = 0;
  for (const Cluster& cluster : clusters_) {
    kernels_.push_back(kernelOf(cluster, edges->width() / 2.0, edges->height() / 2.0));
    highest = std::max(highest, kernels_.back().at(0, 0));
  }
  kernels_.erase(std::remove_if(kernels_.begin(), kernels_.end(),
                                [&](const Kernel& kernel) {
                                  return kernel.at(0, 0) < parameters_.min_height * highest;
                                }),
                 kernels_.end());
  return kernels_;
}

void KernelFinder::link(CannyEdges* edges) {
  chains_.clear();
  for (int y = 1; y < edges->height() - 1; ++y) {
    visitMarked(edges->row(y), 1, edges->width() - 1, 1, [&](int x) {
      const EdgePixel seed{x, y};
      edges->row(y)[x] = 0;
      chains_.pixels.push_back(seed);
      follow(edges, seed);
      std::reverse(chains_.pixels.begin() + static_cast<std::ptrdiff_t>(chains_.openBegin()),
                   chains_.pixels.end());
      follow(edges, seed);
      if (chains_.openLength() >= static_cast<std::size_t>(parameters_.min_cluster)) {
        chains_.close();
      } else {
        chains_.dropOpen();
      }
    });
  }
}

/// Moves the edge from `from` on, without it, to the open chain.
void KernelFinder::follow(CannyEdges* edges, EdgePixel from) {
  while (true) {
    const auto* const end = kNeighbours.data() + kNeighbours.size();
    const auto* const step = std::find_if(kNeighbours.data(), end, [&](const EdgePixel& d) {
      return edges->row(from.y + d.y)[from.x + d.x] != 0;
    });
    if (step == end) {
      return;
    }
    from.x += step->x;
    from.y += step->y;
    edges->row(from.y)[from.x] = 0;
    chains_.pixels.push_back(from);
  }
}

/// Adds the pixels [first, last] as clusters; returns the ratio of length to deviation of the best.
double KernelFinder::split(std::size_t first, std::size_t last) {
  const EdgePixel a = chains_.pixels[first];
  const EdgePixel b = chains_.pixels[last];
  const double length = std::hypot(b.x - a.x, b.y - a.y);
  std::int64_t greatest = 0;
  std::size_t farthest = first;
  for (std::size_t i = first; i < last; ++i) {
    const EdgePixel p = chains_.pixels[i];
    const std::int64_t cross =
        std::abs(std::int64_t{p.x - a.x} * (b.y - a.y) - std::int64_t{p.y - a.y} * (b.x - a.x));
    if (cross > greatest) {
      greatest = cross;
      farthest = i;
    }
  }
  const double deviation = length > 0 ? static_cast<double>(greatest) / length : 0;
  const double ratio = length / std::max(deviation, parameters_.min_deviation);
  const auto fewest = static_cast<std::size_t>(parameters_.min_cluster);
  if (farthest - first + 1 >= fewest && last - farthest + 1 >= fewest) {
    const std::size_t before = clusters_.size();
    const double left = split(first, farthest);
    const double right = split(farthest, last);
    if (left > ratio || right > ratio) {
      return std::max(left, right);
    }
    clusters_.resize(before);
  }
  clusters_.push_back({first, last + 1});
  return ratio;
}

Kernel KernelFinder::kernelOf(const Cluster& cluster, double middle_x, double middle_y) const {
  const auto n = static_cast<double>(cluster.end - cluster.begin);
  double mean_x = 0;
  double mean_y = 0;
  for (std::size_t i = cluster.begin; i < cluster.end; ++i) {
    mean_x += chains_.pixels[i].x;
    mean_y += chains_.pixels[i].y;
  }
  // Times 1/n, as the method's authors have it: the last bit of an upright line's mean says in
  // which of two bins it lies, and on which side of the accumulator.
  mean_x = (mean_x - n * middle_x) * (1 / n);
  mean_y = (mean_y - n * middle_y) * (1 / n);
  double xx = 0;
  double yy = 0;
  double xy = 0;
  for (std::size_t i = cluster.begin; i < cluster.end; ++i) {
    const double x = chains_.pixels[i].x - middle_x - mean_x;
    const double y = chains_.pixels[i].y - middle_y - mean_y;
    xx += x * x;
    yy += y * y;
    xy += x * y;
  }
  // The direction (ux, uy) of the greatest spread, and the normal (vx, vy), which points down.
  const double angle = std::atan2(2 * xy, xx - yy) / 2;
  const double ux = std::cos(angle);
  const double uy = std::sin(angle);
  double vx = -uy;
  double vy = ux;
  if (xy == 0 && xx < yy) {  // exactly upright: 0 degrees, not 180
    vx = 1;
    vy = 0;
  } else if (vy < 0) {
    vx = -vx;
    vy = -vy;
  }
  Kernel kernel;
  kernel.rho = vx * mean_x + vy * mean_y;
  kernel.theta = std::acos(std::clamp(vx, -1.0, 1.0)) * kDegrees;

  const double spread = ux * ux * xx + 2 * ux * uy * xy + uy * uy * yy;
  const double slope_variance = 1 / spread;
  const double along = ux * mean_x + uy * mean_y;
  const double sine = std::sqrt(std::max(0.0, 1 - vx * vx));
  const double theta_by_slope = sine > 0 ? ux / sine * kDegrees : 0;
  const double enlarged = parameters_.sigmas * parameters_.sigmas;
  kernel.rho_variance = (along * along * slope_variance + 1 / n) * enlarged;
  kernel.theta_variance = theta_by_slope * theta_by_slope * slope_variance;
  if (kernel.theta_variance == 0) {
    kernel.theta_variance = kThetaVarianceOfExact;
  }
  kernel.theta_variance *= enlarged;
  kernel.covariance = -along * theta_by_slope * slope_variance;
  return kernel;
}

}  // namespace evolin::kht
