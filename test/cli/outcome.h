// What a verb leaves behind when it is run inside the test: status, standard output and error.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "command.h"

namespace evolin::test {

struct Outcome {
  int status;
  std::string out;
  std::string err;
};

inline Outcome runCaptured(const std::vector<cli::Command>& commands,
                           const std::vector<std::string>& arguments) {
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  const int status = cli::runProgram(commands, arguments);
  std::string out = ::testing::internal::GetCapturedStdout();
  return {status, out, ::testing::internal::GetCapturedStderr()};
}

}  // namespace evolin::test
