// Physical lines followed through a sequence: ids chained from index pairs of annotated frames.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <unordered_map>
#include <vector>

#include "evolin_ros/geometry/line_segment.h"

namespace evolin {

/// Sets the id of every line in `frames`: equal ids for lines that the pair files of `folders`
/// (STEMA_STEMB.csv, rows i,j) join directly or through other frames, an id of its own for a line
/// in no pair; ids are dense, from 0, by first appearance in `frames`. `index` maps a stem to its
/// place in `frames`, `names` is the reverse. Throws Error or ParseError naming file and row for a
/// pair file of unknown frames, an index beyond its frame's lines, and a chain that would hold two
/// lines of one frame.
void chainLineIds(const std::vector<std::filesystem::path>& folders,
                  const std::unordered_map<std::string, std::size_t>& index,
                  const std::vector<std::string>& names, std::vector<LineSegments>* frames);

}  // namespace evolin
