// Voting around the middle of each kernel, and peaks among the bins that were touched.
#include "kht_votes.h"

#include <algorithm>
#include <cmath>

namespace evolin::kht {
namespace {

constexpr int kEmptyRows = 2;  // that end a quarter of a vote
constexpr double kMostVotes =
    1e5;  // of a kernel for a line; only without `min_height` are there more

/// What the weakest vote of all kernels within their ellipses is to be multiplied by to count.
double scaleOf(const std::vector<Kernel>& kernels) {
  double scale = 1;
  for (const Kernel& kernel : kernels) {
    // The shorter axis of the ellipse.
    const double half_sum = (kernel.rho_variance + kernel.theta_variance) / 2;
    const double half_difference = (kernel.rho_variance - kernel.theta_variance) / 2;
    const double least = std::max(0.0, half_sum - std::hypot(half_difference, kernel.covariance));
    const double angle = std::atan2(kernel.covariance, half_difference) / 2 + CV_PI / 2;
    const double radius = std::sqrt(least);
    const double value = kernel.at(radius * std::cos(angle), radius * std::sin(angle));
    if (value > 0 && value < 1) {
      scale = std::max(scale, 1 / value);
    }
  }
  return scale;
}

}  // namespace

const std::vector<PolarLine>& Accumulator::vote(const std::vector<Kernel>& kernels, cv::Size size) {
  clear(size);
  const double scale = scaleOf(kernels);
  for (const Kernel& kernel : kernels) {
    for (const int rho_step : {1, -1}) {
      for (const int theta_step : {1, -1}) voteQuarter(kernel, scale, rho_step, theta_step);
    }
  }
  findPeaks();
  return lines_;
}

void Accumulator::clear(cv::Size size) {
  for (std::size_t theta = 0; theta < spans_.size(); ++theta) {
    const Span& span = spans_[theta];
    for (int rho = span.begin; rho < span.end; ++rho)
      votes_[binAt(rho, static_cast<int>(theta))] = 0;
    spans_[theta] = Span();
  }
  lines_.clear();
  const double diagonal = std::hypot(size.width, size.height);
  greatest_rho_ = diagonal / 2;
  const int rhos = static_cast<int>((diagonal + 1) / delta_);
  const int thetas = static_cast<int>(180 / delta_);
  if (rhos != rhos_ || thetas != thetas_) {
    rhos_ = rhos;
    thetas_ = thetas;
    votes_.assign(binAt(0, thetas_ + 2), 0);
    visited_.assign(votes_.size(), 0);
    spans_.assign(static_cast<std::size_t>(thetas_) + 2, Span());
  }
}

void Accumulator::voteQuarter(const Kernel& kernel, double scale, int rho_step, int theta_step) {
  int first_rho = static_cast<int>(std::abs((kernel.rho + greatest_rho_) / delta_)) + 1;
  int theta = static_cast<int>(std::abs(kernel.theta / delta_)) + 1;
  // The bins of the kernel's middle belong to the quarters of rising indices.
  double rho_offset = 0;
  double theta_offset = 0;
  if (rho_step < 0) {
    --first_rho;
    rho_offset = -delta_;
  }
  if (theta_step < 0) {
    --theta;
    theta_offset = -delta_;
  }
  const double rho_direction = rho_step;
  int empty = 0;
  for (int row = 0; row < thetas_; ++row) {
    if (theta < 1 || theta > thetas_) {
      // The same lines, upside down.
      theta = theta < 1 ? thetas_ : 1;
      first_rho = rhos_ - first_rho + 1;
      rho_step = -rho_step;
    }
    bool any = false;
    double offset = rho_offset;
    int rho = first_rho;
    for (; rho >= 1 && rho <= rhos_; rho += rho_step) {
      const auto votes = static_cast<std::int32_t>(
          std::min(kernel.at(offset, theta_offset) * scale, kMostVotes) + 0.5);
      if (votes <= 0) {
        break;
      }
      votes_[binAt(rho, theta)] += votes;
      any = true;
      offset += rho_direction * delta_;
    }
    if (any) {
      Span& span = spans_[static_cast<std::size_t>(theta)];
      span.begin = std::min(span.begin, std::min(first_rho, rho - rho_step));
      span.end = std::max(span.end, std::max(first_rho, rho - rho_step) + 1);
    } else if (++empty == kEmptyRows) {
      return;
    }
    theta += theta_step;
    theta_offset += theta_step * delta_;
  }
}

void Accumulator::findPeaks() {
  const std::size_t row = static_cast<std::size_t>(rhos_) + 2;
  peaks_.clear();
  const auto three = [](const std::int32_t* p) {
    return std::int64_t{p[-1]} + 2 * std::int64_t{p[0]} + p[1];
  };
  for (std::size_t theta = 0; theta < spans_.size(); ++theta) {
    for (int rho = spans_[theta].begin; rho < spans_[theta].end; ++rho) {
      const std::size_t bin = binAt(rho, static_cast<int>(theta));
      const std::int32_t* here = votes_.data() + bin;
      if (*here > 0) {
        peaks_.push_back({three(here - row) + 2 * three(here) + three(here + row), bin});
      }
    }
  }
  // Not stable, on purpose: in a plateau of equal votes a stable order finds one line, and the
  // authors' code several, which std::sort of the same bins in the same order finds too.
  std::sort(peaks_.begin(), peaks_.end(),
            [](const Peak& a, const Peak& b) { return a.votes > b.votes; });
  for (const Peak& peak : peaks_) {
    const std::uint8_t* here = visited_.data() + peak.bin;
    const auto any = [](const std::uint8_t* p) { return (p[-1] | p[0] | p[1]) != 0; };
    if (!any(here - row) && !any(here) && !any(here + row)) {
      const auto rho = static_cast<double>(peak.bin % row) - 1;
      const auto theta = static_cast<double>(peak.bin / row) - 1;
      lines_.push_back({rho * delta_ - greatest_rho_, theta * delta_});
    }
    visited_[peak.bin] = 1;
  }
  for (const Peak& peak : peaks_) visited_[peak.bin] = 0;
}

}  // namespace evolin::kht
