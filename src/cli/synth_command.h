// The verb `synth`: the built-in synthetic sequence as a folder or a bag.
#pragma once

#include "command.h"

namespace evolin::cli {

Command synthCommand();

}  // namespace evolin::cli
