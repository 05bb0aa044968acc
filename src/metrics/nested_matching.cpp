// Nearest pairs first, then augmenting paths by breadth-first search over bits.
//
// A set of predicted pixels that can be matched all at once may be grown pixel by pixel: a pixel
// either joins by an augmenting path, or never will, as such sets form a matroid. A search that
// fails has met only matched ground-truth pixels, from which no free one can be reached, and later
// augmenting paths cannot lead there either: these pixels are dead and leave all later searches. So
// the searches of all levels together visit little more than the searches of the last level would.
#include "nested_matching.h"

#include <utility>

namespace evolin {

namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFF;

class NestedMatcher {
 public:
  NestedMatcher(const PixelGrid& grid, const IndexedCells& ground_truth, const Deadline& deadline)
      : grid_(grid),
        ground_truth_(ground_truth),
        deadline_(deadline),
        free_(ground_truth.set()),
        live_(ground_truth.set()),
        owners_(ground_truth.size(), kNone),
        visitors_(ground_truth.size(), kNone) {}

  void addLevel(const std::vector<Cell>& added) {
    std::vector<Cell> waiting;
    std::vector<Cell> late;
    for (const Cell cell : added) {
      (free_.anyNear(grid_, cell) ? waiting : late).push_back(cell);
    }
    matchNearestFirst(&waiting);
    for (const Cell cell : waiting) {
      augment(cell);
    }
    for (const Cell cell : late) {
      augment(cell);
    }
    result_.sizes.push_back(result_.predicted.size());
  }

  NestedMatching take() { return std::move(result_); }

 private:
  /// Takes away from `waiting` what finds a free partner within reach, shortest pairs first.
  void matchNearestFirst(std::vector<Cell>* waiting) {
    for (const PixelGrid::DiscCell& place : grid_.nearestFirst()) {
      deadline_.check();
      std::size_t kept = 0;
      for (const Cell cell : *waiting) {
        const Cell partner = cell + place.offset;
        if (free_.contains(partner)) {
          join(cell, partner);
        } else {
          (*waiting)[kept++] = cell;
        }
      }
      waiting->resize(kept);
      if (kept == 0) {
        return;
      }
    }
  }

  void join(Cell predicted, Cell partner) {
    free_.erase(partner);
    const std::uint32_t index = ground_truth_.index(partner);
    owners_[index] = static_cast<std::uint32_t>(result_.predicted.size());
    result_.predicted.push_back(predicted);
    result_.partners.push_back(index);
  }

  /// Matches `start` by a shortest augmenting path if there is one.
  void augment(Cell start) {
    deadline_.check();
    const auto number = static_cast<std::uint32_t>(result_.predicted.size());
    queue_.clear();
    queue_.push_back(number);
    result_.predicted.push_back(start);
    visited_.clear();
    Cell end = 0;
    bool found = false;
    for (std::size_t next = 0; next < queue_.size() && !found; ++next) {
      const std::uint32_t from = queue_[next];
      live_.forEachNear(grid_, result_.predicted[from], [&](Cell cell, std::uint32_t) {
        live_.erase(cell);
        visited_.push_back(cell);
        const std::uint32_t index = ground_truth_.index(cell);
        visitors_[index] = from;
        if (owners_[index] == kNone) {
          end = cell;
          found = true;
          return false;
        }
        queue_.push_back(owners_[index]);
        return true;
      });
    }
    if (!found) {
      result_.predicted.pop_back();  // what was visited stays erased: it is dead
      return;
    }
    for (const Cell cell : visited_) {
      live_.insert(cell);
    }
    free_.erase(end);
    flipPath(ground_truth_.index(end), number);
  }

  /// Gives every ground-truth pixel on the way back from `index` to the one that reached it, who
  /// in turn leaves the pixel through which it was reached itself.
  void flipPath(std::uint32_t index, std::uint32_t start) {
    while (true) {
      const std::uint32_t owner = visitors_[index];
      owners_[index] = owner;
      if (owner == start) {
        result_.partners.push_back(index);
        return;
      }
      std::swap(result_.partners[owner], index);
    }
  }

  const PixelGrid& grid_;
  const IndexedCells& ground_truth_;
  const Deadline& deadline_;
  CellSet free_;                         ///< unmatched ground-truth cells
  CellSet live_;                         ///< ground-truth cells that searches may visit
  std::vector<std::uint32_t> owners_;    ///< of ground-truth pixels: number in result_.predicted
  std::vector<std::uint32_t> visitors_;  ///< of ground-truth pixels: who reached them last
  std::vector<std::uint32_t> queue_;
  std::vector<Cell> visited_;
  NestedMatching result_;
};

}  // namespace

NestedMatching matchNested(const PixelGrid& grid, const IndexedCells& ground_truth,
                           const std::vector<std::vector<Cell>>& added, const Deadline& deadline) {
  NestedMatcher matcher(grid, ground_truth, deadline);
  for (const std::vector<Cell>& level : added) {
    matcher.addLevel(level);
  }
  return matcher.take();
}

}  // namespace evolin
