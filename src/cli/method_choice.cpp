// Values are YAML: numbers and words as they are, lists in brackets.
#include "method_choice.h"

#include "command.h"
#include "evolin_ros/base/text.h"
#include "evolin_ros/base/yaml_file.h"

namespace evolin::cli {

namespace {

/// At commas that are in no bracket.
std::vector<std::string> splitOutsideBrackets(const std::string& text) {
  std::vector<std::string> pieces(1);
  int depth = 0;
  for (const char letter : text) {
    depth += letter == '[' || letter == '{' ? 1 : 0;
    depth -= letter == ']' || letter == '}' ? 1 : 0;
    if (letter == ',' && depth == 0) {
      pieces.emplace_back();
    } else {
      pieces.back() += letter;
    }
  }
  return pieces;
}

/// Those that run here, without the one that turned out not to.
std::string others(const std::vector<PluginInfo>& plugins, const std::string& but) {
  std::string names;
  for (const PluginInfo& plugin : plugins) {
    if (plugin.why_unavailable.empty() && plugin.name != but) {
      names += (names.empty() ? "" : ", ") + plugin.name;
    }
  }
  return names;
}

/// `make` gives a configured instance of `name`, `list` all plug-ins of the kind.
template <class Plugin, class Make, class List>
std::function<std::shared_ptr<Plugin>()> makerOf(const std::string& name, const Make& make,
                                                 const List& list, Needs* needs) {
  auto first = std::make_shared<std::shared_ptr<Plugin>>();
  try {
    *first = make();
  } catch (const UnavailableError& error) {
    throw UnavailableError(std::string(error.what()) + "; available: " + others(list(), name));
  }
  const Needs more = (*first)->needs();
  needs->depth = needs->depth || more.depth;
  needs->camera = needs->camera || more.camera;
  needs->pose = needs->pose || more.pose;
  return [make, first] { return *first ? std::exchange(*first, nullptr) : make(); };
}

}  // namespace

void parseAssignments(const std::string& option, const std::string& text, YAML::Node* parameters) {
  for (const std::string& piece : splitOutsideBrackets(text)) {
    const std::size_t equals = piece.find('=');
    const std::string key(trim(piece.substr(0, equals)));
    if (equals == std::string::npos || key.empty()) {
      throw UsageError(option + ": is " + quote(piece) + ", expected key=value");
    }
    const std::string value(trim(std::string_view(piece).substr(equals + 1)));
    const bool nested = !value.empty() && (value.front() == '[' || value.front() == '{');
    try {
      (*parameters)[key] = nested ? parseYaml(value, option) : YAML::Node(value);
    } catch (const Error& error) {
      throw UsageError(error.what());
    }
  }
}

MethodChoice parseMethod(const std::string& option, const std::string& text,
                         const std::string& config) {
  MethodChoice choice;
  if (!config.empty()) {
    const YAML::Node loaded = readYamlFile(config);
    if (!loaded.IsMap() && !loaded.IsNull()) {
      throw Error(config + ": expected a map of parameters");
    }
    if (loaded.IsMap()) {
      choice.parameters = YAML::Clone(loaded);
    }
  }
  const std::size_t colon = text.find(':');
  choice.name = text.substr(0, colon);
  if (choice.name.empty()) {
    throw UsageError(option + ": is " + quote(text) + ", expected NAME or NAME:key=value,...");
  }
  if (colon != std::string::npos) {
    parseAssignments(option, text.substr(colon + 1), &choice.parameters);
  }
  return choice;
}

std::function<std::shared_ptr<LineDetector>()> detectorMaker(PluginLoader* loader,
                                                             const MethodChoice& choice,
                                                             Needs* needs) {
  return makerOf<LineDetector>(
      choice.name,
      [loader, choice] {
        const std::shared_ptr<LineDetector> detector = loader->loadDetector(choice.name);
        detector->configure(choice.parameters);
        return detector;
      },
      [loader] { return loader->listDetectors(); }, needs);
}

std::function<std::shared_ptr<LineAssociator>()> associatorMaker(PluginLoader* loader,
                                                                 const MethodChoice& choice,
                                                                 Needs* needs) {
  return makerOf<LineAssociator>(
      choice.name,
      [loader, choice] {
        const std::shared_ptr<LineAssociator> associator = loader->loadAssociator(choice.name);
        associator->configure(choice.parameters);
        return associator;
      },
      [loader] { return loader->listAssociators(); }, needs);
}

}  // namespace evolin::cli
