// The most memory that a piece of a program takes, as the kernel counts it.
#pragma once

#include <fstream>
#include <optional>
#include <string>
#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace evolin {

/// Counts from its construction on. Only where Linux lets a process forget its own peak
/// (/proc/self/clear_refs).
class PeakMemory {
 public:
  PeakMemory() {
#if defined(__GLIBC__)
    malloc_trim(0);  // what others gave back is not to be used in silence
#endif
    std::ofstream peak("/proc/self/clear_refs");
    peak << "5" << std::flush;
    if (peak.good()) {
      before_ = read("VmRSS:");
    }
  }

  /// Bytes of the peak since then above what the process had; none where that cannot be told.
  std::optional<double> growth() const {
    const std::optional<double> peak = read("VmHWM:");
    return before_ && peak ? std::optional<double>(*peak - *before_) : std::nullopt;
  }

 private:
  /// Of /proc/self/status, whose sizes are in KiB.
  static std::optional<double> read(const std::string& key) {
    std::ifstream status("/proc/self/status");
    std::string word;
    while (status >> word) {
      double kibibytes = 0;
      if (word == key && status >> kibibytes) {
        return kibibytes * 1024;
      }
    }
    return std::nullopt;
  }

  std::optional<double> before_;
};

}  // namespace evolin
