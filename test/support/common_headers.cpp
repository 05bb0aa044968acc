// The translation unit that carries the tests' precompiled header.
#include "test/support/common_headers.h"
