// The binary descriptors compiled as for an OpenCV without line_descriptor: our own works, OpenCV's
// says what is missing.
#include <gtest/gtest.h>

#include <opencv2/core/version.hpp>
#include <string>

#include "evolin_ros/association/lbd_binary_associator.h"
#include "evolin_ros/association/opencv_lbd_binary.h"
#include "evolin_ros/base/error.h"
#include "test/association/textured_images.h"

namespace evolin {
namespace {

TEST(UnavailableOpenCvLbdBinary, SaysWhatIsMissing) {
  const std::string why = OpenCvLbdBinaryAssociator().whyUnavailable();
  for (const char* part : {CV_VERSION, "BinaryDescriptor", "line_descriptor", "opencv_contrib"}) {
    EXPECT_NE(why.find(part), std::string::npos) << why;
  }
}

TEST(UnavailableOpenCvLbdBinary, RefusesToBeConfiguredOrUsed) {
  OpenCvLbdBinaryAssociator associator;
  try {
    associator.configure(YAML::Node());
    FAIL() << "opencv_lbd_binary was configured";
  } catch (const UnavailableError& error) {
    EXPECT_NE(std::string(error.what()).find("associator opencv_lbd_binary"), std::string::npos)
        << error.what();
    EXPECT_NE(std::string(error.what()).find(associator.whyUnavailable()), std::string::npos)
        << error.what();
  }
  EXPECT_THROW(associator.match(FrameLines(), FrameLines()), Error);
  const cv::Mat image(40, 40, CV_8UC1, cv::Scalar(0));
  EXPECT_THROW(describeOpenCvLbdBinary(image, LineSegments(1)), UnavailableError);
}

TEST(LbdBinary, NeedsNoOpenCvModule) {
  LbdBinaryAssociator associator;
  EXPECT_EQ(associator.whyUnavailable(), "");
  associator.configure(YAML::Node());
  FrameLines frame;
  frame.frame.image = test::texture(200, 240);
  frame.lines = {test::segment(50, 50, 150, 60), test::segment(60, 150, 170, 120)};
  const LineMatches matches = associator.match(frame, frame);
  ASSERT_EQ(matches.size(), 2U);
  EXPECT_EQ(matches[1].second, 1U);
}

}  // namespace
}  // namespace evolin
