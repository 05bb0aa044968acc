// Bidding for sites, searching where bidding gets stuck.
#include "price_search.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace evolin {

namespace {

constexpr std::int32_t kFar = std::numeric_limits<std::int32_t>::max();

/// Pixels by which a bid exceeds the second best offer, auction by auction.
constexpr std::array<std::int32_t, 3> kAuctionSteps = {16, 4, 1};
constexpr std::size_t kFewBidders = 400;     ///< searches for so few cost less than an auction
constexpr std::size_t kBidsPerBidder = 100;  ///< after which an auction is broken off
constexpr std::size_t kBidsPerCheck = 256;   ///< of the deadline
constexpr int kDisplacements = 30;           ///< in a row, after which a bidder waits
constexpr int kRounds = 2;                   ///< of bids without step

}  // namespace

PriceSearch::PriceSearch(ArcLists* arcs, std::size_t sites, double most, const Deadline& deadline)
    : lists_(*arcs),
      deadline_(deadline),
      limit_(static_cast<Price>(most * kUnits)),
      prices_(sites, 0),
      sites_(sites, {kFar, kNone, kNone}),
      offers_(arcs->ranges.size()),
      chosen_(arcs->ranges.size(), kNoArc) {}

void PriceSearch::bid(const std::vector<std::uint32_t>& bidders) {
  bidders_ = bidders;
  waiting_ = bidders;
  bidWithoutStep();
  if (waiting_.size() > kFewBidders) {
    for (const std::int32_t step : kAuctionSteps) {
      auction(step * kUnits);
    }
    bidWithoutStep();
  }
  std::reverse(waiting_.begin(), waiting_.end());
}

std::size_t PriceSearch::placeNext() {
  deadline_.check();
  const std::uint32_t bidder = waiting_.back();
  waiting_.pop_back();
  search(bidder, limit_);
  return settled_.size();
}

void PriceSearch::updateOffers() {
  for (const std::uint32_t bidder : waiting_) {
    offers_[bidder] = bestOffer(bidder).cost;
  }
}

bool PriceSearch::replace(std::uint32_t bidder, std::vector<Arc> arcs) {
  deadline_.check();
  const ArcLists::Range old_range = lists_.ranges[bidder];
  const Word old_choice = chosen_[bidder];
  const Price old_offer = old_choice == kNoArc ? limit_ : offers_[bidder];
  lists_.ranges[bidder] = {arcs.data(), arcs.data() + arcs.size()};
  if (old_choice != kNoArc) {
    sites_[Arc(old_choice).site()].owner = kNone;
    chosen_[bidder] = kNoArc;
  }
  search(bidder, std::min(limit_, old_offer - bestOffer(bidder).cost));
  if (chosen_[bidder] != kNoArc) {
    lists_.others.push_back(std::move(arcs));
    return true;
  }
  lists_.ranges[bidder] = old_range;
  chosen_[bidder] = old_choice;
  if (old_choice != kNoArc) {
    sites_[Arc(old_choice).site()].owner = bidder;
    offers_[bidder] = old_offer;
  }
  return false;
}

/// The innermost loop: without branches, as which arc is the cheapest cannot be foreseen.
PriceSearch::Offer PriceSearch::bestOffer(std::uint32_t bidder) const {
  Word best = kNoArc;
  Word second = kNoArc;
  const Word* const prices = prices_.data();
  for (const Arc arc : lists_.ranges[bidder]) {
    const Word offer = arc.word() + prices[arc.site()];
    second = std::min(second, std::max(best, offer));
    best = std::min(best, offer);
  }
  // With nowhere else to go no price is too high, and none is needed.
  return {Arc(best - prices[Arc(best).site()]), toPrice(best),
          toPrice(second == kNoArc ? best : second)};
}

/// Who had the site before, or kNone.
std::uint32_t PriceSearch::take(std::uint32_t bidder, Arc arc) {
  std::uint32_t& owner = sites_[arc.site()].owner;
  const std::uint32_t before = owner;
  if (before != kNone) {
    chosen_[before] = kNoArc;
  }
  owner = bidder;
  chosen_[bidder] = arc.word();
  return before;
}

/// Everybody takes his cheapest site and raises its price to where the second cheapest is as
/// good; who is driven out goes on. Keeps all s at 0, but gets stuck where offers tie.
void PriceSearch::bidWithoutStep() {
  std::vector<std::uint32_t> stuck;
  for (int round = 0; round < kRounds; ++round) {
    stuck.clear();
    for (std::uint32_t bidder : waiting_) {
      for (int times = 0; bidder != kNone; ++times) {
        Offer offer = bestOffer(bidder);
        const bool tied = offer.cost == offer.second && sites_[offer.best.site()].owner != kNone;
        if ((tied && !preferFreeSite(bidder, &offer)) || offer.second > limit_ ||
            times == kDisplacements) {
          offers_[bidder] = offer.cost;
          stuck.push_back(bidder);
          break;
        }
        prices_[offer.best.site()] += toWord(offer.second - offer.cost);
        offers_[bidder] = offer.second;
        bidder = take(bidder, offer.best);
      }
    }
    waiting_.swap(stuck);
  }
}

/// Changes the best of tied offers to one for a free site; false if there is none.
bool PriceSearch::preferFreeSite(std::uint32_t bidder, Offer* offer) const {
  const auto& arcs = lists_.ranges[bidder];
  const auto free_one = std::find_if(arcs.begin(), arcs.end(), [&](Arc arc) {
    return cost(arc) == offer->cost && sites_[arc.site()].owner == kNone;
  });
  if (free_one == arcs.end()) {
    return false;
  }
  offer->best = *free_one;
  return true;
}

/// Bids above the second best offer by a step, which unties; then takes back what became too dear.
/// Who is driven out bids at once: he looks at much the same sites, which are at hand.
void PriceSearch::auction(Price step) {
  std::size_t bids = 0;
  const std::size_t most = kBidsPerBidder * bidders_.size();
  bool goes_on = true;
  for (std::size_t next = 0; next < waiting_.size() && goes_on; ++next) {
    for (std::uint32_t bidder = waiting_[next]; bidder != kNone && goes_on; ++bids) {
      if (bids % kBidsPerCheck == 0) {
        deadline_.check();
      }
      const Offer offer = bestOffer(bidder);
      Word& price = prices_[offer.best.site()];
      price += toWord(offer.second - offer.cost + step);
      goes_on = toPrice(price) < limit_ && bids < most;
      bidder = take(bidder, offer.best);
    }
  }
  takeBackDearChoices();
}

/// Takes back every choice that is not the cheapest; all bidders without choice wait.
void PriceSearch::takeBackDearChoices() {
  waiting_.clear();
  for (const std::uint32_t bidder : bidders_) {
    offers_[bidder] = bestOffer(bidder).cost;
    const Word chosen = chosen_[bidder];
    if (chosen != kNoArc && cost(Arc(chosen)) > offers_[bidder]) {
      sites_[Arc(chosen).site()].owner = kNone;
      chosen_[bidder] = kNoArc;
    }
    if (chosen_[bidder] == kNoArc) {
      waiting_.push_back(bidder);
    }
  }
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
    const Word base = toWord(distance - offers_[bidder]);
    for (const Arc arc : lists_.ranges[bidder]) {
      const std::uint32_t index = arc.site();
      const Price there = toPrice(base + arc.word() + prices_[index]);
      if (there >= nearest || there >= sites_[index].distance) {
        continue;
      }
      Site& site = sites_[index];
      if (site.distance == kFar) {
        touched_.push_back(index);
      }
      site.distance = there;
      site.reached_from = bidder;
      if (site.owner == kNone) {
        nearest = there;
        goal = index;
      } else {
        queue_.push(there, index);
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
        prices_[index] += toWord(nearest - site.distance);
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
    const Word left = chosen_[bidder];
    const ArcLists::Range range = lists_.ranges[bidder];
    chosen_[bidder] = std::find_if(range.begin(), range.end(), [site](Arc arc) {
                        return arc.site() == site;
                      })->word();
    sites_[site].owner = bidder;
    site = left == kNoArc ? kNone : Arc(left).site();
  } while (bidder != start);
}

/// An auction overshoots. By a search in the slack of all arcs from all sites at once.
void PriceSearch::lowerPrices(const std::vector<std::uint32_t>& bidders) {
  for (const std::uint32_t bidder : bidders) {
    if (chosen_[bidder] != kNoArc) {
      const std::uint32_t index = Arc(chosen_[bidder]).site();
      sites_[index].distance = std::min(priceOf(index), limit_);
      if (priceOf(index) < limit_) {
        queue_.push(priceOf(index), index);
      }
    }
  }
  Price distance = 0;
  for (std::uint32_t next = nextSite(limit_, &distance); next != kNone;
       next = nextSite(limit_, &distance)) {
    const std::uint32_t bidder = sites_[next].owner;
    const Word base = toWord(distance - offers_[bidder]);
    for (const Arc arc : lists_.ranges[bidder]) {
      Site& site = sites_[arc.site()];
      const Price there = toPrice(base + arc.word() + prices_[arc.site()]);
      if (there < site.distance && site.owner != kNone) {
        site.distance = there;
        queue_.push(there, arc.site());
      }
    }
  }
  queue_.clear();
  for (const std::uint32_t bidder : bidders) {
    if (chosen_[bidder] != kNoArc) {
      Site& site = sites_[Arc(chosen_[bidder]).site()];
      prices_[Arc(chosen_[bidder]).site()] -= toWord(site.distance);
      site.distance = kFar;
    }
  }
  for (const std::uint32_t bidder : bidders) {
    if (chosen_[bidder] != kNoArc) {
      offers_[bidder] = cost(Arc(chosen_[bidder]));
    }
  }
}

}  // namespace evolin
