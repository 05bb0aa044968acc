// Raw pictures through a pipe.
#include "video_file.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"

extern char** environ;

namespace evolin::cli {

namespace {

/// The file that stands at `file` may go only when the user says so.
std::filesystem::path checked(std::filesystem::path file, bool force) {
  if (std::filesystem::exists(file) && !force) {
    throw Error(file.string() + ": exists; --force replaces it");
  }
  return file;
}

std::string reasonOf(int code) { return std::generic_category().message(code); }

/// Coders of video want even sides.
int even(int size) { return size + size % 2; }

}  // namespace

bool isVideoName(const std::filesystem::path& file) {
  return file.extension() == ".mp4" || file.extension() == ".gif";
}

VideoFile::VideoFile(std::filesystem::path file, double rate, bool force)
    : file_(checked(std::move(file), force)), rate_(rate), temporary_(file_) {}

VideoFile::~VideoFile() {
  if (pipe_ >= 0) {
    close(pipe_);
  }
  if (process_ > 0) {
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
  }
}

void VideoFile::start(const cv::Size& size) {
  size_ = {even(size.width), even(size.height)};
  const bool gif = file_.extension() == ".gif";
  std::vector<std::string> words = {
      "ffmpeg",
      "-loglevel",
      "error",
      "-y",
      "-f",
      "rawvideo",
      "-pixel_format",
      "bgr24",
      "-video_size",
      std::to_string(size_.width) + "x" + std::to_string(size_.height),
      "-framerate",
      formatDouble(rate_),
      "-i",
      "-"};
  const std::vector<std::string> coding =
      gif ? std::vector<std::string>{"-filter_complex",
                                     "split[a][b];[a]palettegen[p];[b][p]paletteuse", "-f", "gif"}
          : std::vector<std::string>{"-pix_fmt", "yuv420p", "-movflags", "+faststart", "-f", "mp4"};
  words.insert(words.end(), coding.begin(), coding.end());
  words.push_back(std::filesystem::absolute(temporary_.path()).string());
  std::vector<char*> pointers;
  pointers.reserve(words.size() + 1);
  for (std::string& word : words) {
    pointers.push_back(word.data());
  }
  pointers.push_back(nullptr);

  int ends[2] = {-1, -1};
  if (pipe2(ends, O_CLOEXEC) != 0) {
    throw Error(file_.string() + ": no pipe to ffmpeg: " + reasonOf(errno));
  }
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
  // Ctrl-C is for us: we close the pipe and ffmpeg ends its file.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  const int failure =
      posix_spawnp(&process_, "ffmpeg", &actions, &attributes, pointers.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[0]);
  pipe_ = ends[1];
  if (failure != 0) {
    process_ = -1;
    throw Error(file_.string() + ": ffmpeg cannot be started (" + reasonOf(failure) +
                "); install the package ffmpeg, or name a folder for single pictures");
  }
}

void VideoFile::add(const cv::Mat& picture) {
  if (process_ < 0) {
    start(picture.size());
  }
  if (picture.size() == size_ && picture.isContinuous()) {
    write(picture);
    return;
  }
  cv::Mat fitted(size_, CV_8UC3, cv::Scalar::all(0));
  const cv::Rect shared(0, 0, std::min(picture.cols, size_.width),
                        std::min(picture.rows, size_.height));
  picture(shared).copyTo(fitted(shared));
  write(fitted);
}

void VideoFile::write(const cv::Mat& picture) {
  const std::size_t size = picture.total() * picture.elemSize();
  // A reader that has gone shows as an error here instead of ending this program.
  struct sigaction ignore = {};
  struct sigaction former = {};
  ignore.sa_handler = SIG_IGN;
  sigaction(SIGPIPE, &ignore, &former);
  std::size_t done = 0;
  int failure = 0;
  while (done < size && failure == 0) {
    const ssize_t written = ::write(pipe_, picture.data + done, size - done);
    if (written >= 0) {
      done += static_cast<std::size_t>(written);
    } else if (errno != EINTR) {
      failure = errno;
    }
  }
  sigaction(SIGPIPE, &former, nullptr);
  if (failure != 0) {
    throw Error(file_.string() + ": ffmpeg takes no more pictures: " + reasonOf(failure));
  }
}

void VideoFile::finish() {
  if (process_ < 0) {
    throw Error(file_.string() + ": no picture was made");
  }
  close(std::exchange(pipe_, -1));
  int status = 0;
  while (waitpid(process_, &status, 0) < 0 && errno == EINTR) {
  }
  process_ = -1;
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    throw Error(file_.string() + ": ffmpeg failed");
  }
  temporary_.commit();
}

}  // namespace evolin::cli
