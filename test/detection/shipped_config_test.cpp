// The files of config/detectors/ against the defaults in the code.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <string>
#include <tuple>

#include "evolin_ros/base/error.h"
#include "evolin_ros/detection/cannylines.h"
#include "evolin_ros/detection/edlines.h"
#include "evolin_ros/detection/elsed.h"
#include "evolin_ros/detection/fld.h"
#include "evolin_ros/detection/fsg.h"
#include "evolin_ros/detection/hough_p.h"
#include "evolin_ros/detection/kht.h"
#include "evolin_ros/detection/lsd.h"
#include "evolin_ros/detection/lsdnet.h"
#include "evolin_ros/detection/lswms.h"
#include "evolin_ros/detection/mlsd.h"
#include "evolin_ros/detection/opencv_edlines.h"
#include "evolin_ros/detection/opencv_fld.h"
#include "evolin_ros/detection/opencv_lsd.h"

namespace evolin {
namespace {

auto values(const OpenCvLsdParameters& p) {
  return std::make_tuple(p.refine, p.scale, p.sigma_scale, p.quantization, p.angle_tolerance,
                         p.log_eps, p.density_threshold, p.bins);
}

auto values(const OpenCvEdLinesParameters& p) {
  return std::make_tuple(p.parameter_free, p.gradient_operator, p.gradient_threshold,
                         p.anchor_threshold, p.scan_interval, p.min_path_length, p.sigma,
                         p.sum_gradient, p.nfa_validation, p.min_line_length,
                         p.max_distance_between_two_lines, p.line_fit_error_threshold,
                         p.max_error_threshold);
}

auto values(const OpenCvFldParameters& p) {
  return std::make_tuple(p.length_threshold, p.distance_threshold, p.canny_threshold1,
                         p.canny_threshold2, p.canny_aperture, p.merge);
}

auto values(const HoughPParameters& p) {
  return std::make_tuple(p.canny_threshold1, p.canny_threshold2, p.canny_aperture, p.rho, p.theta,
                         p.threshold, p.min_length, p.max_gap);
}

auto selectionValues(const DetectorSelection& s) {
  return std::make_tuple(s.score_threshold, s.min_length, s.max_lines, s.mask);
}

auto values(const CannyLinesParameters& p) {
  return std::tuple_cat(
      std::make_tuple(p.sigma, p.meaningful_gradient, p.fit_error, p.validate, p.compatible),
      selectionValues(p.selection));
}

auto values(const KhtParameters& p) {
  return std::tuple_cat(std::make_tuple(p.canny_threshold1, p.canny_threshold2, p.min_cluster,
                                        p.min_deviation, p.delta, p.min_height, p.sigmas),
                        selectionValues(p.selection));
}

auto values(const EdLinesParameters& p) {
  return std::tuple_cat(
      std::make_tuple(p.kernel, p.sigma, p.gradient_threshold, p.anchor_threshold, p.scan_interval,
                      p.min_path_length, p.min_line_length, p.first_fit_error, p.pixel_distance,
                      p.join_distance, p.join_error, p.validate),
      selectionValues(p.selection));
}

auto values(const ElsedParameters& p) {
  return std::tuple_cat(
      std::make_tuple(p.kernel, p.sigma, p.gradient_threshold, p.anchor_threshold, p.scan_interval,
                      p.min_line_length, p.line_fit_error, p.pixel_distance, p.max_outliers,
                      p.junctions, p.junction_eigenvalues, p.junction_angle, p.validate,
                      p.validation_threshold),
      selectionValues(p.selection));
}

auto values(const LsdParameters& p) {
  return std::tuple_cat(
      std::make_tuple(p.refine, p.scale, p.sigma_scale, p.quantization, p.angle_tolerance,
                      p.log_eps, p.density_threshold, p.bins, p.compatible),
      selectionValues(p.selection));
}

auto values(const LswmsParameters& p) {
  return std::tuple_cat(
      std::make_tuple(p.radius, p.angle_tolerance, p.max_error, p.score, p.compatible),
      selectionValues(p.selection));
}

auto values(const FldParameters& p) {
  return std::tuple_cat(std::make_tuple(p.length_threshold, p.distance_threshold,
                                        p.canny_threshold1, p.canny_threshold2, p.canny_aperture),
                        selectionValues(p.selection));
}

auto values(const FsgParameters& p) {
  return std::tuple_cat(
      std::make_tuple(p.endpoint_error, p.max_overlap, p.max_gap, p.orientation_bins, p.length_bins,
                      p.segment_density, p.min_line_length),
      selectionValues(p.selection));
}

auto networkValues(const NetworkOptions& n) {
  return std::make_tuple(n.model, n.backend, n.target, n.threads, n.verify);
}

auto values(const MlsdParameters& p) {
  return std::tuple_cat(networkValues(p.network),
                        std::make_tuple(p.min_grid_length, p.candidates, p.clip),
                        selectionValues(p.selection));
}

auto values(const LsdNetParameters& p) {
  return std::tuple_cat(networkValues(p.network),
                        std::make_tuple(p.channel_order, p.compatible, p.single_pass, p.clip),
                        selectionValues(p.selection));
}

std::filesystem::path configFolder() {
  return std::filesystem::path(EVOLIN_SOURCE_DIR) / "config" / "detectors";
}

// A file that names every parameter once, with the default, has as many keys as the struct has
// members; unknown keys do not load.
template <typename Detector>
void expectHoldsAllDefaults(const std::string& name) {
  Detector detector;
  if (!detector.whyUnavailable().empty()) {
    GTEST_SKIP() << detector.whyUnavailable();
  }
  const YAML::Node file = YAML::LoadFile((configFolder() / (name + ".yaml")).string());
  ASSERT_NO_THROW(detector.configure(file));
  const auto defaults = values(Detector().parameters());
  EXPECT_TRUE(values(detector.parameters()) == defaults);
  std::set<std::string> keys;
  for (const auto& entry : file) {
    keys.insert(entry.first.as<std::string>());
  }
  EXPECT_EQ(keys.size(), file.size()) << "a key occurs twice";
  EXPECT_EQ(keys.size(), std::tuple_size<std::decay_t<decltype(defaults)>>::value);
}

TEST(ShippedDetectorConfig, OwnLsdHoldsAllDefaults) { expectHoldsAllDefaults<Lsd>("lsd"); }

TEST(ShippedDetectorConfig, LswmsHoldsAllDefaults) { expectHoldsAllDefaults<Lswms>("lswms"); }

TEST(ShippedDetectorConfig, FsgHoldsAllDefaults) { expectHoldsAllDefaults<Fsg>("fsg"); }

TEST(ShippedDetectorConfig, LsdHoldsAllDefaults) {
  expectHoldsAllDefaults<OpenCvLsd>("opencv_lsd");
}

TEST(ShippedDetectorConfig, CannyLinesHoldsAllDefaults) {
  expectHoldsAllDefaults<CannyLines>("cannylines");
}

TEST(ShippedDetectorConfig, KhtHoldsAllDefaults) { expectHoldsAllDefaults<Kht>("kht"); }

TEST(ShippedDetectorConfig, OwnEdLinesHoldsAllDefaults) {
  expectHoldsAllDefaults<EdLines>("edlines");
}

TEST(ShippedDetectorConfig, EdLinesHoldsAllDefaults) {
  expectHoldsAllDefaults<OpenCvEdLines>("opencv_edlines");
}

TEST(ShippedDetectorConfig, OwnFldHoldsAllDefaults) { expectHoldsAllDefaults<Fld>("fld"); }

TEST(ShippedDetectorConfig, FldHoldsAllDefaults) {
  expectHoldsAllDefaults<OpenCvFld>("opencv_fld");
}

TEST(ShippedDetectorConfig, ElsedHoldsAllDefaults) { expectHoldsAllDefaults<Elsed>("elsed"); }

TEST(ShippedDetectorConfig, HoughPHoldsAllDefaults) { expectHoldsAllDefaults<HoughP>("hough_p"); }

// Without weights their files are read as far as the file of the model: it is what is missed.
template <typename Detector>
void expectHoldsAllDefaultsOfANetwork(const std::string& name) {
  const YAML::Node file = YAML::LoadFile((configFolder() / (name + ".yaml")).string());
  const auto defaults = values(Detector().parameters());
  EXPECT_EQ(file.size(), std::tuple_size<std::decay_t<decltype(defaults)>>::value);
  EXPECT_EQ(file["model"].as<std::string>(), Detector().parameters().network.model);
  if (!whyNoNetworks().empty()) {
    GTEST_SKIP() << whyNoNetworks();
  }
  Detector detector;
  try {
    detector.configure(file);
    EXPECT_TRUE(values(detector.parameters()) == defaults);
  } catch (const UnavailableError& error) {
    if (std::string(error.what()).find("parameter 'model'") == std::string::npos) {
      GTEST_SKIP() << error.what();
    }
  }
}

TEST(ShippedDetectorConfig, MlsdHoldsAllDefaults) {
  expectHoldsAllDefaultsOfANetwork<Mlsd>("mlsd");
}

TEST(ShippedDetectorConfig, LsdNetHoldsAllDefaults) {
  expectHoldsAllDefaultsOfANetwork<LsdNet>("lsdnet");
}

TEST(ShippedDetectorConfig, HasNoFileWithoutATest) {
  const std::set<std::string> tested = {"cannylines.yaml", "edlines.yaml",   "elsed.yaml",
                                        "fld.yaml",        "fsg.yaml",       "hough_p.yaml",
                                        "kht.yaml",        "lsd.yaml",       "lsdnet.yaml",
                                        "lswms.yaml",      "mlsd.yaml",      "opencv_edlines.yaml",
                                        "opencv_fld.yaml", "opencv_lsd.yaml"};
  for (const auto& entry : std::filesystem::directory_iterator(configFolder())) {
    EXPECT_EQ(tested.count(entry.path().filename().string()), 1U) << entry.path();
  }
}

}  // namespace
}  // namespace evolin
