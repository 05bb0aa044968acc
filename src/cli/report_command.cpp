// `evolin report` hands over to Python.
#include "report_command.h"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <system_error>

#include "package_files.h"

namespace evolin::cli {

namespace {

/// That of the system has the system's numpy and matplotlib, whatever comes first in PATH.
std::string pythonProgram() {
  if (const char* chosen = std::getenv("EVOLIN_PYTHON"); chosen != nullptr && *chosen != '\0') {
    return chosen;
  }
  const char* system = "/usr/bin/python3";
  return access(system, X_OK) == 0 ? system : "python3";
}

int runReport(const std::vector<std::string>& arguments) {
  const std::filesystem::path program = packageFolder() / "python" / "evolin_report";
  if (!std::filesystem::exists(program / "__main__.py")) {
    throw Error(program.string() + ": not there; is the package installed as a whole?");
  }
  // -B: what is installed may belong to somebody else.
  std::vector<std::string> words = {pythonProgram(), "-B", program.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  pointers.reserve(words.size() + 1);
  for (std::string& word : words) {
    pointers.push_back(word.data());
  }
  pointers.push_back(nullptr);
  std::cout.flush();
  execvp(pointers.front(), pointers.data());
  throw Error(words.front() + " cannot be started (" + std::generic_category().message(errno) +
              "): reports need Python 3.8 or newer with numpy and matplotlib (packages python3, "
              "python3-numpy, python3-matplotlib); EVOLIN_PYTHON names another one");
}

}  // namespace

Command reportCommand() {
  return {"report", "tables, plots and pages from result directories", runReport};
}

}  // namespace evolin::cli
