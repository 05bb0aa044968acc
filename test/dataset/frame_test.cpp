// Claims about grey images.
#include "evolin_ros/dataset/frame.h"

#include <gtest/gtest.h>

#include "evolin_ros/base/error.h"

namespace evolin {
namespace {

TEST(ToGray, SharesAGreyImage) {
  const cv::Mat image(3, 4, CV_8UC1, cv::Scalar(7));
  EXPECT_EQ(toGray(image).data, image.data);
}

TEST(ToGray, WeighsBlueGreenAndRed) {
  cv::Mat image(1, 4, CV_8UC3);
  image.at<cv::Vec3b>(0) = {255, 0, 0};
  image.at<cv::Vec3b>(1) = {0, 255, 0};
  image.at<cv::Vec3b>(2) = {0, 0, 255};
  image.at<cv::Vec3b>(3) = {10, 100, 200};
  const cv::Mat gray = toGray(image);
  ASSERT_EQ(gray.type(), CV_8UC1);
  ASSERT_EQ(gray.size(), image.size());
  EXPECT_EQ(gray.at<uchar>(0), 29);   // 0.114 * 255
  EXPECT_EQ(gray.at<uchar>(1), 150);  // 0.587 * 255
  EXPECT_EQ(gray.at<uchar>(2), 76);   // 0.299 * 255
  EXPECT_EQ(gray.at<uchar>(3), 120);  // 0.114 * 10 + 0.587 * 100 + 0.299 * 200 = 119.64
}

TEST(ToGray, ReadsAPartOfALargerImage) {
  cv::Mat image(10, 10, CV_8UC3, cv::Scalar(0, 0, 0));
  image(cv::Rect(2, 3, 4, 5)).setTo(cv::Scalar(90, 90, 90));
  const cv::Mat gray = toGray(image(cv::Rect(2, 3, 4, 5)));
  ASSERT_EQ(gray.size(), cv::Size(4, 5));
  EXPECT_EQ(cv::countNonZero(gray != 90), 0);
}

TEST(ToGray, RefusesEmptyImagesAndOtherTypes) {
  EXPECT_THROW(toGray(cv::Mat()), Error);
  for (const int type : {CV_8UC2, CV_8UC4, CV_8SC1, CV_16UC1, CV_16UC3, CV_32FC1, CV_64FC3}) {
    EXPECT_THROW(toGray(cv::Mat(2, 2, type, cv::Scalar::all(1))), Error) << type;
  }
  const int sizes[] = {2, 2, 2};
  EXPECT_THROW(toGray(cv::Mat(3, sizes, CV_8UC1, cv::Scalar(1))), Error);
  try {
    toGray(cv::Mat(2, 2, CV_16UC3, cv::Scalar::all(1)));
    FAIL() << "took a 16-bit image";
  } catch (const Error& error) {
    EXPECT_STREQ(
        error.what(),
        "image of 3 16-bit unsigned channel(s) in 2 dimensions: expected an 8-bit image of "
        "1 (grey) or 3 (BGR) channels");
  }
}

TEST(FrameLines, StartWithoutWhatIsOptional) {
  const FrameLines lines;
  EXPECT_EQ(lines.frame.stamp, 0);
  EXPECT_TRUE(lines.frame.image.empty());
  EXPECT_TRUE(lines.frame.depth.empty());
  EXPECT_FALSE(lines.frame.camera);
  EXPECT_FALSE(lines.frame.pose);
  EXPECT_FALSE(lines.description.has_value());
}

}  // namespace
}  // namespace evolin
