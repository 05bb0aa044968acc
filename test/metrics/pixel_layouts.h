// Sets of pixels on which matchings are hard: chains, combs, ladders, clouds.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "evolin_ros/metrics/pixel_matching.h"
#include "test/support/random_lines.h"

namespace evolin::test {

/// A matching problem: `added` by level, as countMatchedPixels takes it.
struct PixelLayout {
  ImageSize size;
  PixelMatchingRule rule;
  Pixels ground_truth;
  std::vector<Pixels> added;
};

inline std::vector<std::size_t> countMatched(const PixelLayout& layout) {
  return countMatchedPixels(layout.size, layout.rule, layout.ground_truth, layout.added);
}

/// `count` places along a snake: `step` apart to the right, then `turns` steps down, to the left,
/// and so on. Places that are not neighbours on the snake are out of reach of each other.
inline Pixels snake(ImageSize size, int step, int turns, std::size_t count) {
  Pixels places;
  Pixel place;
  int direction = 1;
  while (places.size() < count) {
    places.push_back(place);
    const int next = place.x + direction * step;
    if (next >= 0 && next < size.width) {
      place.x = next;
      continue;
    }
    direction = -direction;
    for (int turn = 1; turn < turns && places.size() < count; ++turn) {
      place.y += step;
      places.push_back(place);
    }
    place.y += step;
  }
  return places;
}

/// `links` + 1 ground-truth pixels a reach apart, of which all but the first have a predicted pixel
/// on top, and at level 1 one more predicted pixel beyond the last. To match all, every pair must
/// shift by one reach, `links` + 1 times in all.
inline PixelLayout shiftedChain(ImageSize size, const PixelMatchingRule& rule, std::size_t links) {
  const Pixels places = snake(size, rule.reach, 3, links + 2);
  PixelLayout layout{size, rule, {places.begin(), places.end() - 1}, {}};
  layout.added = {{places.begin() + 1, places.end() - 1}, {places.back()}};
  return layout;
}

/// Chains with `links` links each that hang off one long spine of pairs on top of each other; the
/// predicted pixels beyond the teeth's tips come level by level.
inline PixelLayout comb(ImageSize size, const PixelMatchingRule& rule, int teeth, int links) {
  PixelLayout layout{size, rule, {}, {{}}};
  for (int tooth = 0; tooth < teeth; ++tooth) {
    const int x = 2 * tooth * rule.reach;
    for (const int spine : {x, x + rule.reach}) {
      layout.ground_truth.push_back({spine, 0});
      if (spine > 0) {
        layout.added[0].push_back({spine, 0});
      }
    }
    for (int link = 1; link <= links; ++link) {
      layout.ground_truth.push_back({x, link * rule.reach});
      layout.added[0].push_back({x, link * rule.reach});
    }
    layout.added.push_back({{x, (links + 1) * rule.reach}});
  }
  return layout;
}

/// Two parallel rows of ground truth; the predictions follow them at a slope, so that they drift
/// out of reach of one row and into the other's.
inline PixelLayout ladder(ImageSize size, const PixelMatchingRule& rule, int rungs) {
  PixelLayout layout{size, rule, {}, {{}, {}}};
  for (int x = 0; x < size.width; ++x) {
    layout.ground_truth.push_back({x, 0});
    layout.ground_truth.push_back({x, 2 * rule.reach});
    layout.added[0].push_back({x, x * 2 * rule.reach / size.width});
    if (x % (size.width / rungs) == 0) {
      for (int y = 1; y < 2 * rule.reach; ++y) {
        if (y != layout.added[0].back().y) {
          layout.added[1].push_back({x, y});
        }
      }
    }
  }
  return layout;
}

/// Each pixel of a small image is ground truth, and predicted at one of the levels, at random.
inline PixelLayout cloud(RandomLines* random, ImageSize size, int reach, double free_cost,
                         double truth_share, double predicted_share, std::size_t levels) {
  PixelLayout layout{size, {reach, free_cost}, {}, std::vector<Pixels>(levels)};
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      if (random->uniform(0, 1) < truth_share) {
        layout.ground_truth.push_back({x, y});
      }
      if (random->uniform(0, 1) < predicted_share) {
        layout.added[random->index(levels)].push_back({x, y});
      }
    }
  }
  return layout;
}

/// Random walks of ground truth, and the same pixels moved along by about a reach: many long
/// augmenting paths of very different costs.
inline PixelLayout driftingWalks(RandomLines* random, ImageSize size, int reach, double free_cost,
                                 int walks, int length) {
  PixelLayout layout{size, {reach, free_cost}, {}, std::vector<Pixels>(2)};
  std::vector<bool> true_there(static_cast<std::size_t>(size.width) * size.height);
  std::vector<bool> predicted_there(true_there.size());
  const auto put = [&size](Pixel pixel, std::vector<bool>* there, Pixels* pixels) {
    pixel.x = std::clamp(pixel.x, 0, size.width - 1);
    pixel.y = std::clamp(pixel.y, 0, size.height - 1);
    const std::size_t index = static_cast<std::size_t>(pixel.y) * size.width + pixel.x;
    if (!(*there)[index]) {
      (*there)[index] = true;
      pixels->push_back(pixel);
    }
  };
  for (int walk = 0; walk < walks; ++walk) {
    Pixel at{static_cast<int>(random->index(size.width)),
             static_cast<int>(random->index(size.height))};
    const int jump = reach / 2 + 1 + static_cast<int>(random->index(reach / 2 + 1));
    for (int i = 0; i < length; ++i) {
      put(at, &true_there, &layout.ground_truth);
      (random->index(2) == 0 ? at.x : at.y) += random->index(5) == 0 ? -jump : jump;
      if (random->index(12) != 0) {
        put({at.x + static_cast<int>(random->index(3)), at.y}, &predicted_there,
            &layout.added[random->index(8) == 0 ? 1 : 0]);
      }
    }
  }
  return layout;
}

}  // namespace evolin::test
