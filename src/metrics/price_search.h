// Prices of ground-truth pixels under which every predicted pixel of a set gets a partner that is,
// as nearly as whole units tell, its cheapest.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "bucket_queue.h"
#include "evolin_ros/base/deadline.h"

namespace evolin {

/// A weight in a search's units and a site (ground-truth pixel), for some bidder (predicted pixel)
/// that has it within reach: in one word, the weight above, so that a price in the same place is
/// added and the cheapest offer found (of equal ones that for the lowest site) by plain arithmetic
/// of words.
class Arc {
 public:
  Arc(std::uint32_t site, std::uint32_t units) : Arc((std::uint64_t{units} << kSiteBits) | site) {}
  explicit Arc(std::uint64_t word) : word_(word) {}

  static constexpr unsigned kSiteBits = 32;

  std::uint64_t word() const { return word_; }
  std::uint32_t site() const { return static_cast<std::uint32_t>(word_); }
  std::int32_t units() const { return static_cast<std::int32_t>(word_ >> kSiteBits); }

 private:
  std::uint64_t word_;
};

/// The arcs of all bidders.
struct ArcLists {
  struct Range {
    const Arc* first;
    const Arc* last;

    const Arc* begin() const { return first; }
    const Arc* end() const { return last; }
  };
  std::vector<Arc> arcs;                 ///< of the bidders there from the beginning
  std::vector<std::vector<Arc>> others;  ///< of those who came instead of one
  std::vector<Range> ranges;             ///< of each bidder
};

/// The auction algorithm (Bertsekas 1988), then shortest augmenting paths (Jonker and Volgenant
/// 1987), in weights rounded to whole units, where many paths tie and searches are short.
class PriceSearch {
 public:
  /// Takes note of `arcs`, which must outlive it. Prices above `most` pixels are not looked for.
  /// Throws DeadlineError from bid(), placeNext() and replace() when `deadline`, which must outlive
  /// it too, passes.
  PriceSearch(ArcLists* arcs, std::size_t sites, double most, const Deadline& deadline);

  /// The weight of an arc of so many pixels, up to 255.
  static std::uint32_t units(double pixels) {
    return static_cast<std::uint32_t>(pixels * kUnits + 0.5);
  }

  /// Lets `bidders`, who share no site with any others, bid. Who gets no site waits. Call it once
  /// for a bidder.
  void bid(const std::vector<std::uint32_t>& bidders);

  /// Whether any of the last bid()'s bidders waits.
  bool anyWaits() const { return !waiting_.empty(); }
  /// Finds a choice for one who waits. Returns the number of sites that it had to look from.
  std::size_t placeNext();

  void updateOffers();

  /// Gives the choices of `bidders`, who share no site with any others, the lowest prices, from 0,
  /// at which they remain the cheapest.
  void lowerPrices(const std::vector<std::uint32_t>& bidders);

  /// Puts the predicted pixel with `arcs` in the place of `bidder` if that
  /// makes all choices together cheaper. The choices remain the cheapest at their prices; to have
  /// the lowest such prices again, call lowerPrices().
  bool replace(std::uint32_t bidder, std::vector<Arc> arcs);

  /// A site that nobody else has chosen; kNone: there is none within the price limit.
  std::uint32_t chosen(std::uint32_t bidder) const {
    return chosen_[bidder] == kNoArc ? kNone : Arc(chosen_[bidder]).site();
  }
  /// In pixels.
  double price(std::uint32_t site) const { return static_cast<double>(priceOf(site)) / kUnits; }
  /// In pixels: what a bidder's cheapest site costs him, rounding apart; of one who waits, what it
  /// did cost at the last bid or updateOffers(), which is no more.
  double offer(std::uint32_t bidder) const { return static_cast<double>(offers_[bidder]) / kUnits; }

  /// Calls visit(site) for all sites that may be the cheapest for a bidder, rounding considered:
  /// two weights in units are wrong by up to one half each.
  template <typename Visit>
  void forEachCheapest(std::uint32_t bidder, const Visit& visit) const {
    const Price most = bestOffer(bidder).cost + 1;
    for (const Arc arc : lists_.ranges[bidder]) {
      if (cost(arc) <= most) {
        visit(arc.site());
      }
    }
  }

  static constexpr std::uint32_t kNone = 0xFFFFFFFF;
  static constexpr double kRounding = 0.5 / 32;  ///< of a weight, in pixels

 private:
  using Price = std::int32_t;  ///< in units
  using Word = std::uint64_t;  ///< a price in the place of an arc's weight

  static constexpr Price kUnits = 32;  ///< a pixel
  static_assert(kRounding * kUnits == 0.5, "weights are rounded to the nearest unit");
  static constexpr Word kNoArc = ~Word{0};

  /// A site, and what the current search knows of it.
  struct Site {
    Price distance;
    std::uint32_t owner;
    std::uint32_t reached_from;
  };
  struct Offer {
    Arc best;
    Price cost;
    Price second;
  };

  static Word toWord(Price price) {
    return static_cast<Word>(static_cast<std::int64_t>(price)) << Arc::kSiteBits;
  }
  static Price toPrice(Word word) { return static_cast<Price>(word >> Arc::kSiteBits); }

  Price priceOf(std::uint32_t site) const { return toPrice(prices_[site]); }
  Price cost(Arc arc) const { return toPrice(arc.word() + prices_[arc.site()]); }
  Offer bestOffer(std::uint32_t bidder) const;
  std::uint32_t take(std::uint32_t bidder, Arc arc);
  void bidWithoutStep();
  bool preferFreeSite(std::uint32_t bidder, Offer* offer) const;
  void auction(Price step);
  void takeBackDearChoices();
  void search(std::uint32_t start, Price within);
  std::uint32_t nextSite(Price nearest, Price* distance);
  void finishSearch(std::uint32_t start, std::uint32_t goal, Price nearest);
  void flipPath(std::uint32_t start, std::uint32_t goal);

  ArcLists& lists_;
  const Deadline& deadline_;
  Price limit_;
  BucketQueue queue_;
  std::vector<Word> prices_;  ///< of sites
  std::vector<Site> sites_;
  std::vector<std::uint32_t> bidders_;  ///< of the last bid()
  std::vector<std::uint32_t> waiting_;
  std::vector<Price> offers_;  ///< least cost of each bidder at current prices
  std::vector<Word> chosen_;   ///< arc of each bidder, or kNoArc

  std::vector<std::uint32_t> touched_;  ///< sites with a distance in the current search
  std::vector<std::uint32_t> settled_;
};

}  // namespace evolin
