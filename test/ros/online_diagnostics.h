// What nodelets say of themselves on /diagnostics.
#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>

#include <functional>
#include <optional>
#include <string>

#include "online_stream.h"

namespace evolin::test {

class DiagnosticsReader {
 public:
  using Status = diagnostic_msgs::DiagnosticStatus;

  /// `node` is the nodelet's name, with its leading slash.
  explicit DiagnosticsReader(const std::string& node)
      : node_(node.substr(1)), messages_("/diagnostics") {}

  /// The newest status of this name ("latency", "drops", ...).
  std::optional<Status> newest(const std::string& name) const {
    std::optional<Status> found;
    for (const diagnostic_msgs::DiagnosticArray& message : messages_.messages()) {
      for (const Status& status : message.status) {
        if (status.name == node_ + ": " + name) {
          found = status;
        }
      }
    }
    return found;
  }

  /// "" where the status has no such key.
  static std::string valueOf(const Status& status, const std::string& key) {
    for (const diagnostic_msgs::KeyValue& value : status.values) {
      if (value.key == key) {
        return value.value;
      }
    }
    return {};
  }

  /// Waits until the newest status of this name satisfies `condition`.
  ::testing::AssertionResult waitFor(const std::string& name,
                                     const std::function<bool(const Status&)>& condition) const {
    const auto result = ::evolin::test::waitFor("diagnostics '" + name + "' of " + node_, [&] {
      const std::optional<Status> status = newest(name);
      return status && condition(*status);
    });
    if (result) {
      return result;
    }
    auto failure = ::testing::AssertionFailure() << result.message();
    if (const std::optional<Status> status = newest(name)) {
      failure << "; the last one: level " << static_cast<int>(status->level) << ", "
              << status->message;
      for (const diagnostic_msgs::KeyValue& value : status->values) {
        failure << "\n  " << value.key << ": " << value.value;
      }
    } else {
      failure << "; there was none";
    }
    return failure;
  }

 private:
  std::string node_;
  Collector<diagnostic_msgs::DiagnosticArray> messages_;
};

}  // namespace evolin::test
