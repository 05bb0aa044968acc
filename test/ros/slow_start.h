// A nodelet that takes its time to start, while messages come and its timer is due.
#pragma once

namespace evolin::test {

/// 0 when all messages and the timer reached it once it had started.
int slowStart();

}  // namespace evolin::test
