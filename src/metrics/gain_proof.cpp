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
// They are sought in weights rounded to whole units, where many paths tie and searches are short;
// the rounding ends up in the s. The bound itself is computed from exact weights at the end, so
// nothing depends on how the prices were found: by the auction algorithm (Bertsekas 1988) and
// shortest augmenting paths (Jonker and Volgenant 1987).
#include "gain_proof.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "disjoint_parts.h"

namespace evolin {

namespace {

using Price = std::int32_t;

constexpr std::uint32_t kNone = 0xFFFFFFFF;
constexpr Price kFar = std::numeric_limits<Price>::max();
constexpr std::uint64_t kNoOffer = std::numeric_limits<std::uint64_t>::max();

constexpr Price kUnits = 16;  ///< a pixel; coarser ones tie more often but cost more of the bound
constexpr double kMostExpensive = 1e5;  ///< pixels; no camera's diagonal is as long
constexpr double kMargin = 0.01;        ///< far above all rounding of doubles, and above the 1e-6
/// Units by which a bid exceeds the second best offer, auction by auction.
constexpr std::array<Price, 2> kAuctionSteps = {256, 64};
constexpr std::size_t kFewBidders = 400;     ///< searches for so few cost less than an auction
constexpr std::size_t kBidsPerBidder = 100;  ///< after which an auction is broken off
constexpr int kDisplacements = 30;           ///< in a row, after which a bidder waits
constexpr std::size_t kUsualArcs = 32;       ///< memory to begin with, a bidder
constexpr int kRounds = 2;                   ///< of bids without step

struct Arc {
  std::uint32_t site;
  std::uint16_t units;    ///< rounded weight
  std::uint16_t squared;  ///< exact weight, squared
};

/// A ground-truth pixel, and what the current search knows of it.
struct Site {
  Price distance = kFar;
  std::uint32_t owner = kNone;
  std::uint32_t reached_from = kNone;
};

/// Sites by distance in buckets, for searches whose distances never fall (Dial 1969).
class BucketQueue {
 public:
  /// For distances below `end`.
  explicit BucketQueue(Price end)
      : heads_(static_cast<std::size_t>(end), kNone),
        occupied_(static_cast<std::size_t>(end) / kBits + 1) {}

  void push(Price distance, std::uint32_t site) {
    const auto bucket = static_cast<std::size_t>(distance);
    entries_.push_back({site, heads_[bucket], distance});
    heads_[bucket] = static_cast<std::uint32_t>(entries_.size() - 1);
    occupied_[bucket / kBits] |= std::uint64_t{1} << (bucket % kBits);
  }

  /// Moves `distance` up to the next bucket that holds a site; false when that is not below `end`.
  bool advance(Price end, Price* distance) const {
    if (*distance >= end) {
      return false;
    }
    const auto bucket = static_cast<std::size_t>(*distance);
    const std::size_t last_word = static_cast<std::size_t>(end - 1) / kBits;
    std::size_t word = bucket / kBits;
    std::uint64_t bits = occupied_[word] & (~std::uint64_t{0} << (bucket % kBits));
    while (bits == 0) {
      if (++word > last_word) {
        return false;
      }
      bits = occupied_[word];
    }
    *distance = static_cast<Price>(word * kBits) + __builtin_ctzll(bits);
    return *distance < end;
  }

  /// A site of a bucket that holds one.
  std::uint32_t pop(Price distance) {
    const auto bucket = static_cast<std::size_t>(distance);
    const Entry entry = entries_[heads_[bucket]];
    heads_[bucket] = entry.next;
    if (entry.next == kNone) {
      occupied_[bucket / kBits] &= ~(std::uint64_t{1} << (bucket % kBits));
    }
    return entry.site;
  }

  void clear() {
    for (const Entry& entry : entries_) {
      const auto bucket = static_cast<std::size_t>(entry.distance);
      heads_[bucket] = kNone;
      occupied_[bucket / kBits] = 0;
    }
    entries_.clear();
  }

 private:
  static constexpr std::size_t kBits = 64;

  struct Entry {
    std::uint32_t site;
    std::uint32_t next;
    Price distance;
  };

  std::vector<std::uint32_t> heads_;     ///< by distance: last entry pushed
  std::vector<std::uint64_t> occupied_;  ///< one bit a bucket
  std::vector<Entry> entries_;
};

class GainProof {
 public:
  GainProof(const PixelGrid& grid, const IndexedCells& ground_truth, const NestedMatching& matching,
            double free_cost)
      : matching_(matching),
        free_cost_(free_cost),
        limit_(static_cast<Price>(std::clamp(free_cost, 1.0, kMostExpensive) * kUnits) * 2),
        queue_(limit_),
        parts_(ground_truth.size()),
        prices_(ground_truth.size(), 0),
        sites_(ground_truth.size()),
        unproven_(ground_truth.size(), false) {
    listArcs(grid, ground_truth);
  }

  std::vector<std::uint32_t> run() {
    setAsideLightParts();
    if (!bidders_.empty()) {
      findPrices();
      lowerPrices();
      setAsideProvenParts();
    }
    std::vector<std::uint32_t> unproven;
    for (const std::uint32_t bidder : bidders_) {
      unproven.push_back(matching_.partners[bidder]);
    }
    return unproven;
  }

 private:
  struct Offer {
    const Arc* best;
    Price cost;
    Price second;
  };

  void listArcs(const PixelGrid& grid, const IndexedCells& ground_truth) {
    const auto reach = static_cast<std::size_t>(grid.reach());
    lengths_.resize(reach * reach + 1);
    std::vector<std::uint16_t> units(lengths_.size());
    for (std::size_t squared = 0; squared < lengths_.size(); ++squared) {
      lengths_[squared] = std::sqrt(static_cast<double>(squared));
      units[squared] = static_cast<std::uint16_t>(std::lround(lengths_[squared] * kUnits));
    }
    arcs_.reserve(matching_.predicted.size() * kUsualArcs);
    first_arcs_.reserve(matching_.predicted.size() + 1);
    first_arcs_.push_back(0);
    for (std::size_t bidder = 0; bidder < matching_.predicted.size(); ++bidder) {
      const std::uint32_t root = parts_.find(matching_.partners[bidder]);
      ground_truth.set().forEachNear(
          grid, matching_.predicted[bidder], [&](Cell cell, std::uint32_t squared) {
            const std::uint32_t site = ground_truth.index(cell);
            arcs_.push_back({site, units[squared], static_cast<std::uint16_t>(squared)});
            parts_.unite(root, site);
            return true;
          });
      first_arcs_.push_back(static_cast<std::uint32_t>(arcs_.size()));
    }
    offers_.resize(matching_.predicted.size());
    chosen_.resize(matching_.predicted.size(), nullptr);
  }

  const Arc* begin(std::uint32_t bidder) const { return arcs_.data() + first_arcs_[bidder]; }
  const Arc* end(std::uint32_t bidder) const { return arcs_.data() + first_arcs_[bidder + 1]; }

  /// Bidders are the predicted pixels of parts that still lack a proof; claim 1 above.
  void setAsideLightParts() {
    std::vector<double> weights(sites_.size(), 0);
    for (std::uint32_t bidder = 0; bidder < matching_.predicted.size(); ++bidder) {
      const std::uint32_t partner = matching_.partners[bidder];
      const Arc* arc = std::find_if(begin(bidder), end(bidder),
                                    [partner](const Arc& each) { return each.site == partner; });
      weights[parts_.find(partner)] += lengths_[arc->squared];
    }
    for (std::uint32_t bidder = 0; bidder < matching_.predicted.size(); ++bidder) {
      if (weights[parts_.find(matching_.partners[bidder])] >= free_cost_ - kMargin) {
        bidders_.push_back(bidder);
      }
    }
  }

  void findPrices() {
    std::vector<std::uint32_t> waiting = bidders_;
    bidWithoutStep(&waiting);
    if (waiting.size() > kFewBidders) {
      for (const Price step : kAuctionSteps) {
        auction(step, &waiting);
      }
      bidWithoutStep(&waiting);
    }
    for (const std::uint32_t bidder : waiting) {
      search(bidder);
    }
  }

  /// The innermost loop: without branches, as which arc is the cheapest cannot be foreseen.
  Offer bestOffer(std::uint32_t bidder) const {
    std::uint64_t best = kNoOffer;
    std::uint64_t second = kNoOffer;
    const Arc* const arcs = begin(bidder);
    const auto count = static_cast<std::uint32_t>(end(bidder) - arcs);
    for (std::uint32_t i = 0; i < count; ++i) {
      const auto cost = static_cast<std::uint64_t>(arcs[i].units + prices_[arcs[i].site]);
      const std::uint64_t offer = (cost << 32U) | i;
      second = std::min(second, std::max(best, offer));
      best = std::min(best, offer);
    }
    const auto cost = static_cast<Price>(best >> 32U);
    // With nowhere else to go no price is too high, and none is needed.
    return {arcs + static_cast<std::uint32_t>(best), cost,
            second == kNoOffer ? cost : static_cast<Price>(second >> 32U)};
  }

  /// Who had the site before, or kNone.
  std::uint32_t take(std::uint32_t bidder, const Arc* arc) {
    Site& site = sites_[arc->site];
    const std::uint32_t before = site.owner;
    if (before != kNone) {
      chosen_[before] = nullptr;
    }
    site.owner = bidder;
    chosen_[bidder] = arc;
    return before;
  }

  /// Everybody takes his cheapest site and raises its price to where the second cheapest is as
  /// good; who is driven out goes on. Keeps all s at 0, but gets stuck where offers tie.
  void bidWithoutStep(std::vector<std::uint32_t>* waiting) {
    std::vector<std::uint32_t> stuck;
    for (int round = 0; round < kRounds; ++round) {
      stuck.clear();
      for (std::uint32_t bidder : *waiting) {
        for (int times = 0; bidder != kNone; ++times) {
          Offer offer = bestOffer(bidder);
          if (offer.cost == offer.second && sites_[offer.best->site].owner != kNone) {
            offer.best = freeSiteAt(bidder, offer.cost);
          }
          if (offer.best == nullptr || offer.second > limit_ || times == kDisplacements) {
            stuck.push_back(bidder);
            break;
          }
          prices_[offer.best->site] += offer.second - offer.cost;
          offers_[bidder] = offer.second;
          bidder = take(bidder, offer.best);
        }
      }
      waiting->swap(stuck);
    }
  }

  const Arc* freeSiteAt(std::uint32_t bidder, Price cost) const {
    const Arc* found = std::find_if(begin(bidder), end(bidder), [this, cost](const Arc& arc) {
      return sites_[arc.site].owner == kNone && arc.units + prices_[arc.site] == cost;
    });
    return found == end(bidder) ? nullptr : found;
  }

  /// Bids above the second best offer by a step, which unties; then takes back every choice that is
  /// not the cheapest, and leaves these bidders in `waiting`.
  void auction(Price step, std::vector<std::uint32_t>* waiting) {
    std::vector<std::uint32_t> queue = *waiting;
    const std::size_t most = kBidsPerBidder * bidders_.size();
    bool within_limit = true;
    for (std::size_t next = 0; next < queue.size() && next < most && within_limit; ++next) {
      const std::uint32_t bidder = queue[next];
      const Offer offer = bestOffer(bidder);
      Price& price = prices_[offer.best->site];
      price += offer.second - offer.cost + step;
      within_limit = price < limit_;
      const std::uint32_t before = take(bidder, offer.best);
      if (before != kNone) {
        queue.push_back(before);
      }
    }
    waiting->clear();
    for (const std::uint32_t bidder : bidders_) {
      const Offer offer = bestOffer(bidder);
      offers_[bidder] = offer.cost;
      const Arc* arc = chosen_[bidder];
      if (arc != nullptr && arc->units + prices_[arc->site] > offer.cost) {
        sites_[arc->site].owner = kNone;
        chosen_[bidder] = nullptr;
      }
      if (chosen_[bidder] == nullptr) {
        waiting->push_back(bidder);
      }
    }
  }

  /// Dijkstra's search from a bidder without site to the nearest site without owner.
  void search(std::uint32_t start) {
    touched_.clear();
    settled_.clear();
    offers_[start] = bestOffer(start).cost;
    Price nearest = limit_;
    std::uint32_t goal = kNone;
    std::uint32_t bidder = start;
    Price distance = 0;
    while (true) {
      const Price base = distance - offers_[bidder];
      for (const Arc* arc = begin(bidder); arc != end(bidder); ++arc) {
        Site& site = sites_[arc->site];
        const Price there = base + arc->units + prices_[arc->site];
        if (there >= site.distance || there >= nearest) {
          continue;
        }
        if (site.distance == kFar) {
          touched_.push_back(arc->site);
        }
        site.distance = there;
        site.reached_from = bidder;
        if (site.owner == kNone) {
          nearest = there;
          goal = arc->site;
        } else {
          queue_.push(there, arc->site);
        }
      }
      const std::uint32_t next = nextSite(nearest, &distance);
      if (next == kNone) {
        break;
      }
      settled_.push_back(next);
      bidder = sites_[next].owner;
    }
    queue_.clear();
    finishSearch(start, goal, nearest);
  }

  /// kNone when nothing is left that is nearer than `nearest`.
  std::uint32_t nextSite(Price nearest, Price* distance) {
    while (queue_.advance(nearest, distance)) {
      const std::uint32_t site = queue_.pop(*distance);
      if (sites_[site].distance == *distance) {
        return site;
      }
    }
    return kNone;
  }

  void finishSearch(std::uint32_t start, std::uint32_t goal, Price nearest) {
    if (goal == kNone || offers_[start] > limit_) {
      unproven_[parts_.find(matching_.partners[start])] = true;
    } else {
      for (const std::uint32_t index : settled_) {
        const Site& site = sites_[index];
        if (site.distance < nearest) {
          prices_[index] += nearest - site.distance;
          offers_[site.owner] += nearest - site.distance;
        }
      }
      offers_[start] += nearest;
      flipPath(start, goal);
    }
    for (const std::uint32_t index : touched_) {
      sites_[index].distance = kFar;
    }
  }

  void flipPath(std::uint32_t start, std::uint32_t goal) {
    std::uint32_t site = goal;
    std::uint32_t bidder = kNone;
    do {
      bidder = sites_[site].reached_from;
      const Arc* left = chosen_[bidder];
      chosen_[bidder] = std::find_if(begin(bidder), end(bidder),
                                     [site](const Arc& arc) { return arc.site == site; });
      sites_[site].owner = bidder;
      site = left == nullptr ? kNone : left->site;
    } while (bidder != start);
  }

  /// Gives all sites with owners the lowest prices, from 0, at which every choice remains the
  /// cheapest: an auction overshoots. By a search in the slack of all arcs from all sites at once.
  void lowerPrices() {
    for (const std::uint32_t bidder : bidders_) {
      if (chosen_[bidder] != nullptr) {
        const std::uint32_t index = chosen_[bidder]->site;
        sites_[index].distance = std::min(prices_[index], limit_);
        if (prices_[index] < limit_) {
          queue_.push(prices_[index], index);
        }
      }
    }
    Price distance = 0;
    for (std::uint32_t next = nextSite(limit_, &distance); next != kNone;
         next = nextSite(limit_, &distance)) {
      const std::uint32_t bidder = sites_[next].owner;
      const Price base = distance - offers_[bidder];
      for (const Arc* arc = begin(bidder); arc != end(bidder); ++arc) {
        Site& site = sites_[arc->site];
        const Price there = base + arc->units + prices_[arc->site];
        if (site.owner != kNone && there < site.distance) {
          site.distance = there;
          queue_.push(there, arc->site);
        }
      }
    }
    queue_.clear();
    for (std::size_t index = 0; index < sites_.size(); ++index) {
      if (sites_[index].owner != kNone && sites_[index].distance < limit_) {
        prices_[index] -= sites_[index].distance;
      }
    }
  }

  /// Claim 2 above, in exact weights.
  void setAsideProvenParts() {
    struct Extremes {
      double highest = -std::numeric_limits<double>::infinity();
      double lowest = std::numeric_limits<double>::infinity();
      double excess = 0;
    };
    std::vector<Extremes> extremes(sites_.size());
    for (const std::uint32_t bidder : bidders_) {
      const std::uint32_t part = parts_.find(matching_.partners[bidder]);
      const Arc* chosen = chosen_[bidder];
      if (chosen == nullptr) {
        unproven_[part] = true;
        continue;
      }
      double least = std::numeric_limits<double>::infinity();
      for (const Arc* arc = begin(bidder); arc != end(bidder); ++arc) {
        least = std::min(least, cost(*arc));
      }
      Extremes& found = extremes[part];
      found.highest = std::max(found.highest, cost(*chosen));
      found.lowest = std::min(found.lowest, exactPrice(*chosen));
      found.excess += cost(*chosen) - least;
    }
    std::vector<std::uint32_t> remaining;
    for (const std::uint32_t bidder : bidders_) {
      const std::uint32_t part = parts_.find(matching_.partners[bidder]);
      const Extremes& found = extremes[part];
      if (unproven_[part] || found.highest - found.lowest + found.excess >= free_cost_ - kMargin) {
        remaining.push_back(bidder);
      }
    }
    bidders_.swap(remaining);
  }

  double exactPrice(const Arc& arc) const {
    return static_cast<double>(prices_[arc.site]) / kUnits;
  }
  double cost(const Arc& arc) const { return lengths_[arc.squared] + exactPrice(arc); }

  const NestedMatching& matching_;
  double free_cost_;
  Price limit_;  ///< beyond it no bound would hold
  BucketQueue queue_;
  std::vector<double> lengths_;  ///< by squared length
  std::vector<Arc> arcs_;        ///< of bidder b: from first_arcs_[b] to [b + 1]
  std::vector<std::uint32_t> first_arcs_;
  DisjointParts parts_;        ///< of sites
  std::vector<Price> prices_;  ///< of sites
  std::vector<Site> sites_;
  std::vector<std::uint32_t> bidders_;
  std::vector<Price> offers_;       ///< least cost of each bidder at current prices
  std::vector<const Arc*> chosen_;  ///< pair of each bidder, or nullptr
  std::vector<bool> unproven_;      ///< by the part's site

  std::vector<std::uint32_t> touched_;  ///< sites with a distance in the current search
  std::vector<std::uint32_t> settled_;
};

}  // namespace

std::vector<std::uint32_t> findUnproven(const PixelGrid& grid, const IndexedCells& ground_truth,
                                        const NestedMatching& matching, double free_cost) {
  return GainProof(grid, ground_truth, matching, free_cost).run();
}

}  // namespace evolin
