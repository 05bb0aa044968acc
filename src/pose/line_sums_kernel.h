// The loops of lineSums(), for files that are compiled for different processors. Everything has
// internal linkage and nothing of the standard library is used: the linker must not take one
// file's copy of a function for the other's.
#pragma once

#include <cstddef>

#include "line_sums.h"

namespace evolin {

namespace {

struct TwoWide {
  using Vector __attribute__((vector_size(16))) = double;
  static double sum(const Vector& v) { return v[0] + v[1]; }
};
struct FourWide {
  using Vector __attribute__((vector_size(32))) = double;
  static double sum(const Vector& v) { return (v[0] + v[1]) + (v[2] + v[3]); }
};

/// The lanes of lineSums() are kParts vectors, each summed up on its own.
template <class Vectors>
class LineLoops {
 public:
  template <bool with_equations>
  static void sum(const LineTableView& table, const LineMotion& motion, double delta,
                  LineSums* sums) {
    sums->cost = 0;
    for (double& value : sums->hessian) {
      value = 0;
    }
    for (double& value : sums->right_side) {
      value = 0;
    }
    for (std::size_t part = 0; part < kParts; ++part) {
      Sums of;
      clear(&of);
      sumPart<with_equations>(table, part, motion, delta, &of);
      sums->cost += Vectors::sum(of.cost);
      for (int i = 0; with_equations && i < 21; ++i) {
        sums->hessian[i] += Vectors::sum(of.hessian[i]);
      }
      for (int i = 0; with_equations && i < 6; ++i) {
        sums->right_side[i] -= Vectors::sum(of.pull[i]);
      }
    }
  }

 private:
  using Vector = typename Vectors::Vector;

  using Bits = decltype(Vector{} < Vector{});

  static constexpr std::size_t kParts = kLineLanes * sizeof(double) / sizeof(Vector);

  static constexpr std::size_t kWidth = sizeof(Vector) / sizeof(double);

  /// Of the first or the second points.
  struct Columns {
    Columns(const LineTableView& table, int end)
        : x(table.columns[end == 0 ? kPoint1X : kPoint2X]),
          y(table.columns[end == 0 ? kPoint1Y : kPoint2Y]),
          z(table.columns[end == 0 ? kPoint1Z : kPoint2Z]),
          normal_x(table.columns[kNormalX]),
          normal_y(table.columns[kNormalY]),
          normal_z(table.columns[kNormalZ]),
          residual(table.columns[end == 0 ? kResidual1 : kResidual2]) {}

    const double *x, *y, *z;
    const double *normal_x, *normal_y, *normal_z;
    double* residual;
  };

  static void load(const double* values, Vector* vector) {
    __builtin_memcpy(vector, values, sizeof(*vector));
  }

  static Vector absolute(const Vector& value) {
    constexpr long long kAllButSign = 0x7fffffffffffffff;
    return reinterpret_cast<Vector>(reinterpret_cast<Bits>(value) & kAllButSign);
  }

  struct Sums {
    Vector cost;
    Vector hessian[21];
    Vector pull[6];
  };

  /// Points whose derivatives are kept at a time, in vectors; they stay in the first cache.
  static constexpr std::size_t kBlock = 64;

  /// Of one block, in fractions of z: J = (c, p) / z.
  struct Derivatives {
    Vector c0[kBlock], c1[kBlock], c2[kBlock];  ///< Y x p
    Vector p0[kBlock], p1[kBlock], p2[kBlock];  ///< n - e (0, 0, 1)
    Vector product[kBlock];                     ///< n . Y = e z
    Vector weight[kBlock];                      ///< w / z^2
  };

  static void clear(Sums* sums) {
    sums->cost = Vector{};
    for (int i = 0; i < 21; ++i) {
      sums->hessian[i] = Vector{};
    }
    for (int i = 0; i < 6; ++i) {
      sums->pull[i] = Vector{};
    }
  }

  /// All first points, then all second ones.
  template <bool with_equations>
  static void sumPart(const LineTableView& table, std::size_t part, const LineMotion& motion,
                      double delta, Sums* sums) {
    Derivatives block;
    std::size_t filled = 0;
    const std::size_t count = table.rows / kLineLanes;
    for (int end = 0; end < 2; ++end) {
      const Columns columns(table, end);
      std::size_t size = 0;
      for (std::size_t begin = 0; begin < count; begin += size) {
        const std::size_t room = kBlock - filled;
        size = count - begin < room ? count - begin : room;
        derive<with_equations>(columns, begin, size, part, motion, delta, filled, &block,
                               &sums->cost);
        filled += size;
        if (filled == kBlock) {
          addProducts<with_equations>(block, filled, sums);
          filled = 0;
        }
      }
    }
    addProducts<with_equations>(block, filled, sums);
  }

  /// Residuals and cost of `size` vectors of points, and what their equations take, from place
  /// `first` of the block.
  template <bool with_equations>
  static void derive(const Columns& columns, std::size_t begin, std::size_t size, std::size_t part,
                     const LineMotion& motion, double delta, std::size_t first, Derivatives* block,
                     Vector* cost_sum) {
    const double* const r = motion.rotation;
    const double* const t = motion.translation;
    const Vector limit = Vector{} + delta;
    Vector cost = *cost_sum;
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t row = (begin + i) * kLineLanes + part * kWidth;
      Vector px, py, pz, nx, ny, nz;
      load(columns.x + row, &px);
      load(columns.y + row, &py);
      load(columns.z + row, &pz);
      const Vector x = (r[0] * px + r[1] * py) + (r[2] * pz + t[0]);
      const Vector y = (r[3] * px + r[4] * py) + (r[5] * pz + t[1]);
      const Vector z = (r[6] * px + r[7] * py) + (r[8] * pz + t[2]);
      load(columns.normal_x + row, &nx);
      load(columns.normal_y + row, &ny);
      load(columns.normal_z + row, &nz);
      const Vector a = (nx * x + ny * y) + nz * z;
      const Vector inverse = 1.0 / z;
      const Vector e = a * inverse;
      __builtin_memcpy(columns.residual + row, &e, sizeof(e));
      const Vector size_e = absolute(e);
      const Vector inner = size_e > limit ? limit : size_e;
      cost += inner * (2.0 * size_e - inner);
      if (with_equations) {
        const std::size_t place = first + i;
        const Vector p2 = nz - e;
        block->p0[place] = nx;
        block->p1[place] = ny;
        block->p2[place] = p2;
        block->c0[place] = y * p2 - z * ny;
        block->c1[place] = z * nx - x * p2;
        block->c2[place] = x * ny - y * nx;
        block->product[place] = a;
        block->weight[place] = inverse * inverse * (delta / (size_e > limit ? size_e : limit));
      }
    }
    *cost_sum = cost;
  }

  template <bool with_equations>
  static void addProducts(const Derivatives& block, std::size_t size, Sums* sums) {
    if (with_equations) {
      addRotations(block, size, sums);
      addMixed(block, size, sums);
      addTranslations(block, size, sums);
    }
  }

  // Rows of the upper triangle, in loops so small that their sums stay in registers.

  static void addRotations(const Derivatives& block, std::size_t size, Sums* sums) {
    Vector h0 = sums->hessian[0], h1 = sums->hessian[1], h2 = sums->hessian[2];
    Vector h3 = sums->hessian[3], h4 = sums->hessian[4], h5 = sums->hessian[5];
    Vector h6 = sums->hessian[6], h7 = sums->hessian[7], h8 = sums->hessian[8];
    Vector h9 = sums->hessian[9], h10 = sums->hessian[10];
    Vector pull0 = sums->pull[0], pull1 = sums->pull[1];
    for (std::size_t i = 0; i < size; ++i) {
      const Vector weight = block.weight[i];
      const Vector c0 = weight * block.c0[i];
      const Vector c1 = weight * block.c1[i];
      h0 += c0 * block.c0[i];
      h1 += c0 * block.c1[i];
      h2 += c0 * block.c2[i];
      h3 += c0 * block.p0[i];
      h4 += c0 * block.p1[i];
      h5 += c0 * block.p2[i];
      pull0 += c0 * block.product[i];
      h6 += c1 * block.c1[i];
      h7 += c1 * block.c2[i];
      h8 += c1 * block.p0[i];
      h9 += c1 * block.p1[i];
      h10 += c1 * block.p2[i];
      pull1 += c1 * block.product[i];
    }
    const Vector sum[] = {h0, h1, h2, h3, h4, h5, h6, h7, h8, h9, h10};
    for (int i = 0; i < 11; ++i) {
      sums->hessian[i] = sum[i];
    }
    sums->pull[0] = pull0;
    sums->pull[1] = pull1;
  }

  static void addMixed(const Derivatives& block, std::size_t size, Sums* sums) {
    Vector h11 = sums->hessian[11], h12 = sums->hessian[12], h13 = sums->hessian[13];
    Vector h14 = sums->hessian[14], h15 = sums->hessian[15], h16 = sums->hessian[16];
    Vector h17 = sums->hessian[17];
    Vector pull2 = sums->pull[2], pull3 = sums->pull[3];
    for (std::size_t i = 0; i < size; ++i) {
      const Vector weight = block.weight[i];
      const Vector c2 = weight * block.c2[i];
      const Vector p0 = weight * block.p0[i];
      h11 += c2 * block.c2[i];
      h12 += c2 * block.p0[i];
      h13 += c2 * block.p1[i];
      h14 += c2 * block.p2[i];
      pull2 += c2 * block.product[i];
      h15 += p0 * block.p0[i];
      h16 += p0 * block.p1[i];
      h17 += p0 * block.p2[i];
      pull3 += p0 * block.product[i];
    }
    const Vector sum[] = {h11, h12, h13, h14, h15, h16, h17};
    for (int i = 0; i < 7; ++i) {
      sums->hessian[11 + i] = sum[i];
    }
    sums->pull[2] = pull2;
    sums->pull[3] = pull3;
  }

  static void addTranslations(const Derivatives& block, std::size_t size, Sums* sums) {
    Vector h18 = sums->hessian[18], h19 = sums->hessian[19], h20 = sums->hessian[20];
    Vector pull4 = sums->pull[4], pull5 = sums->pull[5];
    for (std::size_t i = 0; i < size; ++i) {
      const Vector weight = block.weight[i];
      const Vector p1 = weight * block.p1[i];
      const Vector p2 = weight * block.p2[i];
      h18 += p1 * block.p1[i];
      h19 += p1 * block.p2[i];
      pull4 += p1 * block.product[i];
      h20 += p2 * block.p2[i];
      pull5 += p2 * block.product[i];
    }
    sums->hessian[18] = h18;
    sums->hessian[19] = h19;
    sums->hessian[20] = h20;
    sums->pull[4] = pull4;
    sums->pull[5] = pull5;
  }
};

}  // namespace

}  // namespace evolin
