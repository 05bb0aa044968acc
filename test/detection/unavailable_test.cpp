// The detectors compiled as for an OpenCV that lacks them all.
#include <gtest/gtest.h>

#include <opencv2/core/version.hpp>

#include "evolin_ros/base/error.h"
#include "evolin_ros/detection/lsdnet.h"
#include "evolin_ros/detection/mlsd.h"
#include "evolin_ros/detection/opencv_edlines.h"
#include "evolin_ros/detection/opencv_fld.h"
#include "evolin_ros/detection/opencv_lsd.h"

namespace evolin {
namespace {

template <typename Detector>
void expectSaysWhatIsMissing(const std::string& name, const std::string& thing,
                             const std::string& since) {
  Detector detector;
  const std::string why = detector.whyUnavailable();
  EXPECT_NE(why.find(CV_VERSION), std::string::npos) << why;
  EXPECT_NE(why.find(thing), std::string::npos) << why;
  EXPECT_NE(why.find(since), std::string::npos) << why;
  try {
    detector.configure(YAML::Node());
    FAIL() << name << " was configured";
  } catch (const UnavailableError& error) {
    EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
  }
  Frame frame;
  frame.image = cv::Mat(40, 40, CV_8UC1, cv::Scalar(0));
  EXPECT_THROW(detector.detect(frame), Error);
}

TEST(UnavailableDetector, LsdSaysWhatIsMissing) {
  expectSaysWhatIsMissing<OpenCvLsd>("opencv_lsd", "LineSegmentDetector", "4.1.0 to 4.5.3");
}

TEST(UnavailableDetector, EdLinesSaysWhatIsMissing) {
  expectSaysWhatIsMissing<OpenCvEdLines>("opencv_edlines", "EdgeDrawing", "4.5.2");
}

TEST(UnavailableDetector, FldSaysWhatIsMissing) {
  expectSaysWhatIsMissing<OpenCvFld>("opencv_fld", "FastLineDetector", "opencv_contrib");
}

TEST(UnavailableDetector, NetworksSayWhatIsMissing) {
  expectSaysWhatIsMissing<Mlsd>("mlsd", "module dnn", "3.3");
  expectSaysWhatIsMissing<LsdNet>("lsdnet", "module dnn", "3.3");
}

}  // namespace
}  // namespace evolin
