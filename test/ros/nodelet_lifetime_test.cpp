// Nodelets that come and go, and interrupts at any moment, in a process of our own that may carry a
// sanitizer. Starts a master of its own.
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <signal.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "online_process.h"
#include "online_support.h"
#include "test/support/temporary_folder.h"

namespace evolin::test {
namespace {

int freePort() {
  const int probe = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address = {};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  int port = 0;
  if (bind(probe, reinterpret_cast<sockaddr*>(&address), size) == 0 &&
      getsockname(probe, reinterpret_cast<sockaddr*>(&address), &size) == 0) {
    port = ntohs(address.sin_port);
  }
  close(probe);
  return port;
}

bool answers(int port) {
  const int probe = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address = {};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  const bool there = connect(probe, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
  close(probe);
  return there;
}

class NodeletLifetime : public ::testing::Test {
 protected:
  void SetUp() override {
    if (std::system("command -v rosmaster > /dev/null") != 0) {
      GTEST_SKIP() << "there is no program rosmaster";
    }
    // Tests of other programs may run on this machine at the same time.
    const int port = freePort();
    setenv("ROS_MASTER_URI", ("http://localhost:" + std::to_string(port)).c_str(), 1);
    setenv("ROS_HOSTNAME", "localhost", 1);
    // Of foreign libraries alone, by name, which needs both stacks of a race; without a sanitizer
    // nobody reads them.
    const std::string folder = std::string(EVOLIN_SOURCE_DIR) + "/test/sanitizers/";
    setenv("TSAN_OPTIONS", ("suppressions=" + folder + "thread.supp history_size=7").c_str(), 0);
    setenv("LSAN_OPTIONS", ("suppressions=" + folder + "leak.supp").c_str(), 0);
    master_ = std::make_unique<Process>(
        std::vector<std::string>{"rosmaster", "--core", "-p", std::to_string(port)});
    ASSERT_TRUE(waitFor("a master", [&] { return answers(port); }));
  }

  static std::string host() { return NODELET_HOST; }

  /// Of a report in `folder`; 0 where there is none yet.
  static std::size_t evaluatedIn(const std::filesystem::path& folder) {
    const std::filesystem::path file = folder / "report.json";
    return std::filesystem::exists(file)
               ? readReport(file).at("coverage").at("evaluated").get<std::size_t>()
               : 0;
  }

  TemporaryFolder folder_;
  std::unique_ptr<Process> master_;
};

TEST_F(NodeletLifetime, APlugInGetsThePixelsOfTheMessageThemselves) {
  const char* const path = std::getenv("ROS_PACKAGE_PATH");
  setenv(
      "ROS_PACKAGE_PATH",
      (std::string(EVOLIN_SOURCE_DIR) + "/test/plugins:" + (path == nullptr ? "" : path)).c_str(),
      1);
  for (const char* encoding : {"mono8", "bgr8"}) {
    SCOPED_TRACE(encoding);
    Process process({host(), "address", encoding});
    EXPECT_EQ(process.wait(60), std::optional<int>(0)) << "4: another address";
  }
}

TEST_F(NodeletLifetime, WhatComesWhileANodeletStartsIsNotLost) {
  Process process({host(), "start"});
  EXPECT_EQ(process.wait(60), std::optional<int>(0)) << "3: does not load; 4: something is lost";
}

TEST_F(NodeletLifetime, AHundredLoadsAndUnloadsInAStream) {
  Process process({host(), "cycle", "100", folder_.path().string()});
  // ThreadSanitizer takes minutes, more where others use the machine.
  EXPECT_EQ(process.wait(1500), std::optional<int>(0)) << "a sanitizer's findings are above";
}

TEST_F(NodeletLifetime, AnInterruptAtAnyMomentLeavesWhatASavePeriodAgoWasThere) {
  std::mt19937 random(20231);
  std::uniform_int_distribution<int> moment(0, 1200);
  for (int round = 0; round < 8; ++round) {
    const int milliseconds = moment(random);
    SCOPED_TRACE("interrupted after " + std::to_string(milliseconds) + " ms");
    const TemporaryFolder folder;
    const auto evaluated = [&folder] { return evaluatedIn(folder.path()); };
    Process process({host(), "stream", folder.path().string()});
    std::size_t before = 0;
    if (round % 2 == 1) {
      // From save period to save period there is more on disk.
      for (int period = 0; period < 3; ++period) {
        ASSERT_TRUE(waitFor(
            "a report of more frames", [&] { return evaluated() > before; }, 120));
        before = evaluated();
      }
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
    before = evaluated();
    process.send(SIGINT);
    const std::optional<int> status = process.wait(120);
    // Before ROS has started nobody takes the signal.
    const bool before_start = before == 0 && evaluated() == 0 && status == -SIGINT;
    ASSERT_TRUE(before_start || status == 0)
        << "status " << status.value_or(-1000) << ": a sanitizer's findings are above";
    // Strict JSON, and nothing that was on disk has been lost.
    EXPECT_GE(evaluated(), before);
    EXPECT_GE(evaluated(), round % 2 == 1 ? 3U : 0U);
  }
}

}  // namespace
}  // namespace evolin::test
