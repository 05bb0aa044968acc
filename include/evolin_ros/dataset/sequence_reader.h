// One small interface over dataset folders: frames in order, with whatever belongs to each.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "evolin_ros/dataset/frame.h"
#include "evolin_ros/dataset/needs.h"

namespace evolin {

/// kTum: TUM RGB-D folder; kIcl: ICL-NUIM in its TUM-compatible form; kEvolin: the benchmark's own
/// layout.
enum class Layout { kAuto, kTum, kIcl, kEvolin };

/// "auto", "tum", "icl" or "evolin".
std::string toString(Layout layout);

/// Throws Error naming the value and the accepted ones.
Layout parseLayout(const std::string& text);

struct SequenceOptions {
  Layout layout = Layout::kAuto;
  /// A preset (tum_fr1, tum_fr2, tum_fr3, icl) or a YAML file; "" takes the folder's
  /// calibration_matrix.txt where it has one, else the frames have no camera.
  std::string camera;
  std::filesystem::path camera_folder;  ///< where presets are looked up (config/cameras)
  std::filesystem::path ground_truth;   ///< folder of line annotations; "" takes the sequence's own
                                        ///< gt_lines/ where it has one
  double start = 0;                     ///< seconds to skip from the first image
  std::optional<double> duration;       ///< seconds to take from there; none: all
  std::optional<int> pose_offset;  ///< image i takes pose row i + N; none: the layout's own rule
  bool allow_missing = false;  ///< images that are absent or unreadable are skipped and counted,
                               ///< not an error; a frame whose depth image is so has no depth
  bool read_depth = true;      ///< false: frames come without depth, which takes time to decode
  bool same_rows =
      false;  ///< equal annotation rows are the same physical line (no gt_associations needed)
};

/// A frame as a dataset has it.
struct SequenceFrame {
  Frame frame;                       ///< image, depth, pose and camera where the dataset has them
  std::string image_file;            ///< path as the dataset lists it
  std::optional<Stamp> depth_stamp;  ///< of the depth image, where there is one
  std::optional<LineSegments>
      ground_truth;  ///< annotated lines with ids where known; none: this frame has no annotation
};

/// What a reader has left out so far.
struct SequenceCounts {
  std::size_t frames = 0;          ///< given out
  std::size_t missing_images = 0;  ///< skipped under allow_missing
  std::size_t missing_depths = 0;  ///< frames given out without depth
  std::size_t missing_poses = 0;   ///< frames given out without pose
  std::size_t missing_ground_truth = 0;
};

/// Frames in order of time. Images are decoded one at a time.
class SequenceReader {
 public:
  SequenceReader() = default;
  SequenceReader(const SequenceReader&) = delete;
  SequenceReader& operator=(const SequenceReader&) = delete;
  virtual ~SequenceReader() = default;

  /// The next frame, or none at the end. Throws ParseError or Error naming the file for a missing
  /// or unreadable image, image and depth of different size, or a malformed annotation.
  virtual std::optional<SequenceFrame> next() = 0;

  /// Frames that next() will give at the most, counted from the lists.
  virtual std::size_t size() const = 0;

  /// What some frame at least comes with, by the lists.
  virtual Needs offers() const = 0;

  virtual const SequenceCounts& counts() const = 0;

  /// The layout that was found, never kAuto.
  virtual Layout layout() const = 0;

  /// One line for the report: how poses were paired with images, for example "by stamp,
  /// interpolated".
  virtual std::string poseRule() const = 0;
};

/// Throws Error or ParseError with file, line, value and expectation: an empty or unknown folder
/// (saying what was looked for), stamps that do not increase, a quaternion of zero norm, a
/// calibration with zero focal length.
std::unique_ptr<SequenceReader> openSequence(const std::filesystem::path& folder,
                                             const SequenceOptions& options);

}  // namespace evolin
