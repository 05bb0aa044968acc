// Line lists, one a kind of line.
#include "view_markers.h"

#include <cmath>
#include <string>
#include <utility>

#include "conversions.h"
#include "evolin_ros/drawing/palette.h"

namespace evolin::ros_shell {

namespace {

using visualization_msgs::Marker;

/// Collects lists of lines on the image plane.
class MarkerMaker {
 public:
  MarkerMaker(const std_msgs::Header& header, const Camera& camera, double distance, double width)
      : header_(header), camera_(camera), distance_(distance), width_(width) {
    header_.frame_id = withoutLeadingSlash(header.frame_id);
  }

  void clear() { array_ = noMarkers(header_); }

  void begin(const std::string& name, const Colour& colour) {
    marker_ = Marker();
    marker_.header = header_;
    marker_.ns = name;
    marker_.id = 0;
    marker_.type = Marker::LINE_LIST;
    marker_.pose.orientation.w = 1;
    marker_.color = toMessage(colour);
    marker_.scale.x = width_ * distance_ / std::abs(camera_.fx);
  }

  void line(double x1, double y1, double x2, double y2) {
    if (std::isfinite(x1) && std::isfinite(y1) && std::isfinite(x2) && std::isfinite(y2)) {
      marker_.points.push_back(point(x1, y1));
      marker_.points.push_back(point(x2, y2));
    }
  }

  void line(const LineSegment& segment) { line(segment.x1, segment.y1, segment.x2, segment.y2); }

  /// The last line's colour, where a list's lines differ.
  void colourLast(const Colour& colour) {
    marker_.colors.resize(marker_.points.size(), toMessage(colour));
  }

  /// RViz complains of lists without points.
  void end() {
    marker_.action = marker_.points.empty() ? Marker::DELETE : Marker::ADD;
    array_.markers.push_back(std::move(marker_));
  }

  /// From the camera's centre to the corners, and around.
  void border(double width, double height) {
    const double right = width - 0.5;
    const double bottom = height - 0.5;
    const std::pair<double, double> corners[] = {
        {-0.5, -0.5}, {right, -0.5}, {right, bottom}, {-0.5, bottom}};
    for (int i = 0; i < 4; ++i) {
      const auto& [x, y] = corners[i];
      const auto& [next_x, next_y] = corners[(i + 1) % 4];
      line(x, y, next_x, next_y);
      marker_.points.emplace_back();
      marker_.points.push_back(point(x, y));
    }
  }

  visualization_msgs::MarkerArray take() { return std::move(array_); }

 private:
  geometry_msgs::Point point(double x, double y) const {
    geometry_msgs::Point result;
    result.x = (x - camera_.cx) / camera_.fx * distance_;
    result.y = (y - camera_.cy) / camera_.fy * distance_;
    result.z = distance_;
    return result;
  }

  std_msgs::Header header_;
  Camera camera_;
  double distance_;
  double width_;
  Marker marker_;
  visualization_msgs::MarkerArray array_;
};

void addVerdict(const EvaluatedFrame& frame, LineVerdict verdict, bool shown, MarkerMaker* maker) {
  for (std::size_t row = 0; shown && row < frame.verdicts.predicted.size(); ++row) {
    if (frame.verdicts.predicted[row] == verdict) {
      maker->line(frame.lines[row]);
    }
  }
  maker->end();
}

void addTrails(const EvaluatedFrame& frame, bool shown, MarkerMaker* maker) {
  maker->begin("trails", palette::kPlain);
  for (std::size_t i = 0; shown && i < frame.trails.size(); ++i) {
    const LineTrail& trail = frame.trails[i];
    for (std::size_t k = 1; k < trail.points.size(); ++k) {
      maker->line(trail.points[k - 1].x, trail.points[k - 1].y, trail.points[k].x,
                  trail.points[k].y);
    }
    maker->colourLast(colourOfNumber(trail.track));
  }
  maker->end();
}

}  // namespace

visualization_msgs::MarkerArray toMarkers(const std_msgs::Header& header, const Camera& camera,
                                          double distance, const EvaluatedFrame& frame,
                                          const ViewOptions& options, bool anew) {
  MarkerMaker maker(header, camera, distance, options.line_width);
  if (anew) {
    maker.clear();
  }
  maker.begin("image_border", palette::kPlain);
  maker.border(frame.image.cols, frame.image.rows);
  maker.end();
  maker.begin("misses", palette::kMissed);
  for (std::size_t row = 0; options.misses && row < frame.verdicts.found.size(); ++row) {
    if (!frame.verdicts.found[row]) {
      maker.line(frame.ground_truth[row]);
    }
  }
  maker.end();
  maker.begin("not_scored", palette::kPlain);
  addVerdict(frame, LineVerdict::kDropped, options.dropped, &maker);
  maker.begin("false_positives", palette::kFalsePositive);
  addVerdict(frame, LineVerdict::kFalsePositive, options.false_positives, &maker);
  maker.begin("true_positives", palette::kTruePositive);
  addVerdict(frame, LineVerdict::kTruePositive, options.true_positives, &maker);
  maker.begin("detected", palette::kPlain);
  if (!frame.no_verdicts.empty()) {
    for (const LineSegment& line : frame.lines) {
      maker.line(line);
    }
  }
  maker.end();
  addTrails(frame, options.trails, &maker);
  return maker.take();
}

visualization_msgs::MarkerArray noMarkers(const std_msgs::Header& header) {
  visualization_msgs::MarkerArray array;
  Marker& marker = array.markers.emplace_back();
  marker.header = header;
  marker.header.frame_id = withoutLeadingSlash(header.frame_id);
  marker.pose.orientation.w = 1;
  marker.action = Marker::DELETEALL;
  return array;
}

}  // namespace evolin::ros_shell
