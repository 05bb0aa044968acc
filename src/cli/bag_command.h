// The verb `bag`: a dataset folder becomes a bag.
#pragma once

#include "command.h"

namespace evolin::cli {

Command bagCommand();

}  // namespace evolin::cli
