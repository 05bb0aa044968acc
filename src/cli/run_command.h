// The verb `run`: detector, associator and evaluation over a recording.
#pragma once

#include "command.h"

namespace evolin::cli {

Command runCommand();

}  // namespace evolin::cli
