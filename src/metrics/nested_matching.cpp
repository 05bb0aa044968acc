// Nearest pairs first, then augmenting paths by breadth-first search over bits.
//
// A set of predicted pixels that can be matched all at once may be grown pixel by pixel: a pixel
// either joins by an augmenting path, or never will, as such sets form a matroid. The ground-truth
// pixels that a pixel which never will join can reach, over pairs in turn, are matched all, and
// later augmenting paths cannot lead there either: they are dead and leave all later searches. So
// the searches of all levels together visit little more than the searches of the last level would.
//
// Which pixels of a level join is free where it has too many. Each free ground-truth pixel takes
// the one fewest pairs away: long shifts make the matching dear, and its proof (gain_proof) hard.
#include "nested_matching.h"

#include <algorithm>
#include <utility>

namespace evolin {

namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFF;
/// After so many places of the disc it is cheaper to ask who has nothing free left in it.
constexpr std::size_t kOffsetsPerCheck = 16;

class NestedMatcher {
 public:
  NestedMatcher(const PixelGrid& grid, const IndexedCells& ground_truth,
                const std::vector<std::vector<Cell>>& added, const Deadline& deadline)
      : grid_(grid),
        ground_truth_(ground_truth),
        predicted_(grid, added),
        deadline_(deadline),
        free_(ground_truth.set()),
        live_(ground_truth.set()),
        standing_(grid),
        owners_(ground_truth.size(), kNone),
        partners_(predicted_.size(), kNone),
        visitors_(ground_truth.size(), kNone),
        roots_(predicted_.size(), kNone) {}

  void addLevel(const std::vector<Cell>& added) {
    std::vector<Cell> waiting = added;
    matchNearestFirst(&waiting);
    augment(waiting);
    result_.sizes.push_back(result_.predicted.size());
  }

  NestedMatching take() {
    for (const Cell cell : result_.predicted) {
      result_.partners.push_back(partners_[predicted_.index(cell)]);
    }
    return std::move(result_);
  }

 private:
  /// Takes away from `waiting` what finds a free partner within reach, shortest pairs first.
  void matchNearestFirst(std::vector<Cell>* waiting) {
    std::vector<Cell> beside;  // nothing free within reach
    std::vector<Cell> left = *waiting;
    const std::vector<PixelGrid::Offset>& offsets = grid_.nearestFirst();
    for (std::size_t place = 0; place < offsets.size() && !left.empty(); ++place) {
      deadline_.check();
      if (place % kOffsetsPerCheck == 0) {
        const auto gone = std::stable_partition(
            left.begin(), left.end(), [this](Cell cell) { return free_.anyNear(grid_, cell); });
        beside.insert(beside.end(), gone, left.end());
        left.erase(gone, left.end());
      }
      std::size_t kept = 0;
      for (const Cell cell : left) {
        const Cell partner = grid_.moved(cell, offsets[place]);
        if (free_.contains(partner)) {
          free_.erase(partner);
          join(cell);
          pair(predicted_.index(cell), ground_truth_.index(partner));
        } else {
          left[kept++] = cell;
        }
      }
      left.resize(kept);
    }
    beside.insert(beside.end(), left.begin(), left.end());
    waiting->swap(beside);
  }

  void join(Cell cell) { result_.predicted.push_back(cell); }

  void pair(std::uint32_t number, std::uint32_t site) {
    owners_[site] = number;
    partners_[number] = site;
  }

  /// Grows trees of pairs in turn from all waiting pixels at once. A tree that comes to a free
  /// ground-truth pixel is an augmenting path and falls. What it held is offered to the trees that
  /// stand, which grow on, until none comes to a free pixel any more: what they hold is dead then.
  void augment(const std::vector<Cell>& waiting) {
    reached_.clear();
    for (const Cell cell : waiting) {
      const std::uint32_t root = predicted_.index(cell);
      roots_[root] = root;
      standing_.insert(cell);
      grow(root);
    }
    std::size_t next = 0;
    while (true) {
      deadline_.check();
      fallen_ = false;
      for (; next < reached_.size(); ++next) {
        const std::uint32_t site = ground_truth_.index(reached_[next]);
        const std::uint32_t root = roots_[visitors_[site]];
        if (stands(root)) {
          const std::uint32_t owner = owners_[site];
          roots_[owner] = root;
          standing_.insert(predicted_.cells()[owner]);
          grow(owner);
        }
      }
      if (!fallen_) {
        break;
      }
      next = regrow();
    }
    for (const Cell cell : waiting) {
      standing_.erase(cell);
    }
    for (const Cell cell : reached_) {
      standing_.erase(predicted_.cells()[owners_[ground_truth_.index(cell)]]);
    }
  }

  /// A tree stands until its root is matched.
  bool stands(std::uint32_t root) const { return partners_[root] == kNone; }

  /// Takes what is live within reach of a predicted pixel into its tree.
  void grow(std::uint32_t from) {
    const std::uint32_t root = roots_[from];
    live_.forEachNear(grid_, predicted_.cells()[from], [&](Cell cell, std::uint32_t) {
      live_.erase(cell);
      reached_.push_back(cell);
      const std::uint32_t site = ground_truth_.index(cell);
      visitors_[site] = from;
      if (!free_.contains(cell)) {
        return true;
      }
      free_.erase(cell);
      join(predicted_.cells()[root]);
      flipPath(site, root);
      fallen_ = true;
      return false;
    });
  }

  /// Clears away the trees that fell; what they held and a standing tree has within reach goes to
  /// that tree. Returns the place in reached_ from which on trees have yet to grow.
  std::size_t regrow() {
    std::vector<Cell> released;
    std::size_t kept = 0;
    for (const Cell cell : reached_) {
      const std::uint32_t site = ground_truth_.index(cell);
      if (stands(roots_[visitors_[site]])) {
        reached_[kept++] = cell;
      } else {
        released.push_back(cell);
        standing_.erase(predicted_.cells()[owners_[site]]);
      }
    }
    reached_.resize(kept);
    for (const Cell cell : released) {
      bool taken = false;
      standing_.forEachNear(grid_, cell, [&](Cell near, std::uint32_t) {
        visitors_[ground_truth_.index(cell)] = predicted_.index(near);
        taken = true;
        return false;
      });
      if (taken) {
        reached_.push_back(cell);
      } else {
        live_.insert(cell);
      }
    }
    return kept;
  }

  /// Gives every ground-truth pixel on the way back from `site` to the one that reached it, who
  /// in turn leaves the pixel through which it was reached itself.
  void flipPath(std::uint32_t site, std::uint32_t root) {
    std::uint32_t owner = kNone;
    do {
      owner = visitors_[site];
      const std::uint32_t left = partners_[owner];
      pair(owner, site);
      site = left;
    } while (owner != root);
  }

  const PixelGrid& grid_;
  const IndexedCells& ground_truth_;
  const IndexedCells predicted_;  ///< of all levels
  const Deadline& deadline_;
  CellSet free_;                         ///< unmatched ground-truth cells
  CellSet live_;                         ///< ground-truth cells neither dead nor in a tree
  CellSet standing_;                     ///< predicted cells of the trees that stand
  std::vector<std::uint32_t> owners_;    ///< of ground-truth pixels: number of predicted pixel
  std::vector<std::uint32_t> partners_;  ///< of predicted pixels: number of ground-truth pixel
  std::vector<std::uint32_t> visitors_;  ///< of ground-truth pixels: who reached them last
  std::vector<std::uint32_t> roots_;  ///< of predicted pixels: of the tree that they were last in
  std::vector<Cell> reached_;         ///< ground-truth cells in trees
  bool fallen_ = false;               ///< some tree, since the last look
  NestedMatching result_;
};

}  // namespace

NestedMatching matchNested(const PixelGrid& grid, const IndexedCells& ground_truth,
                           const std::vector<std::vector<Cell>>& added, const Deadline& deadline) {
  NestedMatcher matcher(grid, ground_truth, added, deadline);
  for (const std::vector<Cell>& level : added) {
    matcher.addLevel(level);
  }
  return matcher.take();
}

}  // namespace evolin
