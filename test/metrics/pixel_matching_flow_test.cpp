// Counts of matched pixels against LEMON's network simplex, on inputs too large for a plain solver.
#include <gtest/gtest.h>
#include <lemon/list_graph.h>
#include <lemon/network_simplex.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "evolin_ros/dataset/csv.h"
#include "evolin_ros/metrics/pixel_matching.h"
#include "test/metrics/pixel_layouts.h"
#include "test/support/shared_data.h"

namespace evolin {
namespace {

using test::PixelLayout;
using Counts = std::vector<std::size_t>;

/// The number of pairs of the cheapest matching, as a flow from ground-truth pixels to predicted
/// ones or past them at the free cost. In whole billionths of a pixel: far below the 1e-6 that
/// tells otherwise equal matchings apart, even summed over the longest path.
std::size_t countByFlow(const PixelLayout& layout, const Pixels& predicted) {
  using Graph = lemon::ListDigraph;
  using Solver = lemon::NetworkSimplex<Graph, std::int64_t, std::int64_t>;
  constexpr double kBillion = 1e9;
  const auto key = [](int x, int y) { return static_cast<std::int64_t>(y) * 65536 + x; };
  Graph graph;
  std::unordered_map<std::int64_t, Graph::Node> nodes;
  std::vector<Graph::Arc> to_drain;
  std::vector<Graph::Arc> pairs;
  std::vector<std::int64_t> pair_costs;
  const Graph::Node source = graph.addNode();
  const Graph::Node drain = graph.addNode();
  for (const Pixel& pixel : predicted) {
    const Graph::Node node = graph.addNode();
    nodes.emplace(key(pixel.x, pixel.y), node);
    to_drain.push_back(graph.addArc(node, drain));
  }
  std::vector<Graph::Arc> past;
  const int reach = layout.rule.reach;
  for (const Pixel& pixel : layout.ground_truth) {
    Graph::Node truth = lemon::INVALID;
    for (int dy = -reach; dy <= reach; ++dy) {
      for (int dx = -reach; dx <= reach; ++dx) {
        const auto found = nodes.find(key(pixel.x + dx, pixel.y + dy));
        if (dx * dx + dy * dy > reach * reach || found == nodes.end()) {
          continue;
        }
        if (truth == lemon::INVALID) {
          truth = graph.addNode();
          to_drain.push_back(graph.addArc(source, truth));
          past.push_back(graph.addArc(truth, drain));
        }
        pairs.push_back(graph.addArc(truth, found->second));
        pair_costs.push_back(
            std::llround((std::sqrt(static_cast<double>(dx * dx + dy * dy)) + 1e-6) * kBillion));
      }
    }
  }
  Graph::ArcMap<std::int64_t> capacity(graph, 1);
  Graph::ArcMap<std::int64_t> cost(graph, 0);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    cost[pairs[i]] = pair_costs[i];
  }
  for (const Graph::Arc arc : past) {
    cost[arc] = std::llround(layout.rule.free_cost * kBillion);
  }
  Solver solver(graph);
  solver.upperMap(capacity).costMap(cost).stSupply(source, drain,
                                                   static_cast<std::int64_t>(past.size()));
  EXPECT_EQ(solver.run(), Solver::OPTIMAL);
  std::size_t count = past.size();
  for (const Graph::Arc arc : past) {
    count -= static_cast<std::size_t>(solver.flow(arc));
  }
  return count;
}

/// Of the levels that `wanted` numbers.
void expectFlowCounts(const PixelLayout& layout, const std::vector<std::size_t>& wanted) {
  const Counts counts = test::countMatched(layout);
  Pixels predicted;
  std::size_t next = 0;
  for (const std::size_t level : wanted) {
    for (; next <= level; ++next) {
      predicted.insert(predicted.end(), layout.added[next].begin(), layout.added[next].end());
    }
    EXPECT_EQ(counts[level], countByFlow(layout, predicted)) << "level " << level;
  }
}

/// Pixels of lines, each in the first level that draws it.
class Sketch {
 public:
  explicit Sketch(ImageSize size)
      : size_(size), there_(static_cast<std::size_t>(size.width) * size.height) {}

  Pixels draw(const LineSegments& lines) {
    Pixels fresh;
    for (const LineSegment& line : lines) {
      Pixels pixels;
      rasterize(line, size_, &pixels);
      for (const Pixel& pixel : pixels) {
        const std::size_t index = static_cast<std::size_t>(pixel.y) * size_.width + pixel.x;
        if (!there_[index]) {
          there_[index] = true;
          fresh.push_back(pixel);
        }
      }
    }
    return fresh;
  }

 private:
  ImageSize size_;
  std::vector<bool> there_;
};

PixelLayout layoutOf(ImageSize size, const LineSegments& truth, const LineSegments& predicted,
                     const std::vector<double>& falling_thresholds) {
  PixelLayout layout{size, pixelMatchingRule(size), Sketch(size).draw(truth), {}};
  Sketch sketch(size);
  for (const double threshold : falling_thresholds) {
    LineSegments shown;
    for (const LineSegment& line : predicted) {
      if (line.score > threshold) {
        shown.push_back(line);
      }
    }
    layout.added.push_back(sketch.draw(shown));
  }
  return layout;
}

TEST(PixelMatchingByFlow, AgreesOnChainsUnderTheImagesOwnRule) {
  const ImageSize size{640, 480};
  for (const std::size_t links : {98U, 99U, 600U}) {
    expectFlowCounts(test::shiftedChain(size, pixelMatchingRule(size), links), {0, 1});
  }
}

TEST(PixelMatchingByFlow, AgreesOnCombsAndLadders) {
  for (const double free_cost : {20.0, 60.0, 150.0, 400.0}) {
    expectFlowCounts(test::comb({400, 300}, {5, free_cost}, 40, 20), {0, 1, 20, 40});
    expectFlowCounts(test::ladder({400, 40}, {8, free_cost}, 25), {0, 1});
  }
}

TEST(PixelMatchingByFlow, AgreesOnDriftingWalks) {
  test::RandomLines random(21);
  for (int round = 0; round < 30; ++round) {
    const int reach = 3 + static_cast<int>(random.index(6));
    expectFlowCounts(
        test::driftingWalks(&random, {320, 240}, reach, random.uniform(2.0, 40.0) * reach, 12, 120),
        {0, 1});
  }
}

TEST(PixelMatchingByFlow, AgreesOnClouds) {
  test::RandomLines random(22);
  for (int round = 0; round < 12; ++round) {
    expectFlowCounts(test::cloud(&random, {90, 60}, 4, random.uniform(4, 30), 0.3, 0.3, 3),
                     {0, 1, 2});
  }
}

TEST(PixelMatchingByFlow, AgreesOnRandomLines) {
  test::RandomLines random(23);
  const ImageSize size{200, 150};
  for (int round = 0; round < 6; ++round) {
    const LineSegments truth = random.anywhere(30, size.width, size.height);
    LineSegments predicted = random.detectionsOf(truth, 60, 8);
    PixelLayout layout = layoutOf(size, truth, predicted, {0.7, 0.3, -1});
    expectFlowCounts(layout, {0, 1, 2});
    // Dear pairs: what the image's rule never asks for on so small an image.
    layout.rule.reach = 6;
    layout.rule.free_cost = random.uniform(6, 40);
    expectFlowCounts(layout, {0, 1, 2});
  }
}

TEST(PixelMatchingByFlow, AgreesOnTheLivingRoom) {
  EVOLIN_REQUIRE_SHARED_DATA();
  const auto sample = test::sharedFolder() / "data" / "icl_nuim_lr_sample";
  const auto scored = sample / "predictions" / "scored";
  PixelLayout layout =
      layoutOf({640, 480}, readLinesCsv(sample / "gt_lines" / "0004.csv"),
               readScoredLinesCsv(scored / "lines" / "0004.csv", scored / "scores" / "0004.csv"),
               {0.9, 0.6, 0.3, 0.0});
  expectFlowCounts(layout, {0, 1, 2});
  layout.rule.free_cost = 60;  // as if the diagonal were short: here pairs do get too dear
  expectFlowCounts(layout, {0, 2});
}

/// With all twenty thresholds 8 is proven after exchanges of predicted pixels, 39 only just.
class DenseFrame : public ::testing::TestWithParam<std::string> {};

TEST_P(DenseFrame, Agrees) {
  EVOLIN_REQUIRE_SHARED_DATA();
  const auto set = test::sharedFolder() / "data" / "golden" / "sets" / "timing";
  const auto scored = set / "scored_lines";
  const std::string file = GetParam() + ".csv";
  PixelLayout layout = layoutOf(
      {640, 480}, readLinesCsv(set / "gt_lines" / file),
      readScoredLinesCsv(scored / "lines" / file, scored / "scores" / file), {0.7, 0.35, 0.1});
  expectFlowCounts(layout, {0, 1, 2});
  layout.rule.free_cost = 80;
  expectFlowCounts(layout, {0, 1, 2});
}

INSTANTIATE_TEST_SUITE_P(PixelMatchingByFlow, DenseFrame, ::testing::Values("0008", "0039"),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace evolin
