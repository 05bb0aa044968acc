// The size of an image file, from its header where that is enough.
#pragma once

#include <filesystem>

#include "evolin_ros/geometry/image_size.h"

namespace evolin::cli {

/// In pixels, as OpenCV decodes the file. PNG headers are read directly; any other image is
/// decoded. Throws Error naming the file when it is no readable image.
ImageSize readImageSize(const std::filesystem::path& file);

}  // namespace evolin::cli
