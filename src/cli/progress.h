// Progress of a long run on standard error: one line kept up to date on a terminal, now and then a
// line elsewhere.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace evolin::cli {

class Progress {
 public:
  /// `what` stands before the counts ("frames"); `total` is the number of steps to come.
  Progress(std::string what, std::size_t total);

  /// `done` steps are behind.
  void update(std::size_t done);

  /// Ends the line with the final count and the rate.
  void finish(std::size_t done);

 private:
  using Clock = std::chrono::steady_clock;

  std::string line(std::size_t done, bool with_remaining) const;

  std::string what_;
  std::size_t total_;
  bool terminal_;
  Clock::time_point begin_;
  Clock::time_point shown_;
};

}  // namespace evolin::cli
