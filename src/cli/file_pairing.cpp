// Pairing by stem, never by order.
#include "file_pairing.h"

#include "evolin_ros/base/error.h"
#include "evolin_ros/dataset/csv.h"

namespace evolin::cli {

namespace {

void requireStemsOf(const FileSet& reference, const FileSet& other) {
  for (const auto& [stem, file] : reference.files) {
    if (other.files.count(stem) == 0) {
      throw Error(other.folder.string() + ": no " + other.what + " of " + stem + ", but " +
                  file.string() + " exists; expected one file of each a stem (" +
                  std::to_string(reference.files.size()) + " " + reference.what + ", " +
                  std::to_string(other.files.size()) + " " + other.what + ")");
    }
  }
}

}  // namespace

const std::filesystem::path& FileSet::at(const std::string& stem) const {
  const auto found = files.find(stem);
  if (found == files.end()) {
    throw Error(folder.string() + ": no " + what + " of " + stem);
  }
  return found->second;
}

FileSet listByStem(const std::string& what, const std::filesystem::path& folder,
                   const std::vector<std::string>& extensions) {
  FileSet set{what, folder, {}};
  for (const std::filesystem::path& file : listFiles(folder, extensions)) {
    const auto [found, inserted] = set.files.emplace(file.stem().string(), file);
    if (!inserted) {
      throw Error(folder.string() + ": both " + found->second.filename().string() + " and " +
                  file.filename().string() + " are " + what + " of " + found->first +
                  "; expected one");
    }
  }
  return set;
}

void requireSameStems(const FileSet& first, const FileSet& second) {
  requireStemsOf(first, second);
  requireStemsOf(second, first);
}

}  // namespace evolin::cli
