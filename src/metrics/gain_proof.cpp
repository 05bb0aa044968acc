// Prices for ground-truth pixels that bound what any exchange of pairs can gain.
//
// Why it is enough. Let N be a matching of most pairs and O a cheapest one with fewer pairs. Among
// the paths and cycles of pairs that are in one of the two only, some path has one pair of N more
// than of O; exchanging O for N along it frees one ground-truth pixel less. As O is cheapest, the
// path's pairs of N cost at least `free_cost` more than its pairs of O: its gain is that large. All
// vertices of the path are matched in N. So it is enough to show that no path within the matched
// vertices gains `free_cost`, and any matching N of the same vertices may serve. One that matches
// the predicted pixels of the last level serves all levels at once: what it matches of levels 0 to
// k is a matching of most pairs at level k, and its paths are among those already dealt with.
//
// How it is shown, part by connected part, as a path stays in one. Let p_1 g_1, ..., p_n g_n be the
// pairs of N on the path, and p_j g_(j+1) those of O, of weight w. The gain is the sum of
// w(p_j, g_j) less the sum of w(p_j, g_(j+1)).
// 1. It is at most the weight of all pairs of the part. That settles the small parts.
// 2. For any prices c of ground-truth pixels, let s_j be by how much w(p_j, g_j) + c(g_j) exceeds
//    the least w(p_j, g) + c(g) of any g within reach. Summed over j < n, the gain is at most
//    w(p_n, g_n) + c(g_n) - c(g_1) + s_1 + ... + s_(n-1), so at most the largest w + c, less the
//    smallest c, plus all s of the part.
// Good prices and a good N are those of the cheapest matching of the predicted pixels, every s 0.
// They are sought in weights rounded to whole units, and the rounding ends up in the s; parts that
// fail by it are tried once more in finer units. The bound itself is computed from exact weights,
// so nothing depends on how the prices were found.
#include "gain_proof.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "disjoint_parts.h"
#include "price_search.h"

namespace evolin {

namespace {

/// Units a pixel: coarse ones tie more often, fine ones cost less of the bound.
constexpr std::int32_t kCoarse = 16;
constexpr std::int32_t kFine = 64;
constexpr double kMostExpensive = 25500;  ///< pixels: no image has as long a diagonal
constexpr double kPriceLimit = 4;         ///< in free costs; auctions overshoot
constexpr double kMargin = 0.01;          ///< far above all rounding of doubles, and above the 1e-6
constexpr std::size_t kUsualArcs = 32;    ///< memory to begin with, a bidder

class GainProof {
 public:
  GainProof(const PixelGrid& grid, const IndexedCells& ground_truth, const NestedMatching& matching,
            double free_cost)
      : matching_(matching),
        free_cost_(free_cost),
        sites_(ground_truth.size()),
        parts_(ground_truth.size()) {
    listArcs(grid, ground_truth);
  }

  std::vector<std::uint32_t> run(int reach, const Deadline& deadline) {
    setAsideLightParts();
    PriceSearch search(&lists_, sites_, reach,
                       std::clamp(free_cost_, 1.0, kMostExpensive) * kPriceLimit, deadline);
    for (const std::int32_t units : {kCoarse, kFine}) {
      if (!bidders_.empty()) {
        search.run(bidders_, units);
        setAsideProvenParts(search);
      }
    }
    std::vector<std::uint32_t> unproven;
    for (const std::uint32_t bidder : bidders_) {
      unproven.push_back(matching_.partners[bidder]);
    }
    return unproven;
  }

 private:
  void listArcs(const PixelGrid& grid, const IndexedCells& ground_truth) {
    const auto reach = static_cast<std::size_t>(grid.reach());
    lengths_.resize(reach * reach + 1);
    for (std::size_t squared = 0; squared < lengths_.size(); ++squared) {
      lengths_[squared] = std::sqrt(static_cast<double>(squared));
    }
    lists_.arcs.reserve(matching_.predicted.size() * kUsualArcs);
    lists_.first.reserve(matching_.predicted.size() + 1);
    lists_.first.push_back(0);
    for (std::size_t bidder = 0; bidder < matching_.predicted.size(); ++bidder) {
      const std::uint32_t root = parts_.find(matching_.partners[bidder]);
      ground_truth.set().forEachNear(
          grid, matching_.predicted[bidder], [&](Cell cell, std::uint32_t squared) {
            const std::uint32_t site = ground_truth.index(cell);
            lists_.arcs.push_back({site, 0, static_cast<std::uint16_t>(squared)});
            parts_.unite(root, site);
            return true;
          });
      lists_.first.push_back(static_cast<std::uint32_t>(lists_.arcs.size()));
    }
  }

  /// Bidders are the predicted pixels of parts that still lack a proof; claim 1 above.
  void setAsideLightParts() {
    std::vector<double> weights(sites_, 0);
    for (std::uint32_t bidder = 0; bidder < matching_.predicted.size(); ++bidder) {
      const std::uint32_t partner = matching_.partners[bidder];
      const Arc* arc = std::find_if(lists_.begin(bidder), lists_.end(bidder),
                                    [partner](const Arc& each) { return each.site == partner; });
      weights[parts_.find(partner)] += lengths_[arc->squared];
    }
    for (std::uint32_t bidder = 0; bidder < matching_.predicted.size(); ++bidder) {
      if (weights[parts_.find(matching_.partners[bidder])] >= free_cost_ - kMargin) {
        bidders_.push_back(bidder);
      }
    }
  }

  /// Claim 2 above, in exact weights.
  void setAsideProvenParts(const PriceSearch& search) {
    struct Extremes {
      double highest = -std::numeric_limits<double>::infinity();
      double lowest = std::numeric_limits<double>::infinity();
      double excess = 0;
    };
    std::vector<Extremes> extremes(sites_);
    const auto cost = [this, &search](const Arc& arc) {
      return lengths_[arc.squared] + search.price(arc.site);
    };
    for (const std::uint32_t bidder : bidders_) {
      const std::uint32_t part = parts_.find(matching_.partners[bidder]);
      Extremes& found = extremes[part];
      const Arc* chosen = search.chosen(bidder);
      if (chosen == nullptr) {
        found.excess = std::numeric_limits<double>::infinity();
        continue;
      }
      double least = std::numeric_limits<double>::infinity();
      for (const Arc* arc = lists_.begin(bidder); arc != lists_.end(bidder); ++arc) {
        least = std::min(least, cost(*arc));
      }
      found.highest = std::max(found.highest, cost(*chosen));
      found.lowest = std::min(found.lowest, search.price(chosen->site));
      found.excess += cost(*chosen) - least;
    }
    std::vector<std::uint32_t> remaining;
    for (const std::uint32_t bidder : bidders_) {
      const std::uint32_t part = parts_.find(matching_.partners[bidder]);
      const Extremes& found = extremes[part];
      // An infinite excess may come with an infinite difference: the sum must not be NaN.
      if (found.excess >= free_cost_ ||
          found.highest - found.lowest + found.excess >= free_cost_ - kMargin) {
        remaining.push_back(bidder);
      }
    }
    bidders_.swap(remaining);
  }

  const NestedMatching& matching_;
  double free_cost_;
  std::size_t sites_;
  std::vector<double> lengths_;  ///< by squared length
  ArcLists lists_;
  DisjointParts parts_;  ///< of sites
  std::vector<std::uint32_t> bidders_;
};

}  // namespace

std::vector<std::uint32_t> findUnproven(const PixelGrid& grid, const IndexedCells& ground_truth,
                                        const NestedMatching& matching, double free_cost,
                                        const Deadline& deadline) {
  return GainProof(grid, ground_truth, matching, free_cost).run(grid.reach(), deadline);
}

}  // namespace evolin
