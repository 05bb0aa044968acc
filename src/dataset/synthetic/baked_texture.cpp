// Baking, halving, and sampling along the longer axis of a pixel's footprint.
#include "baked_texture.h"

#include <algorithm>
#include <cmath>

#include "patterns.h"

namespace evolin::synthetic {

namespace {

constexpr double kLightSpacing = 0.08;  // m between places where light is computed
constexpr double kFromRim = 0.004;      // m; on the rim itself the neighbour would cast a shadow
constexpr int kMostTexels = 4096;       // a side
constexpr float kMostProbes = 8;        // along a long footprint

/// Light on a grid of places of a patch, with straight lines between them.
class LightMap {
 public:
  LightMap(const Patch& patch, const Lighting& lighting)
      : columns_(count(patch.width)), rows_(count(patch.height)) {
    const Vector3 normal = patch.normal();
    const double inset_u = std::min(kFromRim, patch.width / 4);
    const double inset_v = std::min(kFromRim, patch.height / 4);
    for (int row = 0; row < rows_; ++row) {
      const double v = inset_v + (patch.height - 2 * inset_v) * row / (rows_ - 1);
      for (int column = 0; column < columns_; ++column) {
        const double u = inset_u + (patch.width - 2 * inset_u) * column / (columns_ - 1);
        const Vector3 place = patch.origin + u * patch.u + v * patch.v;
        known_.push_back(lighting.covered(place, normal) ? 0 : 1);
        light_.push_back(known_.back() != 0 ? lighting.at(place, normal) : Color(0, 0, 0));
      }
    }
    spread();
  }

  /// x and y in [0, 1] over the patch.
  Color at(double x, double y) const {
    const double across = x * (columns_ - 1);
    const double up = y * (rows_ - 1);
    const int column = std::min(static_cast<int>(across), columns_ - 2);
    const int row = std::min(static_cast<int>(up), rows_ - 2);
    const double s = across - column;
    const double t = up - row;
    const Color* low = &light_[index(row, column)];
    const Color* high = low + columns_;
    return (low[0] * (1 - s) + low[1] * s) * (1 - t) + (high[0] * (1 - s) + high[1] * s) * t;
  }

 private:
  static int count(double length) {
    return std::max(2, static_cast<int>(std::ceil(length / kLightSpacing)) + 1);
  }

  /// Gives places under other things the light around them: their own darkness would seep out from
  /// below through the interpolation.
  void spread() {
    for (bool changed = true; changed;) {
      changed = false;
      const std::vector<char> known = known_;
      for (int row = 0; row < rows_; ++row) {
        for (int column = 0; column < columns_; ++column) {
          if (known[index(row, column)] != 0) {
            continue;
          }
          Color sum = Color::Zero();
          int count = 0;
          for (int r = std::max(row - 1, 0); r <= std::min(row + 1, rows_ - 1); ++r) {
            for (int c = std::max(column - 1, 0); c <= std::min(column + 1, columns_ - 1); ++c) {
              if (known[index(r, c)] != 0) {
                sum += light_[index(r, c)];
                ++count;
              }
            }
          }
          if (count > 0) {
            light_[index(row, column)] = sum / count;
            known_[index(row, column)] = 1;
            changed = true;
          }
        }
      }
    }
  }

  std::size_t index(int row, int column) const {
    return static_cast<std::size_t>(row) * columns_ + column;
  }

  int columns_;
  int rows_;
  std::vector<Color> light_;
  std::vector<char> known_;  ///< nothing stands on the place
};

/// A camera's response: nearly straight below, flat at the top, 255 never reached.
double response(double light) {
  constexpr double kExposure = 1.7;
  return 255 * (1 - std::exp(-kExposure * light)) / (1 - std::exp(-kExposure * 1.6));
}

std::uint8_t toByte(double level) {
  return static_cast<std::uint8_t>(std::clamp(level + 0.5, 0.0, 255.0));
}

int texelCount(double length, double texel) {
  return std::clamp(static_cast<int>(std::ceil(length / texel)), 2, kMostTexels);
}

}  // namespace

BakedTexture::BakedTexture(const Patch& patch, const Lighting& lighting, double texel) {
  Level base;
  base.width = texelCount(patch.width, texel);
  base.height = texelCount(patch.height, texel);
  base.texels.resize(static_cast<std::size_t>(base.width) * base.height * 4);
  per_metre_u_ = static_cast<float>(base.width / patch.width);
  per_metre_v_ = static_cast<float>(base.height / patch.height);
  const LightMap light(patch, lighting);
  std::uint8_t* out = base.texels.data();
  for (int row = 0; row < base.height; ++row) {
    const double y = (row + 0.5) / base.height;
    for (int column = 0; column < base.width; ++column, out += 4) {
      const double x = (column + 0.5) / base.width;
      const Color color = reflectance(patch.material, x * patch.width, y * patch.height,
                                      patch.width, patch.height) *
                          (light.at(x, y) + patch.material.glow);
      for (int channel = 0; channel < 3; ++channel) {
        out[channel] = toByte(response(color[2 - channel]));
      }
    }
  }
  levels_.push_back(std::move(base));
  addLevels();
}

void BakedTexture::addLevels() {
  while (levels_.back().width > 1 || levels_.back().height > 1) {
    const Level& fine = levels_.back();
    Level coarse;
    coarse.width = (fine.width + 1) / 2;
    coarse.height = (fine.height + 1) / 2;
    coarse.texels.resize(static_cast<std::size_t>(coarse.width) * coarse.height * 4);
    std::uint8_t* out = coarse.texels.data();
    for (int row = 0; row < coarse.height; ++row) {
      const int rows[] = {2 * row, std::min(2 * row + 1, fine.height - 1)};
      for (int column = 0; column < coarse.width; ++column) {
        const int columns[] = {2 * column, std::min(2 * column + 1, fine.width - 1)};
        for (int channel = 0; channel < 4; ++channel) {
          int sum = 2;
          for (const int r : rows) {
            for (const int c : columns) {
              sum += fine.texels[(static_cast<std::size_t>(r) * fine.width + c) * 4 + channel];
            }
          }
          *out++ = static_cast<std::uint8_t>(sum / 4);
        }
      }
    }
    levels_.push_back(std::move(coarse));
  }
}

Eigen::Array4f BakedTexture::bilinear(std::size_t level, float u, float v) const {
  const Level& image = levels_[level];
  // Odd sizes are rounded up, so that a coarse texel covers 2^level fine ones exactly.
  const float scale = 1.0F / static_cast<float>(1U << level);
  const float x =
      std::clamp(u * per_metre_u_ * scale - 0.5F, 0.0F, static_cast<float>(image.width - 1));
  const float y =
      std::clamp(v * per_metre_v_ * scale - 0.5F, 0.0F, static_cast<float>(image.height - 1));
  const int column = static_cast<int>(x);
  const int row = static_cast<int>(y);
  const float s = x - static_cast<float>(column);
  const float t = y - static_cast<float>(row);
  const std::size_t right = column + 1 < image.width ? 4 : 0;
  const std::size_t down = row + 1 < image.height ? static_cast<std::size_t>(image.width) * 4 : 0;
  const std::uint8_t* texel =
      &image.texels[(static_cast<std::size_t>(row) * image.width + column) * 4];
  const auto read = [](const std::uint8_t* at) {
    return Eigen::Array4f(at[0], at[1], at[2], at[3]);
  };
  return (read(texel) * (1 - s) + read(texel + right) * s) * (1 - t) +
         (read(texel + down) * (1 - s) + read(texel + down + right) * s) * t;
}

Eigen::Array4f BakedTexture::at(float u, float v, const Footprint& footprint) const {
  float u_long = footprint.u_right;
  float v_long = footprint.v_right;
  const auto square = [this](float du, float dv) {
    return du * du * per_metre_u_ * per_metre_u_ + dv * dv * per_metre_v_ * per_metre_v_;
  };
  float long_square = square(footprint.u_right, footprint.v_right);
  float short_square = square(footprint.u_down, footprint.v_down);
  if (short_square > long_square) {
    std::swap(long_square, short_square);
    u_long = footprint.u_down;
    v_long = footprint.v_down;
  }
  const float stretch = std::sqrt(long_square / std::max(short_square, 1e-12F));
  const float probes = std::clamp(std::ceil(stretch), 1.0F, kMostProbes);
  const float size = std::max(short_square, long_square / (kMostProbes * kMostProbes));
  const float detail = std::clamp(0.5F * std::log2(std::max(size, 1e-12F)), 0.0F,
                                  static_cast<float>(levels_.size() - 1));
  const auto fine = static_cast<std::size_t>(detail);
  const std::size_t coarse = std::min(fine + 1, levels_.size() - 1);
  const float share = detail - static_cast<float>(fine);

  Eigen::Array4f sum = Eigen::Array4f::Zero();
  for (float probe = 0; probe < probes; ++probe) {
    const float place = (probe + 0.5F) / probes - 0.5F;
    const float here_u = u + place * u_long;
    const float here_v = v + place * v_long;
    sum += bilinear(fine, here_u, here_v) * (1 - share);
    if (share > 0) {
      sum += bilinear(coarse, here_u, here_v) * share;
    }
  }
  return sum / probes;
}

}  // namespace evolin::synthetic
