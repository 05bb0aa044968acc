// Shuffles with a generator whose numbers the standard fixes.
#include "evolin_ros/association/random_associator.h"

#include <algorithm>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/parameters.h"

namespace evolin {

namespace {

const char* const kOwner = "associator random";

/// A whole number below `count` (> 0), each equally likely; std::uniform_int_distribution differs
/// from library to library.
std::size_t below(std::size_t count, std::mt19937_64* random) {
  const std::uint64_t fair = std::mt19937_64::max() - std::mt19937_64::max() % count;
  std::uint64_t number = (*random)();
  while (number >= fair) {
    number = (*random)();
  }
  return static_cast<std::size_t>(number % count);
}

std::uint32_t half(Stamp stamp, int which) {
  return static_cast<std::uint32_t>(static_cast<std::uint64_t>(stamp) >> (32 * which));
}

}  // namespace

void RandomAssociator::configure(const YAML::Node& parameters) {
  RandomParameters read;
  ParameterReader reader(parameters, kOwner);
  reader.read("seed", &read.seed, 0);
  reader.finish();
  parameters_ = read;
  configured_ = true;
}

LineMatches RandomAssociator::match(const FrameLines& first, const FrameLines& second) {
  if (!configured_) {
    throw Error(std::string(kOwner) + ": match() was called before configure()");
  }
  std::seed_seq seed = {static_cast<std::uint32_t>(parameters_.seed), half(first.frame.stamp, 0),
                        half(first.frame.stamp, 1), half(second.frame.stamp, 0),
                        half(second.frame.stamp, 1)};
  std::mt19937_64 random(seed);
  const bool fewer_first = first.lines.size() <= second.lines.size();
  const std::size_t fewer = std::min(first.lines.size(), second.lines.size());
  std::vector<std::uint32_t> partners(std::max(first.lines.size(), second.lines.size()));
  std::iota(partners.begin(), partners.end(), 0U);
  LineMatches matches(fewer);
  for (std::size_t i = 0; i < fewer; ++i) {
    std::swap(partners[i], partners[i + below(partners.size() - i, &random)]);
    matches[i].first = fewer_first ? static_cast<std::uint32_t>(i) : partners[i];
    matches[i].second = fewer_first ? partners[i] : static_cast<std::uint32_t>(i);
  }
  std::sort(matches.begin(), matches.end(),
            [](const LineMatch& a, const LineMatch& b) { return a.first < b.first; });
  return matches;
}

}  // namespace evolin
