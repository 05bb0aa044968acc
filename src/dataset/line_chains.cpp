// Union-find over the annotated lines of a sequence.
#include "line_chains.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "evolin_ros/base/error.h"
#include "evolin_ros/dataset/csv.h"

namespace evolin {

namespace {

// Lines are numbered through: row r of frame f is node first_[f] + r.
class LineChains {
 public:
  explicit LineChains(const std::vector<LineSegments>& frames) {
    first_.reserve(frames.size() + 1);
    first_.push_back(0);
    for (const LineSegments& lines : frames) {
      first_.push_back(first_.back() + lines.size());
    }
    parent_.resize(first_.back());
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
    members_.resize(parent_.size());
    for (std::size_t frame = 0; frame < frames.size(); ++frame) {
      for (std::size_t row = 0; row < frames[frame].size(); ++row) {
        members_[node(frame, row)].emplace(frame, row);
      }
    }
  }

  std::size_t node(std::size_t frame, std::size_t row) const { return first_[frame] + row; }

  std::size_t root(std::size_t node) {
    while (parent_[node] != node) {
      parent_[node] = parent_[parent_[node]];
      node = parent_[node];
    }
    return node;
  }

  struct Conflict {
    std::size_t frame;
    std::size_t row;
    std::size_t other_row;
  };

  // Joins the two chains, or leaves them and returns where they hold two lines of one frame.
  std::optional<Conflict> join(std::size_t a, std::size_t b) {
    a = root(a);
    b = root(b);
    if (a == b) {
      return std::nullopt;
    }
    if (members_[a].size() < members_[b].size()) {
      std::swap(a, b);
    }
    for (const auto& [frame, row] : members_[b]) {
      const auto [same_frame, is_new] = members_[a].emplace(frame, row);
      if (!is_new) {
        return Conflict{frame, same_frame->second, row};
      }
    }
    members_[b].clear();
    parent_[b] = a;
    return std::nullopt;
  }

 private:
  std::vector<std::size_t> first_;
  std::vector<std::size_t> parent_;
  std::vector<std::map<std::size_t, std::size_t>> members_;  ///< of a root: frame to row
};

using FramePair = std::pair<std::size_t, std::size_t>;

// Stems may hold underscores themselves, so every cut is tried.
FramePair framesOfPairFile(const std::filesystem::path& file,
                           const std::unordered_map<std::string, std::size_t>& index) {
  const std::string stem = file.stem().string();
  std::vector<FramePair> found;
  for (std::size_t cut = stem.find('_'); cut != std::string::npos; cut = stem.find('_', cut + 1)) {
    const auto first = index.find(stem.substr(0, cut));
    const auto second = index.find(stem.substr(cut + 1));
    if (first != index.end() && second != index.end()) {
      found.emplace_back(first->second, second->second);
    }
  }
  if (found.size() != 1) {
    throw ParseError(file.string(), 0,
                     found.empty() ? "no two annotated frames have this name, expected "
                                     "STEM_STEM.csv with stems of the line files"
                                   : "the name can be cut into two frames in several ways, "
                                     "expected only one");
  }
  return found.front();
}

}  // namespace

void chainLineIds(const std::vector<std::filesystem::path>& folders,
                  const std::unordered_map<std::string, std::size_t>& index,
                  const std::vector<std::string>& names, std::vector<LineSegments>* frames) {
  LineChains chains(*frames);
  for (const std::filesystem::path& folder : folders) {
    for (const std::filesystem::path& file : listFiles(folder, {".csv"})) {
      const FramePair pair = framesOfPairFile(file, index);
      const auto fail = [&](std::size_t row, const std::string& message) {
        throw ParseError(file.string(), static_cast<int>(row) + 1, message);
      };
      const auto require_row = [&](std::size_t at, std::size_t frame, std::int64_t row) {
        const std::size_t count = (*frames)[frame].size();
        if (row < 0 || static_cast<std::uint64_t>(row) >= count) {
          fail(at, "index " + std::to_string(row) + " is beyond the " + std::to_string(count) +
                       " lines of frame " + names[frame]);
        }
        return static_cast<std::size_t>(row);
      };
      const IndexPairs rows = readIndexPairsCsv(file);
      for (std::size_t i = 0; i < rows.size(); ++i) {
        const std::size_t first = require_row(i, pair.first, rows[i].first);
        const std::size_t second = require_row(i, pair.second, rows[i].second);
        const auto conflict =
            chains.join(chains.node(pair.first, first), chains.node(pair.second, second));
        if (conflict) {
          fail(i, "the pair " + std::to_string(first) + "," + std::to_string(second) +
                      " would make lines " + std::to_string(conflict->row) + " and " +
                      std::to_string(conflict->other_row) + " of frame " + names[conflict->frame] +
                      " the same physical line");
        }
      }
    }
  }
  std::unordered_map<std::size_t, std::int64_t> ids;
  for (std::size_t frame = 0; frame < frames->size(); ++frame) {
    for (std::size_t row = 0; row < (*frames)[frame].size(); ++row) {
      const std::size_t root = chains.root(chains.node(frame, row));
      const auto next = static_cast<std::int64_t>(ids.size());
      (*frames)[frame][row].id = ids.emplace(root, next).first->second;
    }
  }
}

}  // namespace evolin
