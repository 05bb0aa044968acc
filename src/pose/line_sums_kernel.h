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
      sumPart(table, part, motion, delta, &of);
      sums->cost += Vectors::sum(of.cost);
      for (int i = 0; i < 21; ++i) {
        sums->hessian[i] += Vectors::sum(of.hessian[i]);
      }
      for (int i = 0; i < 6; ++i) {
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

  /// Rows whose derivatives are kept at a time, in vectors; they stay in the first cache.
  static constexpr std::size_t kBlock = 32;

  /// Of one of the two points of a row, in fractions of z: J = (c, p) / z, p = n - e (0, 0, 1).
  struct OfPoint {
    Vector c0[kBlock], c1[kBlock], c2[kBlock];  ///< Y x p
    Vector p2[kBlock];
    Vector product[kBlock];  ///< n . Y = e z
    Vector weight[kBlock];   ///< w / z^2
  };

  struct Block {
    OfPoint points[2];
    /// Weighted sums over the two points.
    Vector c0[kBlock], c1[kBlock];
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

  static void sumPart(const LineTableView& table, std::size_t part, const LineMotion& motion,
                      double delta, Sums* sums) {
    Block block;
    const std::size_t count = table.rows / kLineLanes;
    for (std::size_t begin = 0; begin < count; begin += kBlock) {
      const std::size_t size = count - begin < kBlock ? count - begin : kBlock;
      const std::size_t offset = begin * kLineLanes + part * kWidth;
      derive(table, offset, size, motion, delta, &block, &sums->cost);
      const double* const normal_x = table.columns[kNormalX] + offset;
      const double* const normal_y = table.columns[kNormalY] + offset;
      addRotations(size, &block, sums);
      addMixed(block, normal_x, normal_y, size, sums);
      addTranslations(block, normal_x, normal_y, size, sums);
    }
  }

  static void derive(const LineTableView& table, std::size_t offset, std::size_t size,
                     const LineMotion& motion, double delta, Block* block, Vector* cost_sum) {
    const Columns columns[2] = {Columns(table, 0), Columns(table, 1)};
    const double* const r = motion.rotation;
    const double* const t = motion.translation;
    const Vector limit = Vector{} + delta;
    Vector cost = *cost_sum;
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t row = offset + i * kLineLanes;
      Vector nx, ny, nz;
      load(columns[0].normal_x + row, &nx);
      load(columns[0].normal_y + row, &ny);
      load(columns[0].normal_z + row, &nz);
      for (int end = 0; end < 2; ++end) {
        Vector px, py, pz;
        load(columns[end].x + row, &px);
        load(columns[end].y + row, &py);
        load(columns[end].z + row, &pz);
        const Vector x = (r[0] * px + r[1] * py) + (r[2] * pz + t[0]);
        const Vector y = (r[3] * px + r[4] * py) + (r[5] * pz + t[1]);
        const Vector z = (r[6] * px + r[7] * py) + (r[8] * pz + t[2]);
        const Vector a = (nx * x + ny * y) + nz * z;
        // One division: 1 / z and the weight both come of 1 / (z max(|a|, delta |z|)).
        const Vector size_a = absolute(a);
        const Vector bound = limit * absolute(z);
        const Vector larger = size_a > bound ? size_a : bound;
        const Vector quotient = 1.0 / (z * larger);
        const Vector e = a * (quotient * larger);
        __builtin_memcpy(columns[end].residual + row, &e, sizeof(e));
        const Vector size_e = absolute(e);
        const Vector inner = size_e > limit ? limit : size_e;
        cost += inner * ((size_e - inner) + size_e);
        OfPoint& point = block->points[end];
        const Vector p2 = nz - e;
        point.p2[i] = p2;
        point.c0[i] = y * p2 - z * ny;
        point.c1[i] = z * nx - x * p2;
        point.c2[i] = x * ny - y * nx;
        point.product[i] = a;
        point.weight[i] = limit * absolute(quotient);
      }
    }
    *cost_sum = cost;
  }

  // The products, in loops so small that their sums stay in registers.

  static void addRotations(std::size_t size, Block* block, Sums* sums) {
    Vector h0 = sums->hessian[0], h1 = sums->hessian[1], h2 = sums->hessian[2];
    Vector h5 = sums->hessian[5], h6 = sums->hessian[6], h7 = sums->hessian[7];
    Vector h10 = sums->hessian[10];
    Vector pull0 = sums->pull[0], pull1 = sums->pull[1];
    const OfPoint& f = block->points[0];
    const OfPoint& s = block->points[1];
    for (std::size_t i = 0; i < size; ++i) {
      const Vector f0 = f.weight[i] * f.c0[i];
      const Vector f1 = f.weight[i] * f.c1[i];
      h0 += f0 * f.c0[i];
      h1 += f0 * f.c1[i];
      h2 += f0 * f.c2[i];
      h5 += f0 * f.p2[i];
      pull0 += f0 * f.product[i];
      h6 += f1 * f.c1[i];
      h7 += f1 * f.c2[i];
      h10 += f1 * f.p2[i];
      pull1 += f1 * f.product[i];
      const Vector s0 = s.weight[i] * s.c0[i];
      const Vector s1 = s.weight[i] * s.c1[i];
      h0 += s0 * s.c0[i];
      h1 += s0 * s.c1[i];
      h2 += s0 * s.c2[i];
      h5 += s0 * s.p2[i];
      pull0 += s0 * s.product[i];
      h6 += s1 * s.c1[i];
      h7 += s1 * s.c2[i];
      h10 += s1 * s.p2[i];
      pull1 += s1 * s.product[i];
      block->c0[i] = f0 + s0;
      block->c1[i] = f1 + s1;
    }
    sums->hessian[0] = h0;
    sums->hessian[1] = h1;
    sums->hessian[2] = h2;
    sums->hessian[5] = h5;
    sums->hessian[6] = h6;
    sums->hessian[7] = h7;
    sums->hessian[10] = h10;
    sums->pull[0] = pull0;
    sums->pull[1] = pull1;
  }

  static void addMixed(const Block& block, const double* normal_x, const double* normal_y,
                       std::size_t size, Sums* sums) {
    Vector h3 = sums->hessian[3], h4 = sums->hessian[4], h8 = sums->hessian[8];
    Vector h9 = sums->hessian[9], h12 = sums->hessian[12], h13 = sums->hessian[13];
    Vector h11 = sums->hessian[11], h14 = sums->hessian[14], pull2 = sums->pull[2];
    const OfPoint& f = block.points[0];
    const OfPoint& s = block.points[1];
    for (std::size_t i = 0; i < size; ++i) {
      Vector nx, ny;
      load(normal_x + i * kLineLanes, &nx);
      load(normal_y + i * kLineLanes, &ny);
      const Vector f2 = f.weight[i] * f.c2[i];
      const Vector s2 = s.weight[i] * s.c2[i];
      h11 += f2 * f.c2[i] + s2 * s.c2[i];
      h14 += f2 * f.p2[i] + s2 * s.p2[i];
      pull2 += f2 * f.product[i] + s2 * s.product[i];
      const Vector c2 = f2 + s2;
      h3 += nx * block.c0[i];
      h4 += ny * block.c0[i];
      h8 += nx * block.c1[i];
      h9 += ny * block.c1[i];
      h12 += nx * c2;
      h13 += ny * c2;
    }
    sums->hessian[3] = h3;
    sums->hessian[4] = h4;
    sums->hessian[8] = h8;
    sums->hessian[9] = h9;
    sums->hessian[12] = h12;
    sums->hessian[13] = h13;
    sums->hessian[11] = h11;
    sums->hessian[14] = h14;
    sums->pull[2] = pull2;
  }

  static void addTranslations(const Block& block, const double* normal_x, const double* normal_y,
                              std::size_t size, Sums* sums) {
    Vector h15 = sums->hessian[15], h16 = sums->hessian[16], h17 = sums->hessian[17];
    Vector h18 = sums->hessian[18], h19 = sums->hessian[19], h20 = sums->hessian[20];
    Vector pull3 = sums->pull[3], pull4 = sums->pull[4], pull5 = sums->pull[5];
    const OfPoint& first = block.points[0];
    const OfPoint& second = block.points[1];
    for (std::size_t i = 0; i < size; ++i) {
      Vector nx, ny;
      load(normal_x + i * kLineLanes, &nx);
      load(normal_y + i * kLineLanes, &ny);
      const Vector weights = first.weight[i] + second.weight[i];
      const Vector p2_first = first.weight[i] * first.p2[i];
      const Vector p2_second = second.weight[i] * second.p2[i];
      const Vector p2 = p2_first + p2_second;
      const Vector product =
          first.weight[i] * first.product[i] + second.weight[i] * second.product[i];
      const Vector weighted_x = weights * nx;
      h15 += weighted_x * nx;
      h16 += weighted_x * ny;
      h17 += nx * p2;
      h18 += (weights * ny) * ny;
      h19 += ny * p2;
      h20 += p2_first * first.p2[i] + p2_second * second.p2[i];
      pull3 += nx * product;
      pull4 += ny * product;
      pull5 += p2_first * first.product[i] + p2_second * second.product[i];
    }
    sums->hessian[15] = h15;
    sums->hessian[16] = h16;
    sums->hessian[17] = h17;
    sums->hessian[18] = h18;
    sums->hessian[19] = h19;
    sums->hessian[20] = h20;
    sums->pull[3] = pull3;
    sums->pull[4] = pull4;
    sums->pull[5] = pull5;
  }
};

}  // namespace

}  // namespace evolin
