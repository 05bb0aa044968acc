// One network: loading, running, refusing; on small files made here, so that no weights are needed.
#include "evolin_ros/inference/network.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "evolin_ros/inference/model_catalogue.h"
#include "evolin_ros/inference/model_files.h"
#include "test/inference/onnx_bytes.h"
#include "test/support/environment.h"
#include "test/support/expect_error.h"
#include "test/support/fuzz.h"
#include "test/support/temporary_folder.h"

namespace evolin {
namespace {

namespace onnx = test::onnx;
using test::Variable;

class NetworkTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!whyNoNetworks().empty()) {
      GTEST_SKIP() << whyNoNetworks();
    }
  }

  static NetworkInterface relu() {
    NetworkInterface interface;
    interface.owner = "detector test";
    interface.input = {"image", {1, 3, -1, -1}};
    interface.outputs = {{"maps", {1, 3, -1, -1}}};
    interface.how_to_get = "Ask its author.";
    return interface;
  }

  NetworkOptions optionsFor(const std::string& content) const {
    NetworkOptions options;
    options.model = folder_.write("network.onnx", content).string();
    return options;
  }

  test::TemporaryFolder folder_;
};

TEST_F(NetworkTest, Runs) {
  Network network(relu(), optionsFor(onnx::model(onnx::reluGraph(4))));
  ASSERT_EQ(network.inputShape(), (std::vector<int>{1, 3, 4, 4}));
  cv::Mat input(4, network.inputShape().data(), CV_32F);
  for (std::size_t i = 0; i < input.total(); ++i) {
    input.ptr<float>()[i] = static_cast<float>(i) - 20;
  }
  const std::vector<cv::Mat>& answers = network.run(input);
  ASSERT_EQ(answers.size(), 1U);
  for (std::size_t i = 0; i < input.total(); ++i) {
    EXPECT_EQ(answers[0].ptr<float>()[i], std::max(0.0F, static_cast<float>(i) - 20));
  }
  EXPECT_GT(network.lastMilliseconds(), 0);
  test::expectError([&] { network.run(cv::Mat(4, 4, CV_32F)); },
                    {"detector test", "'image' [4, 4]", "'image' [1, 3, 4, 4]"});
}

TEST_F(NetworkTest, NamesBothSidesOfWhatDiffers) {
  NetworkInterface other = relu();
  other.outputs[0].name = "heatmap";
  const NetworkOptions options = optionsFor(onnx::model(onnx::reluGraph(4)));
  test::expectError([&] { Network(other, options); },
                    {"detector test", "network.onnx", "another network", "'maps' [1, 3, 4, 4]",
                     "'heatmap' [1, 3, ?, ?]", "Ask its author."});
  other = relu();
  other.input.shape[1] = 1;
  test::expectError([&] { Network(other, options); }, {"'image' [1, 1, ?, ?]"});
}

// The file promises another shape than it gives.
TEST_F(NetworkTest, ComparesWhatComesOutToo) {
  const std::string graph = onnx::bytes(1, onnx::node("Relu", {"image"}, "maps")) +
                            onnx::bytes(11, onnx::value("image", {1, 3, 4, 4})) +
                            onnx::bytes(12, onnx::value("maps", {1, 3, -1, -1}));
  NetworkInterface wrong = relu();
  wrong.outputs[0].shape = {1, 3, 9, 9};
  test::expectError([&] { Network(wrong, optionsFor(onnx::model(graph))); },
                    {"gives 'maps' [1, 3, 4, 4]; expected 'maps' [1, 3, 9, 9]"});
}

TEST_F(NetworkTest, VerifiesUnlessToldNotTo) {
  NetworkOptions options = optionsFor(onnx::model(onnx::reluGraph(4), false));
  test::expectError([&] { Network(relu(), options); },
                    {"SHA-256", "not that of a published file", "verify: false"});
  options.verify = false;
  EXPECT_NO_THROW(Network(relu(), options));
  options.verify = true;
  NetworkInterface knowing = relu();
  knowing.digests = {readOnnxFile(options.model).digest};
  EXPECT_NO_THROW(Network(knowing, options));
}

TEST_F(NetworkTest, AFileThatIsNotThereIsUnavailableAndSaysHowToGetIt) {
  NetworkOptions options;
  options.model = "no_such.onnx";
  const Variable home("ROS_HOME", folder_.path().string());
  test::expectError<UnavailableError>(
      [&] { Network(relu(), options); },
      {"detector test", "'model'", "'no_such.onnx'", folder_.path().string(), "Ask its author."});
  options.model = "";
  test::expectError<ConfigError>([&] { Network(relu(), options); }, {"'model'", "empty"});
}

TEST_F(NetworkTest, AnOperationThatOpenCvLacksIsAnError) {
  const std::string graph = onnx::bytes(1, onnx::node("NoSuchOperation", {"image"}, "maps")) +
                            onnx::bytes(11, onnx::value("image", {1, 3, 4, 4})) +
                            onnx::bytes(12, onnx::value("maps", {1, 3, 4, 4}));
  test::expectError([&] { Network(relu(), optionsFor(onnx::model(graph))); },
                    {"network.onnx", "OpenCV"});
}

TEST_F(NetworkTest, AWrongBackendOrTargetNamesThoseThatAreThere) {
  NetworkOptions options = optionsFor(onnx::model(onnx::reluGraph(4)));
  options.target = "myriad";
  test::expectError<UnavailableError>([&] { Network(relu(), options); },
                                      {"'opencv' on 'myriad'", "opencv on cpu"});
}

TEST_F(NetworkTest, DamagedFilesAreErrorsAndNeverCrash) {
  const std::string whole = onnx::model(onnx::reluGraph(8));
  test::Fuzzer fuzzer(8);
  test::FuzzCounts counts;
  for (int round = 0; round < 1500; ++round) {
    const std::string damaged = fuzzer.damaged(whole);
    test::countAnswer([&] { Network(relu(), optionsFor(damaged)); }, damaged, &counts);
  }
  EXPECT_GT(counts.errors, 500U);
}

TEST(ModelFiles, AreLookedForInTheFoldersInTheirOrder) {
  const test::TemporaryFolder folder;
  folder.write("a/one.onnx", "a");
  folder.write("b/one.onnx", "b");
  folder.write("home/evolin_ros/models/two.onnx", "h");
  const Variable models("EVOLIN_MODELS",
                        (folder.path() / "a").string() + "::" + (folder.path() / "b").string());
  const Variable home("ROS_HOME", (folder.path() / "home").string());
  ASSERT_EQ(modelFolders().size(), 3U);
  EXPECT_EQ(findModelFile("one.onnx"), folder.path() / "a" / "one.onnx");
  EXPECT_EQ(findModelFile("two.onnx"), folder.path() / "home/evolin_ros/models/two.onnx");
  EXPECT_FALSE(findModelFile("three.onnx"));
  EXPECT_FALSE(findModelFile((folder.path() / "one.onnx").string()));
  EXPECT_TRUE(findModelFile((folder.path() / "b/one.onnx").string()));
  EXPECT_FALSE(findModelFile(folder.path().string())) << "a folder is no file";
}

TEST(ModelCatalogue, TheShippedOneIsReadAndKnowsTheStateOfFiles) {
  const std::vector<ModelEntry> entries =
      readModelCatalogue(std::filesystem::path(EVOLIN_SOURCE_DIR) / "config/models.yaml");
  EXPECT_GE(entries.size(), 16U);
  const test::TemporaryFolder folder;
  const Variable models("EVOLIN_MODELS", folder.path().string());
  const Variable home("ROS_HOME", (folder.path() / "home").string());
  for (const ModelEntry& entry : entries) {
    EXPECT_EQ(statusOf(entry).state, ModelState::kAbsent) << entry.name;
    folder.write(entry.file, "text");
    EXPECT_EQ(statusOf(entry).state, ModelState::kDamaged) << entry.name;
    folder.write(entry.file, onnx::model(onnx::reluGraph(4), false));
    EXPECT_EQ(statusOf(entry).state,
              entry.sha256.empty() ? ModelState::kUnknown : ModelState::kWrongSum);
    folder.write(entry.file, onnx::model(onnx::reluGraph(4)));
    EXPECT_EQ(statusOf(entry).state,
              entry.sha256.empty() ? ModelState::kPresent : ModelState::kWrongSum);
  }
}

TEST(ModelCatalogue, RefusesWhatIsNoList) {
  const test::TemporaryFolder folder;
  const auto refused = [&](const std::string& text, const std::string& why) {
    const auto file = folder.write("models.yaml", text);
    test::expectError<ParseError>([&] { readModelCatalogue(file); }, {"models.yaml", why});
  };
  const std::string entry =
      "  - {name: a, title: t, repository: r, licence: l, file: a.onnx, get: g";
  refused("a: 1", "'models'");
  refused("models:\n" + entry + ", colour: red}\n", "colour");
  refused("models:\n  - {name: a}\n", "none empty");
  refused("models:\n" + entry + ", sha256: 12}\n", "64 hexadecimal digits");
  refused("models:\n" + entry + "}\n" + entry + "}\n", "twice");
}

}  // namespace
}  // namespace evolin
