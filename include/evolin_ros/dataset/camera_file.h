// Camera files: our YAML presets, camera_info YAML as ROS tools write it, and the benchmark's
// calibration_matrix.txt.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "evolin_ros/geometry/camera.h"

namespace evolin {

/// Reads either our own form (keys width, height, fx, fy, cx, cy, and optionally name,
/// distortion_model, distortion, depth_factor) or the form that ROS calibration tools write
/// (image_width, image_height, camera_matrix, distortion_model, distortion_coefficients). The name
/// is the file's stem unless the file gives one. Throws ParseError with file and line for a missing
/// or unknown key or a value of a wrong type, Error as validateCamera() for values that it refuses.
Camera readCameraFile(const std::filesystem::path& file);

/// Reads the 3 x 3 matrix K = [fx 0 cx; 0 fy cy; 0 0 1] in pixels, without distortion. The file
/// does not tell the image size: `width` and `height` stay 0 for the caller to fill in. Throws
/// ParseError with file and line for another shape, text, a focal length of zero, or skew.
Camera readCalibrationMatrix(const std::filesystem::path& file);

/// Names of the presets in `folder` (stems of its *.yaml files) in alphabetical order; empty when
/// there is no such folder.
std::vector<std::string> listCameraPresets(const std::filesystem::path& folder);

/// The file that a user means by `name_or_file`: that of a preset of `folder`, or the text itself
/// when it has a slash or an extension .yaml, .yml or .txt (a calibration matrix), be it there or
/// not. Throws Error naming the presets when it is neither.
std::filesystem::path cameraFileOf(const std::string& name_or_file,
                                   const std::filesystem::path& folder);

/// The camera in cameraFileOf(); throws as that and as the functions that read it.
Camera loadCamera(const std::string& name_or_file, const std::filesystem::path& folder);

}  // namespace evolin
