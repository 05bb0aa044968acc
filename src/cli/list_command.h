// The verb `list`: what is available here, and why something is not.
#pragma once

#include "command.h"

namespace evolin::cli {

Command listCommand();

}  // namespace evolin::cli
