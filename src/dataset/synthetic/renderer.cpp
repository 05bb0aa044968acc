// A scanline renderer: visibility at 4 x 4 places a pixel, colour once for every surface in it.
#include "evolin_ros/dataset/synthetic/renderer.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <mutex>

#include "baked_texture.h"
#include "lighting.h"
#include "projected_surface.h"

namespace evolin::synthetic {

namespace {

constexpr int kGrid = 4;  // places a pixel in each direction
constexpr std::int16_t kNothing = -1;
/// Of the camera with a focal length of kReferenceFocal; finer cameras get finer textures.
constexpr double kTexel = 0.004;
constexpr double kReferenceFocal = 525;

double placeInPixel(int i) { return (i + 0.5) / kGrid - 0.5; }

/// One row of places: the nearest surface at each.
class VisibilityRow {
 public:
  /// Place i is at x = first + i * step.
  VisibilityRow(int places, double first, double step)
      : first_(first), step_(step), inverse_depth_(places), surface_(places) {}

  void clear() {
    std::fill(inverse_depth_.begin(), inverse_depth_.end(), 0.0F);
    std::fill(surface_.begin(), surface_.end(), kNothing);
  }

  void draw(const ProjectedSurface& surface, std::int16_t index, double y) {
    double left = 0;
    double right = 0;
    if (!surface.span(y, &left, &right)) {
      return;
    }
    const auto places = static_cast<double>(surface_.size());
    const int begin = static_cast<int>(std::clamp(std::ceil((left - first_) / step_), 0.0, places));
    const int end =
        static_cast<int>(std::clamp(std::floor((right - first_) / step_) + 1, 0.0, places));
    const auto slope = static_cast<float>(surface.inverse_depth.right * step_);
    const auto start = static_cast<float>(surface.inverse_depth.at(first_ + begin * step_, y));
    float* depths = inverse_depth_.data() + begin;
    std::int16_t* surfaces = surface_.data() + begin;
    for (int i = 0; i < end - begin; ++i) {
      const float here = start + slope * static_cast<float>(i);
      const bool nearer = here > depths[i];
      depths[i] = nearer ? here : depths[i];
      surfaces[i] = nearer ? index : surfaces[i];
    }
  }

  std::int16_t operator[](int place) const { return surface_[static_cast<std::size_t>(place)]; }

 private:
  double first_;
  double step_;
  std::vector<float> inverse_depth_;
  std::vector<std::int16_t> surface_;
};

/// The places of one pixel that see one surface.
struct Seen {
  std::int16_t surface = kNothing;
  int count = 0;
  double sum_x = 0;
  double sum_y = 0;
};

/// In order of the places, so that sums come out the same everywhere.
void collect(const std::vector<VisibilityRow>& rows, int pixel, std::vector<Seen>* seen) {
  seen->clear();
  const std::int16_t first = rows[0][pixel * kGrid];
  bool uniform = true;
  for (const VisibilityRow& row : rows) {
    for (int i = 0; i < kGrid; ++i) {
      uniform = uniform && row[pixel * kGrid + i] == first;
    }
  }
  if (uniform) {
    seen->push_back({first, kGrid * kGrid, 0, 0});
    return;
  }
  for (int k = 0; k < kGrid; ++k) {
    for (int i = 0; i < kGrid; ++i) {
      const std::int16_t surface = rows[static_cast<std::size_t>(k)][pixel * kGrid + i];
      auto part = std::find_if(seen->begin(), seen->end(),
                               [surface](const Seen& each) { return each.surface == surface; });
      if (part == seen->end()) {
        part = seen->insert(part, {surface, 0, 0, 0});
      }
      ++part->count;
      part->sum_x += placeInPixel(i);
      part->sum_y += placeInPixel(k);
    }
  }
}

}  // namespace

class Renderer::Textures {
 public:
  Textures(const Scene& scene, double texel)
      : scene_(scene), lighting_(scene), texel_(texel), slots_(scene.patches.size()) {}

  const BakedTexture& of(std::size_t patch) {
    Slot& slot = slots_[patch];
    std::call_once(slot.made, [&] {
      slot.texture = std::make_unique<BakedTexture>(scene_.patches[patch], lighting_, texel_);
    });
    return *slot.texture;
  }

 private:
  struct Slot {
    std::once_flag made;
    std::unique_ptr<BakedTexture> texture;
  };

  const Scene& scene_;
  Lighting lighting_;
  double texel_;
  std::vector<Slot> slots_;
};

Renderer::Renderer(const Scene& scene, const Camera& camera)
    : scene_(scene),
      camera_(camera),
      textures_(std::make_unique<Textures>(scene, kTexel * kReferenceFocal / camera.fx)) {}

Renderer::~Renderer() = default;

Rendering Renderer::render(const Pose& camera_to_world) const {
  const View view(camera_, camera_to_world);
  std::vector<ProjectedSurface> surfaces;
  std::vector<const BakedTexture*> textures;
  for (const Surface& surface : scene_.surfaces) {
    std::optional<ProjectedSurface> projected =
        projectSurface(surface, scene_.patches[surface.patch], view, kNearPlane);
    if (projected && projected->bottom >= -0.5 && projected->top <= camera_.height - 0.5) {
      surfaces.push_back(std::move(*projected));
      textures.push_back(nullptr);
    }
  }
  const auto shade = [&](std::size_t index, double x, double y) {
    const ProjectedSurface& surface = surfaces[index];
    if (textures[index] == nullptr) {
      textures[index] = &textures_->of(surface.patch);
    }
    const double z = 1 / surface.inverse_depth.at(x, y);
    const double u_ray = surface.u_ray.at(x, y);
    const double v_ray = surface.v_ray.at(x, y);
    const double z_right = -z * z * surface.inverse_depth.right;
    const double z_down = -z * z * surface.inverse_depth.down;
    const Footprint footprint{static_cast<float>(z_right * u_ray + z * surface.u_ray.right),
                              static_cast<float>(z_right * v_ray + z * surface.v_ray.right),
                              static_cast<float>(z_down * u_ray + z * surface.u_ray.down),
                              static_cast<float>(z_down * v_ray + z * surface.v_ray.down)};
    return textures[index]->at(static_cast<float>(z * u_ray - surface.u_origin),
                               static_cast<float>(z * v_ray - surface.v_origin), footprint);
  };

  Rendering result;
  result.color.create(camera_.height, camera_.width, CV_32FC3);
  result.depth.create(camera_.height, camera_.width, CV_32FC1);
  std::vector<VisibilityRow> rows(
      kGrid, VisibilityRow(camera_.width * kGrid, placeInPixel(0), 1.0 / kGrid));
  VisibilityRow centres(camera_.width, 0, 1);
  std::vector<Seen> seen;
  for (int y = 0; y < camera_.height; ++y) {
    centres.clear();
    for (VisibilityRow& row : rows) {
      row.clear();
    }
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
      if (surfaces[i].top > y + 0.5 || surfaces[i].bottom < y - 0.5) {
        continue;
      }
      const auto index = static_cast<std::int16_t>(i);
      centres.draw(surfaces[i], index, y);
      for (int k = 0; k < kGrid; ++k) {
        rows[static_cast<std::size_t>(k)].draw(surfaces[i], index, y + placeInPixel(k));
      }
    }
    auto* color = result.color.ptr<cv::Vec3f>(y);
    auto* depth = result.depth.ptr<float>(y);
    for (int x = 0; x < camera_.width; ++x) {
      depth[x] =
          centres[x] == kNothing
              ? std::numeric_limits<float>::quiet_NaN()
              : static_cast<float>(
                    1 / surfaces[static_cast<std::size_t>(centres[x])].inverse_depth.at(x, y));
      // Places of one surface share its colour at their mean.
      Eigen::Array4f sum = Eigen::Array4f::Zero();
      collect(rows, x, &seen);
      for (const Seen& part : seen) {
        if (part.surface != kNothing) {
          sum += static_cast<float>(part.count) * shade(static_cast<std::size_t>(part.surface),
                                                        x + part.sum_x / part.count,
                                                        y + part.sum_y / part.count);
        }
      }
      sum /= static_cast<float>(kGrid * kGrid);
      color[x] = cv::Vec3f(sum[0], sum[1], sum[2]);
    }
  }
  return result;
}

}  // namespace evolin::synthetic
