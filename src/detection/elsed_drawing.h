// ELSED's drawing: edge pixels are followed from anchors, and segments grow along them, over
// junctions and around turns.
#pragma once

#include <cstdint>
#include <vector>

#include "elsed_line.h"
#include "evolin_ros/detection/elsed.h"
#include "smoothed_gradient.h"

namespace evolin::elsed {

enum class Label : std::uint8_t { kFree, kEdge, kAnchor, kInlier, kOutlier, kJunction };

/// The first and the last pixel, the line, and the pixels [begin, end) of Drawing::pixels(), of
/// which those count that are still labelled as inliers.
struct DrawnSegment {
  IncrementalLine::Equation line;
  bool horizontal = true;
  EdgePixel first;
  EdgePixel last;
  std::size_t begin = 0;
  std::size_t end = 0;
  std::int64_t size = 0;  ///< pixels in the line's fit
};

/// Draws the segments of one image after the other, in buffers that it keeps.
class Drawing {
 public:
  explicit Drawing(const ElsedParameters& parameters) : parameters_(parameters) {}

  /// `maps` must outlive the call only.
  void draw(const GradientMaps& maps);

  const std::vector<DrawnSegment>& segments() const { return segments_; }
  const std::vector<EdgePixel>& pixels() const { return pixels_; }
  Label label(EdgePixel p) const { return labels_[maps_->at(p.x, p.y)]; }

 private:
  enum class Direction : std::uint8_t { kUp, kDown, kLeft, kRight };
  enum class Side : std::uint8_t { kEnd, kStart };

  /// The end of a segment that grows: its outermost pixel, and the one before it.
  struct Tip {
    EdgePixel pixel;
    EdgePixel before;
    std::size_t added = 0;  // pixels that came on this side after the first fit
    bool extended = false;  // nothing is left to try here
  };

  /// Where to go on later: `preset` are pixels of the walk that led there.
  struct Branch {
    Direction direction = Direction::kRight;
    EdgePixel start;
    Side side = Side::kEnd;
    std::vector<EdgePixel> preset;
  };

  struct Walker {
    EdgePixel at;
    EdgePixel before;
    bool vertical = false;  // the edge here runs rather up than sideways
  };

  void findAnchors(const GradientMaps& maps);
  void sortAnchorsByColumn(int width);
  void drawFrom(EdgePixel anchor);
  void drawOneWay(EdgePixel anchor, Direction direction, bool first_way);
  bool walkBranch(Walker* walker, Side side, std::size_t* window);
  void growWithoutSegment(EdgePixel p, std::size_t* window);
  void rememberForTheOtherWay(std::size_t window);
  void undoLastInlier(Side side, EdgePixel anchor);
  bool scheduleSuccessors(const Walker& walker, Side side, EdgePixel anchor, bool hit);
  void schedule(bool* reused, Direction direction, EdgePixel start, Side side);
  bool continueSegment(bool* reused, EdgePixel anchor, bool obstructed);
  void finishSegment();
  void addToSegment(EdgePixel p, Side side);

  bool jump(Side side);
  bool walkBeyond(int steps);
  bool gradientsAgree(const IncrementalLine::Equation& line) const;
  void addJunction(Side side);
  void bresenham(EdgePixel from, EdgePixel to);

  bool step(Walker* walker) const;
  Direction lineDirection() const;
  static Direction opposite(Direction direction);
  static Walker walkerAt(EdgePixel start, Direction direction);

  unsigned strength(int x, int y) const { return maps_->strength[maps_->at(x, y)] >> 1U; }
  void setLabel(EdgePixel p, Label label) { labels_[maps_->at(p.x, p.y)] = label; }
  Tip& tip(Side side) { return side == Side::kEnd ? end_ : start_; }

  ElsedParameters parameters_;
  const GradientMaps* maps_ = nullptr;
  std::vector<Label> labels_;
  std::vector<EdgePixel> anchors_;
  std::vector<EdgePixel> unsorted_anchors_;
  std::vector<std::uint32_t> column_ends_;
  std::vector<std::uint8_t> anchor_flags_;

  std::vector<EdgePixel> pixels_;  // all that were drawn, in order
  std::vector<DrawnSegment> segments_;
  std::vector<EdgePixel> initial_pixels_;  // of the first way, for the second

  // The segment under construction.
  IncrementalLine line_;
  bool fitting_ = false;  // line_ holds a window of pixels
  bool exists_ = false;   // and that window is a segment
  std::size_t fit_begin_ = 0;
  std::size_t fit_end_ = 0;
  std::size_t begin_ = 0;
  Tip start_;
  Tip end_;

  // Branches [0, depth_) of the stack; the rest keep their memory.
  std::vector<Branch> stack_;
  std::size_t depth_ = 0;
  std::vector<EdgePixel> outliers_;
  std::vector<EdgePixel> junction_;
  std::vector<EdgePixel> beyond_;
};

}  // namespace evolin::elsed
