// The loops for processors with AVX2, for which this file alone is compiled.
#include "lbd_rows.h"
#include "lbd_rows_kernel.h"

#ifdef __AVX2__
#include <immintrin.h>
#endif

namespace evolin::wide {

namespace {

#ifdef __AVX2__
// By name where the compiler makes more instructions of an expression than there need be.
struct EightFloats {
  using Float = __m256;
  using Int __attribute__((vector_size(32))) = std::int32_t;

  // Four pairs that do not wait for each other. The processor's own gathering takes longer.
  static Int gather(const std::int32_t* pixels, const std::uint32_t* places) {
    const __m128i first = _mm_unpacklo_epi64(pair(pixels, places), pair(pixels, places + 2));
    const __m128i second = _mm_unpacklo_epi64(pair(pixels, places + 4), pair(pixels, places + 6));
    return reinterpret_cast<Int>(_mm256_set_m128i(second, first));
  }
  static Int lowerHalves(const Int& words) {
    return reinterpret_cast<Int>(
        _mm256_madd_epi16(reinterpret_cast<__m256i>(words), _mm256_set1_epi32(1)));
  }
  static Float positive(const Float& values) { return _mm256_max_ps(values, Float{}); }
  static Float negative(const Float& values) { return _mm256_min_ps(values, Float{}); }

 private:
  static __m128i pair(const std::int32_t* pixels, const std::uint32_t* places) {
    return _mm_insert_epi32(_mm_cvtsi32_si128(pixels[places[0]]), pixels[places[1]], 1);
  }
};
using Widest = EightFloats;
#else
using Widest = FourFloats;
#endif

}  // namespace

void sumLbdRows(const LbdGradientView& gradient, const LbdSupport& support, bool clamped,
                LbdRowSums* sums) {
  clamped ? LbdLoops<Widest>::sum<true>(gradient, support, sums)
          : LbdLoops<Widest>::sum<false>(gradient, support, sums);
}

}  // namespace evolin::wide
