// Refuses or mends what yaml-cpp before 0.7 never comes back from, then parses.
#include "evolin_ros/base/yaml_file.h"

#include <algorithm>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"

namespace evolin {

namespace {

/// YAML has no such characters. yaml-cpp takes one of them (4) for the end of the text, and others
/// for UTF-16 (0).
bool isForbiddenControl(char c) {
  return static_cast<unsigned char>(c) < 0x20 && c != '\t' && c != '\n' && c != '\r';
}

/// `line` up to its comment. Text in quotes may hold what looks like the beginning of a comment,
/// and may have begun lines earlier; but then its end stands on this line, or all of the line is in
/// it.
std::string_view withoutComment(std::string_view line) {
  if (line.find_first_of("\"'") != std::string_view::npos) {
    return line;
  }
  for (std::size_t at = line.find('#'); at != std::string_view::npos; at = line.find('#', at + 1)) {
    if (at == 0 || line[at - 1] == ' ' || line[at - 1] == '\t') {
      return line.substr(0, at);
    }
  }
  return line;
}

/// Until 0.7, yaml-cpp's scanner takes neither branch at a colon before ']' or before the end of
/// the text in a list or map in brackets, and fills the memory with empty tokens (its issues 499,
/// 793).
void refuseEndlessInput(std::string_view text, const std::string& file) {
  const auto control = std::find_if(text.begin(), text.end(), isForbiddenControl);
  if (control != text.end()) {
    throw ParseError(file, 1 + static_cast<int>(std::count(text.begin(), control, '\n')),
                     "holds the control character " + std::to_string(int(*control)) +
                         ", expected YAML in UTF-8");
  }
  // The first byte of UTF-16's byte order marks; no UTF-8 has either.
  if (!text.empty() && (text.front() == '\xFE' || text.front() == '\xFF')) {
    throw ParseError(file, 1, "begins like UTF-16, expected YAML in UTF-8");
  }
  int number = 1;
  while (!text.empty()) {
    // A lone carriage return ends a line for YAML, too.
    const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
    if (withoutComment(text.substr(0, end)).find(":]") != std::string_view::npos) {
      throw ParseError(file, number, "has ':]', expected a space between the two or no colon");
    }
    if (end == text.size()) break;
    if (text[end] == '\n') ++number;
    text.remove_prefix(end + 1);
  }
}

}  // namespace

YAML::Node parseYaml(std::string_view text, const std::string& file) {
  refuseEndlessInput(text, file);
  try {
    // A line end more would hide from yaml-cpp that text in quotes does not end.
    const bool ends_in_colon = !text.empty() && text.back() == ':';
    return YAML::Load(std::string(text) + (ends_in_colon ? "\n" : ""));
  } catch (const YAML::Exception& error) {
    throw ParseError(file, error.mark.line + 1, "not valid YAML: " + error.msg);
  }
}

YAML::Node readYamlFile(const std::filesystem::path& file) {
  std::string content;
  for (const std::string& line : readLines(file)) {
    content += line + '\n';
  }
  return parseYaml(content, file.string());
}

}  // namespace evolin
