// The published implementation's relative poses with the inputs it had.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "evolin_ros/pose/relative_pose.h"
#include "test/support/shared_data.h"

namespace evolin::test {

struct GoldenPair {
  int first = 0;
  int second = 0;
  SpatialMatches matches;
  Pose truth;            ///< first to second
  Pose first_to_second;  ///< as estimated
  Pose second_to_first;
  std::vector<double> forward_errors;  ///< translation angle, rotation (deg), translation (m)
  std::vector<double> backward_errors;
  std::size_t forward_active = 0;  ///< matches left at the end
  std::size_t backward_active = 0;
};

struct GoldenPairs {
  Camera camera;
  std::vector<GoldenPair> pairs;
  nlohmann::json results;
};

inline Pose poseFromJson(const nlohmann::json& rows) {
  Eigen::Matrix3d rotation;
  Pose pose;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      rotation(row, column) = rows[row][column].get<double>();
    }
    pose.translation[row] = rows[row][3].get<double>();
  }
  pose.rotation = Eigen::Quaterniond(rotation).normalized();
  return pose;
}

inline LiftedLine lineFromJson(const nlohmann::json& pixels, const nlohmann::json& points) {
  LiftedLine line;
  for (int axis = 0; axis < 2; ++axis) {
    line.pixel1[axis] = pixels[0][axis].get<double>();
    line.pixel2[axis] = pixels[1][axis].get<double>();
  }
  for (int axis = 0; axis < 3; ++axis) {
    line.point1[axis] = points[0][axis].get<double>();
    line.point2[axis] = points[1][axis].get<double>();
  }
  return line;
}

inline GoldenPairs readGoldenPairs(const std::filesystem::path& file, const Camera& camera) {
  std::ifstream stream(file);
  const nlohmann::json all = nlohmann::json::parse(stream);
  GoldenPairs golden;
  golden.camera = camera;
  golden.results = all["results"];
  for (const nlohmann::json& entry : all["pairs"]) {
    // The first call looks at the second frame's points from the first.
    const nlohmann::json& to_first = entry["calls"][0];
    const nlohmann::json& to_second = entry["calls"][1];
    GoldenPair pair;
    pair.first = entry["first"];
    pair.second = entry["second"];
    pair.truth = poseFromJson(entry["gt_first_to_second"]);
    pair.first_to_second = poseFromJson(entry["est_first_to_second"]);
    pair.second_to_first = poseFromJson(entry["est_second_to_first"]);
    pair.forward_errors =
        entry["first_to_second_errors_angtrans_rot_abstrans"].get<std::vector<double>>();
    pair.backward_errors =
        entry["second_to_first_errors_angtrans_rot_abstrans"].get<std::vector<double>>();
    pair.forward_active = to_first["numpy_port_info"]["inlier_lines"];
    pair.backward_active = to_second["numpy_port_info"]["inlier_lines"];
    for (std::size_t match = 0; match < to_first["lines_3d"].size(); ++match) {
      pair.matches.push_back(
          {lineFromJson(to_first["measured_lines_2d"][match], to_second["lines_3d"][match]),
           lineFromJson(to_second["measured_lines_2d"][match], to_first["lines_3d"][match]),
           match});
    }
    golden.pairs.push_back(std::move(pair));
  }
  return golden;
}

inline Camera pinhole(double fx, double fy, double cx, double cy) {
  Camera camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = fx;
  camera.fy = fy;
  camera.cx = cx;
  camera.cy = cy;
  return camera;
}

/// Nine pairs of neighbours of the living room, 57 matches each.
inline GoldenPairs goldenLivingRoom() {
  return readGoldenPairs(sharedFolder() / "data/golden/icl/pose_error_pairs.json",
                         pinhole(481.2, -480, 319.5, 239.5));
}

/// Seven pairs of a drawn scene with some faulty depth, 44 to 48 matches each.
inline GoldenPairs goldenDrawnScene() {
  return readGoldenPairs(sharedFolder() / "data/golden/sets/pose_basic/expected/pose_error.json",
                         pinhole(525, 525, 319.5, 239.5));
}

}  // namespace evolin::test
