// The program `evolin`: the list of its verbs.
#include <cstdlib>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "associate_command.h"
#include "bag_command.h"
#include "benchmark_command.h"
#include "command.h"
#include "detect_command.h"
#include "evaluate_command.h"
#include "list_command.h"
#include "models_command.h"
#include "render_command.h"
#include "report_command.h"
#include "run_command.h"
#include "synth_command.h"
#include "validate_command.h"

namespace {

/// Images come and go with every frame: handing their memory back to the system and taking it
/// again, page by page, costs as much as the work on them.
void keepFreedMemory() {
#ifdef __GLIBC__
  constexpr int kMegabyte = 1 << 20;
  mallopt(M_MMAP_THRESHOLD, 32 * kMegabyte);
  mallopt(M_TRIM_THRESHOLD, 512 * kMegabyte);
#endif
}

}  // namespace

int main(int argc, char** argv) {
  keepFreedMemory();
  const std::vector<evolin::cli::Command> commands = {
      evolin::cli::associateCommand(), evolin::cli::bagCommand(),
      evolin::cli::benchmarkCommand(), evolin::cli::detectCommand(),
      evolin::cli::evaluateCommand(),  evolin::cli::listCommand(),
      evolin::cli::modelsCommand(),    evolin::cli::renderCommand(),
      evolin::cli::reportCommand(),    evolin::cli::runCommand(),
      evolin::cli::synthCommand(),     evolin::cli::validateCommand(),
  };
  return evolin::cli::runProgram(commands, {argv + 1, argv + argc});
}
