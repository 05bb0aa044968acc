// Predicted pixels join one by one, each by one shortest path, so that the matching is a cheapest
// one at any time.
//
// Duality keeps it so: values u of ground-truth pixels, at most free_cost and equal to it at free
// ones, and v of predicted pixels, at least 0 and equal to it at free ones, with u - v at most the
// weight of any pair and equal to it for matched pairs. A new pixel takes the v that its best pair
// asks for. If that is above 0, Dijkstra's search over reduced weights finds the cheapest of three
// ways to put things right: match a free ground-truth pixel, free a predicted pixel that is worth
// less, or stay free. Values fall by what the search leaves over. Ground-truth values never rise,
// so a predicted pixel that stays or becomes free remains so, and the number of pairs never falls.
#include "exact_matching.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace evolin {

namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFF;
constexpr double kFar = std::numeric_limits<double>::infinity();
constexpr double kPairCost = 1e-6;  ///< of every pair, on top of its distance

class ExactMatcher {
 public:
  ExactMatcher(const PixelGrid& grid, const IndexedCells& ground_truth, double free_cost)
      : grid_(grid), ground_truth_(ground_truth), sites_(ground_truth.size()) {
    for (Site& site : sites_) {
      site.value = free_cost;
    }
    const auto reach = static_cast<std::size_t>(grid.reach());
    for (std::size_t squared = 0; squared <= reach * reach; ++squared) {
      weights_.push_back(std::sqrt(static_cast<double>(squared)) + kPairCost);
    }
  }

  void add(Cell cell) {
    const auto start = static_cast<std::uint32_t>(pixels_.size());
    Pixel pixel;
    pixel.first_arc = arcs_.size();
    ground_truth_.forEachNear(
        grid_, cell, [this, &pixel](std::uint32_t near, std::uint32_t squared) {
          const Arc arc{near, squared};
          arcs_.push_back(arc);
          pixel.value = std::max(pixel.value, sites_[arc.site].value - weights_[squared]);
          return true;
        });
    pixel.end_arc = arcs_.size();
    pixels_.push_back(pixel);
    if (pixel.value > 0) {
      settle(start);
    }
    if (pixels_[start].partner == kNone) {
      pixels_.pop_back();  // free for good
      arcs_.resize(pixel.first_arc);
    }
  }

  std::size_t pairs() const { return pairs_; }

 private:
  struct Arc {
    std::uint32_t site;
    std::uint32_t squared;
  };
  struct Site {
    double value = 0;
    double distance = kFar;
    std::uint32_t owner = kNone;
    std::uint32_t reached_from = kNone;
  };
  struct Pixel {
    double value = 0;
    std::size_t first_arc = 0;
    std::size_t end_arc = 0;
    std::uint32_t partner = kNone;
  };
  struct HeapEntry {
    double distance;
    std::uint32_t site;
    bool operator<(const HeapEntry& other) const { return distance > other.distance; }
  };

  void settle(std::uint32_t start) {
    touched_.clear();
    settled_.clear();
    heap_.clear();
    least_ = pixels_[start].value;  // to stay free
    freed_site_ = kNone;
    goal_ = kNone;
    relax(start, 0);
    while (!heap_.empty() && heap_.front().distance < least_) {
      const HeapEntry entry = heap_.front();
      std::pop_heap(heap_.begin(), heap_.end());
      heap_.pop_back();
      if (entry.distance == sites_[entry.site].distance) {
        settled_.push_back(entry.site);
        relax(sites_[entry.site].owner, entry.distance);
      }
    }
    lowerValues(start);
    if (goal_ != kNone) {
      ++pairs_;
      flipPath(start, goal_);
    } else if (freed_site_ != kNone) {
      pixels_[sites_[freed_site_].owner].partner = kNone;
      flipPath(start, freed_site_);
    }
    for (const std::uint32_t index : touched_) {
      sites_[index].distance = kFar;
    }
  }

  /// Looks at all pairs of a pixel at `distance` from the start.
  void relax(std::uint32_t from, double distance) {
    const Pixel& pixel = pixels_[from];
    for (std::size_t index = pixel.first_arc; index < pixel.end_arc; ++index) {
      const Arc arc = arcs_[index];
      Site& site = sites_[arc.site];
      // Rounding may leave a reduced weight just below 0.
      const double there =
          std::max(distance, distance + pixel.value + weights_[arc.squared] - site.value);
      if (there >= site.distance || there >= least_ || arc.site == pixel.partner) {
        continue;
      }
      if (site.distance == kFar) {
        touched_.push_back(arc.site);
      }
      site.distance = there;
      site.reached_from = from;
      if (site.owner == kNone) {
        least_ = there;
        goal_ = arc.site;
        continue;
      }
      const double freeing = there + pixels_[site.owner].value;
      if (freeing < least_) {
        least_ = freeing;
        goal_ = kNone;
        freed_site_ = arc.site;
      }
      if (there < least_) {
        heap_.push_back({there, arc.site});
        std::push_heap(heap_.begin(), heap_.end());
      }
    }
  }

  void lowerValues(std::uint32_t start) {
    for (const std::uint32_t index : settled_) {
      Site& site = sites_[index];
      if (site.distance < least_) {
        site.value -= least_ - site.distance;
        pixels_[site.owner].value -= least_ - site.distance;
      }
    }
    pixels_[start].value -= least_;
  }

  void flipPath(std::uint32_t start, std::uint32_t index) {
    std::uint32_t pixel = kNone;
    do {
      pixel = sites_[index].reached_from;
      sites_[index].owner = pixel;
      std::swap(pixels_[pixel].partner, index);
    } while (pixel != start);
  }

  const PixelGrid& grid_;
  const IndexedCells& ground_truth_;
  std::vector<double> weights_;  ///< by squared distance
  std::vector<Site> sites_;      ///< ground-truth pixels
  std::vector<Pixel> pixels_;    ///< predicted pixels that are or were matched
  std::vector<Arc> arcs_;
  std::size_t pairs_ = 0;

  // Of the current search:
  double least_ = 0;  ///< cost of the best way out so far
  std::uint32_t goal_ = kNone;
  std::uint32_t freed_site_ = kNone;  ///< whose owner the best way out frees, where goal_ is none
  std::vector<std::uint32_t> touched_;
  std::vector<std::uint32_t> settled_;
  std::vector<HeapEntry> heap_;
};

}  // namespace

std::vector<std::size_t> countCheapest(const PixelGrid& grid, const IndexedCells& ground_truth,
                                       const std::vector<std::vector<Cell>>& added,
                                       double free_cost, const Deadline& deadline) {
  ExactMatcher matcher(grid, ground_truth, free_cost);
  std::vector<std::size_t> counts;
  for (const std::vector<Cell>& level : added) {
    for (const Cell cell : level) {
      deadline.check();
      matcher.add(cell);
    }
    counts.push_back(matcher.pairs());
  }
  return counts;
}

}  // namespace evolin
