// Edge drawing: pixels are linked from anchors along ridges of the gradient into chains (Topal,
// Akinlar: Edge Drawing, Journal of Visual Communication and Image Representation 23, 2012).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "evolin_ros/detection/edlines.h"
#include "pixel_chains.h"
#include "smoothed_gradient.h"

namespace evolin::edlines {

/// Draws the edges of one image after the other, in buffers that it keeps.
class EdgeDrawing {
 public:
  explicit EdgeDrawing(const EdLinesParameters& parameters) : parameters_(parameters) {}

  /// Chains in the order in which they are found. The strength of the image's outermost pixels
  /// becomes 0.
  const PixelChains& draw(GradientMaps* maps);

 private:
  enum class Mark : std::uint8_t { kFree, kAnchor, kEdge };
  enum class Direction : std::uint8_t { kLeft, kRight, kUp, kDown };

  /// Pixels that were walked in one direction: drawn_[begin, begin + length).
  struct Stretch {
    std::size_t begin = 0;
    std::size_t length = 0;
    std::array<int, 2> next = {-1, -1};  // where it went on to the left or up, and right or down
  };

  /// Where a stretch is to begin, and which one it continues.
  struct Start {
    EdgePixel pixel;
    Direction direction = Direction::kLeft;
    int from = 0;
  };

  void findAnchors();
  void sortAnchors();
  void drawFrom(EdgePixel anchor);
  void scheduleAcross(EdgePixel pixel, bool vertical, int from);
  template <Direction kDirection>
  void walk(const Start& start);
  void extractChains();
  void measurePaths();
  std::size_t pathLength(int stretch) const {
    return stretch < 0 ? 0 : lengths_[static_cast<std::size_t>(stretch)];
  }
  void listPath(int stretch);
  void appendPathBackwards();
  void appendPathForwards();
  void dropTrailing(EdgePixel next);

  EdLinesParameters parameters_;
  GradientMaps* maps_ = nullptr;
  std::vector<Mark> marks_;
  std::vector<EdgePixel> unsorted_anchors_;
  std::vector<EdgePixel> anchors_;
  std::vector<std::uint32_t> slots_;

  // Of the anchor at hand. Stretch 0 is the root, without pixels.
  std::vector<EdgePixel> drawn_;
  std::size_t repeated_ = 0;  // pixels that begin two stretches
  std::vector<Stretch> stretches_;
  std::vector<Start> stack_;
  std::vector<std::size_t> lengths_;  // of the longest path from each stretch
  std::vector<int> path_;

  PixelChains chains_;
};

}  // namespace evolin::edlines
