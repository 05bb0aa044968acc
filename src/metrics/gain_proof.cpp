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
// Neither need be the best there is. The matching given may serve as N, and its s shrink as the
// search for prices goes on: it is broken off where they are small enough, mostly half-way.
//
// Where all that fails, the choice of predicted pixels may be at fault: of a level's pixels beyond
// what can be matched, the matching may have left out those that would be cheap. N remains a
// matching of most pairs at every level when such a pixel takes the place of a dear one of the same
// level and part, for as long as all can be matched at once. The bound is tried again after a
// handful of exchanges.
#include "gain_proof.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

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
    PriceSearch search(&lists_, sites_, std::clamp(free_cost_, 1.0, kMostExpensive) * kPriceLimit,
                       deadline);
    std::vector<Part> unproven;
    for (Part& part : heavyParts()) {
      if (!proveInPassing(part, &search) && !proveByCheapest(part, &search)) {
        unproven.push_back(std::move(part));
      }
    }
    if (!unproven.empty()) {
      listSpares(search, &unproven);
    }
    std::vector<std::uint32_t> sites;
    for (Part& part : unproven) {
      if (!proveByExchanges(&part, &search)) {
        for (const std::uint32_t bidder : part.bidders) {
          sites.push_back(matching_.partners[bidder]);
        }
      }
    }
    return sites;
  }

 private:
  /// A predicted pixel without partner that might take the place of a bidder.
  struct Spare {
    double cost;  ///< least w + c
    Cell cell;
  };

  /// A connected part of the graph.
  struct Part {
    std::vector<std::uint32_t> bidders;      ///< numbers of predicted pixels of the matching
    std::vector<std::vector<Spare>> spares;  ///< by level, dearest first
  };

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
      ground_truth_.forEachNear(grid_, matching_.predicted[bidder],
                                [&](std::uint32_t site, std::uint32_t squared) {
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

  /// None that would link two parts.
  void listSpares(const PriceSearch& search, std::vector<Part>* parts) {
    CellSet matched(grid_);
    for (const Cell cell : matching_.predicted) {
      matched.insert(cell);
    }
    std::vector<Part*> wanted(sites_, nullptr);
    for (Part& part : *parts) {
      wanted[parts_.find(matching_.partners[part.bidders.front()])] = &part;
      part.spares.resize(added_.size());
    }
    for (std::size_t level = 0; level < added_.size(); ++level) {
      for (const Cell cell : added_[level]) {
        if (matched.contains(cell)) {
          continue;
        }
        Part* part = nullptr;
        bool fits = true;
        double cost = std::numeric_limits<double>::infinity();
        ground_truth_.forEachNear(grid_, cell, [&](std::uint32_t site, std::uint32_t squared) {
          Part* const there = wanted[parts_.find(site)];
          fits = there != nullptr && (part == nullptr || part == there);
          part = there;
          cost = std::min(cost, lengths_[squared] + search.price(site));
          return fits;
        });
        if (fits) {
          part->spares[level].push_back({cost, cell});
        }
      }
      for (Part& part : *parts) {
        std::sort(part.spares[level].begin(), part.spares[level].end(),
                  [](const Spare& a, const Spare& b) { return a.cost > b.cost; });
      }
    }
  }

  bool proveByExchanges(Part* part, PriceSearch* search) {
    bool proven = false;
    for (int round = 0; round < kExchangeRounds && !proven && exchange(part, search); ++round) {
      proven = isProven(*part, *search,
                        [search](std::uint32_t bidder) { return search->chosen(bidder); });
    }
    return proven;
  }

  /// Puts cheap unmatched pixels in the place of dear bidders of the same level, and so makes N
  /// another matching of most pairs at every level. False when there are none.
  bool exchange(Part* part, PriceSearch* search) {
    struct Dear {
      double cost;
      std::uint32_t bidder;
    };
    std::vector<Dear> dear;
    for (const std::uint32_t bidder : part->bidders) {
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
      std::vector<Spare>& spares = part->spares[level];
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
    search->lowerPrices(part->bidders);
    return count > 0;
  }

  std::vector<Arc> arcsOf(Cell predicted) const {
    std::vector<Arc> arcs;
    ground_truth_.forEachNear(grid_, predicted, [&](std::uint32_t site, std::uint32_t squared) {
      arcs.emplace_back(site, units_[squared]);
      return true;
    });
    return arcs;
  }

  /// The parts that claim 1 above leaves.
  std::vector<Part> heavyParts() {
    std::vector<double> weights(sites_, 0);
    const auto bidders = static_cast<std::uint32_t>(matching_.predicted.size());
    for (std::uint32_t bidder = 0; bidder < bidders; ++bidder) {
      const std::uint32_t partner = matching_.partners[bidder];
      weights[parts_.find(partner)] += length(bidder, partner);
    }
    std::vector<Part> heavy;
    std::vector<std::uint32_t> numbers(sites_, kNone);
    for (std::uint32_t bidder = 0; bidder < bidders; ++bidder) {
      const std::uint32_t part = parts_.find(matching_.partners[bidder]);
      if (weights[part] < free_cost_ - kMargin) {
        continue;
      }
      if (numbers[part] == kNone) {
        numbers[part] = static_cast<std::uint32_t>(heavy.size());
        heavy.emplace_back();
      }
      heavy[numbers[part]].bidders.push_back(bidder);
    }
    return heavy;
  }

  /// With the matching as it was given, and prices only as good as it takes.
  bool proveInPassing(const Part& part, PriceSearch* search) const {
    search->bid(part.bidders);
    bool worth_it = seemsProven(part, *search);
    // A look costs about as much as the searches between two of them.
    for (std::size_t steps = 0; !worth_it && search->anyWaits();) {
      steps += search->placeNext();
      if (steps >= part.bidders.size()) {
        steps = 0;
        search->updateOffers();
        worth_it = seemsProven(part, *search);
      }
    }
    return worth_it && isProven(part, *search, [this](std::uint32_t bidder) {
             return matching_.partners[bidder];
           });
  }

  /// With the cheapest matching of the predicted pixels. After proveInPassing().
  bool proveByCheapest(const Part& part, PriceSearch* search) const {
    while (search->anyWaits()) {
      search->placeNext();
    }
    search->lowerPrices(part.bidders);
    return isProven(part, *search,
                    [search](std::uint32_t bidder) { return search->chosen(bidder); });
  }

  /// What claim 2 above needs.
  struct Bound {
    double highest = -std::numeric_limits<double>::infinity();
    double lowest = std::numeric_limits<double>::infinity();
    double excess = 0;

    /// A pair of the matching, and the least that any pair of its predicted pixel costs.
    void add(double length, double price, double least) {
      highest = std::max(highest, length + price);
      lowest = std::min(lowest, price);
      excess += length + price - least;
    }
    double gain() const { return highest - lowest + excess; }
  };

  /// Claim 2 above for the matching as it was given, by what the search knows of the least costs.
  bool seemsProven(const Part& part, const PriceSearch& search) const {
    Bound bound;
    for (const std::uint32_t bidder : part.bidders) {
      const std::uint32_t site = matching_.partners[bidder];
      bound.add(length(bidder, site), search.price(site),
                search.offer(bidder) - PriceSearch::kRounding);
    }
    return bound.gain() < free_cost_ - kMargin;
  }

  /// Claim 2 above, in exact weights; partnerOf(bidder) is that of the matching, kNone: it has
  /// none.
  template <typename PartnerOf>
  bool isProven(const Part& part, const PriceSearch& search, const PartnerOf& partnerOf) const {
    Bound bound;
    for (const std::uint32_t bidder : part.bidders) {
      const std::uint32_t partner = partnerOf(bidder);
      if (partner == kNone) {
        return false;
      }
      double least = std::numeric_limits<double>::infinity();
      search.forEachCheapest(bidder, [&](std::uint32_t site) {
        least = std::min(least, length(bidder, site) + search.price(site));
      });
      bound.add(length(bidder, partner), search.price(partner), least);
    }
    return bound.gain() < free_cost_ - kMargin;
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
};

}  // namespace

std::vector<std::uint32_t> findUnproven(const PixelGrid& grid, const IndexedCells& ground_truth,
                                        const std::vector<std::vector<Cell>>& added,
                                        const NestedMatching& matching, double free_cost,
                                        const Deadline& deadline) {
  return GainProof(grid, ground_truth, added, matching, free_cost, deadline).run(deadline);
}

}  // namespace evolin
