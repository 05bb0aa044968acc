// The verb `report`: tables, plots and pages from result directories.
#pragma once

#include "command.h"

namespace evolin::cli {

/// Becomes the Python program python/evolin_report of the package, whose exit status is then this
/// program's.
Command reportCommand();

}  // namespace evolin::cli
