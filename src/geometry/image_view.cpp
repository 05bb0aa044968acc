// Normalised points to pixels, and how much of a segment in space an image shows.
#include "evolin_ros/geometry/image_view.h"

#include <algorithm>
#include <utility>

namespace evolin {

namespace {

Camera withoutDistortion(Camera camera) {
  camera.distortion_model = "plumb_bob";
  camera.distortion.clear();
  return camera;
}

Eigen::Vector2d between(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double share) {
  return a + share * (b - a);
}

}  // namespace

ImageView::ImageView(const Camera& camera, const Camera& lens, const Eigen::Matrix3d& rotation)
    : camera_(camera), lens_(lens), rotation_(rotation) {
  validateCamera(camera_, "camera " + camera_.name);
  findBounds();
}

/// The border is bent between the points that are looked at, hence the margin.
void ImageView::findBounds() {
  constexpr int kPoints = 64;  // on each side
  constexpr double kMargin = 0.02;
  const double farthest = LensDistortion::kFarthest;
  bounds_ = {farthest, farthest, -farthest, -farthest};
  const auto include = [this](double x, double y) {
    const std::optional<Eigen::Vector2d> at = normalizedOf({x, y});
    if (!at) {
      return false;
    }
    bounds_ = {std::min(bounds_.left, at->x()), std::min(bounds_.top, at->y()),
               std::max(bounds_.right, at->x()), std::max(bounds_.bottom, at->y())};
    return true;
  };
  const double right = camera_.width - 1.0;
  const double bottom = camera_.height - 1.0;
  bool all = true;
  for (int i = 0; i <= kPoints; ++i) {
    const double share = static_cast<double>(i) / kPoints;
    all = include(share * right, 0) && all;
    all = include(share * right, bottom) && all;
    all = include(0, share * bottom) && all;
    all = include(right, share * bottom) && all;
  }
  if (!all) {  // a corner that the lens model does not reach
    bounds_ = {-farthest, -farthest, farthest, farthest};
  }
  const double margin = kMargin * (bounds_.right - bounds_.left + bounds_.bottom - bounds_.top);
  bounds_ = {bounds_.left - margin, bounds_.top - margin, bounds_.right + margin,
             bounds_.bottom + margin};
}

ImageView ImageView::distorted(const Camera& camera) {
  return ImageView(camera, camera, Eigen::Matrix3d::Identity());
}

ImageView ImageView::rectified(const Camera& pinhole, const Eigen::Matrix3d& rotation) {
  return ImageView(withoutDistortion(pinhole), withoutDistortion(pinhole), rotation);
}

std::optional<Eigen::Vector2d> ImageView::pixelOf(const Eigen::Vector2d& normalized) const {
  const Eigen::Vector3d turned = rotation_ * normalized.homogeneous();
  if (!(turned.z() > 0)) {
    return std::nullopt;
  }
  const std::optional<Eigen::Vector2d> seen = lens_.distort(turned.hnormalized());
  if (!seen) {
    return std::nullopt;
  }
  return Eigen::Vector2d(camera_.fx * seen->x() + camera_.cx, camera_.fy * seen->y() + camera_.cy);
}

std::optional<Eigen::Vector2d> ImageView::normalizedOf(const Eigen::Vector2d& pixel) const {
  const std::optional<Eigen::Vector2d> turned = lens_.undistort(
      {(pixel.x() - camera_.cx) / camera_.fx, (pixel.y() - camera_.cy) / camera_.fy});
  if (!turned) {
    return std::nullopt;
  }
  const Eigen::Vector3d direction = rotation_.transpose() * turned->homogeneous();
  return direction.z() > 0 ? std::optional<Eigen::Vector2d>(direction.hnormalized()) : std::nullopt;
}

bool ImageView::shows(const Eigen::Vector2d& normalized) const {
  const std::optional<Eigen::Vector2d> pixel = pixelOf(normalized);
  return pixel && pixel->x() >= 0 && pixel->y() >= 0 && pixel->x() <= camera_.width - 1.0 &&
         pixel->y() <= camera_.height - 1.0;
}

std::optional<LineSegment> ImageView::project(const Segment3d& segment, double near) const {
  Eigen::Vector3d p1 = segment.p1;
  Eigen::Vector3d p2 = segment.p2;
  if (!p1.allFinite() || !p2.allFinite() || std::max(p1.z(), p2.z()) < near) {
    return std::nullopt;
  }
  if (std::min(p1.z(), p2.z()) < near) {
    Eigen::Vector3d& behind = p1.z() < near ? p1 : p2;
    behind = p1 + (near - p1.z()) / (p2.z() - p1.z()) * (p2 - p1);
    behind.z() = near;
  }
  LineSegment flat;
  flat.x1 = p1.x() / p1.z();
  flat.y1 = p1.y() / p1.z();
  flat.x2 = p2.x() / p2.z();
  flat.y2 = p2.y() / p2.z();
  const std::optional<LineSegment> around = clipToRectangle(flat, bounds_);
  if (!around) {
    return std::nullopt;
  }
  const Eigen::Vector2d begin(around->x1, around->y1);
  const Eigen::Vector2d end(around->x2, around->y2);

  // Samples close enough that no visible part of a length worth drawing slips between them.
  constexpr int kSteps = 256;
  std::pair<int, int> longest(0, -1);
  for (int step = 0, first = 0; step <= kSteps; ++step) {
    if (!shows(between(begin, end, static_cast<double>(step) / kSteps))) {
      first = step + 1;
    } else if (step - first > longest.second - longest.first) {
      longest = {first, step};
    }
  }
  if (longest.second < longest.first) {
    return std::nullopt;
  }
  const auto border = [&](double outside, double inside) {
    for (int halving = 0; halving < 60; ++halving) {
      const double middle = (outside + inside) / 2;
      (shows(between(begin, end, middle)) ? inside : outside) = middle;
    }
    return inside;
  };
  const auto share = [](int step) { return static_cast<double>(step) / kSteps; };
  const double enters =
      longest.first == 0 ? 0 : border(share(longest.first - 1), share(longest.first));
  const double leaves =
      longest.second == kSteps ? 1 : border(share(longest.second + 1), share(longest.second));
  const std::optional<Eigen::Vector2d> from = pixelOf(between(begin, end, enters));
  const std::optional<Eigen::Vector2d> to = pixelOf(between(begin, end, leaves));
  if (!from || !to) {
    return std::nullopt;
  }
  LineSegment line;
  line.x1 = from->x();
  line.y1 = from->y();
  line.x2 = to->x();
  line.y2 = to->y();
  return line;
}

}  // namespace evolin
