// Checks that a call fails with a message that says certain things.
#pragma once

#include <gtest/gtest.h>

#include <initializer_list>
#include <string>

#include "evolin_ros/base/error.h"

namespace evolin::test {

/// Calls `action`, expects it to throw ErrorType, and expects every one of `parts` in the message.
template <typename ErrorType = Error, typename Action>
void expectError(const Action& action, std::initializer_list<std::string> parts) {
  try {
    action();
  } catch (const ErrorType& error) {
    const std::string message = error.what();
    for (const std::string& part : parts) {
      EXPECT_NE(message.find(part), std::string::npos)
          << "'" << part << "' is not in the message: " << message;
    }
    return;
  }
  ADD_FAILURE() << "nothing was thrown, expected an error about " << *parts.begin();
}

}  // namespace evolin::test
