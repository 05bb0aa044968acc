// Where the real samples and golden figures stand, and how a test says that it was skipped without
// them.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

namespace evolin::test {

/// The folder named by EVOLIN_SHARED ("" when unset); it holds data/ and models/.
inline std::filesystem::path sharedFolder() {
  const char* value = std::getenv("EVOLIN_SHARED");
  return value == nullptr ? std::filesystem::path() : std::filesystem::path(value);
}

}  // namespace evolin::test

/// Skips the running test, saying so, where EVOLIN_SHARED is unset. A macro because GTEST_SKIP
/// returns from the test itself.
#define EVOLIN_REQUIRE_SHARED_DATA()                                      \
  if (::evolin::test::sharedFolder().empty()) {                           \
    GTEST_SKIP() << "EVOLIN_SHARED is unset: no real samples to test on"; \
  }                                                                       \
  static_cast<void>(0)
