// The benchmark's depth_associations.txt: which depth image belongs to which colour image, by row.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

namespace evolin {

/// For every one of `images` images the row of its depth image among `depths`, none where the file
/// has no line for it. A line holds an image index and a depth index, both counted from 0 in order
/// of file names (whole numbers, also written as 3.0); blank lines and those that start with # are
/// skipped. Throws ParseError with file and line for another number of fields, text, an index out
/// of range, or an image that occurs twice.
std::vector<std::optional<std::size_t>> readDepthAssociations(const std::filesystem::path& file,
                                                              std::size_t images,
                                                              std::size_t depths);

}  // namespace evolin
