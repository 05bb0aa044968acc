// Most pairs first, then a proof that the cheapest matching has as many; where there is none, the
// cheapest matching itself.
//
// The count is unique: between two cheapest matchings with different counts, a path of pairs from
// one and pairs from the other in turn, one more of the first, would cost exactly `free_cost`. Its
// distances are square roots of whole numbers, so their signed sum is an algebraic integer, as is a
// diagonal; and the 1e-6 of the odd pair is not.
#include "evolin_ros/metrics/pixel_matching.h"

#include <cmath>
#include <cstdint>
#include <string>

#include "disjoint_parts.h"
#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"
#include "exact_matching.h"
#include "gain_proof.h"
#include "nested_matching.h"
#include "pixel_grid.h"

namespace evolin {

namespace {

constexpr double kReachOfDiagonal = 0.01;
constexpr int kMaxReach = 255;  ///< squared distances fit 16 bits

void requireSize(ImageSize size) {
  if (size.width <= 0 || size.height <= 0) {
    throw Error("an image of " + std::to_string(size.width) + " x " + std::to_string(size.height) +
                " pixels: expected a positive size");
  }
}

void requireRule(const PixelMatchingRule& rule) {
  if (rule.reach < 1 || rule.reach > kMaxReach) {
    throw Error("reach of pixel pairs " + std::to_string(rule.reach) + ": expected 1 to " +
                std::to_string(kMaxReach) + " pixels");
  }
  if (!(rule.free_cost > 0) || !std::isfinite(rule.free_cost)) {
    throw Error("cost of a free pixel " + formatDouble(rule.free_cost) +
                ": expected a positive, finite number of pixels");
  }
}

/// The pixels of `pixels` with ground truth within reach; the others never match.
std::vector<Cell> cellsNear(const PixelGrid& grid, const CellSet& truth, const Pixels& pixels,
                            const Deadline& deadline) {
  constexpr std::size_t kPixelsPerCheck = 4096;
  std::vector<Cell> cells;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (i % kPixelsPerCheck == 0) {
      deadline.check();
    }
    const Cell cell = grid.cell(pixels[i]);
    if (truth.anyNear(grid, cell)) {
      cells.push_back(cell);
    }
  }
  return cells;
}

/// Replaces the counts of the connected parts of the whole graph that hold `unproven` pixels.
std::vector<std::size_t> recount(const PixelGrid& grid, const IndexedCells& ground_truth,
                                 const std::vector<std::vector<Cell>>& added,
                                 const NestedMatching& matching,
                                 const std::vector<std::uint32_t>& unproven, double free_cost,
                                 const Deadline& deadline) {
  DisjointParts parts(ground_truth.size());
  std::vector<std::vector<std::uint32_t>> neighbours(added.size());  // one of each added pixel
  for (std::size_t level = 0; level < added.size(); ++level) {
    for (const Cell cell : added[level]) {
      std::uint32_t one = 0;
      bool first = true;
      ground_truth.forEachNear(grid, cell, [&](std::uint32_t near, std::uint32_t) {
        if (first) {
          one = near;
          first = false;
        } else {
          parts.unite(one, near);
        }
        return true;
      });
      neighbours[level].push_back(one);
    }
  }
  std::vector<bool> chosen(ground_truth.size(), false);
  for (const std::uint32_t index : unproven) {
    chosen[parts.find(index)] = true;
  }
  std::vector<std::vector<Cell>> added_there(added.size());
  for (std::size_t level = 0; level < added.size(); ++level) {
    for (std::size_t i = 0; i < added[level].size(); ++i) {
      if (chosen[parts.find(neighbours[level][i])]) {
        added_there[level].push_back(added[level][i]);
      }
    }
  }
  std::vector<std::size_t> counts =
      countCheapest(grid, ground_truth, added_there, free_cost, deadline);
  std::size_t elsewhere = 0;
  std::size_t next = 0;
  for (std::size_t level = 0; level < counts.size(); ++level) {
    for (; next < matching.sizes[level]; ++next) {
      elsewhere += chosen[parts.find(matching.partners[next])] ? 0 : 1;
    }
    counts[level] += elsewhere;
  }
  return counts;
}

}  // namespace

PixelMatchingRule pixelMatchingRule(ImageSize size) {
  requireSize(size);
  const double width = size.width;
  const double height = size.height;
  const double diagonal = std::sqrt(width * width + height * height);
  return {static_cast<int>(std::ceil(kReachOfDiagonal * diagonal)), diagonal};
}

std::vector<std::size_t> countMatchedPixels(ImageSize size, const PixelMatchingRule& rule,
                                            const Pixels& ground_truth,
                                            const std::vector<Pixels>& added,
                                            const Deadline& deadline) {
  requireSize(size);
  requireRule(rule);
  const PixelGrid grid(size, rule.reach);
  const IndexedCells truth(grid, ground_truth);
  std::vector<std::vector<Cell>> levels;
  levels.reserve(added.size());
  for (const Pixels& pixels : added) {
    levels.push_back(cellsNear(grid, truth.set(), pixels, deadline));
  }
  deadline.check();
  const NestedMatching matching = matchNested(grid, truth, levels, deadline);
  const std::vector<std::uint32_t> unproven =
      findUnproven(grid, truth, levels, matching, rule.free_cost, deadline);
  return unproven.empty()
             ? matching.sizes
             : recount(grid, truth, levels, matching, unproven, rule.free_cost, deadline);
}

}  // namespace evolin
