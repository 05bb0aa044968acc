// Stems may hold an underscore themselves, so that the list of frames says where a name is cut.
#include "evolin_ros/dataset/association_folder.h"

#include <algorithm>
#include <set>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"
#include "evolin_ros/dataset/csv.h"

namespace evolin {

namespace fs = std::filesystem;

namespace {

/// "rgb/0000.png" names 0000, and so does "0000.csv"; "1305031453.359684" is a stem as it is.
std::string stemOf(const std::string& file) {
  const fs::path name = fs::path(file).filename();
  const std::string extension = name.extension().string();
  const bool is_number =
      extension.size() > 1 && extension.find_first_not_of("0123456789", 1) == std::string::npos;
  return (is_number ? name : name.stem()).string();
}

bool holdsCsv(const fs::path& folder) {
  return std::any_of(
      fs::directory_iterator(folder), fs::directory_iterator(),
      [](const fs::directory_entry& entry) { return entry.path().extension() == ".csv"; });
}

fs::path findStamps(const fs::path& folder, const fs::path& pair_folder) {
  for (const fs::path& place : {pair_folder, folder, pair_folder.parent_path()}) {
    const bool beside = place == pair_folder.parent_path() && place != folder;
    if ((!beside || pair_folder.filename() == "associations") && fs::exists(place / "stamps.txt")) {
      return place / "stamps.txt";
    }
  }
  throw Error(
      folder.string() +
      ": which file belongs to which images is unknown: there is no stamps.txt in it and no "
      "other file was named; it has a line 'stamp file' for every frame, as in TUM's lists, "
      "for example '1305031453.359684 0000.csv'");
}

}  // namespace

AssociationFolder::AssociationFolder(const fs::path& folder, const fs::path& stamps_file) {
  if (!fs::is_directory(folder)) {
    throw Error(folder.string() + ": not a folder, expected one with files of index pairs");
  }
  const fs::path inner = folder / "associations";
  folder_ = !holdsCsv(folder) && fs::is_directory(inner) ? inner : folder;
  const fs::path stamps = stamps_file.empty() ? findStamps(folder, folder_) : stamps_file;
  std::set<std::string> stems;
  for (const StampedFile& entry : readStampsFile(stamps)) {
    entries_.push_back({entry.stamp, stemOf(entry.file)});
    if (!stems.insert(entries_.back().file).second) {
      throw ParseError(
          stamps.string(), 0,
          "frame " + quote(entries_.back().file) + " is listed twice, expected one stamp a frame");
    }
  }
  for (const fs::path& file : listFiles(folder_, {".csv"})) {
    pairs_.emplace(stemsOf(file), readIndexPairsCsv(file));
  }
}

AssociationFolder::Stems AssociationFolder::stemsOf(const fs::path& file) const {
  const std::string name = file.stem().string();
  const auto is_listed = [this](const std::string& stem) {
    return std::any_of(entries_.begin(), entries_.end(),
                       [&](const StampedFile& entry) { return entry.file == stem; });
  };
  for (std::size_t cut = name.find('_'); cut != std::string::npos; cut = name.find('_', cut + 1)) {
    Stems stems(name.substr(0, cut), name.substr(cut + 1));
    if (is_listed(stems.first) && is_listed(stems.second)) {
      return stems;
    }
  }
  throw Error(file.string() +
              ": is named after two frames that the stamps file does not list, expected "
              "FIRST_SECOND.csv of frames in it");
}

std::optional<IndexPairs> AssociationFolder::at(Stamp first, Stamp second) const {
  const StampedFile* const one = findNearest(entries_, first, kTolerance);
  const StampedFile* const other = findNearest(entries_, second, kTolerance);
  if (one == nullptr || other == nullptr) {
    return std::nullopt;
  }
  const auto found = pairs_.find({one->file, other->file});
  return found == pairs_.end() ? std::nullopt : std::optional<IndexPairs>(found->second);
}

}  // namespace evolin
