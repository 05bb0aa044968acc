// The loop of resampleAreas(), for files that are compiled for different processors. Everything has
// internal linkage and nothing of the standard library is used: the linker must not take one
// file's copy of a function for the other's.
#pragma once

#include "resampled_areas.h"

namespace evolin {

namespace {

inline void sumAreas(const RankedRuns& ranked, const std::int32_t* weights, const double* steps,
                     double* __restrict losses, double* __restrict misses) {
  for (std::size_t i = 0; i < ranked.settings * kAreaLanes; ++i) {
    losses[i] = 0;
    misses[i] = 0;
  }
  std::int32_t predictions[kAreaLanes] = {};
  double step[kAreaLanes] = {};
  std::uint32_t place = 0;
  for (std::size_t r = 0; r < ranked.count; ++r) {
    const RankedRun run = ranked.runs[r];
    std::int32_t copies[kAreaLanes] = {};
    for (; place < run.end; ++place) {
      const std::int32_t* const weight = weights + ranked.frames[place] * kAreaLanes;
      for (std::size_t lane = 0; lane < kAreaLanes; ++lane) {
        copies[lane] += weight[lane];
      }
    }
    double more[kAreaLanes];
    double length[kAreaLanes];
    for (std::size_t lane = 0; lane < kAreaLanes; ++lane) {
      predictions[lane] += copies[lane];
      more[lane] = copies[lane];
      const double before = step[lane];
      step[lane] = steps[predictions[lane]];
      length[lane] = step[lane] - before;
    }
    for (std::size_t setting = 0; setting < ranked.settings; ++setting) {
      double* __restrict const loss = losses + setting * kAreaLanes;
      double* __restrict const miss = misses + setting * kAreaLanes;
      if (((run.hits >> setting) & 1U) != 0) {
        for (std::size_t lane = 0; lane < kAreaLanes; ++lane) {
          loss[lane] += miss[lane] * length[lane];
        }
      } else {
        for (std::size_t lane = 0; lane < kAreaLanes; ++lane) {
          miss[lane] += more[lane];
        }
      }
    }
  }
}

}  // namespace

}  // namespace evolin
