// Camera files, presets and calibration matrices.
#include "evolin_ros/dataset/camera_file.h"

#include <gtest/gtest.h>

#include <string>

#include "test/support/expect_error.h"
#include "test/support/shared_data.h"
#include "test/support/temporary_folder.h"

namespace evolin {
namespace {

using test::expectError;
using test::TemporaryFolder;

std::filesystem::path presetFolder() {
  return std::filesystem::path(__FILE__).parent_path() / "../../config/cameras";
}

const std::string kGood = "width: 320\nheight: 240\nfx: 260.5\nfy: -261\ncx: 159.5\ncy: 119.5\n";

TEST(CameraPresets, AreTheFourOfTheDataSets) {
  EXPECT_EQ(listCameraPresets(presetFolder()),
            (std::vector<std::string>{"icl", "tum_fr1", "tum_fr2", "tum_fr3"}));
  EXPECT_TRUE(listCameraPresets("/nowhere").empty());
}

TEST(CameraPresets, HoldThePublishedCalibrations) {
  const Camera fr1 = loadCamera("tum_fr1", presetFolder());
  EXPECT_EQ(fr1.name, "tum_fr1");
  EXPECT_EQ(fr1.width, 640);
  EXPECT_EQ(fr1.height, 480);
  EXPECT_EQ(fr1.fx, 517.3);
  EXPECT_EQ(fr1.cy, 255.3);
  EXPECT_EQ(fr1.distortion_model, "plumb_bob");
  EXPECT_EQ(fr1.distortion, (std::vector<double>{0.2624, -0.9531, -0.0054, 0.0026, 1.1633}));
  EXPECT_EQ(fr1.depth_factor, 5000);
  const Camera fr2 = loadCamera("tum_fr2", presetFolder());
  EXPECT_EQ(fr2.fy, 521.0);
  EXPECT_EQ(fr2.distortion, (std::vector<double>{0.2312, -0.7849, -0.0033, -0.0001, 0.9172}));
  const Camera fr3 = loadCamera("tum_fr3", presetFolder());
  EXPECT_EQ(fr3.fx, 535.4);
  EXPECT_EQ(fr3.distortion, std::vector<double>(5, 0));
  const Camera icl = loadCamera("icl", presetFolder());
  EXPECT_EQ(icl.fx, 481.2);
  EXPECT_EQ(icl.fy, -480);
}

TEST(LoadCamera, NamesThePresetsWhenThereIsNoSuchOne) {
  expectError([] { loadCamera("tum_fr9", presetFolder()); }, {"tum_fr9", "icl, tum_fr1"});
  expectError([] { loadCamera("icl", "/nowhere"); }, {"/nowhere"});
}

TEST(CameraFileOf, IsThePresetOfAPlainNameAndElseTheTextItself) {
  EXPECT_EQ(cameraFileOf("icl", presetFolder()), presetFolder() / "icl.yaml");
  for (const char* text :
       {"icl.yaml", "mine.yml", "calibration_matrix.txt", "./icl", "/nowhere/x"}) {
    EXPECT_EQ(cameraFileOf(text, presetFolder()), text);
  }
  expectError([] { cameraFileOf("", presetFolder()); }, {"''", "icl, tum_fr1"});
}

TEST(LoadCamera, TakesAFileByItsPath) {
  const TemporaryFolder folder;
  const auto file = folder.write("own.yaml", kGood);
  const Camera camera = loadCamera(file.string(), presetFolder());
  EXPECT_EQ(camera.name, "own");
  EXPECT_EQ(camera.fy, -261);
  EXPECT_EQ(camera.depth_factor, 5000);
  EXPECT_TRUE(camera.distortion.empty());
  expectError<ParseError>([&] { loadCamera("/nowhere/x.yaml", presetFolder()); }, {"x.yaml"});
}

TEST(ReadCameraFile, ReadsWhatRosCalibrationToolsWrite) {
  const TemporaryFolder folder;
  const auto file = folder.write(
      "head.yaml",
      "image_width: 640\nimage_height: 480\ncamera_name: head\n"
      "camera_matrix:\n  rows: 3\n  cols: 3\n  data: [500, 0, 320, 0, 501, 240, 0, 0, 1]\n"
      "distortion_model: plumb_bob\n"
      "distortion_coefficients:\n  rows: 1\n  cols: 5\n  data: [0.1, 0.2, 0.3, 0.4, 0.5]\n"
      "rectification_matrix:\n  rows: 3\n  cols: 3\n  data: [1, 0, 0, 0, 1, 0, 0, 0, 1]\n");
  const Camera camera = readCameraFile(file);
  EXPECT_EQ(camera.name, "head");
  EXPECT_EQ(camera.width, 640);
  EXPECT_EQ(camera.fx, 500);
  EXPECT_EQ(camera.fy, 501);
  EXPECT_EQ(camera.cx, 320);
  EXPECT_EQ(camera.cy, 240);
  EXPECT_EQ(camera.distortion, (std::vector<double>{0.1, 0.2, 0.3, 0.4, 0.5}));
}

TEST(ReadCameraFile, NamesFileLineAndValueOfWhatIsWrong) {
  const TemporaryFolder folder;
  const struct {
    std::string text;
    std::string place;
    std::string said;
  } cases[] = {
      {kGood + "focal: 3\n", "bad.yaml:7", "unknown key 'focal'"},
      {kGood + "depth_factor: many\n", "bad.yaml:7", "many"},
      {kGood + "distortion: [0.1, x, 0, 0]\n", "bad.yaml:7", "'x'"},
      {kGood + "distortion: [0.1, 0.2, 0.3]\n", "bad.yaml", "3 coefficients"},
      {kGood + "depth_factor: 0\n", "bad.yaml", "depth_factor is 0"},
      {"width: 320\nheight: 240\nfx: 0\nfy: 1\ncx: 1\ncy: 1\n", "bad.yaml:3", "fx is 0"},
      {"width: 3.5\nheight: 240\nfx: 1\nfy: 1\ncx: 1\ncy: 1\n", "bad.yaml:1", "3.5"},
      {"width: 320\nheight: -1\nfx: 1\nfy: 1\ncx: 1\ncy: 1\n", "bad.yaml:2", "-1"},
      {"width: 320\nheight: 240\nfx: .nan\nfy: 1\ncx: 1\ncy: 1\n", "bad.yaml:3", ".nan"},
      {"width: 320\nheight: 240\nfy: 1\ncx: 1\ncy: 1\n", "bad.yaml", "'fx' is missing"},
      {"width: [320\n", "bad.yaml:", "YAML"},
      {"just words\n", "bad.yaml", "expected a map"},
      {"", "bad.yaml", "expected a map"},
      {"image_width: 2\nimage_height: 2\ncamera_matrix: [1, 2]\n", "bad.yaml:3", "2 numbers"}};
  for (const auto& bad : cases) {
    const auto file = folder.write("bad.yaml", bad.text);
    expectError([&] { readCameraFile(file); }, {bad.place, bad.said});
  }
}

TEST(ReadCalibrationMatrix, ReadsThePinholeParameters) {
  const TemporaryFolder folder;
  const auto file =
      folder.write("calibration_matrix.txt", "4.812e+02 0.0 3.195e+02\n0 -480 239.5\n0.0 0 1\n");
  const Camera camera = readCalibrationMatrix(file);
  EXPECT_EQ(camera.fx, 481.2);
  EXPECT_EQ(camera.fy, -480);
  EXPECT_EQ(camera.cx, 319.5);
  EXPECT_EQ(camera.cy, 239.5);
  EXPECT_EQ(camera.width, 0);
}

TEST(ReadCalibrationMatrix, NamesFileLineAndValueOfWhatIsWrong) {
  const TemporaryFolder folder;
  const struct {
    std::string text;
    std::string place;
    std::string said;
  } cases[] = {{"0 0 3\n0 4 5\n0 0 1\n", "K.txt:1", "fx is 0"},
               {"3 0 3\n0 0 5\n0 0 1\n", "K.txt:2", "fy is 0"},
               {"3 1 3\n0 4 5\n0 0 1\n", "K.txt:1", "column 2 is 1, expected 0"},
               {"3 0 3\n0 4 5\n0 0 2\n", "K.txt:3", "column 3 is 2, expected 1"},
               {"3 0\n0 4 5\n0 0 1\n", "K.txt:1", "'3 0'"},
               {"3 0 3\n0 4 5\n", "K.txt", "2 rows"},
               {"3 0 3\n0 4 5\n0 0 1\n0 0 1\n", "K.txt:4", "row 4"},
               {"3 0 3\n0 four 5\n0 0 1\n", "K.txt:2", "four"},
               {"3 0 nan\n0 4 5\n0 0 1\n", "K.txt:1", "nan"}};
  for (const auto& bad : cases) {
    const auto file = folder.write("K.txt", bad.text);
    expectError<ParseError>([&] { readCalibrationMatrix(file); }, {bad.place, bad.said});
  }
}

TEST(ReadCalibrationMatrix, ReadsTheOneOfTheRealSample) {
  EVOLIN_REQUIRE_SHARED_DATA();
  const Camera camera = readCalibrationMatrix(test::sharedFolder() /
                                              "data/icl_nuim_lr_sample/calibration_matrix.txt");
  EXPECT_EQ(camera.fx, 481.2);
  EXPECT_EQ(camera.fy, -480);
}

}  // namespace
}  // namespace evolin
