// The list of network files, config/models.yaml, and which of them are here.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace evolin {

/// One network of the list; texts are as the file has them.
struct ModelEntry {
  std::string name;
  std::string method;  ///< plug-in that runs it; "": none yet
  std::string title;
  std::string repository;
  std::string licence;
  std::string file;
  std::string sha256;  ///< of the file, in lower case; "": none is known
  std::string get;
  std::string input;
  std::string evolin;
  std::string authors;
};

/// Throws ParseError for a file that is no list of such entries: unknown or missing keys, a name or
/// file that occurs twice, a sum of other than 64 hexadecimal digits.
std::vector<ModelEntry> readModelCatalogue(const std::filesystem::path& file);

enum class ModelState {
  kPresent,   ///< with the known or its recorded sum
  kUnknown,   ///< with neither: plug-ins take it with `verify: false`
  kAbsent,    ///< in none of the folders
  kWrongSum,  ///< another content than the published or the recorded one
  kDamaged    ///< no whole ONNX file
};

/// "present", "present, sum unknown", "absent", "wrong sum", "damaged".
std::string toString(ModelState state);

struct ModelStatus {
  ModelState state = ModelState::kAbsent;
  std::filesystem::path file;  ///< "" where absent
  std::string detail;          ///< the sum that the file has, or what is wrong with it
};

/// Looks for the file and reads it.
ModelStatus statusOf(const ModelEntry& entry);

}  // namespace evolin
