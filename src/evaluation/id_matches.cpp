// Joining lines of two frames by id.
#include "evolin_ros/evaluation/id_matches.h"

#include <algorithm>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "evolin_ros/base/error.h"

namespace evolin {

namespace {

bool hasIds(const LineSet& set) {
  return std::any_of(set.lines.begin(), set.lines.end(),
                     [](const LineSegment& line) { return line.id >= 0; });
}

LineMatches pairsOfEqualIds(const LineSegments& first, const LineSegments& second) {
  std::unordered_map<std::int64_t, std::uint32_t> row_of;
  for (std::size_t row = 0; row < first.size(); ++row) {
    if (first[row].id >= 0) {
      row_of.emplace(first[row].id, static_cast<std::uint32_t>(row));
    }
  }
  LineMatches matches;
  for (std::size_t row = 0; row < second.size(); ++row) {
    const auto found = row_of.find(second[row].id);
    if (found != row_of.end()) {
      LineMatch match;
      match.first = found->second;
      match.second = static_cast<std::uint32_t>(row);
      matches.push_back(match);
    }
  }
  return matches;
}

}  // namespace

IdMatcher::IdMatcher(int frame_step, std::string source)
    : step_(static_cast<std::size_t>(frame_step)),
      source_(source.empty() ? "ids" : std::move(source)) {
  if (frame_step < 1) {
    throw Error("matches from ids: a frame step of " + std::to_string(frame_step) +
                ", expected at least 1");
  }
}

IdMatcher::Result IdMatcher::add(const LineSet& lines) {
  Result result;
  result.jumped_back = !window_.empty() && lines.stamp <= window_.back().stamp;
  if (result.jumped_back || (!window_.empty() && window_.back().source != lines.source)) {
    window_.clear();
  }
  LineSet kept = lines;
  std::unordered_set<std::int64_t> seen;
  for (LineSegment& line : kept.lines) {
    if (line.id >= 0 && !seen.insert(line.id).second) {
      line.id = kNoId;
      ++result.repeated;
    }
  }
  window_.push_back(std::move(kept));
  if (window_.size() > step_ + 1) {
    window_.pop_front();
  }
  if (window_.size() <= step_) {
    return result;
  }
  const LineSet& first = window_.front();
  const LineSet& second = window_.back();
  const auto usable = [](const LineSet& set) { return set.lines.empty() || hasIds(set); };
  result.without_ids = !usable(first) || !usable(second);
  if (!result.without_ids) {
    MatchSet set;
    set.first_stamp = first.stamp;
    set.stamp = second.stamp;
    set.frame_id = second.frame_id;
    set.source = source_;
    set.lines_source = second.source;
    set.matches = pairsOfEqualIds(first.lines, second.lines);
    result.matches = std::move(set);
  }
  return result;
}

}  // namespace evolin
