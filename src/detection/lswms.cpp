// LSWMS: parameters, coordinates, scores.
#include "evolin_ros/detection/lswms.h"

#include <algorithm>
#include <utility>

#include "evolin_ros/base/error.h"
#include "grey_image.h"
#include "lswms_search.h"

namespace evolin {
namespace {

const char* const kOwner = "detector lswms";

}  // namespace

/// The buffers and stages behind Lswms.
class Lswms::Engine {
 public:
  explicit Engine(const LswmsParameters& parameters)
      : parameters_(parameters), search_(parameters), filter_(parameters.selection) {}

  LineSegments detect(const Frame& frame) {
    const cv::Mat& gray = gray_.of(frame.image);
    const std::vector<lswms::Found>& found = search_.run(gray);
    const int shift = parameters_.compatible ? search_.margin() - 2 * parameters_.radius : 0;
    LineSegments lines;
    lines.reserve(found.size());
    for (const lswms::Found& one : found) {
      LineSegment line;
      line.x1 = one.a.x + shift;
      line.y1 = one.a.y + shift;
      line.x2 = one.b.x + shift;
      line.y2 = one.b.y + shift;
      line.score = score(one, line);
      lines.push_back(line);
    }
    return filter_.apply(std::move(lines), gray.size(), kOwner);
  }

 private:
  double score(const lswms::Found& found, const LineSegment& line) const {
    if (parameters_.score == "length") {
      return line.length();
    }
    return parameters_.compatible ? found.published_error
                                  : std::max(0.0, 1 - found.error / parameters_.max_error);
  }

  LswmsParameters parameters_;
  GreyImage gray_;
  lswms::Search search_;
  LineFilter filter_;
};

Lswms::Lswms() = default;
Lswms::~Lswms() = default;

void Lswms::configure(const YAML::Node& parameters) {
  LswmsParameters read;
  ParameterReader reader(parameters, kOwner);
  reader.read("radius", &read.radius, 1, 15);
  reader.read("angle_tolerance", &read.angle_tolerance, 1.0, 45.0);
  reader.read("max_error", &read.max_error, 0.001, 1.6);
  reader.read("score", &read.score, {"angle", "length"});
  reader.read("compatible", &read.compatible);
  readSelection(&reader, &read.selection);
  reader.finish();
  engine_ = std::make_unique<Engine>(read);
  parameters_ = read;
}

LineSegments Lswms::detect(const Frame& frame) {
  if (!engine_) {
    throw Error(std::string(kOwner) + ": detect() was called before configure()");
  }
  return engine_->detect(frame);
}

}  // namespace evolin
