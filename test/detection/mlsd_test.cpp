// The plug-in `mlsd` with the authors' weights.
#include "evolin_ros/detection/mlsd.h"

#include <gtest/gtest.h>

#include "test/detection/awkward_images.h"
#include "test/detection/network_golden.h"
#include "test/support/expect_error.h"
#include "test/support/models.h"
#include "test/support/temporary_folder.h"

namespace evolin {
namespace {

YAML::Node parametersFor(const test::Model& model, const std::string& others = "{}") {
  YAML::Node parameters = YAML::Load(others);
  parameters["model"] = model.file.string();
  return parameters;
}

void expectGolden(const test::Model& model, const std::string& set, const std::string& others) {
  Mlsd detector;
  detector.configure(parametersFor(model, others));
  std::size_t golden_lines = 0;
  std::size_t same_ends = 0;
  std::size_t same = 0;
  std::size_t found = 0;
  for (int frame = 0; frame < test::kGoldenFrames; ++frame) {
    const LineSegments lines = detector.detect(test::goldenColor(frame));
    const LineSegments golden = test::networkLines(set, frame);
    golden_lines += golden.size();
    found += lines.size();
    same_ends += test::countSame(lines, golden, 0.05, 1);
    same += test::countSame(lines, golden, 0.05, 1e-4);
  }
  ::testing::Test::RecordProperty("same_ends", static_cast<int>(same_ends));
  EXPECT_GE(static_cast<double>(same_ends), 0.995 * static_cast<double>(golden_lines));
  EXPECT_GE(static_cast<double>(same), 0.99 * static_cast<double>(golden_lines));
  EXPECT_NEAR(static_cast<double>(found), static_cast<double>(golden_lines),
              0.005 * static_cast<double>(golden_lines));
}

TEST(Mlsd, TinyOf512EqualsTheBenchmarksLines) {
  const test::Model model = test::mlsdTiny512();
  EVOLIN_REQUIRE_MODEL(model);
  expectGolden(model, "mlsd_tiny_512/evolin", "{}");
}

TEST(Mlsd, TinyOf512EqualsTheAuthorsLines) {
  const test::Model model = test::mlsdTiny512();
  EVOLIN_REQUIRE_MODEL(model);
  expectGolden(model, "mlsd_tiny_512/default", "{score_threshold: 0.1, min_grid_length: 20}");
}

TEST(Mlsd, TinyOf320FromTheAuthorsFileEqualsTheirLines) {
  const test::Model model =
      test::convertedModel("mlsd_tiny_320.onnx", "M-LSD_320_tiny_fp32.tflite");
  EVOLIN_REQUIRE_MODEL(model);
  expectGolden(model, "mlsd_tiny_320/evolin", "{}");
  expectGolden(model, "mlsd_tiny_320/default", "{score_threshold: 0.1, min_grid_length: 20}");
}

TEST(Mlsd, LargeFromTheAuthorsFileFindsLines) {
  const test::Model model =
      test::convertedModel("mlsd_large_512.onnx", "M-LSD_512_large_fp16.tflite");
  EVOLIN_REQUIRE_MODEL(model);
  Mlsd large;
  large.configure(parametersFor(model, "{score_threshold: 0.1, min_grid_length: 20}"));
  const LineSegments lines = large.detect(test::goldenColor(0));
  const LineSegments tiny = test::networkLines("mlsd_tiny_512/default", 0);
  // Another network, the same scene: most of the lines are seen by both.
  const std::size_t shared = test::countSame(lines, tiny, 10, 1);
  EXPECT_GT(shared, tiny.size() / 2) << lines.size() << " lines, of tiny " << tiny.size();
}

TEST(Mlsd, SurvivesAwkwardImages) {
  const test::Model model = test::mlsdTiny512();
  EVOLIN_REQUIRE_MODEL(model);
  Mlsd detector;
  detector.configure(parametersFor(model, "{score_threshold: 0.1}"));
  for (const cv::Size& size :
       {cv::Size(1, 1), cv::Size(640, 1), cv::Size(3, 7), cv::Size(203, 97)}) {
    for (const int type : {CV_8UC1, CV_8UC3}) {
      Frame frame;
      frame.image = test::uniformNoise(size, type);
      test::expectSound(detector.detect(frame), detector, std::to_string(size.width));
    }
  }
  test::expectRefusesOtherImages(&detector);
}

TEST(Mlsd, GreyAndColourOfTheSameGreysAreTheSame) {
  const test::Model model = test::mlsdTiny512();
  EVOLIN_REQUIRE_MODEL(model);
  Mlsd detector;
  detector.configure(parametersFor(model));
  const Frame grey = test::goldenGray(0);
  Frame colour = grey;
  cv::cvtColor(grey.image, colour.image, cv::COLOR_GRAY2BGR);
  const LineSegments lines = detector.detect(grey);
  ASSERT_GT(lines.size(), 20U);
  test::expectSameLines(detector.detect(colour), lines, 0, 0);
  EXPECT_GT(detector.times().forward, 0);
}

TEST(Mlsd, SelectsAndClips) {
  const test::Model model = test::mlsdTiny512();
  EVOLIN_REQUIRE_MODEL(model);
  const Frame frame = test::goldenColor(0);
  Mlsd few;
  few.configure(parametersFor(model, "{max_lines: 5, min_length: 30}"));
  const LineSegments best = few.detect(frame);
  EXPECT_EQ(best.size(), 5U);
  Mlsd clipping;
  clipping.configure(parametersFor(model, "{clip: true}"));
  for (const LineSegment& line : clipping.detect(frame)) {
    EXPECT_GE(std::min(line.x1, line.x2), -0.5);
    EXPECT_GE(std::min(line.y1, line.y2), -0.5);
    EXPECT_LE(std::max(line.x1, line.x2), 639.5);
    EXPECT_LE(std::max(line.y1, line.y2), 479.5);
  }
}

TEST(Mlsd, SaysWhatIsWrongWithItsModel) {
  if (!whyNoNetworks().empty()) {
    GTEST_SKIP() << whyNoNetworks();
  }
  Mlsd detector;
  test::expectError<UnavailableError>(
      [&] { detector.configure(YAML::Load("{model: no_such.onnx}")); },
      {"detector mlsd", "'model'", "no_such.onnx", "models", "scripts/models/convert mlsd",
       "docs/NETWORKS.md"});
  test::expectError<ConfigError>([&] { detector.configure(YAML::Load("{model: ''}")); },
                                 {"'model'", "empty"});
  test::expectError<ConfigError>([&] { detector.configure(YAML::Load("{backend: tensorrt}")); },
                                 {"backend", "tensorrt", "opencv"});
  test::expectError<ConfigError>([&] { detector.configure(YAML::Load("{modle: a}")); },
                                 {"modle", "model"});
  const test::TemporaryFolder folder;
  const auto text = folder.write("text.onnx", "this is no network");
  test::expectError([&] { detector.configure(YAML::Load("{model: " + text.string() + "}")); },
                    {"detector mlsd", text.string(), "no whole ONNX file"});
  Frame frame;
  frame.image = cv::Mat(8, 8, CV_8UC1, cv::Scalar(0));
  test::expectError([&] { detector.detect(frame); }, {"before configure()"});
}

TEST(Mlsd, RefusesTheFileOfAnotherNetwork) {
  const test::Model other = test::sharedModel("lsdnet.onnx");
  EVOLIN_REQUIRE_MODEL(other);
  if (!whyNoNetworks().empty()) {
    GTEST_SKIP() << whyNoNetworks();
  }
  Mlsd detector;
  test::expectError([&] { detector.configure(parametersFor(other, "{verify: false}")); },
                    {"another network", "'input_1:0' [?, 288, 288, 3]", "'Identity:0'",
                     "'image' [1, 3, ?, ?]", "'maps' [1, 5, ?, ?]"});
  test::expectError([&] { detector.configure(parametersFor(other)); },
                    {"SHA-256", "verify: false"});
}

}  // namespace
}  // namespace evolin
