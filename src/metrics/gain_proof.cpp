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
// They are sought in weights rounded to whole units, and the rounding ends up in the s. The bound
// itself is computed from exact weights, so nothing depends on how the prices were found.
//
// Where it fails, the choice of predicted pixels may be at fault: of a level's pixels beyond what
// can be matched, the matching may have left out those that would be cheap. N remains a matching of
// most pairs at every level when such a pixel takes the place of a dear one of the same level, for
// as long as all can be matched at once. The bound is tried again after a handful of exchanges.
#include "gain_proof.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "disjoint_parts.h"
#include "price_search.h"

namespace evolin {

namespace {

constexpr double kMostExpensive = 25500;  ///< pixels: no image has as long a diagonal
constexpr double kPriceLimit = 4;         ///< in free costs; auctions overshoot
constexpr double kMargin = 0.01;          ///< far above all rounding of doubles, and above the 1e-6
constexpr int kExchangeRounds = 8;
constexpr std::size_t kExchanges = 8;   ///< a round
constexpr double kLeastSaving = 0.125;  ///< in free costs, to try an exchange
constexpr std::uint32_t kNone = PriceSearch::kNone;
constexpr std::size_t kBiddersPerCheck = 64;  ///< of the deadline
constexpr std::size_t kUsualArcs = 32;        ///< memory to begin with, a bidder

class GainProof {
 public:
  GainProof(const PixelGrid& grid, const IndexedCells& ground_truth,
            const std::vector<std::vector<Cell>>& added, const NestedMatching& matching,
            double free_cost, const Deadline& deadline)
      : grid_(grid),
        ground_truth_(ground_truth),
        added_(added),
        matching_(matching),
        free_cost_(free_cost),
        sites_(ground_truth.size()),
        bidder_cells_(matching.predicted),
        parts_(ground_truth.size()) {
    listArcs(deadline);
  }

  std::vector<std::uint32_t> run(const Deadline& deadline) {
    setAsideLightParts();
    PriceSearch search(&lists_, sites_, std::clamp(free_cost_, 1.0, kMostExpensive) * kPriceLimit,
                       deadline);
    if (!bidders_.empty()) {
      search.run(bidders_);
      setAsideProvenParts(search);
    }
    for (int round = 0; round < kExchangeRounds && exchange(&search); ++round) {
      setAsideProvenParts(search);
    }
    std::vector<std::uint32_t> unproven;
    for (const std::uint32_t bidder : bidders_) {
      unproven.push_back(matching_.partners[bidder]);
    }
    return unproven;
  }

 private:
  void listArcs(const Deadline& deadline) {
    const auto reach = static_cast<std::size_t>(grid_.reach());
    lengths_.resize(reach * reach + 1);
    units_.resize(lengths_.size());
    for (std::size_t squared = 0; squared < lengths_.size(); ++squared) {
      lengths_[squared] = std::sqrt(static_cast<double>(squared));
      units_[squared] = PriceSearch::units(lengths_[squared]);
    }
    const std::size_t bidders = matching_.predicted.size();
    lists_.arcs.reserve(bidders * kUsualArcs);
    std::vector<std::size_t> ends(bidders);
    for (std::size_t bidder = 0; bidder < bidders; ++bidder) {
      if (bidder % kBiddersPerCheck == 0) {
        deadline.check();
      }
      std::uint32_t root = parts_.find(matching_.partners[bidder]);
      ground_truth_.set().forEachNear(grid_, matching_.predicted[bidder],
                                      [&](Cell cell, std::uint32_t squared) {
                                        const std::uint32_t site = ground_truth_.index(cell);
                                        lists_.arcs.emplace_back(site, units_[squared]);
                                        root = parts_.unite(root, site);
                                        return true;
                                      });
      ends[bidder] = lists_.arcs.size();
    }
    const Arc* begin = lists_.arcs.data();
    for (const std::size_t end : ends) {
      lists_.ranges.push_back({begin, lists_.arcs.data() + end});
      begin = lists_.arcs.data() + end;
    }
  }

  /// Exact, in pixels.
  double length(std::uint32_t bidder, std::uint32_t site) const {
    return lengths_[grid_.squaredDistance(bidder_cells_[bidder], ground_truth_.cells()[site])];
  }

  /// A predicted pixel without partner that might take the place of a bidder.
  struct Spare {
    double cost;  ///< least w + c
    Cell cell;
  };

  /// By level: the unmatched pixels of parts without proof, dearest first. None that would link
  /// two parts.
  std::vector<std::vector<Spare>> listSpares(const PriceSearch& search) {
    CellSet matched(grid_);
    for (const Cell cell : matching_.predicted) {
      matched.insert(cell);
    }
    std::vector<bool> wanted(sites_);
    for (const std::uint32_t bidder : bidders_) {
      wanted[parts_.find(matching_.partners[bidder])] = true;
    }
    std::vector<std::vector<Spare>> spares(added_.size());
    for (std::size_t level = 0; level < added_.size(); ++level) {
      for (const Cell cell : added_[level]) {
        if (matched.contains(cell)) {
          continue;
        }
        std::uint32_t part = kNone;
        bool fits = true;
        double cost = std::numeric_limits<double>::infinity();
        ground_truth_.set().forEachNear(grid_, cell, [&](Cell near, std::uint32_t squared) {
          const std::uint32_t site = ground_truth_.index(near);
          const std::uint32_t root = parts_.find(site);
          fits = wanted[root] && (part == kNone || part == root);
          part = root;
          cost = std::min(cost, lengths_[squared] + search.price(site));
          return fits;
        });
        if (fits) {
          spares[level].push_back({cost, cell});
        }
      }
      std::sort(spares[level].begin(), spares[level].end(),
                [](const Spare& a, const Spare& b) { return a.cost > b.cost; });
    }
    return spares;
  }

  /// Puts cheap unmatched pixels in the place of dear bidders of the same level, and so makes N
  /// another matching of most pairs at every level. False when there are none.
  bool exchange(PriceSearch* search) {
    if (bidders_.empty()) {
      return false;
    }
    if (spares_.empty()) {
      spares_ = listSpares(*search);
    }
    struct Dear {
      double cost;
      std::uint32_t bidder;
    };
    std::vector<Dear> dear;
    for (const std::uint32_t bidder : bidders_) {
      const std::uint32_t chosen = search->chosen(bidder);
      dear.push_back({chosen == kNone ? std::numeric_limits<double>::infinity()
                                      : length(bidder, chosen) + search->price(chosen),
                      bidder});
    }
    std::sort(dear.begin(), dear.end(),
              [](const Dear& a, const Dear& b) { return a.cost > b.cost; });
    std::size_t count = 0;
    for (const Dear& each : dear) {
      const auto level = static_cast<std::size_t>(
          std::upper_bound(matching_.sizes.begin(), matching_.sizes.end(), each.bidder) -
          matching_.sizes.begin());
      std::vector<Spare>& spares = spares_[level];
      if (spares.empty() || spares.back().cost > each.cost - kLeastSaving * free_cost_) {
        continue;
      }
      const Cell cell = spares.back().cell;
      spares.pop_back();
      if (search->replace(each.bidder, arcsOf(cell))) {
        bidder_cells_[each.bidder] = cell;
        if (++count == kExchanges) {
          break;
        }
      }
    }
    search->lowerPrices();
    return count > 0;
  }

  std::vector<Arc> arcsOf(Cell predicted) const {
    std::vector<Arc> arcs;
    ground_truth_.set().forEachNear(grid_, predicted, [&](Cell cell, std::uint32_t squared) {
      arcs.emplace_back(ground_truth_.index(cell), units_[squared]);
      return true;
    });
    return arcs;
  }

  /// Bidders are the predicted pixels of parts that still lack a proof; claim 1 above.
  void setAsideLightParts() {
    std::vector<double> weights(sites_, 0);
    for (std::uint32_t bidder = 0; bidder < matching_.predicted.size(); ++bidder) {
      const std::uint32_t partner = matching_.partners[bidder];
      weights[parts_.find(partner)] += length(bidder, partner);
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
    for (const std::uint32_t bidder : bidders_) {
      const std::uint32_t part = parts_.find(matching_.partners[bidder]);
      Extremes& found = extremes[part];
      const std::uint32_t chosen = search.chosen(bidder);
      if (chosen == kNone) {
        found.excess = std::numeric_limits<double>::infinity();
        continue;
      }
      const double price = search.price(chosen);
      const double cost = length(bidder, chosen) + price;
      double least = cost;
      search.forEachCheaper(bidder, [&](std::uint32_t site) {
        least = std::min(least, length(bidder, site) + search.price(site));
      });
      found.highest = std::max(found.highest, cost);
      found.lowest = std::min(found.lowest, price);
      found.excess += cost - least;
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

  const PixelGrid& grid_;
  const IndexedCells& ground_truth_;
  const std::vector<std::vector<Cell>>& added_;
  const NestedMatching& matching_;
  double free_cost_;
  std::size_t sites_;
  std::vector<double> lengths_;       ///< by squared length
  std::vector<std::uint32_t> units_;  ///< by squared length
  std::vector<Cell> bidder_cells_;
  ArcLists lists_;
  DisjointParts parts_;  ///< of sites
  std::vector<std::uint32_t> bidders_;
  std::vector<std::vector<Spare>> spares_;  ///< by level
};

}  // namespace

std::vector<std::uint32_t> findUnproven(const PixelGrid& grid, const IndexedCells& ground_truth,
                                        const std::vector<std::vector<Cell>>& added,
                                        const NestedMatching& matching, double free_cost,
                                        const Deadline& deadline) {
  return GainProof(grid, ground_truth, added, matching, free_cost, deadline).run(deadline);
}

}  // namespace evolin
