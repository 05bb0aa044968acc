// The benchmark's depth_associations.txt: which depth image belongs to which colour image, by row.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

namespace evolin {

struct DepthAssociation {
  std::size_t image = 0;  ///< place of the colour image among the files by name, from 0
  std::size_t depth = 0;  ///< place of the depth image
  int line = 0;           ///< of the file, from 1
};

/// The rows in the order of the file. A row holds an image index and a depth index, both counted
/// from 0 in order of file names (whole numbers, also written as 3.0) and below `images` and
/// `depths`; blank lines and those that start with # are skipped. Throws ParseError with file and
/// line for another number of fields, text, an index out of range, or an image that occurs twice.
std::vector<DepthAssociation> readDepthAssociationRows(const std::filesystem::path& file,
                                                       std::size_t images, std::size_t depths);

/// The same by image: for every one of `images` images the row of its depth image among `depths`,
/// none where the file has no line for it. Throws as readDepthAssociationRows().
std::vector<std::optional<std::size_t>> readDepthAssociations(const std::filesystem::path& file,
                                                              std::size_t images,
                                                              std::size_t depths);

}  // namespace evolin
