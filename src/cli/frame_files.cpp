// What goes by row is checked against whatever else tells which row is which: counts and names.
#include "frame_files.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <utility>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"
#include "evolin_ros/dataset/csv.h"
#include "evolin_ros/dataset/depth_associations.h"
#include "evolin_ros/dataset/image_file.h"
#include "evolin_ros/dataset/trajectory.h"
#include "file_pairing.h"

namespace evolin::cli {

namespace {

/// "9.csv" stands behind "10.csv" in order of names; rows would go to the wrong frames.
void requireOrderByValue(const std::string& folder, const std::vector<std::string>& stems) {
  std::optional<std::int64_t> before;
  for (std::size_t index = 0; index < stems.size(); ++index) {
    const std::optional<std::int64_t> value = parseInteger(stems[index]);
    if (before && value && *value <= *before) {
      throw Error(folder + ": " + stems[index] + " stands behind " + stems[index - 1] +
                  " in order of names; expected numbers with as many digits each (0009, 0010), as "
                  "depth and poses go by this order");
    }
    before = value;
  }
}

std::vector<FrameFiles> listLines(const FrameFolders& folders) {
  const FileSet lines = listByStem("lines", folders.lines, {".csv"});
  FileSet scores;
  if (!folders.scores.empty()) {
    scores = listByStem("scores", folders.scores, {".csv"});
    requireSameStems(lines, scores);
  }
  std::vector<FrameFiles> frames;
  std::vector<std::string> stems;
  for (const auto& [stem, file] : lines.files) {
    FrameFiles frame;
    frame.stem = stem;
    frame.lines = file;
    if (!folders.scores.empty()) {
      frame.scores = scores.at(stem);
    }
    frames.push_back(std::move(frame));
    stems.push_back(stem);
  }
  requireOrderByValue(folders.lines, stems);
  return frames;
}

/// The depth images by name, and which of them belongs to which line file.
struct DepthList {
  FileSet by_stem;
  std::vector<std::filesystem::path> files;
  std::vector<DepthAssociation> rows;
};

std::vector<DepthAssociation> readRows(const FrameFolders& folders, std::size_t images,
                                       std::size_t depths) {
  try {
    return readDepthAssociationRows(folders.depth_associations, images, depths);
  } catch (const Error& error) {
    throw Error(std::string(error.what()) + "; " + std::to_string(images) + " line files in " +
                folders.lines + ", " + std::to_string(depths) + " depth images in " +
                folders.depths);
  }
}

/// Equal indices of folders that share names must be equal names.
void requireSameNames(const FrameFolders& folders, const std::vector<FrameFiles>& lines,
                      const DepthList& depths) {
  const auto has_line_of = [&lines](const std::string& stem) {
    return std::any_of(lines.begin(), lines.end(),
                       [&stem](const FrameFiles& frame) { return frame.stem == stem; });
  };
  for (const DepthAssociation& row : depths.rows) {
    const std::string& line = lines[row.image].stem;
    const std::string depth = depths.files[row.depth].stem().string();
    if (row.image == row.depth && line != depth &&
        (depths.by_stem.files.count(line) > 0 || has_line_of(depth))) {
      throw ParseError(folders.depth_associations, row.line,
                       "joins lines " + lines[row.image].lines.string() + " and depth image " +
                           depths.files[row.depth].string() + ", both at place " +
                           std::to_string(row.image) + " of their folders; expected equal names (" +
                           std::to_string(lines.size()) + " line files, " +
                           std::to_string(depths.files.size()) + " depth images: is one missing?)");
    }
  }
}

DepthList listDepths(const FrameFolders& folders, const std::vector<FrameFiles>& lines) {
  DepthList depths;
  depths.by_stem = listByStem("depth images", folders.depths, {".png", ".tif", ".tiff", ".pgm"});
  std::vector<std::string> stems;
  for (const auto& [stem, file] : depths.by_stem.files) {
    depths.files.push_back(file);
    stems.push_back(stem);
  }
  requireOrderByValue(folders.depths, stems);
  depths.rows = readRows(folders, lines.size(), depths.files.size());
  if (depths.rows.empty()) {
    throw ParseError(folders.depth_associations, 0,
                     "has no rows, expected an image index and a depth index in each");
  }
  for (std::size_t index = 1; index < depths.rows.size(); ++index) {
    const DepthAssociation& row = depths.rows[index];
    const std::size_t before = depths.rows[index - 1].image;
    if (row.image <= before) {
      throw ParseError(folders.depth_associations, row.line,
                       "image index " + std::to_string(row.image) + " comes after " +
                           std::to_string(before) + ", expected rising image indices");
    }
  }
  requireSameNames(folders, lines, depths);
  return depths;
}

/// True when so many poses are for so many frames.
bool fits(std::size_t poses, std::size_t frames, int offset) {
  const auto count = static_cast<std::int64_t>(frames);
  const auto rows = static_cast<std::int64_t>(poses);
  return rows == count || (rows > 0 && rows == count + offset);
}

std::string wrongNumber(const FrameFolders& folders, std::size_t poses, std::size_t lines,
                        std::size_t rows) {
  std::string text = folders.poses + ": " + std::to_string(poses) +
                     " poses, expected one for each of the " + std::to_string(lines) +
                     " line files in " + folders.lines;
  if (rows != lines) {
    text += " or of the " + std::to_string(rows) + " rows of " + folders.depth_associations;
  }
  if (folders.pose_offset != 0) {
    text += ", or " + std::to_string(std::abs(folders.pose_offset)) +
            (folders.pose_offset > 0 ? " more" : " fewer") + " (--pose-offset " +
            std::to_string(folders.pose_offset) + ")";
  }
  return text;
}

}  // namespace

FrameList listFrames(const FrameFolders& folders) {
  FrameList list;
  std::vector<FrameFiles> lines = listLines(folders);
  const DepthList depths = listDepths(folders, lines);
  for (const FrameFiles& line : lines) {
    list.line_stems.push_back(line.stem);
  }
  for (const DepthAssociation& row : depths.rows) {
    lines[row.image].depth = depths.files[row.depth];
  }
  const std::vector<Pose> poses = readPoseRows(folders.poses);
  if (fits(poses.size(), lines.size(), folders.pose_offset)) {
    list.frames = std::move(lines);
  } else if (fits(poses.size(), depths.rows.size(), folders.pose_offset)) {
    list.by_depth_list = true;
    for (const DepthAssociation& row : depths.rows) {
      list.frames.push_back(std::move(lines[row.image]));
    }
  } else {
    throw Error(wrongNumber(folders, poses.size(), lines.size(), depths.rows.size()));
  }
  const auto count = static_cast<std::int64_t>(poses.size());
  for (std::size_t index = 0; index < list.frames.size(); ++index) {
    const std::int64_t row = static_cast<std::int64_t>(index) + folders.pose_offset;
    if (row >= 0 && row < count) {
      list.frames[index].pose = poses[static_cast<std::size_t>(row)];
    }
  }
  return list;
}

DepthImages::DepthImages(const std::vector<FrameFiles>& frames, double factor) : factor_(factor) {
  for (const FrameFiles& frame : frames) {
    if (!frame.depth.empty()) {
      first_ = frame.depth;
      const cv::Mat stored = readStoredDepth(first_);
      size_ = {stored.cols, stored.rows};
      return;
    }
  }
}

DepthMap DepthImages::read(const FrameFiles& frame) const {
  DepthMap depth(readStoredDepth(frame.depth), factor_);
  const auto text = [](const ImageSize& size) {
    return std::to_string(size.width) + " x " + std::to_string(size.height);
  };
  if (depth.size().width != size_.width || depth.size().height != size_.height) {
    throw Error(frame.depth.string() + ": the depth image is " + text(depth.size()) +
                " pixels, expected " + text(size_) + " as " + first_.string());
  }
  return depth;
}

}  // namespace evolin::cli
