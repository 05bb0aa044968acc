// A benchmark's plan on its way from one process to another.
#pragma once

#include <string>

#include "benchmark_plan.h"

namespace evolin::cli {

std::string planToJson(const BenchmarkPlan& plan);

/// Of planToJson() alone.
BenchmarkPlan planFromJson(const std::string& text);

}  // namespace evolin::cli
