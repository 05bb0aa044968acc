// Largest overlap first.
#include "part_names.h"

#include <algorithm>
#include <limits>
#include <tuple>

namespace evolin::synthetic {

namespace {

constexpr std::uint32_t kUnnamed = std::numeric_limits<std::uint32_t>::max();

struct Candidate {
  bool lost = false;  ///< not in the frame before
  double overlap = 0;
  std::uint32_t number = 0;
  std::size_t row = 0;

  /// Best first; a total order, so that the outcome does not depend on the sorting.
  bool operator<(const Candidate& other) const {
    return std::tuple(lost, -overlap, number, row) <
           std::tuple(other.lost, -other.overlap, other.number, other.row);
  }
};

}  // namespace

std::vector<std::uint32_t> PartNames::nextFrame(const std::vector<VisibleLine>& lines) {
  ++frame_;
  std::vector<std::uint32_t> numbers(lines.size(), kUnnamed);
  std::vector<Candidate> candidates;
  std::vector<bool> used;
  for (std::size_t first = 0, last = 0; first < lines.size(); first = last) {
    std::vector<Part>& known = known_[lines[first].edge];
    candidates.clear();
    for (last = first; last < lines.size() && lines[last].edge == lines[first].edge; ++last) {
      const EdgePart& now = lines[last].reach;
      for (std::uint32_t number = 0; number < known.size(); ++number) {
        const EdgePart& then = known[number].reach;
        const double overlap = std::min(now.end, then.end) - std::max(now.begin, then.begin);
        if (overlap > 0) {
          candidates.push_back({known[number].frame + 1 != frame_, overlap, number, last});
        }
      }
    }
    std::sort(candidates.begin(), candidates.end());
    used.assign(known.size(), false);
    for (const Candidate& candidate : candidates) {
      if (numbers[candidate.row] == kUnnamed && !used[candidate.number]) {
        numbers[candidate.row] = candidate.number;
        used[candidate.number] = true;
      }
    }
    for (std::size_t row = first; row < last; ++row) {
      if (numbers[row] == kUnnamed) {
        numbers[row] = static_cast<std::uint32_t>(known.size());
        known.emplace_back();
      }
      known[numbers[row]] = {lines[row].reach, frame_};
    }
  }
  return numbers;
}

}  // namespace evolin::synthetic
