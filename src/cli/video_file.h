// A video or an animation, written by the program ffmpeg.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <opencv2/core.hpp>
#include <optional>

#include "evolin_ros/base/atomic_file.h"

namespace evolin::cli {

/// Whether the name ends as a file that VideoFile writes: .mp4 or .gif.
bool isVideoName(const std::filesystem::path& file);

/// One file; it gets its name at finish(), and never without.
class VideoFile {
 public:
  /// `rate` pictures a second. Throws Error when the file exists, unless `force`.
  VideoFile(std::filesystem::path file, double rate, bool force);
  ~VideoFile();
  VideoFile(const VideoFile&) = delete;
  VideoFile& operator=(const VideoFile&) = delete;

  /// CV_8UC3. The first picture gives the size; later ones are cut or filled up to it. Throws Error
  /// when ffmpeg cannot be started or has ended.
  void add(const cv::Mat& picture);

  /// Throws Error without any picture, and when ffmpeg reports a failure.
  void finish();

 private:
  void start(const cv::Size& size);
  void write(const cv::Mat& picture);

  std::filesystem::path file_;
  double rate_;
  TemporaryFile temporary_;
  pid_t process_ = -1;
  int pipe_ = -1;
  cv::Size size_;
};

}  // namespace evolin::cli
