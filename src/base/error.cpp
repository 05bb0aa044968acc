// Messages of the core's exceptions.
#include "evolin_ros/base/error.h"

namespace evolin {

namespace {

std::string place(const std::string& file, int line) {
  return line > 0 ? file + ":" + std::to_string(line) : file;
}

}  // namespace

ParseError::ParseError(const std::string& file, int line, const std::string& message)
    : Error(place(file, line) + ": " + message), file_(file), line_(line) {}

ConfigError::ConfigError(const std::string& owner, const std::string& key,
                         const std::string& message)
    : Error(owner + ": " + (key.empty() ? "" : "parameter '" + key + "': ") + message), key_(key) {}

GroundTruthError::GroundTruthError(const std::string& frame, std::size_t row,
                                   const std::string& message)
    : Error("ground truth of frame " + frame + ", row " + std::to_string(row) + ": " + message),
      frame_(frame),
      row_(row) {}

}  // namespace evolin
