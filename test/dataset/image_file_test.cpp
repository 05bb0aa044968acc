// Image files, whole and cut off.
#include "evolin_ros/dataset/image_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "test/support/expect_error.h"
#include "test/support/shared_data.h"
#include "test/support/temporary_folder.h"

namespace evolin {
namespace {

using test::expectError;
using test::TemporaryFolder;

cv::Mat noise(int type) {
  cv::Mat image(48, 64, type);
  cv::RNG random(7);
  random.fill(image, cv::RNG::UNIFORM, 0, 255);
  return image;
}

std::string contentOf(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

double difference(const cv::Mat& a, const cv::Mat& b) { return cv::norm(a, b, cv::NORM_INF); }

TEST(ReadImage, KeepsGreyGreyAndColourBgr) {
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "a.png").string();
  for (const int type : {CV_8UC1, CV_8UC3}) {
    const cv::Mat image = noise(type);
    cv::imwrite(file, image);
    const cv::Mat read = readImage(file);
    ASSERT_EQ(read.type(), type);
    EXPECT_EQ(difference(read, image), 0);
  }
}

TEST(ReadImage, DropsTransparency) {
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "a.png").string();
  cv::imwrite(file, noise(CV_8UC4));
  EXPECT_EQ(readImage(file).type(), CV_8UC3);
}

TEST(ReadImage, NoticesAPngCutOffAnywhere) {
  const TemporaryFolder folder;
  const std::string whole = (folder.path() / "whole.png").string();
  cv::imwrite(whole, noise(CV_8UC3));
  const std::string content = contentOf(whole);
  for (std::size_t kept = 8; kept < content.size(); kept += content.size() / 40 + 1) {
    const auto file = folder.write("cut.png", content.substr(0, kept));
    expectError<ParseError>([&] { readImage(file); },
                            {"cut.png", "truncated", std::to_string(kept), "IEND"});
  }
  const auto file = folder.write("cut.png", content.substr(0, content.size() - 1));
  expectError<ParseError>([&] { readImage(file); }, {"truncated"});
  EXPECT_EQ(readImage(folder.write("more.png", content + "tail")).type(), CV_8UC3);
}

TEST(ReadImage, NoticesAJpegCutOffAnywhere) {
  const TemporaryFolder folder;
  for (const int progressive : {0, 1}) {
    const std::string whole = (folder.path() / "whole.jpg").string();
    cv::imwrite(whole, noise(CV_8UC3),
                {cv::IMWRITE_JPEG_PROGRESSIVE, progressive, cv::IMWRITE_JPEG_RST_INTERVAL, 3});
    EXPECT_EQ(readImage(whole).type(), CV_8UC3);
    const std::string content = contentOf(whole);
    for (std::size_t kept = 3; kept < content.size() - 2; kept += content.size() / 40 + 1) {
      const auto file = folder.write("cut.jpg", content.substr(0, kept));
      expectError<ParseError>([&] { readImage(file); },
                              {"cut.jpg", "truncated", std::to_string(kept)});
    }
    EXPECT_EQ(readImage(folder.write("more.jpg", content + std::string(16, '\0'))).type(), CV_8UC3);
  }
}

TEST(ReadImage, IsNotDeceivedByTheEndMarkerOfAThumbnail) {
  const TemporaryFolder folder;
  const std::string whole = (folder.path() / "whole.jpg").string();
  cv::imwrite(whole, noise(CV_8UC3));
  const std::string content = contentOf(whole);
  // An application segment that holds an end marker, then the picture cut off behind another one.
  const std::string segment("\xff\xe1\x00\x08\xff\xd8\xff\xd9\x00\x00", 10);
  const std::string with_thumbnail = content.substr(0, 2) + segment + content.substr(2);
  EXPECT_EQ(readImage(folder.write("whole2.jpg", with_thumbnail)).type(), CV_8UC3);
  const auto file = folder.write("cut.jpg", with_thumbnail.substr(0, content.size() / 2));
  expectError<ParseError>([&] { readImage(file); }, {"truncated"});
}

TEST(ReadImage, SaysWhatIsNoImage) {
  const TemporaryFolder folder;
  expectError<ParseError>([&] { readImage(folder.path() / "none.png"); },
                          {"none.png", "does not exist"});
  const auto empty = folder.write("empty.png", "");
  expectError<ParseError>([&] { readImage(empty); }, {"empty.png", "0 bytes"});
  const auto text = folder.write("text.png", "not an image at all");
  expectError<ParseError>([&] { readImage(text); }, {"text.png", "cannot be decoded"});
  expectError<ParseError>([&] { readImage(folder.path()); }, {"cannot be opened"});
}

TEST(ReadDepthImage, GivesMetresAndNanForNoDepth) {
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "d.png").string();
  const cv::Mat stored = (cv::Mat_<std::uint16_t>(1, 4) << 0, 1, 5000, 65535);
  cv::imwrite(file, stored);
  const cv::Mat depth = readDepthImage(file, 5000);
  ASSERT_EQ(depth.type(), CV_32FC1);
  EXPECT_TRUE(std::isnan(depth.at<float>(0, 0)));
  EXPECT_FLOAT_EQ(depth.at<float>(0, 1), 0.0002F);
  EXPECT_EQ(depth.at<float>(0, 2), 1.0F);
  EXPECT_FLOAT_EQ(depth.at<float>(0, 3), 13.107F);
  EXPECT_EQ(readDepthImage(file, 1000).at<float>(0, 2), 5.0F);
}

TEST(ReadStoredDepth, GivesTheUnitsAsTheyAre) {
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "d.png").string();
  const cv::Mat written = (cv::Mat_<std::uint16_t>(1, 3) << 0, 1, 65535);
  cv::imwrite(file, written);
  const cv::Mat stored = readStoredDepth(file);
  ASSERT_EQ(stored.type(), CV_16UC1);
  EXPECT_EQ(stored.at<std::uint16_t>(0, 0), 0);
  EXPECT_EQ(stored.at<std::uint16_t>(0, 1), 1);
  EXPECT_EQ(stored.at<std::uint16_t>(0, 2), 65535);
  cv::imwrite(file, noise(CV_8UC1));
  expectError<ParseError>([&] { readStoredDepth(file); }, {"d.png", "1 channels of 8 bits"});
}

TEST(ReadDepthImage, RefusesAnImageOfAnotherType) {
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "d.png").string();
  cv::imwrite(file, noise(CV_8UC3));
  expectError<ParseError>([&] { readDepthImage(file, 5000); },
                          {"d.png", "3 channels of 8 bits", "16 bits"});
}

TEST(ReadImage, ReadsEveryRealSampleImage) {
  EVOLIN_REQUIRE_SHARED_DATA();
  int images = 0;
  for (const char* name : {"icl_nuim_lr_sample", "tum_fr3_cabinet_sample", "tum_fr1_desk_sample"}) {
    for (const auto& entry :
         std::filesystem::directory_iterator(test::sharedFolder() / "data" / name / "rgb")) {
      EXPECT_EQ(readImage(entry.path()).size(), cv::Size(640, 480)) << entry.path();
      ++images;
    }
  }
  EXPECT_EQ(images, 10 + 58 + 9);
}

TEST(WriteImage, WritesWhatIsReadAgain) {
  const TemporaryFolder folder;
  const cv::Mat image = noise(CV_8UC3);
  writeImage(folder.path() / "a.png", image);
  EXPECT_EQ(difference(readImage(folder.path() / "a.png"), image), 0);
  writeImage(folder.path() / "a.jpg", image, {cv::IMWRITE_JPEG_QUALITY, 10});
  writeImage(folder.path() / "b.jpg", image, {cv::IMWRITE_JPEG_QUALITY, 95});
  EXPECT_LT(contentOf(folder.path() / "a.jpg").size(), contentOf(folder.path() / "b.jpg").size());
}

TEST(WriteImage, NamesTheFileThatItCannotMake) {
  const TemporaryFolder folder;
  expectError([&] { writeImage(folder.path() / "a.txt", noise(CV_8UC3)); },
              {"a.txt", "cannot be encoded"});
  expectError([&] { writeImage(folder.path() / "a.png", cv::Mat()); },
              {"a.png", "cannot be encoded"});
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  writeImage(folder.path() / "b.png", noise(CV_8UC1));
  expectError([&] { writeImage(folder.path() / "b.png/a.png", noise(CV_8UC1)); }, {"b.png"});
}

}  // namespace
}  // namespace evolin
