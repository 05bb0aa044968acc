// The verb `associate`: the matches of a recording as files.
#pragma once

#include "command.h"

namespace evolin::cli {

Command associateCommand();

}  // namespace evolin::cli
