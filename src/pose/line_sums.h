// Residuals and normal equations of matched lines, many at a time: the inner loop of relative pose.
#pragma once

#include <cstddef>

namespace evolin {

/// Rows of a table of matches, each an array as long as the table's capacity.
enum LineColumn {
  kPoint1X,  ///< the match's two points in the source frame, metres
  kPoint1Y,
  kPoint1Z,
  kPoint2X,
  kPoint2Y,
  kPoint2Z,
  kNormalX,  ///< the image line in the target frame, times the camera matrix: n = K^T l
  kNormalY,
  kNormalZ,
  kResidual1,  ///< l . project(T X), of the motion last summed up
  kResidual2,
  kLineColumns
};

/// What lineSums() reads and writes. The rows behind the last match, up to the next multiple of
/// kLineLanes, hold matches without a line, which add nothing.
struct LineTableView {
  double* columns[kLineColumns];
  std::size_t rows;  ///< a multiple of kLineLanes
};

constexpr std::size_t kLineLanes = 4;

/// x -> rotation x + translation; the rotation by rows.
struct LineMotion {
  double rotation[9];
  double translation[3];
};

/// Of one motion, over all points: with J the derivative of a residual e with respect to d in
/// exp(d) T, rotation first, and w its weight.
struct LineSums {
  double cost;
  double hessian[21];    ///< sum of w J^T J, its upper triangle by rows
  double right_side[6];  ///< -sum of w e J
};

/// Sums up with a Huber kernel: cost e^2 and weight 1 up to |e| = `delta` (finite, above 0), beyond
/// it cost delta (2 |e| - delta) and weight delta / |e|. Residuals go to the table. The same to the
/// last bit whatever the processor: lanes are summed apart, without fused operations.
void lineSums(const LineTableView& table, const LineMotion& motion, double delta, LineSums* sums);

namespace generic {
void lineSums(const LineTableView& table, const LineMotion& motion, double delta, LineSums* sums);
}
/// For processors with AVX2 alone, where there are such.
namespace wide {
void lineSums(const LineTableView& table, const LineMotion& motion, double delta, LineSums* sums);
}
/// For processors with AVX-512 (F, DQ, BW, VL): vectors as wide, in twice the registers.
namespace widest {
void lineSums(const LineTableView& table, const LineMotion& motion, double delta, LineSums* sums);
}

}  // namespace evolin
