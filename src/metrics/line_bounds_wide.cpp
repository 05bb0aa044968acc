// The loops for processors with AVX2 and FMA, for which this file alone is compiled.
#include "line_bounds.h"
#include "line_bounds_kernel.h"

#ifdef __AVX2__
#include <immintrin.h>
#endif

namespace evolin::wide {

namespace {

#ifdef __AVX2__
// By name where the compiler makes more instructions of an expression than there need be.
struct EightLines {
  using Float = __m256;
  using Int __attribute__((vector_size(32))) = std::int32_t;

  static Float smaller(const Float& a, const Float& b) { return _mm256_min_ps(a, b); }
  static Float larger(const Float& a, const Float& b) { return _mm256_max_ps(a, b); }
  static unsigned bits(const Int& mask) {
    return static_cast<unsigned>(_mm256_movemask_ps(reinterpret_cast<__m256>(mask)));
  }
};
using Widest = EightLines;
#else
using Widest = FourLines;
#endif

}  // namespace

std::size_t findCandidates(LineBound kind, const BlockedLines& lines, const BoundQuestion& question,
                           const BoundSpace& space) {
  return findCandidatesWith<Widest>(kind, lines, question, space);
}

}  // namespace evolin::wide
