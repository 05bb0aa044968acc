// The exceptions that the ROS-free core throws; every message names the place, the value and what
// was expected.
#pragma once

#include <stdexcept>
#include <string>

namespace evolin {

/// Root of the tree: anything that went wrong for a reason that the user can mend.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Malformed content of a file. `line` counts from 1; 0 means the file as a whole.
/// what() reads "FILE:LINE: MESSAGE" or "FILE: MESSAGE".
class ParseError : public Error {
 public:
  ParseError(const std::string& file, int line, const std::string& message);

  const std::string& file() const { return file_; }
  int line() const { return line_; }

 private:
  std::string file_;
  int line_;
};

/// A parameter that is unknown, ill-typed or out of range. what() reads "OWNER: parameter 'KEY':
/// MESSAGE", or "OWNER: MESSAGE" where the key is empty (the parameters as a whole).
class ConfigError : public Error {
 public:
  ConfigError(const std::string& owner, const std::string& key, const std::string& message);

  const std::string& key() const { return key_; }

 private:
  std::string key_;
};

/// A method or feature that this build does not have; the message says what it would take.
class UnavailableError : public Error {
 public:
  using Error::Error;
};

/// Ground truth that breaks a rule of the metric; `row` counts from 0 within its frame.
class GroundTruthError : public Error {
 public:
  GroundTruthError(const std::string& frame, std::size_t row, const std::string& message);

  const std::string& frame() const { return frame_; }
  std::size_t row() const { return row_; }

 private:
  std::string frame_;
  std::size_t row_;
};

}  // namespace evolin
