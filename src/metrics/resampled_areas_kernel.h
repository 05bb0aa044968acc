// The loop of resampleAreas(), for files that are compiled for different processors. Everything has
// internal linkage and nothing of the standard library is used: the linker must not take one
// file's copy of a function for the other's.
#pragma once

#include "resampled_areas.h"

namespace evolin {

namespace {

struct TwoSettings {
  using Double __attribute__((vector_size(16))) = double;
  using Bits __attribute__((vector_size(16))) = long long;
};
struct FourSettings {
  using Double __attribute__((vector_size(32))) = double;
  using Bits __attribute__((vector_size(32))) = long long;
};

/// All bits of a setting's word where the setting's bit is set.
struct HitMasks {
  static constexpr std::size_t kPatterns = std::size_t{1} << kAreaSettings;

  alignas(64) long long words[kPatterns][kAreaSettings];

  constexpr HitMasks() : words() {
    for (std::size_t pattern = 0; pattern < kPatterns; ++pattern) {
      for (std::size_t setting = 0; setting < kAreaSettings; ++setting) {
        words[pattern][setting] = ((pattern >> setting) & 1U) != 0 ? -1 : 0;
      }
    }
  }
};

constexpr HitMasks kHitMasks;

template <class Vectors>
void sumAreas(const ScoreRanking::Entry* entries, std::size_t count, unsigned shift,
              const FrameWeight* weights, const double* steps, ResampledAreas* areas) {
  using Double = typename Vectors::Double;
  using Bits = typename Vectors::Bits;
  constexpr std::size_t kWidth = sizeof(Double) / sizeof(double);
  constexpr std::size_t kVectors = kAreaSettings / kWidth;
  Double losses[kVectors] = {};
  Double misses[kVectors] = {};
  const double* step = steps;
  double before = *step;
  for (std::size_t i = 0; i < count; ++i) {
    const FrameWeight& frame = weights[entries[i].frame];
    const long long* const mask =
        kHitMasks.words[(entries[i].hits >> shift) & (HitMasks::kPatterns - 1)];
    step += frame.copies;
    const double length = *step - before;
    before = *step;
    const Bits weight = reinterpret_cast<Bits>(frame.weight - Double{});  // in every lane
    for (std::size_t v = 0; v < kVectors; ++v) {
      Bits hit;
      __builtin_memcpy(&hit, mask + v * kWidth, sizeof(hit));
      const Bits all_misses = reinterpret_cast<Bits>(misses[v]);
      losses[v] += reinterpret_cast<Double>(all_misses & hit) * length;
      misses[v] += reinterpret_cast<Double>(weight & ~hit);
    }
  }
  __builtin_memcpy(areas->losses, losses, sizeof(losses));
  __builtin_memcpy(areas->misses, misses, sizeof(misses));
}

}  // namespace

}  // namespace evolin
