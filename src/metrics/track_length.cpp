// Tracks and physical lines, each remembering the other.
#include "evolin_ros/metrics/track_length.h"

#include <algorithm>
#include <string>
#include <unordered_set>
#include <utility>

#include "evolin_ros/base/error.h"

namespace evolin {

std::vector<std::int64_t> TrackBuilder::addFrame(std::size_t lines, const IndexPairs& matches) {
  IndexPairs ordered = matches;
  std::sort(ordered.begin(), ordered.end());
  std::vector<std::int64_t> ids(lines, kNoId);
  std::vector<bool> continued(previous_.size(), false);
  for (const auto& [before, now] : ordered) {
    if (before < 0 || now < 0 || static_cast<std::uint64_t>(before) >= previous_.size() ||
        static_cast<std::uint64_t>(now) >= lines) {
      throw Error("match (" + std::to_string(before) + ", " + std::to_string(now) +
                  "): expected rows of " + std::to_string(previous_.size()) +
                  " lines in the frame before and " + std::to_string(lines) + " in this one");
    }
    const auto from = static_cast<std::size_t>(before);
    const auto to = static_cast<std::size_t>(now);
    if (!continued[from] && ids[to] == kNoId) {
      continued[from] = true;
      ids[to] = previous_[from];
    }
  }
  for (std::int64_t& id : ids) {
    if (id == kNoId) {
      id = next_id_++;
    }
  }
  previous_ = ids;
  return ids;
}

void TrackMetrics::addFrame(const std::vector<std::int64_t>& track_ids,
                            const std::vector<std::int64_t>& true_ids) {
  if (!true_ids.empty() && true_ids.size() != track_ids.size()) {
    throw Error("tracks of a frame: " + std::to_string(track_ids.size()) + " lines and " +
                std::to_string(true_ids.size()) + " true ids; expected one a line, or none at all");
  }
  std::unordered_set<std::int64_t> present;
  for (const std::int64_t track : track_ids) {
    if (track >= 0 && !present.insert(track).second) {
      throw Error("tracks of a frame: id " + std::to_string(track) +
                  " occurs twice; expected each track once in a frame");
    }
  }
  ++frames_;
  std::unordered_set<std::int64_t> seen;     // physical lines of this frame
  std::unordered_set<std::int64_t> carried;  // those that their last track shows again
  for (std::size_t row = 0; row < track_ids.size(); ++row) {
    if (track_ids[row] < 0) {
      continue;
    }
    Track& track = open_[track_ids[row]];
    ++track.length;
    const std::int64_t line = true_ids.empty() ? kNoId : true_ids[row];
    if (line < 0) {
      continue;
    }
    drifts_ += track.shown != kNoId && track.shown != line ? 1 : 0;
    track.shown = line;
    observations_ += seen.insert(line).second ? 1 : 0;
    const auto last = last_track_.find(line);
    if (last != last_track_.end() && last->second == track_ids[row]) {
      carried.insert(line);
    }
  }
  for (std::size_t row = 0; row < true_ids.size(); ++row) {
    const std::int64_t line = true_ids[row];
    // Each physical line is settled once, by its lowest row: it is carried from then on.
    if (track_ids[row] < 0 || line < 0 || !carried.insert(line).second) {
      continue;
    }
    const auto [last, first_time] = last_track_.insert_or_assign(line, track_ids[row]);
    static_cast<void>(last);
    identity_switches_ += first_time ? 0 : 1;
  }
}

void TrackMetrics::finishSequence() {
  finished_ = lengths();
  open_.clear();
  last_track_.clear();
}

std::map<std::uint32_t, std::uint64_t> TrackMetrics::lengths() const {
  std::map<std::uint32_t, std::uint64_t> result = finished_;
  for (const auto& [id, track] : open_) {
    ++result[track.length];
  }
  return result;
}

std::uint64_t TrackMetrics::tracks() const {
  std::uint64_t count = open_.size();
  for (const auto& [length, number] : finished_) {
    count += number;
  }
  return count;
}

std::optional<double> TrackMetrics::meanLength() const {
  std::uint64_t tracks = 0;
  std::uint64_t sum = 0;
  for (const auto& [length, number] : lengths()) {
    tracks += number;
    sum += number * length;
  }
  return tracks == 0
             ? std::nullopt
             : std::optional<double>(static_cast<double>(sum) / static_cast<double>(tracks));
}

std::optional<double> TrackMetrics::medianLength() const {
  const std::uint64_t count = tracks();
  if (count == 0) {
    return std::nullopt;
  }
  const std::map<std::uint32_t, std::uint64_t> by_length = lengths();
  const auto length_at = [&by_length](std::uint64_t rank) {
    auto at = by_length.begin();
    while (rank >= at->second) {
      rank -= at->second;
      ++at;
    }
    return static_cast<double>(at->first);
  };
  return (length_at((count - 1) / 2) + length_at(count / 2)) / 2;
}

std::uint32_t TrackMetrics::longest() const {
  const std::map<std::uint32_t, std::uint64_t> by_length = lengths();
  return by_length.empty() ? 0 : by_length.rbegin()->first;
}

void TrackMetrics::merge(const TrackMetrics& other) {
  const std::map<std::uint32_t, std::uint64_t> others = other.lengths();
  frames_ += other.frames_;
  observations_ += other.observations_;
  identity_switches_ += other.identity_switches_;
  drifts_ += other.drifts_;
  finishSequence();
  for (const auto& [length, number] : others) {
    finished_[length] += number;
  }
}

void TrackMetrics::reset() { *this = TrackMetrics(); }

}  // namespace evolin
