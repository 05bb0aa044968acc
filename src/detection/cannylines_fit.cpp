// Normal equations of a straight line, in double and in single precision.
#include "cannylines_fit.h"

namespace evolin::cannylines {
namespace {

/// Weighted sums over the pixels, u and v from `origin` on.
template <typename Real>
struct Sums {
  Real n = 0;
  Real u = 0;
  Real v = 0;
  Real uu = 0;
  Real uv = 0;

  template <typename Weight>
  Sums(const std::vector<EdgePixel>& pixels, const LineEquation& axes, EdgePixel origin,
       Weight weight) {
    for (const EdgePixel& p : pixels) {
      const Real w = weight(p);
      const auto of_u = static_cast<Real>(axes.u(p) - axes.u(origin));
      const auto of_v = static_cast<Real>(axes.v(p) - axes.v(origin));
      n += w;
      u += w * of_u;
      v += w * of_v;
      uu += w * of_u * of_u;
      uv += w * of_u * of_v;
    }
  }
};

template <typename Weight>
LineEquation fitExactly(const std::vector<EdgePixel>& pixels, bool steep, Weight weight) {
  LineEquation line;
  line.steep = steep;
  const EdgePixel origin = pixels.front();
  const Sums<double> sums(pixels, line, origin, weight);
  const double spread = sums.n * sums.uu - sums.u * sums.u;
  if (spread > 0) {
    line.k = (sums.n * sums.uv - sums.u * sums.v) / spread;
  }
  line.b = (sums.v - line.k * sums.u) / sums.n + line.v(origin) - line.k * line.u(origin);
  return line;
}

/// `total`: of the weights as it should be. Both unknowns come from the same determinant, whose
/// rounding is what moves the published lines.
template <typename Weight>
LineEquation fitAsPublished(const std::vector<EdgePixel>& pixels, bool steep, Weight weight,
                            float total) {
  LineEquation line;
  line.steep = steep;
  const Sums<float> sums(pixels, line, EdgePixel{0, 0}, weight);
  const float spread = total * sums.uu - sums.u * sums.u;
  if (spread > 0) {
    line.k = static_cast<double>((total * sums.uv - sums.u * sums.v) / spread);
    line.b = static_cast<double>((sums.uu * sums.v - sums.u * sums.uv) / spread);
  } else {
    line.b = static_cast<double>(sums.v / total);
  }
  return line;
}

}  // namespace

LineEquation LineFitter::fit(const std::vector<EdgePixel>& pixels, bool steep) const {
  return compatible_
             ? fitAsPublished(
                   pixels, steep, [](EdgePixel) { return 1.0F; }, static_cast<float>(pixels.size()))
             : fitExactly(pixels, steep, [](EdgePixel) { return 1.0; });
}

LineEquation LineFitter::fitByStrength(const std::vector<EdgePixel>& pixels, bool steep,
                                       const EdgeFinder& edges) const {
  if (!compatible_) {
    return fitExactly(pixels, steep,
                      [&](EdgePixel p) { return static_cast<double>(edges.strength(p)); });
  }
  float total = 0;
  for (const EdgePixel& p : pixels) total += static_cast<float>(edges.strength(p));
  return fitAsPublished(
      pixels, steep, [&](EdgePixel p) { return static_cast<float>(edges.strength(p)) / total; },
      1.0F);
}

}  // namespace evolin::cannylines
