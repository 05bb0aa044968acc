// Reading of camera files.
#include "evolin_ros/dataset/camera_file.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/parameters.h"
#include "evolin_ros/base/text.h"
#include "evolin_ros/base/yaml_file.h"

namespace evolin {

namespace {

constexpr int kLargestImageSide = 1 << 20;

// One map of a camera file whose errors carry the line.
class CameraMap {
 public:
  CameraMap(std::string file, const YAML::Node& node) : file_(std::move(file)), node_(node) {}

  bool has(const std::string& key) const { return node_[key].IsDefined(); }

  YAML::Node get(const std::string& key) const {
    const YAML::Node value = node_[key];
    if (!value.IsDefined()) {
      throw ParseError(file_, 0, "key '" + key + "' is missing, expected " + expectedKeys());
    }
    return value;
  }

  double number(const std::string& key) const { return toNumber(key, get(key)); }

  double focalLength(const std::string& key) const {
    const YAML::Node value = get(key);
    const double pixels = toNumber(key, value);
    if (pixels == 0) {
      fail(value, "focal length " + key + " is 0, expected a number of pixels other than 0");
    }
    return pixels;
  }

  int side(const std::string& key) const {
    const YAML::Node value = get(key);
    const std::optional<std::int64_t> pixels =
        value.IsScalar() ? parseInteger(value.Scalar()) : std::nullopt;
    if (!pixels || *pixels <= 0 || *pixels > kLargestImageSide) {
      fail(value, key + " is " + show(value) + ", expected a positive whole number of pixels");
    }
    return static_cast<int>(*pixels);
  }

  std::string text(const std::string& key) const {
    const YAML::Node value = get(key);
    if (!value.IsScalar()) {
      fail(value, key + " is " + show(value) + ", expected a word");
    }
    return value.Scalar();
  }

  std::vector<double> numbers(const std::string& key, YAML::Node list) const {
    // The matrices of ROS's calibration files are maps {rows, cols, data}.
    if (list.IsMap() && list["data"].IsDefined()) {
      list = list["data"];
    }
    if (!list.IsSequence() && !list.IsNull()) {
      fail(list, key + " is " + show(list) + ", expected a list of numbers");
    }
    std::vector<double> result;
    for (const YAML::Node& item : list) {
      result.push_back(toNumber(key, item));
    }
    return result;
  }

  void refuseUnknown(const std::vector<std::string>& known) const {
    for (const auto& item : node_) {
      const std::string key = item.first.IsScalar() ? item.first.Scalar() : show(item.first);
      if (std::find(known.begin(), known.end(), key) == known.end()) {
        fail(item.first, "unknown key '" + key + "', did you mean '" + nearestWord(key, known) +
                             "'? Expected " + expectedKeys());
      }
    }
  }

  [[noreturn]] void fail(const YAML::Node& node, const std::string& message) const {
    throw ParseError(file_, node.Mark().line + 1, message);
  }

  static std::string show(const YAML::Node& node) {
    if (node.IsScalar()) {
      return quote(node.Scalar());
    }
    if (node.IsNull()) {
      return "empty";
    }
    return node.IsMap() ? "a map" : "a list";
  }

 private:
  static std::string expectedKeys() {
    return "width, height, fx, fy, cx, cy and optionally name, distortion_model, distortion, "
           "depth_factor (or a camera_info file as ROS's calibration tools write it)";
  }

  double toNumber(const std::string& key, const YAML::Node& value) const {
    const std::optional<double> number =
        value.IsScalar() ? parseDouble(value.Scalar()) : std::nullopt;
    if (!number || !std::isfinite(*number)) {
      fail(value, key + " is " + show(value) + ", expected a finite number");
    }
    return *number;
  }

  std::string file_;
  YAML::Node node_;
};

Camera readOwnForm(const CameraMap& map) {
  map.refuseUnknown({"name", "width", "height", "fx", "fy", "cx", "cy", "distortion_model",
                     "distortion", "depth_factor"});
  Camera camera;
  camera.width = map.side("width");
  camera.height = map.side("height");
  camera.fx = map.focalLength("fx");
  camera.fy = map.focalLength("fy");
  camera.cx = map.number("cx");
  camera.cy = map.number("cy");
  if (map.has("distortion")) {
    camera.distortion = map.numbers("distortion", map.get("distortion"));
  }
  if (map.has("name")) {
    camera.name = map.text("name");
  }
  return camera;
}

// Rectification and projection matrices are allowed and unused: raw images carry the distortion.
Camera readCameraInfoForm(const CameraMap& map) {
  Camera camera;
  camera.width = map.side("image_width");
  camera.height = map.side("image_height");
  const YAML::Node node = map.get("camera_matrix");
  const std::vector<double> matrix = map.numbers("camera_matrix", node);
  if (matrix.size() != 9) {
    map.fail(node, "camera_matrix has " + std::to_string(matrix.size()) + " numbers, expected 9");
  }
  camera.fx = matrix[0];
  camera.cx = matrix[2];
  camera.fy = matrix[4];
  camera.cy = matrix[5];
  if (map.has("distortion_coefficients")) {
    camera.distortion = map.numbers("distortion_coefficients", map.get("distortion_coefficients"));
  }
  if (map.has("camera_name")) {
    camera.name = map.text("camera_name");
  }
  return camera;
}

bool isPresetFile(const std::filesystem::path& path) {
  return path.extension() == ".yaml" && std::filesystem::is_regular_file(path);
}

}  // namespace

Camera readCameraFile(const std::filesystem::path& file) {
  const YAML::Node node = readYamlFile(file);
  if (!node.IsMap()) {
    throw ParseError(file.string(), 0,
                     "holds " + CameraMap::show(node) + ", expected a map of camera parameters");
  }
  const CameraMap map(file.string(), node);
  Camera camera = map.has("camera_matrix") ? readCameraInfoForm(map) : readOwnForm(map);
  if (camera.name.empty()) {
    camera.name = file.stem().string();
  }
  if (map.has("distortion_model")) {
    camera.distortion_model = map.text("distortion_model");
  }
  if (map.has("depth_factor")) {
    camera.depth_factor = map.number("depth_factor");
  }
  validateCamera(camera, file.string());
  return camera;
}

Camera readCalibrationMatrix(const std::filesystem::path& file) {
  std::array<std::array<double, 3>, 3> matrix{};
  std::array<int, 3> lines{};
  std::size_t rows = 0;
  int number = 0;
  for (const std::string& line : readLines(file)) {
    ++number;
    const std::string_view text = trim(line);
    if (text.empty() || text.front() == '#') {
      continue;
    }
    const std::vector<std::string_view> words = splitWords(text);
    if (rows == 3 || words.size() != 3) {
      throw ParseError(file.string(), number,
                       "row " + std::to_string(rows + 1) + " is " + quote(text) +
                           ", expected three rows of three numbers: fx 0 cx, 0 fy cy, 0 0 1");
    }
    for (std::size_t column = 0; column < 3; ++column) {
      const std::optional<double> value = parseDouble(words[column]);
      if (!value || !std::isfinite(*value)) {
        throw ParseError(file.string(), number,
                         "value " + quote(words[column]) + ", expected a finite number");
      }
      matrix[rows][column] = *value;
    }
    lines[rows] = number;
    ++rows;
  }
  if (rows != 3) {
    throw ParseError(file.string(), 0,
                     std::to_string(rows) + " rows, expected three: fx 0 cx, 0 fy cy, 0 0 1");
  }
  for (std::size_t row = 0; row < 2; ++row) {
    if (matrix[row][row] == 0) {
      throw ParseError(file.string(), lines[row],
                       std::string("focal length ") + (row == 0 ? "fx" : "fy") +
                           " is 0, expected a number of pixels other than 0");
    }
  }
  const std::array<std::array<double, 3>, 3> pattern = {
      {{matrix[0][0], 0, matrix[0][2]}, {0, matrix[1][1], matrix[1][2]}, {0, 0, 1}}};
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column) {
      if (matrix[row][column] != pattern[row][column]) {
        throw ParseError(file.string(), lines[row],
                         "column " + std::to_string(column + 1) + " is " +
                             formatDouble(matrix[row][column]) + ", expected " +
                             formatDouble(pattern[row][column]) +
                             " (the matrix is fx 0 cx, 0 fy cy, 0 0 1)");
      }
    }
  }
  Camera camera;
  camera.name = file.stem().string();
  camera.fx = matrix[0][0];
  camera.fy = matrix[1][1];
  camera.cx = matrix[0][2];
  camera.cy = matrix[1][2];
  return camera;
}

std::vector<std::string> listCameraPresets(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  if (!std::filesystem::is_directory(folder)) {
    return names;
  }
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (isPresetFile(entry.path())) {
      names.push_back(entry.path().stem().string());
    }
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::filesystem::path cameraFileOf(const std::string& name_or_file,
                                   const std::filesystem::path& folder) {
  const std::filesystem::path path(name_or_file);
  const std::filesystem::path extension = path.extension();
  if (extension == ".yaml" || extension == ".yml" || extension == ".txt" ||
      name_or_file.find('/') != std::string::npos) {
    return path;
  }
  std::filesystem::path preset = folder / (name_or_file + ".yaml");
  if (!name_or_file.empty() && isPresetFile(preset)) {
    return preset;
  }
  std::string known;
  for (const std::string& name : listCameraPresets(folder)) {
    known += (known.empty() ? "" : ", ") + name;
  }
  throw Error(
      "camera " + quote(name_or_file) + " is unknown, expected a YAML file or one of " +
      (known.empty() ? "the presets, but there are none in " + quote(folder.string()) : known));
}

Camera loadCamera(const std::string& name_or_file, const std::filesystem::path& folder) {
  const std::filesystem::path file = cameraFileOf(name_or_file, folder);
  return file.extension() == ".txt" ? readCalibrationMatrix(file) : readCameraFile(file);
}

}  // namespace evolin
