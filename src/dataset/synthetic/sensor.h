// From light to a camera's bytes: blur, noise, rounding.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

namespace evolin::synthetic {

/// Convolves a CV_32FC3 image with a Gaussian of `sigma` pixels (0: nothing happens), its rim
/// repeated outwards.
void blur(double sigma, cv::Mat* image);

/// CV_8UC3 of a CV_32FC3 image of grey levels, with Gaussian noise of `sigma` grey levels in every
/// channel. The noise of a byte depends on `key` and its place alone.
cv::Mat digitise(const cv::Mat& image, double sigma, std::uint64_t key);

/// The standard normal distribution's quantile at `probability` in (0, 1), within 1e-8.
double normalQuantile(double probability);

}  // namespace evolin::synthetic
