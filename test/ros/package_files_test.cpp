// Which files the program says that it is made of.
#include "package_files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace evolin {
namespace {

TEST(ProgramFiles, AreTheRunningProgramAndTheLibrariesOfThePackage) {
  const std::vector<std::filesystem::path> files = programFiles();
  std::vector<std::string> names;
  for (const std::filesystem::path& file : files) {
    EXPECT_TRUE(std::filesystem::is_regular_file(file)) << file;
    names.push_back(file.filename().string());
  }
  ASSERT_FALSE(names.empty());
  EXPECT_EQ(names.front(), "package_files_test");
  EXPECT_TRUE(std::is_sorted(names.begin() + 1, names.end()));
  for (const char* library :
       {"libevolin_association.so", "libevolin_core.so", "libevolin_detection.so",
        "libevolin_evaluation.so", "libevolin_pose.so", "libevolin_ros_shell.so"}) {
    EXPECT_EQ(std::count(names.begin(), names.end(), library), 1) << library;
  }
}

}  // namespace
}  // namespace evolin
