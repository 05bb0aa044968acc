// How long lines are followed and how often they change their identity (not in the article; the
// switches are those of CLEAR MOT, Bernardin and Stiefelhagen 2008).
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <unordered_map>
#include <vector>

#include "evolin_ros/geometry/line_segment.h"

namespace evolin {

/// Turns matches of consecutive frames into track ids, for front-ends that give no ids themselves.
class TrackBuilder {
 public:
  /// One id for each of `lines` lines: that of its match in the frame before, else a new one,
  /// rising from 0. `matches` are (row in the frame before, row in this one); where a row occurs
  /// several times, the pair that comes first in order of rows counts. Throws Error naming a pair
  /// that has no such rows.
  std::vector<std::int64_t> addFrame(std::size_t lines, const IndexPairs& matches);

  /// The next frame has none before it; ids go on rising.
  void startSequence() { previous_.clear(); }

 private:
  std::vector<std::int64_t> previous_;
  std::int64_t next_id_ = 0;
};

/// An accumulator over the frames of sequences, in order within each.
class TrackMetrics {
 public:
  /// The next frame of the sequence. `track_ids` has one id a line (kNoId: not tracked), none
  /// twice. `true_ids` is empty (no ground truth), or has for each line the id of the physical line
  /// that it shows (kNoId: none; see carryOverIds()), the same one for several lines at will.
  /// Throws Error for a repeated track id or another number of true ids, and adds nothing then.
  void addFrame(const std::vector<std::int64_t>& track_ids,
                const std::vector<std::int64_t>& true_ids = {});

  /// The same ids mean other tracks and other lines from here on.
  void finishSequence();

  std::size_t frames() const { return frames_; }
  std::uint64_t tracks() const;

  /// A track is as long as the number of frames that it occurs in. None without tracks.
  std::optional<double> meanLength() const;
  std::optional<double> medianLength() const;  ///< mean of the middle two of an even number
  std::uint32_t longest() const;               ///< 0 without tracks

  /// Frames in which a physical line is shown by tracked lines, summed over physical lines.
  std::uint64_t observations() const { return observations_; }

  /// A physical line is shown, but not by the track that showed it last (of several new ones, that
  /// of the lowest row takes over).
  std::uint64_t identitySwitches() const { return identity_switches_; }

  /// A track shows another physical line than the last that it showed.
  std::uint64_t drifts() const { return drifts_; }

  /// Adds `other`'s sequences, finishing those that are open in both.
  void merge(const TrackMetrics& other);
  void reset();

 private:
  struct Track {
    std::uint32_t length = 0;
    std::int64_t shown = kNoId;  ///< physical line, the last time that it showed one
  };

  std::map<std::uint32_t, std::uint64_t> lengths() const;

  std::size_t frames_ = 0;
  std::uint64_t observations_ = 0;
  std::uint64_t identity_switches_ = 0;
  std::uint64_t drifts_ = 0;
  std::map<std::uint32_t, std::uint64_t> finished_;            ///< tracks by length
  std::unordered_map<std::int64_t, Track> open_;               ///< of this sequence, by track id
  std::unordered_map<std::int64_t, std::int64_t> last_track_;  ///< by physical line
};

}  // namespace evolin
