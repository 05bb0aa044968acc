// Counts what a test program allocates with new; link allocations.cpp, which replaces the global
// operators.
#pragma once

#include <cstddef>

namespace evolin::test {

/// Calls of operator new so far, of all threads.
std::size_t allocations();

}  // namespace evolin::test
