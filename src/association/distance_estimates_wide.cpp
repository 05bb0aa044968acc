// The loops for processors with AVX2 and FMA, for which this file alone is compiled.
#include "distance_estimates.h"
#include "distance_estimates_kernel.h"

#ifdef __AVX2__
#include <immintrin.h>
#endif

namespace evolin::wide {

namespace {

#ifdef __AVX2__
struct EightColumns {
  using Float __attribute__((vector_size(32))) = float;
  using Int __attribute__((vector_size(32))) = std::int32_t;

  static bool any(const Int& mask) {
    return _mm256_movemask_ps(reinterpret_cast<__m256>(mask)) != 0;
  }
};
using Widest = EightColumns;
#else
using Widest = FourColumns;
#endif

}  // namespace

EstimateFunctions estimateFunctions() { return functionsFor<Widest>(); }

}  // namespace evolin::wide
