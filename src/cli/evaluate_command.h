// The verb `evaluate`: one metric family on folders of files.
#pragma once

#include "command.h"

namespace evolin::cli {

Command evaluateCommand();

}  // namespace evolin::cli
