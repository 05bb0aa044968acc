// The lines of CannyLines: pieces of edge chains that grow along the edge map and merge.
#pragma once

#include <cstdint>
#include <vector>

#include "cannylines_edges.h"
#include "cannylines_fit.h"
#include "evolin_ros/geometry/line_segment.h"

namespace evolin::cannylines {

struct Line {
  std::vector<EdgePixel> pixels;  // from one end to the other
  LineEquation equation;
  LineSegment segment;
  bool merged = false;  // into another one
};

/// Finds the lines among the chains of one image after the other, in buffers that it keeps.
class LineFinder {
 public:
  explicit LineFinder(const CannyLinesParameters& parameters)
      : parameters_(parameters), fitter_(parameters.compatible) {}

  /// `edges` must outlive the call only. The result is valid until the next one.
  const LineSegments& find(const EdgeFinder& edges);

 private:
  // Of a pixel in labels_: no edge, an edge of no line, or the negative of 1 + a line's index.
  static constexpr std::int32_t kNone = 0;
  static constexpr std::int32_t kFree = 1;

  /// What an extension has taken since its line was last fitted.
  struct Growth {
    std::size_t fitted = 0;  // pixels of the line when it was
    int edges = 0;
    int gaps = 0;
  };

  void startLabels();
  void split(const EdgePixel* pixels, std::size_t size);
  void addLine(const EdgePixel* pixels, std::size_t size);
  void grow(std::size_t index);
  void extend(std::size_t index);
  bool tryToMerge(std::size_t index, std::size_t other);
  std::size_t nearestInDirection(std::size_t index, const std::int32_t (&labels)[3]) const;
  bool isMeaningful(const Line& line);
  void placeEnds(Line* line) const;
  void label(const Line& line, std::int32_t value);
  std::int32_t labelAt(int x, int y) const;

  CannyLinesParameters parameters_;
  LineFitter fitter_;
  const EdgeFinder* edges_ = nullptr;
  std::size_t meaningful_length_ = 0;
  double most_turn_ = 0;  // radians between lines that merge
  int width_ = 0;
  int height_ = 0;
  std::vector<std::int32_t> labels_;
  std::vector<Line> lines_;  // [0, count_); the rest keep their memory
  std::size_t count_ = 0;
  std::vector<std::size_t> longest_first_;
  std::vector<EdgePixel> joined_;
  LineSegments segments_;
};

}  // namespace evolin::cannylines
