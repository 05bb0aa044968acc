// Finds the verb, runs it, and turns what goes wrong into a message and an exit status.
#include "command.h"

#include <algorithm>
#include <boost/program_options/errors.hpp>
#include <exception>
#include <iostream>

#include "evolin_ros/base/parameters.h"
#include "evolin_ros/base/version.h"

namespace evolin::cli {

namespace {

void printHelp(const std::vector<Command>& commands) {
  std::size_t width = 0;
  for (const Command& command : commands) {
    width = std::max(width, command.name.size());
  }
  std::cout << "Measures line-feature SLAM front-ends.\n\n"
               "Usage: evolin VERB [OPTIONS]\n\n"
               "Verbs:\n";
  for (const Command& command : commands) {
    std::cout << "  " << command.name << std::string(width - command.name.size() + 2, ' ')
              << command.summary << '\n';
  }
  std::cout << "\nevolin VERB --help tells a verb's options; evolin --version the version.\n"
               "Exit status: 0 done, 1 the data or the run failed, 2 wrong use, 130 interrupted.\n";
}

const Command& findCommand(const std::vector<Command>& commands, const std::string& name) {
  std::vector<std::string> names;
  for (const Command& command : commands) {
    if (command.name == name) {
      return command;
    }
    names.push_back(command.name);
  }
  throw UsageError("unknown verb '" + name + "'; did you mean '" + nearestWord(name, names) +
                   "'? (evolin --help lists all)");
}

int runChecked(const std::vector<Command>& commands, const std::vector<std::string>& arguments) {
  std::string head = "evolin";
  try {
    if (arguments.empty() || arguments[0] == "--help" || arguments[0] == "-h") {
      printHelp(commands);
      return kExitDone;
    }
    if (arguments[0] == "--version") {
      std::cout << programVersion() << '\n';
      return kExitDone;
    }
    const Command& command = findCommand(commands, arguments[0]);
    head += " " + command.name;
    return command.run({arguments.begin() + 1, arguments.end()});
  } catch (const UsageError& error) {
    std::cerr << head << ": " << error.what() << '\n';
    return kExitWrongUse;
  } catch (const boost::program_options::error& error) {
    std::cerr << head << ": " << error.what() << '\n';
    return kExitWrongUse;
  } catch (const Interrupted& error) {
    std::cerr << head << ": " << error.what() << '\n';
    return kExitInterrupted;
  } catch (const std::exception& error) {
    std::cerr << head << ": " << error.what() << '\n';
    return kExitFailed;
  }
}

}  // namespace

int runProgram(const std::vector<Command>& commands, const std::vector<std::string>& arguments) {
  const int status = runChecked(commands, arguments);
  std::cout.flush();
  if (!std::cout && status == kExitDone) {
    std::cerr << "evolin: cannot write to standard output\n";
    return kExitFailed;
  }
  return status;
}

}  // namespace evolin::cli
