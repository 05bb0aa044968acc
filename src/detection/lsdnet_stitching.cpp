// Regions that touch across a border of quarters are joined by plans of one quarter at a time.
#include "lsdnet_stitching.h"

#include <algorithm>
#include <deque>
#include <numeric>
#include <set>
#include <utility>

namespace evolin::lsdnet {
namespace {

/// Quarters in the authors' numbering, less one.
enum Quarter { kUpperLeft, kUpperRight, kLowerLeft, kLowerRight };

/// Regions of two sides of a border that hang together.
struct Component {
  std::set<int> a;
  std::set<int> b;
  bool used = false;
};

/// A border between the quarters of side A and of side B.
struct Border {
  Quarter a = kUpperLeft;
  Quarter b = kUpperLeft;
  std::vector<Component> components;

  /// The regions of `quarter` in a component of this border.
  const std::set<int>& of(const Component& component, Quarter quarter) const {
    return quarter == a ? component.a : component.b;
  }

  bool holds(Quarter quarter, const std::set<int>& regions) const {
    return std::any_of(components.begin(), components.end(), [&](const Component& component) {
      const std::set<int>& own = of(component, quarter);
      return std::any_of(regions.begin(), regions.end(),
                         [&](int region) { return own.count(region) > 0; });
    });
  }
};

/// A maximal run [begin, end) of pixels of one region along a border.
struct Run {
  int begin;
  int end;
  int region;
};

/// What becomes one region; the numbers are those of the regions in their quarters.
struct Plan {
  std::set<int> previous;
  std::set<int> current;
  std::set<int> next;
};

/// A quarter, its neighbours in the authors' direction of rotation, and the borders by number.
struct Turn {
  Quarter current;
  Quarter previous;
  Quarter next;
  int previous_border;
  int next_border;
  int beyond_previous;  ///< border of `previous` with the quarter opposite
  int beyond_next;
};

enum BorderNumber { kBorder12, kBorder24, kBorder43, kBorder31 };

constexpr std::array<Turn, 4> kTurns = {
    {{kUpperLeft, kLowerLeft, kUpperRight, kBorder31, kBorder12, kBorder43, kBorder24},
     {kUpperRight, kUpperLeft, kLowerRight, kBorder12, kBorder24, kBorder31, kBorder43},
     {kLowerRight, kUpperRight, kLowerLeft, kBorder24, kBorder43, kBorder12, kBorder31},
     {kLowerLeft, kLowerRight, kUpperLeft, kBorder43, kBorder31, kBorder24, kBorder12}}};

void add(const std::set<int>& more, std::set<int>* all) { all->insert(more.begin(), more.end()); }

bool meet(const std::set<int>& a, const std::set<int>& b) {
  return std::any_of(a.begin(), a.end(), [&](int value) { return b.count(value) > 0; });
}

std::vector<Run> runsOf(const std::vector<int>& labels, int begin, int end) {
  std::vector<Run> runs;
  for (int i = begin; i < end;) {
    const int label = labels[static_cast<std::size_t>(i)];
    int stop = i + 1;
    while (stop < end && labels[static_cast<std::size_t>(stop)] == label) {
      ++stop;
    }
    if (label > 0) {
      runs.push_back({i, stop, label - 1});
    }
    i = stop;
  }
  return runs;
}

class Stitching {
 public:
  Stitching(std::array<Regions, 4> quarters, int rows, int columns)
      : quarters_(std::move(quarters)), rows_(rows), columns_(columns) {}

  Regions join() {
    label();
    const int row = rows_ / 2;
    const int column = columns_ / 2;
    borders_[kBorder12] = makeBorder(kUpperLeft, kUpperRight, left_, right_, 0, row);
    borders_[kBorder24] = makeBorder(kUpperRight, kLowerRight, upper_, lower_, column, columns_);
    borders_[kBorder43] = makeBorder(kLowerRight, kLowerLeft, right_, left_, row, rows_);
    borders_[kBorder31] = makeBorder(kLowerLeft, kUpperLeft, lower_, upper_, 0, column);
    std::array<std::vector<Plan>, 4> plans;
    for (std::size_t turn = 0; turn < kTurns.size(); ++turn) {
      plans[turn] = makePlans(kTurns[turn]);
    }
    for (std::size_t quarter = 0; quarter < quarters_.size(); ++quarter) {
      used_[quarter].assign(quarters_[quarter].size(), false);
    }
    for (std::size_t turn = 0; turn < kTurns.size(); ++turn) {
      apply(kTurns[turn], plans[turn]);
    }
    return {std::make_move_iterator(joined_.begin()), std::make_move_iterator(joined_.end())};
  }

 private:
  /// Region number + 1 of the pixels along the borders; 0: none.
  void label() {
    const int row = rows_ / 2;
    const int column = columns_ / 2;
    left_.assign(static_cast<std::size_t>(rows_), 0);
    right_ = left_;
    upper_.assign(static_cast<std::size_t>(columns_), 0);
    lower_ = upper_;
    for (const Regions& quarter : quarters_) {
      for (std::size_t number = 0; number < quarter.size(); ++number) {
        const int name = static_cast<int>(number) + 1;
        for (const int pixel : quarter[number].pixels) {
          const int r = pixel / columns_;
          const int c = pixel % columns_;
          if (c == column - 1) {
            left_[static_cast<std::size_t>(r)] = name;
          } else if (c == column) {
            right_[static_cast<std::size_t>(r)] = name;
          }
          if (r == row - 1) {
            upper_[static_cast<std::size_t>(c)] = name;
          } else if (r == row) {
            lower_[static_cast<std::size_t>(c)] = name;
          }
        }
      }
    }
  }

  bool agree(Quarter a, int first, Quarter b, int second) const {
    const Region& one = quarters_[a][static_cast<std::size_t>(first)];
    const Region& other = quarters_[b][static_cast<std::size_t>(second)];
    const float dx = one.mean_x - other.mean_x;
    const float dy = one.mean_y - other.mean_y;
    return dx * dx + dy * dy < kDirectionTolerance;
  }

  /// Components in the order of their smallest region of side A.
  Border makeBorder(Quarter a, Quarter b, const std::vector<int>& side_a,
                    const std::vector<int>& side_b, int begin, int end) const {
    Border border{a, b, {}};
    const std::vector<Run> runs_b = runsOf(side_b, begin, end);
    for (const Run& one : runsOf(side_a, begin, end)) {
      for (const Run& other : runs_b) {
        if (other.begin <= one.end && other.end >= one.begin &&
            agree(a, one.region, b, other.region)) {
          connect(one.region, other.region, &border.components);
        }
      }
    }
    std::sort(border.components.begin(), border.components.end(),
              [](const Component& x, const Component& y) { return *x.a.begin() < *y.a.begin(); });
    return border;
  }

  static void connect(int a, int b, std::vector<Component>* components) {
    Component merged;
    merged.a.insert(a);
    merged.b.insert(b);
    const auto touches = [&](const Component& one) {
      return one.a.count(a) > 0 || one.b.count(b) > 0;
    };
    for (const Component& one : *components) {
      if (touches(one)) {
        add(one.a, &merged.a);
        add(one.b, &merged.b);
      }
    }
    components->erase(std::remove_if(components->begin(), components->end(), touches),
                      components->end());
    components->push_back(std::move(merged));
  }

  std::vector<Plan> makePlans(const Turn& turn) {
    Border& before = borders_[static_cast<std::size_t>(turn.previous_border)];
    Border& after = borders_[static_cast<std::size_t>(turn.next_border)];
    const Border& beyond_next = borders_[static_cast<std::size_t>(turn.beyond_next)];
    const Border& beyond_previous = borders_[static_cast<std::size_t>(turn.beyond_previous)];
    std::vector<Plan> plans;
    for (Component& s : after.components) {
      if (s.used) {
        continue;
      }
      Plan plan;
      plan.current = after.of(s, turn.current);
      plan.next = after.of(s, turn.next);
      bool corner = false;
      for (Component& p : before.components) {
        const std::set<int>& shared = before.of(p, turn.current);
        if (p.used || !meet(shared, after.of(s, turn.current))) {
          continue;
        }
        corner = true;
        p.used = true;
        add(shared, &plan.current);
        add(before.of(p, turn.previous), &plan.previous);
      }
      // What goes on around the next corner is left for a later quarter.
      if (!corner && beyond_next.holds(turn.next, plan.next)) {
        continue;
      }
      s.used = true;
      plans.push_back(std::move(plan));
    }
    for (Component& p : before.components) {
      const std::set<int>& previous = before.of(p, turn.previous);
      if (p.used || beyond_previous.holds(turn.previous, previous)) {
        continue;
      }
      p.used = true;
      plans.push_back({previous, before.of(p, turn.current), {}});
    }
    return plans;
  }

  void take(Quarter quarter, int number, Region* head) {
    const std::vector<int>& more = quarters_[quarter][static_cast<std::size_t>(number)].pixels;
    head->pixels.insert(head->pixels.begin(), more.begin(), more.end());
    used_[quarter][static_cast<std::size_t>(number)] = true;
  }

  void apply(const Turn& turn, const std::vector<Plan>& plans) {
    Regions& regions = quarters_[turn.current];
    for (const Plan& plan : plans) {
      const int first = *plan.current.begin();
      Region& head = regions[static_cast<std::size_t>(first)];
      for (const int number : plan.current) {
        if (number != first) {
          take(turn.current, number, &head);
        }
      }
      for (const int number : plan.previous) {
        take(turn.previous, number, &head);
      }
      for (const int number : plan.next) {
        take(turn.next, number, &head);
      }
      used_[turn.current][static_cast<std::size_t>(first)] = true;
      joined_.push_front(head);
    }
    for (std::size_t number = 0; number < regions.size(); ++number) {
      if (!used_[turn.current][number]) {
        joined_.push_front(regions[number]);
      }
    }
  }

  std::array<Regions, 4> quarters_;
  int rows_;
  int columns_;
  std::vector<int> left_;   ///< labels of the column left of the middle
  std::vector<int> right_;  ///< of the column right of it
  std::vector<int> upper_;
  std::vector<int> lower_;
  std::array<Border, 4> borders_;
  std::array<std::vector<bool>, 4> used_;
  std::deque<Region> joined_;
};

}  // namespace

Regions stitchQuarters(std::array<Regions, 4> quarters, int rows, int columns) {
  return Stitching(std::move(quarters), rows, columns).join();
}

}  // namespace evolin::lsdnet
