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
    Sums of_part[kParts] = {};
    for (std::size_t part = 0; part < kParts; ++part) {
      for (int end = 0; end < 2; ++end) {
        sumPoints<with_equations>(Columns(table, end), table.rows / kLineLanes, part, motion, delta,
                                  &of_part[part]);
      }
    }
    sums->cost = 0;
    for (double& value : sums->hessian) {
      value = 0;
    }
    for (double& value : sums->right_side) {
      value = 0;
    }
    for (const Sums& of : of_part) {
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
  static constexpr std::size_t kBlock = 32;

  /// Of one block, in fractions of z: J = (c, p) / z.
  struct Derivatives {
    Vector c0[kBlock], c1[kBlock], c2[kBlock];  ///< Y x p
    Vector p0[kBlock], p1[kBlock], p2[kBlock];  ///< n - e (0, 0, 1)
    Vector product[kBlock];                     ///< n . Y = e z
    Vector weight[kBlock];                      ///< w / z^2
  };

  template <bool with_equations>
  static void sumPoints(const Columns& columns, std::size_t count, std::size_t part,
                        const LineMotion& motion, double delta, Sums* sums) {
    Derivatives block;
    std::size_t size = 0;
    for (std::size_t begin = 0; begin < count; begin += size) {
      size = count - begin < kBlock ? count - begin : kBlock;
      derive<with_equations>(columns, begin, size, part, motion, delta, &block, sums);
      if (with_equations) {
        addRotations(block, size, sums);
        addTranslations(block, size, sums);
      }
    }
  }

  /// Residuals and cost of a block, and what its equations take.
  template <bool with_equations>
  static void derive(const Columns& columns, std::size_t begin, std::size_t size, std::size_t part,
                     const LineMotion& motion, double delta, Derivatives* block, Sums* sums) {
    const double* const r = motion.rotation;
    const double* const t = motion.translation;
    const Vector limit = Vector{} + delta;
    Vector cost = sums->cost;
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
        const Vector p2 = nz - e;
        block->p0[i] = nx;
        block->p1[i] = ny;
        block->p2[i] = p2;
        block->c0[i] = y * p2 - z * ny;
        block->c1[i] = z * nx - x * p2;
        block->c2[i] = x * ny - y * nx;
        block->product[i] = a;
        block->weight[i] = inverse * inverse * (delta / (size_e > limit ? size_e : limit));
      }
    }
    sums->cost = cost;
  }

  /// The upper triangle's first rows; in two loops, so that the sums stay in registers.
  static void addRotations(const Derivatives& block, std::size_t size, Sums* sums) {
    Sums s = *sums;
    for (std::size_t i = 0; i < size; ++i) {
      const Vector weight = block.weight[i];
      const Vector c0 = weight * block.c0[i];
      const Vector c1 = weight * block.c1[i];
      s.hessian[0] += c0 * block.c0[i];
      s.hessian[1] += c0 * block.c1[i];
      s.hessian[2] += c0 * block.c2[i];
      s.hessian[3] += c0 * block.p0[i];
      s.hessian[4] += c0 * block.p1[i];
      s.hessian[5] += c0 * block.p2[i];
      s.pull[0] += c0 * block.product[i];
      s.hessian[6] += c1 * block.c1[i];
      s.hessian[7] += c1 * block.c2[i];
      s.hessian[8] += c1 * block.p0[i];
      s.hessian[9] += c1 * block.p1[i];
      s.hessian[10] += c1 * block.p2[i];
      s.pull[1] += c1 * block.product[i];
    }
    *sums = s;
  }

  static void addTranslations(const Derivatives& block, std::size_t size, Sums* sums) {
    Sums s = *sums;
    for (std::size_t i = 0; i < size; ++i) {
      const Vector weight = block.weight[i];
      const Vector c2 = weight * block.c2[i];
      s.hessian[11] += c2 * block.c2[i];
      s.hessian[12] += c2 * block.p0[i];
      s.hessian[13] += c2 * block.p1[i];
      s.hessian[14] += c2 * block.p2[i];
      s.pull[2] += c2 * block.product[i];
      const Vector p0 = weight * block.p0[i];
      s.hessian[15] += p0 * block.p0[i];
      s.hessian[16] += p0 * block.p1[i];
      s.hessian[17] += p0 * block.p2[i];
      s.pull[3] += p0 * block.product[i];
      const Vector p1 = weight * block.p1[i];
      s.hessian[18] += p1 * block.p1[i];
      s.hessian[19] += p1 * block.p2[i];
      s.pull[4] += p1 * block.product[i];
      const Vector p2 = weight * block.p2[i];
      s.hessian[20] += p2 * block.p2[i];
      s.pull[5] += p2 * block.product[i];
    }
    *sums = s;
  }
};

}  // namespace

}  // namespace evolin
