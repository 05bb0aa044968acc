// The picture of an evaluated frame: sizes, colours at known places, layers that can be left out.
#include "evolin_ros/drawing/evaluation_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "evolin_ros/drawing/canvas.h"
#include "test/support/expect_error.h"

namespace evolin {
namespace {

LineSegment line(double x1, double y1, double x2, double y2) {
  LineSegment result;
  result.x1 = x1;
  result.y1 = y1;
  result.x2 = x2;
  result.y2 = y2;
  return result;
}

/// One line of every verdict, each some rows below the other.
EvaluatedFrame sample() {
  EvaluatedFrame frame;
  frame.image = cv::Mat(480, 640, CV_8UC3, cv::Scalar::all(100));
  frame.lines = {line(100, 50, 300, 50), line(100, 100, 300, 100), line(100, 150, 300, 150)};
  frame.ground_truth = {line(100, 50, 300, 50), line(100, 200, 300, 200)};
  frame.verdicts.predicted = {LineVerdict::kTruePositive, LineVerdict::kFalsePositive,
                              LineVerdict::kDropped};
  frame.verdicts.found = {true, false};
  frame.title = "opencv_lsd";
  frame.judged_by = "structural distance < 5";
  frame.sections = {{"so far", {{"F-score", "24.0 %"}}}};
  return frame;
}

/// The pixel of image row y in its middle column that is nearest to a colour among three rows.
double distanceTo(const Colour& colour, const cv::Mat& picture, int y, double scale = 1) {
  double nearest = 1e9;
  for (int x = 195; x < 205; ++x) {  // a dash and a gap
    const int row = cvRound((y + 0.5) * scale - 0.5);
    for (int dy = -1; dy <= 1; ++dy) {
      const cv::Vec3b pixel = picture.at<cv::Vec3b>(row + dy, cvRound(x * scale));
      nearest =
          std::min(nearest, cv::norm(cv::Scalar(pixel[0], pixel[1], pixel[2]) - toBgr(colour)));
    }
  }
  return nearest;
}

constexpr double kNear = 60;

TEST(EvaluatedFrame, EveryVerdictHasItsColour) {
  for (const double scale : {1.0, 2.0, 1.5}) {
    SCOPED_TRACE(scale);
    ViewOptions options;
    options.scale = scale;
    const cv::Mat picture = drawEvaluatedFrame(sample(), options);
    EXPECT_LT(distanceTo(palette::kTruePositive, picture, 50, scale), kNear);
    EXPECT_LT(distanceTo(palette::kFalsePositive, picture, 100, scale), kNear);
    EXPECT_LT(distanceTo(palette::kPlain, picture, 150, scale), kNear);
    EXPECT_LT(distanceTo(palette::kMissed, picture, 200, scale), kNear);
    EXPECT_LT(distanceTo({60, 60, 60}, picture, 300, scale), 1) << "100 darkened to 60 %";
  }
}

TEST(EvaluatedFrame, LayersCanBeLeftOut) {
  ViewOptions options;
  options.true_positives = options.false_positives = options.misses = options.dropped = false;
  options.trails = false;
  options.margin = false;
  EvaluatedFrame frame = sample();
  frame.trails = {{0, 0, {{10, 10}, {200, 50}}}};
  const cv::Mat picture = drawEvaluatedFrame(frame, options);
  EXPECT_EQ(cv::norm(picture, cv::Mat(480, 640, CV_8UC3, cv::Scalar::all(60)), cv::NORM_INF), 0);
  for (const auto& [layer, row] :
       {std::make_pair(&ViewOptions::true_positives, 50),
        std::make_pair(&ViewOptions::false_positives, 100),
        std::make_pair(&ViewOptions::dropped, 150), std::make_pair(&ViewOptions::misses, 200)}) {
    ViewOptions one = options;
    one.*layer = true;
    const cv::Mat drawn = drawEvaluatedFrame(frame, one);
    for (const int y : {50, 100, 150, 200}) {
      EXPECT_EQ(distanceTo({60, 60, 60}, drawn, y) > 0 ||
                    cv::norm(drawn.row(y), picture.row(y), cv::NORM_INF) > 0,
                y == row)
          << y << " of " << row;
    }
  }
}

TEST(EvaluatedFrame, TrailsHaveTheColourOfTheirTrack) {
  EvaluatedFrame frame = sample();
  frame.trails = {{3, 0, {{100, 300}, {200, 300}, {300, 300}}}};
  const cv::Mat picture = drawEvaluatedFrame(frame, {});
  EXPECT_LT(distanceTo(colourOfNumber(3), picture, 300), kNear);
}

TEST(EvaluatedFrame, TheMarginGrowsThePictureOnly) {
  const EvaluatedFrame frame = sample();
  ViewOptions options;
  EXPECT_EQ(viewSize(frame, options), cv::Size(640 + kViewMargin, 480));
  const cv::Mat with = drawEvaluatedFrame(frame, options);
  EXPECT_EQ(with.size(), viewSize(frame, options));
  options.margin = false;
  EXPECT_EQ(viewSize(frame, options), cv::Size(640, 480));
  const cv::Mat without = drawEvaluatedFrame(frame, options);
  EXPECT_EQ(cv::norm(without, with(cv::Rect(0, 0, 640, 480)), cv::NORM_INF), 0);
  options.scale = 2;
  options.margin = true;
  EXPECT_EQ(viewSize(frame, options), cv::Size(2 * (640 + kViewMargin), 960));
}

TEST(EvaluatedFrame, AHighMarginIsNotCut) {
  EvaluatedFrame frame = sample();
  frame.image = cv::Mat(64, 64, CV_8UC1, cv::Scalar::all(100));
  frame.lines = {line(5, 5, 60, 60), line(5, 10, 60, 40), line(5, 60, 60, 5)};
  const cv::Size size = viewSize(frame, {});
  EXPECT_GT(size.height, 64);
  const cv::Mat picture = drawEvaluatedFrame(frame, {});
  ASSERT_EQ(picture.size(), size);
  // The last row of text is there and some room is left below it.
  const cv::Mat margin = picture(cv::Rect(64, 0, kViewMargin, size.height));
  EXPECT_GT(cv::norm(margin.rowRange(size.height - 26, size.height - 8),
                     cv::Mat(18, kViewMargin, CV_8UC3, toBgr(palette::kPaper)), cv::NORM_INF),
            100);
  EXPECT_EQ(cv::norm(margin.rowRange(size.height - 5, size.height),
                     cv::Mat(5, kViewMargin, CV_8UC3, toBgr(palette::kPaper)), cv::NORM_INF),
            0);
}

TEST(EvaluatedFrame, TheSizeDoesNotHangOnVerdictsOrTrails) {
  const EvaluatedFrame judged = sample();
  EvaluatedFrame plain = judged;
  plain.image = cv::Mat(64, 64, CV_8UC1, cv::Scalar::all(100));
  EvaluatedFrame small = plain;
  small.verdicts = {};
  small.no_verdicts = "no ground truth of this stamp";
  EXPECT_EQ(viewSize(plain, {}), viewSize(small, {}));
  EXPECT_NO_THROW(drawEvaluatedFrame(small, {}));
}

TEST(EvaluatedFrame, LinesWithoutVerdictArePlain) {
  EvaluatedFrame frame = sample();
  frame.verdicts = {};
  frame.no_verdicts = "no ground truth";
  const cv::Mat picture = drawEvaluatedFrame(frame, {});
  for (const int y : {50, 100, 150}) {
    EXPECT_LT(distanceTo(palette::kPlain, picture, y), kNear);
  }
  EXPECT_GT(distanceTo(palette::kMissed, picture, 200), kNear);
}

TEST(EvaluatedFrame, TextLongerThanTheMarginStaysInIt) {
  EvaluatedFrame frame = sample();
  frame.title = std::string(200, 'W');
  frame.judged_by = std::string(200, 'i');
  const cv::Mat picture = drawEvaluatedFrame(frame, {});
  const cv::Mat edge = picture.colRange(picture.cols - 5, picture.cols);
  EXPECT_EQ(cv::norm(edge, cv::Mat(edge.size(), CV_8UC3, toBgr(palette::kPaper)), cv::NORM_INF), 0);
}

TEST(EvaluatedFrame, RefusesWhatItCannotDraw) {
  EvaluatedFrame frame = sample();
  frame.image = cv::Mat();
  test::expectError([&] { drawEvaluatedFrame(frame, {}); }, {"0 x 0"});
  frame = sample();
  frame.verdicts.predicted.pop_back();
  test::expectError([&] { drawEvaluatedFrame(frame, {}); }, {"verdicts on 2", "expected 3"});
  ViewOptions options;
  options.scale = 0;
  test::expectError([&] { validate(options); }, {"scale 0", "0.25 to 8"});
  options = {};
  options.brightness = 1.5;
  test::expectError([&] { validate(options); }, {"brightness 1.5", "0 to 1"});
}

}  // namespace
}  // namespace evolin
