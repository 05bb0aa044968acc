// The verb `benchmark`: a matrix of methods and sequences.
#pragma once

#include "command.h"

namespace evolin::cli {

Command benchmarkCommand();

}  // namespace evolin::cli
