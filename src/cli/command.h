// The verbs of the program `evolin` and how one of them is run.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "evolin_ros/base/error.h"

namespace evolin::cli {

/// Exit statuses, as COMMANDS and every `--help` state them.
constexpr int kExitDone = 0;
constexpr int kExitFailed = 1;
constexpr int kExitWrongUse = 2;
constexpr int kExitInterrupted = 130;

/// The arguments make no sense: exit status 2.
class UsageError : public Error {
 public:
  using Error::Error;
};

/// The user stopped the run: exit status 130.
class Interrupted : public Error {
 public:
  using Error::Error;
};

/// A verb. `run` takes the arguments behind the verb ("--help" among them, which it answers itself)
/// and returns the exit status; results go to standard output, progress to standard error. What it
/// throws becomes "evolin NAME: message" on standard error and the exit status above.
struct Command {
  std::string name;
  std::string summary;  ///< one line for the list of verbs, no full stop
  std::function<int(const std::vector<std::string>& arguments)> run;
};

/// The whole program on `arguments` (without the program's own name): finds the verb, runs it,
/// reports errors. Returns the exit status; throws nothing.
int runProgram(const std::vector<Command>& commands, const std::vector<std::string>& arguments);

}  // namespace evolin::cli
