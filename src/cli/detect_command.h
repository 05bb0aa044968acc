// The verb `detect`: the lines of a recording as files.
#pragma once

#include "command.h"

namespace evolin::cli {

Command detectCommand();

}  // namespace evolin::cli
