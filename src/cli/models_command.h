// The verb `models`: which network files are here, and how to get the others.
#pragma once

#include "command.h"

namespace evolin::cli {

Command modelsCommand();

}  // namespace evolin::cli
