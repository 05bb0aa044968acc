// Anchors, the walk between them, and the longest paths through what was walked.
#include "edge_drawing.h"

#include <algorithm>

#include "marked_pixels.h"
#include "ridge_anchors.h"

namespace evolin::edlines {
namespace {

constexpr int kMargin = 2;  // pixels at the border without anchors
// Values that |dx| + |dy| of 3x3 Prewitt derivatives may have.
constexpr std::size_t kStrengths = 2 * 3 * 255 + 1;

}  // namespace

const PixelChains& EdgeDrawing::draw(GradientMaps* maps) {
  maps_ = maps;
  chains_.clear();
  marks_.assign(maps->strength.size(), Mark::kFree);
  if (maps->width <= 2 * kMargin || maps->height <= 2 * kMargin) {
    return chains_;
  }
  const auto width = static_cast<std::size_t>(maps->width);
  std::fill_n(maps->strength.begin(), width, std::uint16_t{0});
  std::fill(maps->strength.end() - maps->width, maps->strength.end(), std::uint16_t{0});
  for (std::size_t i = width; i < maps->strength.size(); i += width) {
    maps->strength[i - 1] = maps->strength[i] = 0;
  }
  findAnchors();
  sortAnchors();
  for (const EdgePixel& anchor : anchors_) {
    if (marks_[maps->at(anchor.x, anchor.y)] == Mark::kAnchor) {
      drawFrom(anchor);
    }
  }
  return chains_;
}

// ---- anchors

void EdgeDrawing::findAnchors() {
  unsorted_anchors_.clear();
  const int width = maps_->width;
  const int interval = parameters_.scan_interval;
  const auto rise = static_cast<std::int16_t>(parameters_.anchor_threshold);
  for (int y = kMargin; y < maps_->height - kMargin; ++y) {
    const std::uint16_t* here = maps_->strength.data() + maps_->at(0, y);
    const std::uint16_t* above = here - width;
    const std::uint16_t* below = here + width;
    auto* marks = reinterpret_cast<std::uint8_t*>(marks_.data() + maps_->at(0, y));
    flagRidge(above, here, below, kMargin, width - kMargin, rise, marks);
    // Rows and columns at the interval; elsewhere no pixel is an anchor.
    const bool whole_row = y % interval == 0;
    visitMarked(marks, kMargin, width - kMargin, 1, [&](int x) {
      if (whole_row || x % interval == 0) {
        unsorted_anchors_.push_back({x, y});
      } else {
        marks[x] = static_cast<std::uint8_t>(Mark::kFree);
      }
    });
  }
}

void EdgeDrawing::sortAnchors() {
  // By falling strength; rows and columns rise among equals.
  slots_.assign(kStrengths + 1, 0);
  const auto slot = [&](const EdgePixel& p) {
    return kStrengths - 1 - (maps_->strength[maps_->at(p.x, p.y)] >> 1U);
  };
  for (const EdgePixel& anchor : unsorted_anchors_) ++slots_[slot(anchor) + 1];
  for (std::size_t i = 1; i < slots_.size(); ++i) slots_[i] += slots_[i - 1];
  anchors_.resize(unsorted_anchors_.size());
  for (const EdgePixel& anchor : unsorted_anchors_) anchors_[slots_[slot(anchor)]++] = anchor;
}

// ---- the walk

void EdgeDrawing::drawFrom(EdgePixel anchor) {
  drawn_.clear();
  repeated_ = 0;
  stretches_.clear();
  stretches_.emplace_back();
  const bool vertical = (maps_->strength[maps_->at(anchor.x, anchor.y)] & 1U) != 0;
  scheduleAcross(anchor, !vertical, 0);
  while (!stack_.empty()) {
    const Start start = stack_.back();
    stack_.pop_back();
    switch (start.direction) {
      case Direction::kLeft:
        walk<Direction::kLeft>(start);
        break;
      case Direction::kRight:
        walk<Direction::kRight>(start);
        break;
      case Direction::kUp:
        walk<Direction::kUp>(start);
        break;
      case Direction::kDown:
        walk<Direction::kDown>(start);
        break;
    }
  }
  if (drawn_.size() - repeated_ < static_cast<std::size_t>(parameters_.min_path_length)) {
    for (const EdgePixel& p : drawn_) marks_[maps_->at(p.x, p.y)] = Mark::kFree;
    return;
  }
  extractChains();
}

/// Two stretches across the direction (`vertical`) in which `pixel` was reached.
void EdgeDrawing::scheduleAcross(EdgePixel pixel, bool vertical, int from) {
  // The last one in is walked first.
  stack_.push_back({pixel, vertical ? Direction::kRight : Direction::kDown, from});
  stack_.push_back({pixel, vertical ? Direction::kLeft : Direction::kUp, from});
}

template <EdgeDrawing::Direction kDirection>
void EdgeDrawing::walk(const Start& start) {
  constexpr bool kVertical = kDirection == Direction::kUp || kDirection == Direction::kDown;
  constexpr bool kBack = kDirection == Direction::kLeft || kDirection == Direction::kUp;
  constexpr int kAhead = kBack ? -1 : 1;
  // Where straight on is no edge, the side that is looked at first.
  constexpr int kFirstSide = kDirection == Direction::kRight || kDirection == Direction::kDown;
  const std::ptrdiff_t row = maps_->width;
  const std::ptrdiff_t ahead = kAhead * (kVertical ? row : 1);
  const std::ptrdiff_t side = kVertical ? 1 : row;
  constexpr int kFirst = kFirstSide != 0 ? 1 : -1;

  const auto index = static_cast<int>(stretches_.size());
  Stretch stretch;
  stretch.begin = drawn_.size();
  EdgePixel at = start.pixel;
  std::size_t i = maps_->at(at.x, at.y);
  Mark* mark = marks_.data() + i;
  const std::uint16_t* strength = maps_->strength.data() + i;
  if (*mark != Mark::kEdge) {
    ++repeated_;
  }
  drawn_.push_back(at);
  bool closed = false;
  while ((*strength & 1U) == (kVertical ? 1U : 0U)) {
    *mark = Mark::kEdge;
    for (const std::ptrdiff_t k : {-side, side}) {
      if (mark[k] == Mark::kAnchor) mark[k] = Mark::kFree;
    }
    int turn = 0;
    if (mark[ahead] == Mark::kFree) {
      if (mark[ahead + kFirst * side] != Mark::kFree) {
        turn = kFirst;
      } else if (mark[ahead - kFirst * side] != Mark::kFree) {
        turn = -kFirst;
      } else {
        const unsigned a = strength[ahead - side] >> 1U;
        const unsigned b = strength[ahead] >> 1U;
        const unsigned c = strength[ahead + side] >> 1U;
        turn = a > b ? (a > c ? -1 : 1) : (c > b ? 1 : 0);
      }
    }
    mark += ahead + turn * side;
    strength += ahead + turn * side;
    at.x += kVertical ? turn : kAhead;
    at.y += kVertical ? kAhead : turn;
    if (*mark == Mark::kEdge || *strength < 2) {
      closed = true;
      break;
    }
    drawn_.push_back(at);
  }
  if (!closed) {
    // The edge turns: its last pixel begins what follows.
    drawn_.pop_back();
    scheduleAcross(at, kVertical, index);
  }
  stretch.length = drawn_.size() - stretch.begin;
  stretches_[static_cast<std::size_t>(start.from)].next[kBack ? 0 : 1] = index;
  stretches_.push_back(stretch);
}

// ---- paths

void EdgeDrawing::measurePaths() {
  // Successors come later in the list.
  lengths_.resize(stretches_.size());
  for (std::size_t i = stretches_.size(); i-- > 0;) {
    const std::array<int, 2>& next = stretches_[i].next;
    lengths_[i] = stretches_[i].length + std::max(pathLength(next[0]), pathLength(next[1]));
  }
}

/// Lists the longest path that begins with `stretch`.
void EdgeDrawing::listPath(int stretch) {
  path_.clear();
  while (stretch >= 0) {
    path_.push_back(stretch);
    const std::array<int, 2>& next = stretches_[static_cast<std::size_t>(stretch)].next;
    stretch = pathLength(next[0]) >= pathLength(next[1]) ? next[0] : next[1];
  }
}

/// Takes pixels off the open chain's end while the one before is a neighbour of `next`.
void EdgeDrawing::dropTrailing(EdgePixel next) {
  while (chains_.openLength() > 1 && areNeighbours(next, *(chains_.pixels.end() - 2))) {
    chains_.pixels.pop_back();
  }
}

void EdgeDrawing::appendPathBackwards() {
  for (auto at = path_.rbegin(); at != path_.rend(); ++at) {
    Stretch& stretch = stretches_[static_cast<std::size_t>(*at)];
    const EdgePixel* pixels = drawn_.data() + stretch.begin;
    std::size_t length = stretch.length;
    dropTrailing(pixels[length - 1]);
    if (length > 1 && chains_.openLength() > 0 &&
        areNeighbours(pixels[length - 2], chains_.pixels.back())) {
      --length;
    }
    while (length > 0) chains_.pixels.push_back(pixels[--length]);
    stretch.length = 0;
  }
}

void EdgeDrawing::appendPathForwards() {
  for (const int at : path_) {
    Stretch& stretch = stretches_[static_cast<std::size_t>(at)];
    // Of an emptied stretch, that is where the next one begins.
    const EdgePixel* pixels = drawn_.data() + stretch.begin;
    dropTrailing(pixels[0]);
    const bool skips = stretch.length > 1 && chains_.openLength() > 0 &&
                       areNeighbours(pixels[1], chains_.pixels.back());
    for (std::size_t k = skips ? 1 : 0; k < stretch.length; ++k) {
      chains_.pixels.push_back(pixels[k]);
    }
    stretch.length = 0;
  }
}

void EdgeDrawing::extractChains() {
  measurePaths();
  const std::array<int, 2> ways = stretches_.front().next;
  if (pathLength(ways[1]) > 0) {
    listPath(ways[1]);
    appendPathBackwards();
  }
  if (pathLength(ways[0]) > 1) {
    listPath(ways[0]);
    // Both ways begin at the anchor.
    Stretch& first = stretches_[static_cast<std::size_t>(ways[0])];
    ++first.begin;
    --first.length;
    appendPathForwards();
  }
  if (chains_.openLength() > 1) {
    const auto begin = chains_.pixels.begin() + static_cast<std::ptrdiff_t>(chains_.openBegin());
    if (areNeighbours(*(begin + 1), chains_.pixels.back())) {
      chains_.pixels.erase(begin);
    }
  }
  chains_.close();
  for (std::size_t i = 2; i < stretches_.size(); ++i) {
    if (stretches_[i].length < 2) {
      continue;
    }
    if (lengths_[i] >= static_cast<std::size_t>(parameters_.min_path_length)) {
      listPath(static_cast<int>(i));
      appendPathForwards();
      chains_.close();
    }
  }
}

}  // namespace evolin::edlines
