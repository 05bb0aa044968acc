// The greedy merge of FSG: segments that continue each other become one.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "evolin_ros/detection/fsg.h"
#include "evolin_ros/geometry/line_segment.h"
#include "fsg_validity.h"

namespace evolin::fsg {

/// Groups the segments of one image after the other, in buffers that it keeps.
class Grouping {
 public:
  explicit Grouping(const FsgParameters& parameters) : parameters_(parameters) {}

  /// What the groups of `segments` in an image of `size` amount to: segments that stayed alone, as
  /// they were, where they are long enough, and the fitted segments of groups. Longer ones first.
  /// Until the next call.
  const LineSegments& run(const LineSegments& segments, cv::Size size);

 private:
  /// Least squares over the endpoints of a group, and the segment that spans them.
  struct Model {
    bool horizontal = true;
    double n = 0;
    double su = 0;  // u along the first segment's greater coordinate, v across
    double sv = 0;
    double suu = 0;
    double suv = 0;
    Segment base;
  };

  struct Cone;

  void sortByLength(cv::Size size);
  void sortByOrientation();
  void collectCandidates(std::size_t segment);
  void growGroup(std::size_t first);
  std::size_t bestCandidate();
  bool isNear(const Segment& candidate) const;
  bool overlaps(const Segment& candidate) const;
  void take(std::size_t segment);
  void startModel(const Segment& segment);
  void extendModel(const Segment& segment);
  void emit(const Segment& segment);

  FsgParameters parameters_;
  std::unique_ptr<Validity> validity_;
  std::vector<Segment> segments_;
  std::vector<std::uint32_t> order_;
  std::vector<std::uint32_t> orientation_;        // bin of each segment
  std::vector<std::vector<std::uint32_t>> bins_;  // free segments by orientation
  std::vector<std::uint8_t> merged_;
  std::vector<Segment> group_;
  std::vector<std::uint32_t> candidates_;
  std::vector<std::uint32_t> remaining_;
  Model model_;
  LineSegments lines_;
};

}  // namespace evolin::fsg
