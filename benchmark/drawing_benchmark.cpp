// Time of judging and drawing one frame of 640 x 480 pixels: 400 detected and 80 annotated lines,
// 80 trails of 8 points, margin.
#include <benchmark/benchmark.h>

#include "evolin_ros/drawing/evaluation_view.h"
#include "test/support/random_lines.h"

namespace {

constexpr evolin::VectorizedSetting kSetting{evolin::LineDistance::kStructural, 5};
constexpr evolin::ImageSize kSize{640, 480};

evolin::EvaluatedFrame makeFrame() {
  evolin::test::RandomLines random(11);
  evolin::EvaluatedFrame frame;
  frame.image = cv::Mat(kSize.height, kSize.width, CV_8UC3);
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      frame.image.at<cv::Vec3b>(y, x) = cv::Vec3b(x % 256, y % 256, (x + y) % 256);
    }
  }
  frame.ground_truth = random.anywhere(80, kSize.width, kSize.height);
  frame.lines = random.detectionsOf(frame.ground_truth, 400, 12);
  frame.verdicts = evolin::judgeLines(kSetting, evolin::Protocol::kEvolin, kSize, frame.lines,
                                      frame.ground_truth, true);
  for (std::uint32_t row = 0; row < 80; ++row) {
    evolin::LineTrail trail{row, row, {}};
    for (int i = 0; i < 8; ++i) {
      trail.points.emplace_back(frame.ground_truth[row].x1 + 3 * i, frame.ground_truth[row].y1 + i);
    }
    frame.trails.push_back(trail);
  }
  frame.title = "opencv_lsd";
  for (int section = 0; section < 6; ++section) {
    frame.sections.push_back({"section", {{"precision", "15.7 %"}, {"recall", "51.6 %"}}});
  }
  return frame;
}

void judge(benchmark::State& state) {
  const evolin::EvaluatedFrame frame = makeFrame();
  for (auto _ : state) {
    benchmark::DoNotOptimize(evolin::judgeLines(kSetting, evolin::Protocol::kEvolin, kSize,
                                                frame.lines, frame.ground_truth, true));
  }
}
BENCHMARK(judge)->Unit(benchmark::kMillisecond);

/// The argument is the scale.
void draw(benchmark::State& state) {
  const evolin::EvaluatedFrame frame = makeFrame();
  evolin::ViewOptions options;
  options.scale = static_cast<double>(state.range(0));
  for (auto _ : state) {
    benchmark::DoNotOptimize(evolin::drawEvaluatedFrame(frame, options));
  }
}
BENCHMARK(draw)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond);

void drawWithoutMargin(benchmark::State& state) {
  const evolin::EvaluatedFrame frame = makeFrame();
  evolin::ViewOptions options;
  options.margin = false;
  for (auto _ : state) {
    benchmark::DoNotOptimize(evolin::drawEvaluatedFrame(frame, options));
  }
}
BENCHMARK(drawWithoutMargin)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
