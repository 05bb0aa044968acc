// The verb `validate`: what a recording has and lacks.
#pragma once

#include "command.h"

namespace evolin::cli {

Command validateCommand();

}  // namespace evolin::cli
