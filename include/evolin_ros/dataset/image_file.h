// Colour and depth images in files, whole or not at all.
#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace evolin {

/// Of the files that count as images where a folder is listed, in lower case, with the point.
const std::vector<std::string>& imageExtensions();

/// An 8-bit image: CV_8UC1 when the file is grey, else CV_8UC3 in BGR order (transparency is
/// dropped, 16-bit colour reduced to 8 bits). Throws ParseError naming the file when it is absent,
/// empty, no image, or cut off: a PNG without its closing chunk or a JPEG without its end marker,
/// which decoders would fill up with grey.
cv::Mat readImage(const std::filesystem::path& file);

/// CV_16UC1 as stored; 0 means no depth. Throws ParseError as above, and for an image of another
/// type.
cv::Mat readStoredDepth(const std::filesystem::path& file);

/// CV_32FC1 metres from a 16-bit one-channel image that stores metres x `depth_factor`; 0 in the
/// file means no depth and becomes NaN. Throws as readStoredDepth().
cv::Mat readDepthImage(const std::filesystem::path& file, double depth_factor);

/// Writes the file as a whole or not at all, in the form that its extension names (.png, .jpg);
/// `parameters` are those of cv::imencode(). Throws Error naming the file.
void writeImage(const std::filesystem::path& file, const cv::Mat& image,
                const std::vector<int>& parameters = {});

}  // namespace evolin
