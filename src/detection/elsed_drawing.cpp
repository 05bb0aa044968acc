// Anchors, the walk along edges, and the segments that grow on it.
#include "elsed_drawing.h"

#include <algorithm>

#include "marked_pixels.h"
#include "ridge_anchors.h"

namespace evolin::elsed {

void Drawing::draw(const GradientMaps& maps) {
  maps_ = &maps;
  labels_.assign(maps.strength.size(), Label::kFree);
  pixels_.clear();
  segments_.clear();
  findAnchors(maps);
  for (const EdgePixel& anchor : anchors_) {
    if (label(anchor) == Label::kFree) {
      drawFrom(anchor);
    }
  }
}

// ---- anchors

void Drawing::findAnchors(const GradientMaps& maps) {
  unsorted_anchors_.clear();
  anchor_flags_.assign(static_cast<std::size_t>(maps.width), 0);
  int rise = parameters_.anchor_threshold;
  while (true) {
    for (int y = 1; y < maps.height - 1; y += parameters_.scan_interval) {
      const std::uint16_t* here = maps.strength.data() + maps.at(0, y);
      flagRidge(here - maps.width, here, here + maps.width, 1, maps.width - 1,
                static_cast<std::int16_t>(rise), anchor_flags_.data());
      visitMarked(anchor_flags_.data(), 1, maps.width - 1, parameters_.scan_interval, [&](int x) {
        unsorted_anchors_.push_back({x, y});
      });
    }
    if (!unsorted_anchors_.empty() || rise == 0) {
      break;
    }
    rise /= 2;
  }
  sortAnchorsByColumn(maps.width);
}

void Drawing::sortAnchorsByColumn(int width) {
  column_ends_.assign(static_cast<std::size_t>(width) + 1, 0);
  for (const EdgePixel& anchor : unsorted_anchors_) {
    ++column_ends_[static_cast<std::size_t>(anchor.x) + 1];
  }
  for (std::size_t x = 1; x < column_ends_.size(); ++x) {
    column_ends_[x] += column_ends_[x - 1];
  }
  anchors_.resize(unsorted_anchors_.size());
  for (const EdgePixel& anchor : unsorted_anchors_) {
    anchors_[column_ends_[static_cast<std::size_t>(anchor.x)]++] = anchor;
  }
}

// ---- the walk

Drawing::Walker Drawing::walkerAt(EdgePixel start, Direction direction) {
  Walker walker;
  walker.at = walker.before = start;
  walker.vertical = direction == Direction::kUp || direction == Direction::kDown;
  walker.before.x += direction == Direction::kLeft ? 1 : direction == Direction::kRight ? -1 : 0;
  walker.before.y += direction == Direction::kUp ? 1 : direction == Direction::kDown ? -1 : 0;
  return walker;
}

bool Drawing::step(Walker* walker) const {
  const EdgePixel p = walker->at;
  const EdgePixel q = walker->before;
  // The walk never leaves the image, and what it compares lies within a pixel around it.
  const bool inside = p.x > 0 && p.y > 0 && p.x < maps_->width - 1 && p.y < maps_->height - 1;
  walker->before = p;
  if (!inside) {
    return false;
  }
  const std::uint16_t* here = maps_->strength.data() + maps_->at(p.x, p.y);
  const auto at = [&](int dx, int dy) {
    return static_cast<unsigned>(here[dy * maps_->width + dx]) >> 1U;
  };
  // The offset across the walk: -1 or 1 where that pixel alone is the strongest of the three.
  const auto swerve = [](unsigned low, unsigned middle, unsigned high) {
    return low > middle && low > high ? -1 : high > middle && high > low ? 1 : 0;
  };
  int dx = 0;
  int dy = 0;
  if (!walker->vertical) {
    if (q.x != p.x) {
      dx = q.x < p.x ? 1 : -1;
      dy = swerve(at(dx, -1), at(dx, 0), at(dx, 1));
    } else {
      dy = q.y < p.y ? 1 : -1;
      dx = at(-1, dy) > at(1, dy) ? -1 : 1;
    }
  } else if (q.y != p.y) {
    dy = q.y < p.y ? 1 : -1;
    dx = swerve(at(-1, dy), at(0, dy), at(1, dy));
  } else {
    dx = q.x < p.x ? 1 : -1;
    dy = at(dx, -1) > at(dx, 1) ? -1 : 1;
  }
  walker->at = {p.x + dx, p.y + dy};
  return at(dx, dy) > 0;
}

bool Drawing::walkBranch(Walker* walker, Side side, std::size_t* window) {
  const double squared_distance = parameters_.pixel_distance * parameters_.pixel_distance;
  const auto most = static_cast<std::size_t>(parameters_.max_outliers);
  outliers_.clear();
  while (outliers_.size() <= most && step(walker)) {
    const EdgePixel p = walker->at;
    const Label found = label(p);
    if (found == Label::kInlier || found == Label::kJunction || found == Label::kEdge) {
      return true;
    }
    if (!exists_) {
      growWithoutSegment(p, window);
    } else if (line_.isNear(p, squared_distance)) {
      setLabel(p, Label::kInlier);
      addToSegment(p, side);
      outliers_.clear();
      tip(side).extended = false;
    } else {
      outliers_.push_back(p);
      setLabel(p, Label::kOutlier);
    }
    walker->vertical = (maps_->strength[maps_->at(p.x, p.y)] & 1U) != 0;
  }
  return false;
}

// ---- segments

void Drawing::growWithoutSegment(EdgePixel p, std::size_t* window) {
  pixels_.push_back(p);
  setLabel(p, Label::kEdge);
  if (pixels_.size() - *window < static_cast<std::size_t>(parameters_.min_line_length)) {
    return;
  }
  // The window moves on: pixels leave the fit at its tail and enter at its head.
  if (fitting_) {
    for (; fit_begin_ < *window; ++fit_begin_) line_.remove(pixels_[fit_begin_]);
  } else {
    line_.clear();
    fit_begin_ = fit_end_ = *window;
    fitting_ = true;
  }
  const EdgePixel& first = pixels_[*window];
  line_.pointTo(p.x - first.x, p.y - first.y);
  for (; fit_end_ < pixels_.size(); ++fit_end_) line_.add(pixels_[fit_end_]);
  if (!line_.fitsWithin(parameters_.line_fit_error)) {
    *window += 2;
    return;
  }
  line_.update();
  for (std::size_t i = *window; i < pixels_.size(); ++i) setLabel(pixels_[i], Label::kInlier);
  exists_ = true;
  begin_ = *window;
  start_ = {first, pixels_[*window + 1], 0, false};
  end_ = {p, pixels_[pixels_.size() - 2], 0, false};
}

void Drawing::addToSegment(EdgePixel p, Side side) {
  Tip& grown = tip(side);
  pixels_.push_back(p);
  line_.add(p);
  line_.update();
  grown.before = grown.pixel;
  grown.pixel = p;
  ++grown.added;
}

void Drawing::undoLastInlier(Side side, EdgePixel anchor) {
  Tip& shortened = tip(side);
  line_.remove(shortened.pixel);
  line_.update();
  setLabel(shortened.pixel, Label::kFree);
  pixels_.pop_back();
  outliers_.insert(outliers_.begin(), shortened.pixel);
  shortened.pixel = shortened.before;
  if (shortened.added > 0) {
    --shortened.added;
  }
  if (side == Side::kStart && start_.pixel == anchor) {
    start_.extended = true;
  }
}

void Drawing::finishSegment() {
  segments_.push_back({line_.equation(), line_.horizontal(), start_.pixel, end_.pixel, begin_,
                       pixels_.size(), line_.size()});
  exists_ = fitting_ = false;
}

void Drawing::drawFrom(EdgePixel anchor) {
  const bool vertical = (maps_->strength[maps_->at(anchor.x, anchor.y)] & 1U) != 0;
  const Direction direction = vertical ? Direction::kDown : Direction::kRight;
  setLabel(anchor, Label::kAnchor);
  pixels_.push_back(anchor);
  initial_pixels_.clear();
  drawOneWay(anchor, direction, true);
  drawOneWay(anchor, opposite(direction), false);
}

void Drawing::drawOneWay(EdgePixel anchor, Direction direction, bool first_way) {
  bool reused = false;
  depth_ = 0;
  schedule(&reused, direction, anchor, Side::kEnd);
  stack_[0].preset = initial_pixels_;
  for (bool first_branch = true; depth_ > 0; first_branch = false) {
    const Branch& branch = stack_[depth_ - 1];
    const Side side = branch.side;
    Walker walker = walkerAt(branch.start, branch.direction);
    // The anchor itself, the last pixel so far, belongs to the first window.
    std::size_t window = pixels_.size() - (first_way && first_branch ? 1 : 0);
    const std::size_t begin = window;
    pixels_.insert(pixels_.end(), branch.preset.begin(), branch.preset.end());
    const bool hit = walkBranch(&walker, side, &window);
    if (first_way && first_branch && label(anchor) != Label::kInlier) {
      rememberForTheOtherWay(begin);
    }
    if (!exists_) {
      fitting_ = false;
      --depth_;
    } else if (!scheduleSuccessors(walker, side, anchor, hit)) {
      --depth_;
    }
  }
  exists_ = fitting_ = false;
}

void Drawing::rememberForTheOtherWay(std::size_t window) {
  const std::size_t count =
      std::min(pixels_.size() - window, static_cast<std::size_t>(parameters_.min_line_length - 1));
  for (std::size_t i = window + count; i-- > window;) {
    const Label found = label(pixels_[i]);
    if (found == Label::kInlier || found == Label::kJunction) {
      break;
    }
    initial_pixels_.push_back(pixels_[i]);
  }
}

// ---- what comes after a branch

void Drawing::schedule(bool* reused, Direction direction, EdgePixel start, Side side) {
  // The first successor takes the place of the branch that ended, further ones go on top.
  if (depth_ == 0 || *reused) {
    if (stack_.size() == depth_) {
      stack_.emplace_back();
    }
    ++depth_;
  }
  *reused = true;
  Branch& branch = stack_[depth_ - 1];
  branch.direction = direction;
  branch.start = start;
  branch.side = side;
  branch.preset.clear();
}

bool Drawing::scheduleSuccessors(const Walker& walker, Side side, EdgePixel anchor, bool hit) {
  bool reused = false;
  if (!outliers_.empty() && (side == Side::kEnd || start_.added > 0)) {
    undoLastInlier(side, anchor);
  }
  const bool strayed = outliers_.size() > static_cast<std::size_t>(parameters_.max_outliers);
  if (strayed) {
    // The edge turns away from the segment; another one may begin there.
    for (const EdgePixel& p : outliers_) setLabel(p, Label::kFree);
    const EdgePixel& p = walker.at;
    const EdgePixel& q = walker.before;
    const Direction direction = walker.vertical
                                    ? (p.y > q.y ? Direction::kDown : Direction::kUp)
                                    : (p.x > q.x ? Direction::kRight : Direction::kLeft);
    schedule(&reused, direction, p, Side::kEnd);
    std::vector<EdgePixel>& preset = stack_[depth_ - 1].preset;
    preset.push_back(pixels_.back());
    preset.insert(preset.end(), outliers_.begin(), outliers_.end());
  }
  return continueSegment(&reused, anchor, strayed || hit);
}

bool Drawing::continueSegment(bool* reused, EdgePixel anchor, bool obstructed) {
  if (obstructed && !end_.extended && jump(Side::kEnd)) {
    schedule(reused, lineDirection(), pixels_.back(), Side::kEnd);
    return true;
  }
  end_.extended = true;
  if (!start_.extended && start_.pixel == anchor) {
    start_.extended = true;
    schedule(reused, opposite(lineDirection()), anchor, Side::kStart);
  } else if (!start_.extended && jump(Side::kStart)) {
    schedule(reused, opposite(lineDirection()), pixels_.back(), Side::kStart);
  } else {
    finishSegment();
  }
  return *reused;
}

Drawing::Direction Drawing::lineDirection() const {
  const IncrementalLine::Equation line = line_.equation();
  if (std::abs(line.b) > std::abs(line.a)) {
    return -line.b > 0 ? Direction::kRight : Direction::kLeft;
  }
  return line.a > 0 ? Direction::kDown : Direction::kUp;
}

Drawing::Direction Drawing::opposite(Direction direction) {
  switch (direction) {
    case Direction::kUp:
      return Direction::kDown;
    case Direction::kDown:
      return Direction::kUp;
    case Direction::kLeft:
      return Direction::kRight;
    default:
      return Direction::kLeft;
  }
}

}  // namespace evolin::elsed
