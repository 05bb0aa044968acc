// The loops for processors with AVX2 and FMA, for which this file alone is compiled.
#include "line_bounds.h"
#include "line_bounds_kernel.h"

#ifdef __AVX2__
#include <immintrin.h>
#endif

namespace evolin::wide {

namespace {

#ifdef __AVX2__
/// The places of a byte's bits, rising, for every byte.
struct BitPlaces {
  std::uint8_t of[256][8] = {};

  constexpr BitPlaces() {
    for (unsigned bits = 0; bits < 256; ++bits) {
      unsigned found = 0;
      for (std::uint8_t place = 0; place < 8; ++place) {
        if (((bits >> place) & 1U) != 0) {
          of[bits][found++] = place;
        }
      }
    }
  }
};
constexpr BitPlaces kBitPlaces;

// By name where the compiler makes more instructions of an expression than there need be.
struct EightLines {
  using Float = __m256;
  using Int __attribute__((vector_size(32))) = std::int32_t;

  static Float smaller(const Float& a, const Float& b) { return _mm256_min_ps(a, b); }
  static Float larger(const Float& a, const Float& b) { return _mm256_max_ps(a, b); }
  static unsigned bits(const Int& mask) {
    return static_cast<unsigned>(_mm256_movemask_ps(reinterpret_cast<__m256>(mask)));
  }
  /// Without a branch for every bit.
  static std::size_t writePlaces(unsigned bits, std::uint32_t first, std::uint32_t* numbers) {
    const __m256i places = _mm256_cvtepu8_epi32(
        _mm_loadl_epi64(reinterpret_cast<const __m128i*>(kBitPlaces.of[bits])));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(numbers),
                        _mm256_add_epi32(places, _mm256_set1_epi32(static_cast<int>(first))));
    return static_cast<std::size_t>(__builtin_popcount(bits));
  }
};
using Widest = EightLines;
#else
using Widest = FourLines;
#endif

}  // namespace

BoundCounts findCandidates(LineBound kind, const BlockedLines& lines, const BoundQuestion& question,
                           const BoundSpace& space) {
  return findCandidatesWith<Widest>(kind, lines, question, space);
}

}  // namespace evolin::wide
