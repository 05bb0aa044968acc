// What the decoders of networks do with their maps: local maxima, the best k, samples between
// pixels.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace evolin {

/// A pixel of a map and its value.
struct Peak {
  int x = 0;
  int y = 0;
  float value = 0;
};

/// Pixels of a CV_32FC1 map above `threshold` (strictly) than which no pixel of the
/// `window` x `window` square around them (odd, at least 1; cut at the border) is greater, row
/// after row. Of equal neighbours all stay, as with max pooling and a comparison. NaN is no peak
/// and hides none. Throws Error for another type or an even window.
std::vector<Peak> localMaxima(const cv::Mat& map, int window, float threshold);

/// Sorts by falling value, equal ones in their order, and keeps the first `count`.
void keepBest(std::size_t count, std::vector<Peak>* peaks);

/// Where a coordinate of one grid lies on another. The names are those of the alignment that
/// resizing assumes.
enum class Alignment {
  kHalfPixel,  ///< the pixels' outer edges coincide (align_corners = false)
  kCorners     ///< the centres of the outermost pixels coincide (align_corners = true)
};

/// The coordinate `value` of a grid of `from` pixels on one of `to`; pixel centres are whole
/// numbers. With kCorners and one pixel, 0.
double mapCoordinate(double value, int from, int to, Alignment alignment);

/// What lies beyond the outermost pixel centres.
enum class Beyond { kNearest, kZero };

/// The value of every channel of a [channels, height, width] CV_32F tensor at (x, y), bilinear
/// between pixel centres at whole numbers; `samples` gets as many values as there are channels.
/// Throws Error for another type; not finite coordinates give zeros.
void sampleBilinear(const cv::Mat& maps, double x, double y, Beyond beyond,
                    std::vector<float>* samples);

}  // namespace evolin
