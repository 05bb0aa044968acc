// Reading YAML so that any input ends in a document or one ParseError.
#pragma once

#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <string>
#include <string_view>

namespace evolin {

/// The first document of `text` in UTF-8; null when it is empty. `file` names it in errors. Throws
/// ParseError for what is not YAML, and for three things that some releases of yaml-cpp never come
/// back from: control characters other than tabs and line ends, UTF-16, and ':]' (which may stand
/// only in a comment on a line without quotes; write ': ]' where the colon ends a key).
YAML::Node parseYaml(std::string_view text, const std::string& file);

/// The same of a file; throws ParseError also when it is a folder or cannot be read.
YAML::Node readYamlFile(const std::filesystem::path& file);

}  // namespace evolin
