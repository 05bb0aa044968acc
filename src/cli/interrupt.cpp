// A signal handler that sets a flag.
#include "interrupt.h"

#include <atomic>

namespace evolin::cli {

namespace {

// A signal handler can reach nothing but static storage.
std::atomic<bool> interrupt_seen{false};
static_assert(std::atomic<bool>::is_always_lock_free, "the handler must not lock");

void onSignal(int /*signal*/) { interrupt_seen = true; }

}  // namespace

InterruptGuard::InterruptGuard() {
  interrupt_seen = false;
  struct sigaction action = {};
  action.sa_handler = onSignal;
  sigemptyset(&action.sa_mask);
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, &former_int_);
  sigaction(SIGTERM, &action, &former_term_);
}

InterruptGuard::~InterruptGuard() {
  sigaction(SIGINT, &former_int_, nullptr);
  sigaction(SIGTERM, &former_term_, nullptr);
}

bool InterruptGuard::interrupted() const { return interrupt_seen; }

}  // namespace evolin::cli
