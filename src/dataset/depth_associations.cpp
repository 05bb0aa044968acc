// Reading of depth_associations.txt.
#include "evolin_ros/dataset/depth_associations.h"

#include <string>
#include <string_view>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"

namespace evolin {

std::vector<DepthAssociation> readDepthAssociationRows(const std::filesystem::path& file,
                                                       std::size_t images, std::size_t depths) {
  std::vector<DepthAssociation> rows;
  std::vector<bool> seen(images, false);
  int number = 0;
  for (const std::string& line : readLines(file)) {
    ++number;
    const std::string_view text = trim(line);
    if (text.empty() || text.front() == '#') {
      continue;
    }
    const std::vector<std::string_view> words = splitWords(text);
    if (words.size() != 2) {
      throw ParseError(file.string(), number,
                       std::to_string(words.size()) + " fields in " + quote(text) +
                           ", expected two: image index, depth index");
    }
    const auto index = [&](std::size_t column, const std::string& kind, std::size_t count) {
      const std::optional<double> value = parseDouble(words[column]);
      // Written so that NaN fails too.
      if (!value || !(*value >= 0 && *value < static_cast<double>(count)) ||
          *value != static_cast<double>(static_cast<std::size_t>(*value))) {
        throw ParseError(file.string(), number,
                         kind + " index is " + quote(words[column]) +
                             ", expected a whole number from 0 to " + std::to_string(count) +
                             " exclusive (the folder has " + std::to_string(count) + ")");
      }
      return static_cast<std::size_t>(*value);
    };
    const std::size_t image = index(0, "image", images);
    const std::size_t depth = index(1, "depth", depths);
    if (seen[image]) {
      throw ParseError(
          file.string(), number,
          "image index " + quote(words[0]) + " occurs twice, expected one depth an image");
    }
    seen[image] = true;
    rows.push_back({image, depth, number});
  }
  return rows;
}

std::vector<std::optional<std::size_t>> readDepthAssociations(const std::filesystem::path& file,
                                                              std::size_t images,
                                                              std::size_t depths) {
  std::vector<std::optional<std::size_t>> by_image(images);
  for (const DepthAssociation& row : readDepthAssociationRows(file, images, depths)) {
    by_image[row.image] = row.depth;
  }
  return by_image;
}

}  // namespace evolin
