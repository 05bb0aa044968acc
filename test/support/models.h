// Network files for tests: taken from the shared folder, or converted from what stands there.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <opencv2/core/version.hpp>
#include <string>

#include "test/support/shared_data.h"

namespace evolin::test {

/// A model's file, or why there is none here.
struct Model {
  std::filesystem::path file;
  std::string why_absent;
};

/// `name` of the shared models/ as it is.
inline Model sharedModel(const std::string& name) {
  if (sharedFolder().empty()) {
    return {{}, "EVOLIN_SHARED is unset: no network files to test on"};
  }
  const std::filesystem::path file = sharedFolder() / "models" / name;
  if (!std::filesystem::exists(file)) {
    return {{}, file.string() + " is absent"};
  }
  return {file, ""};
}

/// LSDNet's file, where OpenCV reads it: 4.5.1 does not ("Inconsistent shape for ConcatLayer").
inline Model lsdNetModel() {
  if (CV_VERSION_MAJOR * 100 + CV_VERSION_MINOR < 406) {
    return {{}, "OpenCV " CV_VERSION " does not read lsdnet.onnx, 4.6 does"};
  }
  return sharedModel("lsdnet.onnx");
}

/// M-LSD's `name` ("mlsd_tiny_512.onnx"), converted from `checkpoint` of the shared models/ by
/// scripts/models/convert into a folder of the build; done once. Python without PyTorch is a reason
/// to skip, a conversion that fails is a failure.
inline Model convertedModel(const std::string& name, const std::string& checkpoint) {
  const Model source = sharedModel(checkpoint);
  if (source.file.empty()) {
    return source;
  }
  const std::filesystem::path file = std::filesystem::path(EVOLIN_MODEL_CACHE) / name;
  const std::filesystem::path scripts = std::filesystem::path(EVOLIN_SOURCE_DIR) / "scripts/models";
  bool fresh = std::filesystem::exists(file);
  for (const auto& entry : std::filesystem::directory_iterator(scripts / "network_conversion")) {
    fresh =
        fresh && std::filesystem::last_write_time(entry) < std::filesystem::last_write_time(file);
  }
  if (fresh) {
    return {file, ""};
  }
  const std::string command = "/usr/bin/python3 '" + (scripts / "convert").string() +
                              "' mlsd --force --checkpoint '" + source.file.string() +
                              "' --output '" + file.string() + "'";
  const int status = std::system(command.c_str());
  constexpr int kMissingPackage = 3;
  if (WIFEXITED(status) && WEXITSTATUS(status) == kMissingPackage) {
    return {{},
            "Python lacks PyTorch, ONNX, OpenCV or FlatBuffers: nothing to convert " + checkpoint +
                " with"};
  }
  EXPECT_EQ(status, 0) << command;
  return {file, status == 0 ? "" : "it could not be converted"};
}

inline Model mlsdTiny512() {
  return convertedModel("mlsd_tiny_512.onnx", "mlsd_tiny_512_fp32.pth");
}

}  // namespace evolin::test

/// Skips the running test, saying why, where `model` is absent.
#define EVOLIN_REQUIRE_MODEL(model)     \
  if ((model).file.empty()) {           \
    GTEST_SKIP() << (model).why_absent; \
  }                                     \
  static_cast<void>(0)
