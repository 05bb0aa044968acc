// KHT: edges, kernels, votes, and infinite lines as segments.
#include "evolin_ros/detection/kht.h"

#include <cmath>
#include <utility>

#include "canny_edges.h"
#include "evolin_ros/base/error.h"
#include "grey_image.h"
#include "kht_kernels.h"
#include "kht_votes.h"
#include "smoothed_gradient.h"

namespace evolin {
namespace {

const char* const kOwner = "detector kht";

}  // namespace

/// The buffers and stages behind Kht.
class Kht::Engine {
 public:
  explicit Engine(const KhtParameters& parameters)
      : parameters_(parameters),
        gradient_(1, 1.0),
        kernels_(parameters),
        accumulator_(parameters.delta),
        filter_(parameters.selection) {}

  LineSegments detect(const Frame& frame) {
    const cv::Mat& gray = gray_.of(frame.image);
    const double low = parameters_.canny_threshold1;
    const double high = parameters_.canny_threshold2;
    gradient_.compute(gray, CannyEdges::leastStrength(low, high), &maps_);
    edges_.find(maps_, low, high);
    const std::vector<kht::PolarLine>& found =
        accumulator_.vote(kernels_.find(&edges_), gray.size());

    const double middle_x = gray.cols / 2.0;
    const double middle_y = gray.rows / 2.0;
    const double reach = std::hypot(gray.cols, gray.rows);
    LineSegments lines;
    lines.reserve(found.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      const double theta = found[i].theta * CV_PI / 180;
      const double cosine = std::cos(theta);
      const double sine = std::sin(theta);
      const double x = middle_x + found[i].rho * cosine;
      const double y = middle_y + found[i].rho * sine;
      LineSegment line;
      line.x1 = x - reach * sine;
      line.y1 = y + reach * cosine;
      line.x2 = x + reach * sine;
      line.y2 = y - reach * cosine;
      line.score = i == 0 ? 1 : 1 - static_cast<double>(i) / static_cast<double>(found.size() - 1);
      lines.push_back(line);
    }
    return filter_.apply(std::move(lines), gray.size(), kOwner);
  }

 private:
  KhtParameters parameters_;
  GreyImage gray_;
  SmoothedGradient gradient_;
  GradientMaps maps_;
  CannyEdges edges_;
  kht::KernelFinder kernels_;
  kht::Accumulator accumulator_;
  LineFilter filter_;
};

Kht::Kht() = default;
Kht::~Kht() = default;

void Kht::configure(const YAML::Node& parameters) {
  KhtParameters read;
  ParameterReader reader(parameters, kOwner);
  reader.read("canny_threshold1", &read.canny_threshold1, 0.0, 100000.0);
  reader.read("canny_threshold2", &read.canny_threshold2, 0.0, 100000.0);
  reader.read("min_cluster", &read.min_cluster, 3, 100000);
  reader.read("min_deviation", &read.min_deviation, 0.1, 100.0);
  reader.read("delta", &read.delta, 0.1, 10.0);
  reader.read("min_height", &read.min_height, 0.0, 1.0);
  reader.read("sigmas", &read.sigmas, 1.0, 10.0);
  readSelection(&reader, &read.selection);
  reader.finish();
  engine_ = std::make_unique<Engine>(read);
  parameters_ = read;
}

LineSegments Kht::detect(const Frame& frame) {
  if (!engine_) {
    throw Error(std::string(kOwner) + ": detect() was called before configure()");
  }
  return engine_->detect(frame);
}

}  // namespace evolin
