// Where and when a report came about.
#pragma once

#include "evolin_ros/evaluation/report.h"

namespace evolin {

/// Adds "machine" (processor, threads, system, architecture) and "written" (local time) to the
/// report's provenance.
void addMachine(Report* report);

/// Local time by strftime's rules, at most 63 bytes.
std::string localTime(const char* format);

}  // namespace evolin
