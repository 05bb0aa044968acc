// Every line carries its trail along from match to match.
#include "evolin_ros/drawing/line_trails.h"

#include <algorithm>
#include <utility>

#include "evolin_ros/metrics/association.h"

namespace evolin {

std::vector<LineTrail> LineTrails::add(Stamp stamp, const LineSegments& lines, Stamp first_stamp,
                                       const LineMatches& matches) {
  const auto first = std::find_if(remembered_.begin(), remembered_.end(),
                                  [&](const Frame& frame) { return frame.stamp == first_stamp; });
  Frame frame{stamp, {}, lines};
  frame.trails.resize(lines.size());
  if (first != remembered_.end()) {
    for (const LineMatch& match : matches) {
      if (match.first < first->trails.size() && match.second < lines.size() &&
          frame.trails[match.second].points.empty()) {
        frame.trails[match.second] = first->trails[match.first];
      }
    }
  }
  std::vector<LineTrail> followed;
  for (std::size_t row = 0; row < lines.size(); ++row) {
    const LineSegment& line = lines[row];
    LineTrail& trail = frame.trails[row];
    const bool is_new = trail.points.empty();
    if (line.id >= 0) {
      trail.track = line.id;
    } else if (is_new) {
      trail.track = next_track_++;
    }
    trail.row = static_cast<std::uint32_t>(row);
    trail.points.emplace_back((line.x1 + line.x2) / 2, (line.y1 + line.y2) / 2);
    if (trail.points.size() > length_) {
      trail.points.erase(trail.points.begin());
    }
    if (!is_new) {
      followed.push_back(trail);
    }
  }
  remember(std::move(frame));
  return followed;
}

void LineTrails::add(Stamp stamp, const LineSegments& lines) { add(stamp, lines, stamp, {}); }

std::vector<LineTrail> LineTrails::addById(Stamp stamp, const LineSegments& lines) {
  if (remembered_.empty()) {
    add(stamp, lines);
    return {};
  }
  LineMatches matches;
  for (const IndexPair& pair : pairsOfEqualIds(remembered_.back().lines, lines)) {
    matches.push_back(
        {static_cast<std::uint32_t>(pair.first), static_cast<std::uint32_t>(pair.second)});
  }
  return add(stamp, lines, remembered_.back().stamp, matches);
}

void LineTrails::remember(Frame frame) {
  remembered_.push_back(std::move(frame));
  while (remembered_.size() > frames_) {
    remembered_.pop_front();
  }
}

}  // namespace evolin
