// Chains of edge pixels, one after the other in one buffer.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

namespace evolin {

struct EdgePixel {
  std::int32_t x = 0;
  std::int32_t y = 0;

  bool operator==(const EdgePixel& other) const { return x == other.x && y == other.y; }
};

/// The same pixel, or one of the eight around it?
inline bool areNeighbours(EdgePixel a, EdgePixel b) {
  return std::abs(a.x - b.x) <= 1 && std::abs(a.y - b.y) <= 1;
}

/// Sums of coordinates over a set of pixels: whole numbers, exact up to 2^53, so that the order in
/// which pixels come and go leaves no rounding behind.
struct PixelSums {
  double n = 0;
  double x = 0;
  double y = 0;
  double xx = 0;
  double yy = 0;
  double xy = 0;

  void add(EdgePixel p, double times = 1) {
    const double px = p.x;
    const double py = p.y;
    n += times;
    x += times * px;
    y += times * py;
    xx += times * px * px;
    yy += times * py * py;
    xy += times * px * py;
  }

  void remove(EdgePixel p) { add(p, -1); }
};

/// Chain i holds pixels[begin(i)] to pixels[ends[i] - 1]; what lies behind the last end is a chain
/// under construction. Keeps its memory when it is cleared.
struct PixelChains {
  std::vector<EdgePixel> pixels;
  std::vector<std::size_t> ends;

  std::size_t size() const { return ends.size(); }
  std::size_t begin(std::size_t i) const { return i == 0 ? 0 : ends[i - 1]; }
  std::size_t length(std::size_t i) const { return ends[i] - begin(i); }
  const EdgePixel* data(std::size_t i) const { return pixels.data() + begin(i); }

  std::size_t openBegin() const { return ends.empty() ? 0 : ends.back(); }
  std::size_t openLength() const { return pixels.size() - openBegin(); }

  /// Makes the pixels behind the last end a chain.
  void close() { ends.push_back(pixels.size()); }

  /// Forgets the pixels behind the last end.
  void dropOpen() { pixels.resize(openBegin()); }

  void clear() {
    pixels.clear();
    ends.clear();
  }
};

}  // namespace evolin
