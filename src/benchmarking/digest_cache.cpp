// Files by path, size and time of change.
#include "evolin_ros/benchmarking/digest_cache.h"

#include <sys/stat.h>

#include <algorithm>
#include <ctime>
#include <utility>

#include "evolin_ros/base/atomic_file.h"
#include "evolin_ros/base/error.h"
#include "evolin_ros/base/sha256.h"
#include "evolin_ros/base/text.h"

namespace evolin {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kDigits = 64;
constexpr std::time_t kSettled = 3;  // s after which a change of a file changes its time, too

/// Files of a folder by their relative names, hidden ones and those in hidden folders left out.
std::vector<fs::path> filesBelow(const fs::path& folder) {
  std::vector<fs::path> files;
  fs::recursive_directory_iterator entry(folder, fs::directory_options::follow_directory_symlink);
  for (; entry != fs::recursive_directory_iterator(); ++entry) {
    if (entry->path().filename().string().front() == '.') {
      entry.disable_recursion_pending();
    } else if (entry->is_regular_file()) {
      files.push_back(entry->path().lexically_relative(folder));
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

DigestCache::DigestCache(fs::path file) : file_(std::move(file)) {
  if (!fs::is_regular_file(file_)) {
    return;
  }
  for (const std::string& line : readLines(file_)) {
    if (line.size() > kDigits + 1 && line[kDigits] == ' ') {
      known_[line.substr(kDigits + 1)] = line.substr(0, kDigits);
    }
  }
}

std::string DigestCache::digestOf(const fs::path& file) {
  struct stat status {};
  const std::string path = fs::absolute(file).lexically_normal().string();
  if (stat(path.c_str(), &status) != 0 || path.find('\n') != std::string::npos) {
    return sha256OfFile(file);  // which says what is wrong
  }
  const std::string key = std::to_string(status.st_size) + " " +
                          std::to_string(status.st_mtim.tv_sec) + "." +
                          std::to_string(status.st_mtim.tv_nsec) + " " + path;
  const auto found = known_.find(key);
  const std::string digest = found != known_.end() ? found->second : sha256OfFile(file);
  if (status.st_mtim.tv_sec + kSettled < std::time(nullptr)) {
    asked_[key] = digest;
  }
  return digest;
}

std::string DigestCache::digestOf(const std::vector<fs::path>& places) {
  Sha256 all;
  for (const fs::path& place : places) {
    if (fs::is_directory(place)) {
      for (const fs::path& file : filesBelow(place)) {
        all.add(digestOf(place / file) + " " + file.generic_string() + "\n");
      }
    } else if (fs::exists(place)) {
      all.add(digestOf(place) + "\n");
    } else {
      throw Error(place.string() + ": is not there");
    }
    all.add("\n");
  }
  return all.digest();
}

void DigestCache::save() const {
  std::string text;
  for (const auto& [key, digest] : asked_) {
    text += digest + " " + key + "\n";
  }
  writeFileAtomically(file_, text);
}

std::string digestOfText(const std::string& text) {
  Sha256 sum;
  sum.add(text);
  return sum.digest();
}

}  // namespace evolin
