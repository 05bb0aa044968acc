// Helpers that the layouts share.
#include "sequence_plan.h"

#include <algorithm>
#include <cctype>
#include <unordered_map>

#include "evolin_ros/base/error.h"
#include "evolin_ros/dataset/csv.h"
#include "evolin_ros/dataset/image_file.h"

namespace evolin {

namespace fs = std::filesystem;

namespace {

bool holdsImages(const fs::path& folder) {
  if (!fs::is_directory(folder)) {
    return false;
  }
  const fs::directory_iterator files(folder);
  return std::any_of(begin(files), end(files), [](const fs::directory_entry& entry) {
    std::string extension = entry.path().extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
    const std::vector<std::string>& known = imageExtensions();
    return entry.is_regular_file() &&
           std::find(known.begin(), known.end(), extension) != known.end();
  });
}

std::vector<fs::path> listMatching(const fs::path& folder, const std::string& prefix,
                                   const std::string& suffix) {
  std::vector<fs::path> found;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (entry.is_regular_file() && name.size() >= prefix.size() + suffix.size() &&
        name.compare(0, prefix.size(), prefix) == 0 &&
        name.compare(name.size() - suffix.size(), suffix.size(), suffix) == 0) {
      found.push_back(entry.path());
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

bool isNumber(const std::string& text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char letter) {
    return std::isdigit(letter) != 0;
  });
}

std::string withoutLeadingZeros(const std::string& number) {
  const std::size_t first = number.find_first_not_of('0');
  return first == std::string::npos ? std::string() : number.substr(first);
}

bool numberLess(const std::string& a, const std::string& b) {
  const std::string x = withoutLeadingZeros(a);
  const std::string y = withoutLeadingZeros(b);
  return x.size() != y.size() ? x.size() < y.size() : x < y;
}

}  // namespace

Stamp stampOfFrame(std::int64_t number) {
  constexpr std::int64_t kFramesPerSecond = 30;
  return kNanosecondsPerSecond +
         (number * kNanosecondsPerSecond + kFramesPerSecond / 2) / kFramesPerSecond;
}

void assignPosesByRow(const std::vector<Pose>& poses, int offset, SequencePlan* plan) {
  const auto count = static_cast<std::int64_t>(poses.size());
  for (std::size_t i = 0; i < plan->frames.size(); ++i) {
    const std::int64_t row = static_cast<std::int64_t>(i) + offset;
    if (row >= 0 && row < count) {
      plan->frames[i].pose = poses[static_cast<std::size_t>(row)];
    }
  }
  plan->pose_rule = "by row";
  if (offset != 0) {
    plan->pose_rule += std::string(", image i takes pose row i ") + (offset < 0 ? "- " : "+ ") +
                       std::to_string(std::abs(static_cast<std::int64_t>(offset)));
  }
}

std::vector<fs::path> findAssociationLists(const fs::path& folder) {
  return listMatching(folder, "associations", ".txt");
}

std::vector<fs::path> findFreiburgTrajectories(const fs::path& folder) {
  return listMatching(folder, "", ".gt.freiburg");
}

fs::path findImageFolder(const fs::path& folder) {
  for (const char* name : {"images", "rgb"}) {
    if (holdsImages(folder / name)) {
      return folder / name;
    }
  }
  return {};
}

std::vector<fs::path> listImages(const fs::path& folder) {
  std::vector<fs::path> files = listFiles(folder, imageExtensions());
  std::unordered_map<std::string, fs::path> seen;
  for (const fs::path& file : files) {
    const auto [earlier, is_new] = seen.emplace(file.stem().string(), file);
    if (!is_new) {
      throw Error(file.string() + ": has the same stem as " + earlier->second.filename().string() +
                  ", expected one image a stem");
    }
  }
  // By name alone 10.png would come before 2.png.
  if (std::all_of(files.begin(), files.end(),
                  [](const fs::path& file) { return isNumber(file.stem().string()); })) {
    std::stable_sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
      return numberLess(a.stem().string(), b.stem().string());
    });
  } else {
    std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
      return a.stem().string() < b.stem().string();
    });
  }
  return files;
}

}  // namespace evolin
