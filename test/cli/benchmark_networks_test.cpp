// `evolin benchmark` with detectors that are networks: their files may be absent, and count as
// input.
#include <gtest/gtest.h>

#include <utility>

#include "evolin_ros/inference/network.h"
#include "test/cli/benchmark_fixture.h"
#include "test/inference/onnx_bytes.h"
#include "test/support/environment.h"

namespace evolin::cli {
namespace {

namespace fs = std::filesystem;
using test::BenchmarkTest;
using test::Outcome;

TEST_F(BenchmarkTest, ANetworkWithoutItsFileIsUnavailableAndKeepsNothingBack) {
  const test::Variable models("EVOLIN_MODELS", path("models"));
  const test::Variable home("ROS_HOME", path("ros"));
  writeMatrix(
      "sequences: [{name: room, synthetic: {frames: 3, width: 96, height: 72}}]\n"
      "detectors: [lsd, mlsd]\nsettings: [{name: s, metrics: [detection]}]\n");
  const Outcome outcome = run("out");
  EXPECT_EQ(outcome.status, kExitDone) << outcome.err;
  EXPECT_EQ(states("out"),
            (std::map<std::string, std::string>{{"room--lsd--none--s", "finished"},
                                                {"room--mlsd--none--s", "unavailable"}}));
  EXPECT_NE(cell("out", "room--mlsd--none--s").at("error").get<std::string>().find("mlsd"),
            std::string::npos);
  if (whyNoNetworks().empty()) {
    EXPECT_NE(outcome.out.find("there is no file 'mlsd_tiny_512.onnx'"), std::string::npos)
        << outcome.out;
  }

  // What was recorded of it takes its place.
  fs::create_directories(path("theirs"));
  fs::copy(path("out/detections/room--lsd"), path("theirs/room"), fs::copy_options::recursive);
  writeMatrix(
      "sequences: [{name: room, synthetic: {frames: 3, width: 96, height: 72}}]\n"
      "detectors: [lsd, {name: mlsd, plugin: mlsd, recorded: 'theirs/{sequence}'}]\n"
      "settings: [{name: s, metrics: [detection]}]\n");
  EXPECT_EQ(run("out").status, kExitDone);
  EXPECT_EQ(report("out", "room--mlsd--none--s").at("detection").at("entries"),
            report("out", "room--lsd--none--s").at("detection").at("entries"));
}

TEST_F(BenchmarkTest, ANetworksFileIsPartOfTheContent) {
  if (!whyNoNetworks().empty()) {
    GTEST_SKIP() << whyNoNetworks();
  }
  const test::Variable models("EVOLIN_MODELS", path("models"));
  const test::Variable home("ROS_HOME", path("ros"));
  const auto writeModel = [this](const std::string& file, float weight) {
    namespace onnx = test::onnx;
    const std::string kernel = onnx::bytes(1, "kernel_shape") + onnx::number(8, 1) +
                               onnx::number(8, 1) + onnx::number(20, 7);
    const std::string graph =
        onnx::bytes(1, onnx::node("Conv", {"image", "weights"}, "maps") + onnx::bytes(5, kernel)) +
        onnx::bytes(2, "test") +
        onnx::bytes(5, onnx::weight("weights", {5, 3, 1, 1}, std::vector<float>(15, weight))) +
        onnx::bytes(11, onnx::value("image", {1, 3, 16, 16})) +
        onnx::bytes(12, onnx::value("maps", {1, 5, 16, 16}));
    folder_.write("models/" + file, onnx::model(graph));
  };
  writeMatrix(
      "sequences: [{name: room, synthetic: {frames: 3, width: 96, height: 72}}]\n"
      "detectors: [mlsd, {name: other, plugin: mlsd, parameters: {model: other.onnx}}]\n"
      "settings: [{name: s, metrics: [detection]}]\n");
  const auto hashes = [this] {
    const Outcome outcome = run("out", {"--list", "--format", "json"});
    const Json list = Json::parse(outcome.out);
    EXPECT_EQ(list.at("cells").at(0).at("state"), "pending") << outcome.out;
    return std::make_pair(list.at("cells").at(0).at("content_hash"),
                          list.at("cells").at(1).at("content_hash"));
  };
  writeModel("mlsd_tiny_512.onnx", 0);
  writeModel("other.onnx", 0);
  const auto before = hashes();
  EXPECT_EQ(hashes(), before);
  writeModel("mlsd_tiny_512.onnx", 1);
  const auto after = hashes();
  EXPECT_NE(after.first, before.first);
  EXPECT_EQ(after.second, before.second) << "it names another file";
  writeModel("other.onnx", 1);
  EXPECT_NE(hashes().second, before.second);
}

}  // namespace
}  // namespace evolin::cli
