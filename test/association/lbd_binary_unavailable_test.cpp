// The lbd_binary plug-in compiled as for an OpenCV without line_descriptor.
#include <gtest/gtest.h>

#include <opencv2/core/version.hpp>
#include <string>

#include "evolin_ros/association/lbd_binary_associator.h"
#include "evolin_ros/association/lbd_binary_descriptor.h"
#include "evolin_ros/base/error.h"

namespace evolin {
namespace {

TEST(UnavailableLbdBinary, SaysWhatIsMissing) {
  const std::string why = LbdBinaryAssociator().whyUnavailable();
  for (const char* part : {CV_VERSION, "BinaryDescriptor", "line_descriptor", "opencv_contrib"}) {
    EXPECT_NE(why.find(part), std::string::npos) << why;
  }
}

TEST(UnavailableLbdBinary, RefusesToBeConfiguredOrUsed) {
  LbdBinaryAssociator associator;
  try {
    associator.configure(YAML::Node());
    FAIL() << "lbd_binary was configured";
  } catch (const UnavailableError& error) {
    EXPECT_NE(std::string(error.what()).find("associator lbd_binary"), std::string::npos)
        << error.what();
    EXPECT_NE(std::string(error.what()).find(associator.whyUnavailable()), std::string::npos)
        << error.what();
  }
  EXPECT_THROW(associator.match(FrameLines(), FrameLines()), Error);
  const cv::Mat image(40, 40, CV_8UC1, cv::Scalar(0));
  EXPECT_THROW(describeLbdBinary(image, LineSegments(1)), UnavailableError);
}

}  // namespace
}  // namespace evolin
