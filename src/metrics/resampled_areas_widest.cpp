// The loop for processors with AVX-512, for which this file alone is compiled: the sums of sixteen
// resamples stay in registers, and verdicts are masks, as branches on them are hard to foresee.
#include "resampled_areas.h"
#include "resampled_areas_kernel.h"

#ifdef __AVX512VL__
#include <immintrin.h>
#endif

namespace evolin::widest {

#ifdef __AVX512VL__

namespace {

constexpr std::size_t kWidth = 8;  // of a register
constexpr std::size_t kParts = 2;
constexpr std::size_t kLanes = kParts * kWidth;
constexpr std::size_t kSettings = 6;  // at a time: the registers hold their sums

// GCC 12 warns of its own header where there are no masks.
constexpr __mmask8 kEvery = 0xFF;

// Places by twos and eight loads: quicker than the processor's own gather on those that this was
// measured on.
inline __m128d lookUpTwo(const double* steps, std::uint64_t places) {
  return _mm_set_pd(steps[places >> 32U], steps[places & 0xFFFFFFFFU]);
}
inline __m256d lookUpFour(const double* steps, __m128i places) {
  return _mm256_set_m128d(
      lookUpTwo(steps, static_cast<std::uint64_t>(_mm_extract_epi64(places, 1))),
      lookUpTwo(steps, static_cast<std::uint64_t>(_mm_cvtsi128_si64(places))));
}
inline __m512d lookUp(const double* steps, __m256i places) {
  return _mm512_maskz_insertf64x4(
      kEvery, _mm512_castpd256_pd512(lookUpFour(steps, _mm256_castsi256_si128(places))),
      lookUpFour(steps, _mm256_extracti128_si256(places, 1)), 1);
}

struct Sums {
  __m512d losses[kSettings][kParts];
  __m512d misses[kSettings][kParts];
};

// Of kLanes resamples and kSettings settings; `weights` begin at the first of these resamples and
// the bits of hits at `first` with the first of these settings.
inline void sumSome(const RankedRuns& ranked, std::size_t first, const std::int32_t* weights,
                    const double* steps, Sums* sums) {
  __m512d loss[kSettings][kParts] = {};
  __m512d miss[kSettings][kParts] = {};
  __m256i predictions[kParts] = {};
  __m512d step[kParts] = {};
  std::uint32_t place = 0;
  for (std::size_t r = 0; r < ranked.count; ++r) {
    const RankedRun run = ranked.runs[r];
    __m256i copies[kParts] = {};
    for (; place < run.end; ++place) {
      const std::int32_t* const weight = weights + ranked.frames[place] * kAreaLanes;
      for (std::size_t part = 0; part < kParts; ++part) {
        copies[part] = _mm256_add_epi32(
            copies[part],
            _mm256_loadu_si256(reinterpret_cast<const __m256i*>(weight + kWidth * part)));
      }
    }
    const __m256i hits = _mm256_set1_epi32(static_cast<std::int32_t>(run.hits >> first));
    for (std::size_t part = 0; part < kParts; ++part) {
      predictions[part] = _mm256_add_epi32(predictions[part], copies[part]);
      const __m512d more = _mm512_maskz_cvtepi32_pd(kEvery, copies[part]);
      const __m512d before = step[part];
      step[part] = lookUp(steps, predictions[part]);
      const __m512d length = _mm512_sub_pd(step[part], before);
      for (std::size_t k = 0; k < kSettings; ++k) {
        const __mmask8 hit = _mm256_test_epi32_mask(hits, _mm256_set1_epi32(1 << k));
        const auto missed = static_cast<__mmask8>(~hit);
        loss[k][part] = _mm512_mask_add_pd(loss[k][part], hit, loss[k][part],
                                           _mm512_mul_pd(miss[k][part], length));
        miss[k][part] = _mm512_mask_add_pd(miss[k][part], missed, miss[k][part], more);
      }
    }
  }
  for (std::size_t k = 0; k < kSettings; ++k) {
    for (std::size_t part = 0; part < kParts; ++part) {
      sums->losses[k][part] = loss[k][part];
      sums->misses[k][part] = miss[k][part];
    }
  }
}

}  // namespace

void resampleAreas(const RankedRuns& ranked, const std::int32_t* weights, const double* steps,
                   double* losses, double* misses) {
  for (std::size_t first = 0; first < ranked.settings; first += kSettings) {
    for (std::size_t lane = 0; lane < kAreaLanes; lane += kLanes) {
      Sums sums;
      sumSome(ranked, first, weights + lane, steps, &sums);
      for (std::size_t k = 0; k < kSettings && first + k < ranked.settings; ++k) {
        for (std::size_t part = 0; part < kParts; ++part) {
          const std::size_t place = (first + k) * kAreaLanes + lane + kWidth * part;
          _mm512_storeu_pd(losses + place, sums.losses[k][part]);
          _mm512_storeu_pd(misses + place, sums.misses[k][part]);
        }
      }
    }
  }
}

#else

void resampleAreas(const RankedRuns& ranked, const std::int32_t* weights, const double* steps,
                   double* losses, double* misses) {
  sumAreas(ranked, weights, steps, losses, misses);
}

#endif

}  // namespace evolin::widest
