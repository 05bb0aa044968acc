// The verb `render`: pictures of what a run found, frame by frame.
#pragma once

#include "command.h"

namespace evolin::cli {

Command renderCommand();

}  // namespace evolin::cli
