// Bidding for sites, searching where bidding gets stuck.
#include "price_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace evolin {

namespace {

constexpr std::int32_t kFar = std::numeric_limits<std::int32_t>::max();
constexpr std::uint64_t kNoOffer = std::numeric_limits<std::uint64_t>::max();

/// Pixels by which a bid exceeds the second best offer, auction by auction.
constexpr std::array<std::int32_t, 2> kAuctionSteps = {16, 4};
constexpr std::size_t kFewBidders = 400;     ///< searches for so few cost less than an auction
constexpr std::size_t kBidsPerBidder = 100;  ///< after which an auction is broken off
constexpr int kDisplacements = 30;           ///< in a row, after which a bidder waits
constexpr int kRounds = 2;                   ///< of bids without step
constexpr std::size_t kBidsPerCheck = 256;   ///< of the deadline

}  // namespace

PriceSearch::PriceSearch(ArcLists* arcs, std::size_t sites, int reach, double most,
                         const Deadline& deadline)
    : lists_(*arcs),
      deadline_(deadline),
      limit_(static_cast<Price>(most * kUnits)),
      queue_(limit_),
      prices_(sites, 0),
      sites_(sites, {kFar, kNone, kNone}),
      offers_(arcs->ranges.size()),
      chosen_(arcs->ranges.size(), nullptr) {
  const auto longest = static_cast<std::size_t>(reach);
  for (std::size_t squared = 0; squared <= longest * longest; ++squared) {
    weights_.push_back(
        static_cast<std::uint16_t>(std::lround(std::sqrt(static_cast<double>(squared)) * kUnits)));
  }
}

void PriceSearch::run(const std::vector<std::uint32_t>& bidders) {
  bidders_ = bidders;
  for (const std::uint32_t bidder : bidders_) {
    for (Arc* arc = lists_.begin(bidder); arc != lists_.end(bidder); ++arc) {
      arc->units = weights_[arc->squared];
    }
  }
  std::vector<std::uint32_t> waiting = bidders_;
  bidWithoutStep(&waiting);
  if (waiting.size() > kFewBidders) {
    for (const std::int32_t step : kAuctionSteps) {
      auction(step * kUnits, &waiting);
    }
    bidWithoutStep(&waiting);
  }
  for (const std::uint32_t bidder : waiting) {
    deadline_.check();
    search(bidder, limit_);
  }
  lowerPrices();
}

bool PriceSearch::replace(std::uint32_t bidder, std::vector<Arc> arcs) {
  deadline_.check();
  for (Arc& arc : arcs) {
    arc.units = weights_[arc.squared];
  }
  const ArcLists::Range old_range = lists_.ranges[bidder];
  const Arc* const old_choice = chosen_[bidder];
  lists_.ranges[bidder] = {arcs.data(), arcs.data() + arcs.size()};
  if (old_choice != nullptr) {
    sites_[old_choice->site].owner = kNone;
    chosen_[bidder] = nullptr;
  }
  const Price old_offer = old_choice == nullptr ? limit_ : offers_[bidder];
  search(bidder, std::min(limit_, old_offer - bestOffer(bidder).cost));
  if (chosen_[bidder] != nullptr) {
    lists_.others.push_back(std::move(arcs));
    return true;
  }
  lists_.ranges[bidder] = old_range;
  chosen_[bidder] = old_choice;
  if (old_choice != nullptr) {
    sites_[old_choice->site].owner = bidder;
    offers_[bidder] = old_offer;
  }
  return false;
}

/// The innermost loop: without branches, as which arc is the cheapest cannot be foreseen.
PriceSearch::Offer PriceSearch::bestOffer(std::uint32_t bidder) const {
  std::uint64_t best = kNoOffer;
  std::uint64_t second = kNoOffer;
  const Arc* const arcs = lists_.begin(bidder);
  const auto count = static_cast<std::uint32_t>(lists_.end(bidder) - arcs);
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
std::uint32_t PriceSearch::take(std::uint32_t bidder, const Arc* arc) {
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
void PriceSearch::bidWithoutStep(std::vector<std::uint32_t>* waiting) {
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

const Arc* PriceSearch::freeSiteAt(std::uint32_t bidder, Price cost) const {
  const Arc* found =
      std::find_if(lists_.begin(bidder), lists_.end(bidder), [this, cost](const Arc& arc) {
        return sites_[arc.site].owner == kNone && arc.units + prices_[arc.site] == cost;
      });
  return found == lists_.end(bidder) ? nullptr : found;
}

/// Bids above the second best offer by a step, which unties; then takes back what became too dear.
void PriceSearch::auction(Price step, std::vector<std::uint32_t>* waiting) {
  std::vector<std::uint32_t> queue = *waiting;
  const std::size_t most = kBidsPerBidder * bidders_.size();
  bool within_limit = true;
  for (std::size_t next = 0; next < queue.size() && next < most && within_limit; ++next) {
    if (next % kBidsPerCheck == 0) {
      deadline_.check();
    }
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
  *waiting = takeBackDearChoices();
}

/// Takes back every choice that is not the cheapest; all bidders without choice.
std::vector<std::uint32_t> PriceSearch::takeBackDearChoices() {
  std::vector<std::uint32_t> waiting;
  for (const std::uint32_t bidder : bidders_) {
    const Offer offer = bestOffer(bidder);
    offers_[bidder] = offer.cost;
    const Arc* arc = chosen_[bidder];
    if (arc != nullptr && arc->units + prices_[arc->site] > offer.cost) {
      sites_[arc->site].owner = kNone;
      chosen_[bidder] = nullptr;
    }
    if (chosen_[bidder] == nullptr) {
      waiting.push_back(bidder);
    }
  }
  return waiting;
}

/// Dijkstra's search from a bidder without site to the nearest site without owner, nearer than
/// `within`.
void PriceSearch::search(std::uint32_t start, Price within) {
  touched_.clear();
  settled_.clear();
  offers_[start] = bestOffer(start).cost;
  Price nearest = within;
  std::uint32_t goal = kNone;
  std::uint32_t bidder = start;
  Price distance = 0;
  while (true) {
    const Price base = distance - offers_[bidder];
    for (const Arc* arc = lists_.begin(bidder); arc != lists_.end(bidder); ++arc) {
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
std::uint32_t PriceSearch::nextSite(Price nearest, Price* distance) {
  while (queue_.advance(nearest, distance)) {
    const std::uint32_t site = queue_.pop(*distance);
    if (sites_[site].distance == *distance) {
      return site;
    }
  }
  return kNone;
}

void PriceSearch::finishSearch(std::uint32_t start, std::uint32_t goal, Price nearest) {
  if (goal != kNone && offers_[start] <= limit_) {
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

void PriceSearch::flipPath(std::uint32_t start, std::uint32_t goal) {
  std::uint32_t site = goal;
  std::uint32_t bidder = kNone;
  do {
    bidder = sites_[site].reached_from;
    const Arc* left = chosen_[bidder];
    chosen_[bidder] = std::find_if(lists_.begin(bidder), lists_.end(bidder),
                                   [site](const Arc& arc) { return arc.site == site; });
    sites_[site].owner = bidder;
    site = left == nullptr ? kNone : left->site;
  } while (bidder != start);
}

/// Gives all sites with owners the lowest prices, from 0, at which every choice remains the
/// cheapest: an auction overshoots. By a search in the slack of all arcs from all sites at once.
void PriceSearch::lowerPrices() {
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
    for (const Arc* arc = lists_.begin(bidder); arc != lists_.end(bidder); ++arc) {
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
    if (sites_[index].distance != kFar) {
      prices_[index] -= sites_[index].distance;
    }
    sites_[index].distance = kFar;
  }
  for (const std::uint32_t bidder : bidders_) {
    if (chosen_[bidder] != nullptr) {
      offers_[bidder] = chosen_[bidder]->units + prices_[chosen_[bidder]->site];
    }
  }
}

}  // namespace evolin
