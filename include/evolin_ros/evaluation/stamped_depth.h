// The newest depth images of a stream, found by the stamp of the image that they belong to.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>

#include "evolin_ros/base/stamp.h"
#include "evolin_ros/geometry/projection.h"

namespace evolin {

/// Whether what belongs to a stamp is there.
enum class Lookup {
  kFound,
  kNotYet,  ///< it, or something nearer, may still come
  kNever,
};

class StampedDepth {
 public:
  /// `tolerance`: largest distance in time, ns. `capacity`: images that are kept, at least 1.
  StampedDepth(Stamp tolerance, std::size_t capacity);

  /// One that is older than all of a full buffer is forgotten at once.
  void add(Stamp stamp, DepthMap depth);

  /// The depth image nearest to `stamp` (the earlier of two) into `*depth`, which stays valid until
  /// the next add(). Images come in order of time; with `complete` none will come any more.
  Lookup find(Stamp stamp, bool complete, const DepthMap** depth);

  /// Forgets images before `settled`, but for a few that late parts may want, and for some more as
  /// long as `is_wanted` holds for the stamp of the oldest.
  void trim(Stamp settled, const std::function<bool(Stamp)>& is_wanted);

  /// Whether an image of that stamp may have been here and left.
  bool hasForgotten(Stamp stamp) const { return forgotten_ && stamp <= *forgotten_ + tolerance_; }

  bool empty() const { return !newest_; }

  /// Smallest distance in time, ns, at which a look-up without success found something: what a
  /// larger tolerance would have taken.
  std::optional<Stamp> nearestMiss() const { return nearest_miss_; }

 private:
  void forgetOldest();

  Stamp tolerance_;
  std::size_t capacity_;
  std::map<Stamp, DepthMap> images_;
  std::optional<Stamp> newest_;
  std::optional<Stamp> forgotten_;  ///< the newest that left
  std::optional<Stamp> nearest_miss_;
};

}  // namespace evolin
