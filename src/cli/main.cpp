// The program `evolin`: the list of its verbs.
#include "associate_command.h"
#include "bag_command.h"
#include "benchmark_command.h"
#include "command.h"
#include "detect_command.h"
#include "evaluate_command.h"
#include "list_command.h"
#include "run_command.h"
#include "synth_command.h"
#include "validate_command.h"

int main(int argc, char** argv) {
  const std::vector<evolin::cli::Command> commands = {
      evolin::cli::associateCommand(), evolin::cli::bagCommand(),
      evolin::cli::benchmarkCommand(), evolin::cli::detectCommand(),
      evolin::cli::evaluateCommand(),  evolin::cli::listCommand(),
      evolin::cli::runCommand(),       evolin::cli::synthCommand(),
      evolin::cli::validateCommand(),
  };
  return evolin::cli::runProgram(commands, {argv + 1, argv + argc});
}
