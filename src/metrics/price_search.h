// Prices of ground-truth pixels under which every predicted pixel of a set gets a partner that is,
// as nearly as whole units tell, its cheapest.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "bucket_queue.h"
#include "evolin_ros/base/deadline.h"

namespace evolin {

/// A predicted pixel (bidder) and a ground-truth pixel (site) within reach.
struct Arc {
  std::uint32_t site;
  std::uint16_t units;    ///< weight in the search's units
  std::uint16_t squared;  ///< exact weight, squared
};

/// The arcs of all bidders.
struct ArcLists {
  struct Range {
    Arc* begin;
    Arc* end;
  };
  std::vector<Arc> arcs;                 ///< of the bidders there from the beginning
  std::vector<std::vector<Arc>> others;  ///< of those who came instead of one
  std::vector<Range> ranges;             ///< of each bidder

  Arc* begin(std::uint32_t bidder) const { return ranges[bidder].begin; }
  Arc* end(std::uint32_t bidder) const { return ranges[bidder].end; }
};

/// The auction algorithm (Bertsekas 1988), then shortest augmenting paths (Jonker and Volgenant
/// 1987), in weights rounded to whole units, where many paths tie and searches are short.
class PriceSearch {
 public:
  /// Takes note of `arcs`, which must outlive it, are up to `reach` pixels long (at most 255), and
  /// whose units it sets. Prices above `most` pixels are not looked for. Throws DeadlineError from
  /// run() and replace() when `deadline`, which must outlive it too, passes.
  PriceSearch(ArcLists* arcs, std::size_t sites, int reach, double most, const Deadline& deadline);

  /// Finds prices and choices for `bidders`, who share no site with any others. The prices of
  /// chosen sites are the lowest, from 0, at which the choices remain the cheapest. Call it once.
  void run(const std::vector<std::uint32_t>& bidders);

  /// Puts the predicted pixel with `arcs`, whose units it sets, in the place of `bidder` if that
  /// makes all choices together cheaper. The choices remain the cheapest at their prices; to have
  /// the lowest such prices again, call lowerPrices().
  bool replace(std::uint32_t bidder, std::vector<Arc> arcs);
  void lowerPrices();

  /// Nobody has another's choice; nullptr: none within the price limit.
  const Arc* chosen(std::uint32_t bidder) const { return chosen_[bidder]; }
  /// In pixels.
  double price(std::uint32_t site) const { return static_cast<double>(prices_[site]) / kUnits; }

 private:
  using Price = std::int32_t;

  static constexpr Price kUnits = 64;  ///< a pixel
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  /// A site, and what the current search knows of it.
  struct Site {
    Price distance;
    std::uint32_t owner;
    std::uint32_t reached_from;
  };
  struct Offer {
    const Arc* best;
    Price cost;
    Price second;
  };

  Offer bestOffer(std::uint32_t bidder) const;
  std::uint32_t take(std::uint32_t bidder, const Arc* arc);
  void bidWithoutStep(std::vector<std::uint32_t>* waiting);
  const Arc* freeSiteAt(std::uint32_t bidder, Price cost) const;
  void auction(Price step, std::vector<std::uint32_t>* waiting);
  std::vector<std::uint32_t> takeBackDearChoices();
  void search(std::uint32_t start, Price within);
  std::uint32_t nextSite(Price nearest, Price* distance);
  void finishSearch(std::uint32_t start, std::uint32_t goal, Price nearest);
  void flipPath(std::uint32_t start, std::uint32_t goal);

  ArcLists& lists_;
  const Deadline& deadline_;
  Price limit_;                         ///< in units, as all prices
  std::vector<std::uint16_t> weights_;  ///< by squared length
  BucketQueue queue_;
  std::vector<Price> prices_;  ///< of sites
  std::vector<Site> sites_;
  std::vector<std::uint32_t> bidders_;
  std::vector<Price> offers_;       ///< least cost of each bidder at current prices
  std::vector<const Arc*> chosen_;  ///< of each bidder, or nullptr

  std::vector<std::uint32_t> touched_;  ///< sites with a distance in the current search
  std::vector<std::uint32_t> settled_;
};

}  // namespace evolin
