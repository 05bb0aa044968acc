// The loops for processors with AVX-512, for which this file alone is compiled.
#include "lbd_rows.h"
#include "lbd_rows_kernel.h"

#ifdef __AVX512BW__
#include <immintrin.h>
#endif

namespace evolin::widest {

namespace {

#ifdef __AVX512BW__
// See EightFloats in lbd_rows_wide.cpp. With masks that take every value: GCC 12 warns of its own
// header where there are none.
struct SixteenFloats {
  using Float = __m512;
  using Int __attribute__((vector_size(64))) = std::int32_t;

  static constexpr std::uint16_t kEvery = 0xFFFF;

  static Int gather(const std::int32_t* pixels, const std::uint32_t* places) {
    return reinterpret_cast<Int>(_mm512_maskz_inserti64x4(
        0xFF, _mm512_castsi256_si512(eight(pixels, places)), eight(pixels, places + 8), 1));
  }
  static Int lowerHalves(const Int& words) {
    return reinterpret_cast<Int>(
        _mm512_madd_epi16(reinterpret_cast<__m512i>(words), _mm512_set1_epi32(1)));
  }
  static Float positive(const Float& values) {
    return _mm512_maskz_max_ps(kEvery, values, Float{});
  }
  static Float negative(const Float& values) {
    return _mm512_maskz_min_ps(kEvery, values, Float{});
  }

 private:
  static __m256i eight(const std::int32_t* pixels, const std::uint32_t* places) {
    const __m128i first = _mm_unpacklo_epi64(pair(pixels, places), pair(pixels, places + 2));
    const __m128i second = _mm_unpacklo_epi64(pair(pixels, places + 4), pair(pixels, places + 6));
    return _mm256_set_m128i(second, first);
  }
  static __m128i pair(const std::int32_t* pixels, const std::uint32_t* places) {
    return _mm_insert_epi32(_mm_cvtsi32_si128(pixels[places[0]]), pixels[places[1]], 1);
  }
};
using Widest = SixteenFloats;
#else
using Widest = FourFloats;
#endif

}  // namespace

void sumLbdRows(const LbdGradientView& gradient, const LbdSupport& support, bool clamped,
                LbdRowSums* sums) {
  clamped ? LbdLoops<Widest>::sum<true>(gradient, support, sums)
          : LbdLoops<Widest>::sum<false>(gradient, support, sums);
}

}  // namespace evolin::widest
