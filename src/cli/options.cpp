// Boost.Program_options with this program's habits: whole names only, helpful refusals.
#include "options.h"

#include <boost/program_options/cmdline.hpp>
#include <boost/program_options/parsers.hpp>
#include <iostream>

#include "evolin_ros/base/parameters.h"

namespace evolin::cli {

namespace po = boost::program_options;

namespace {

std::vector<std::string> longNames(const po::options_description& options) {
  std::vector<std::string> names;
  for (const auto& option : options.options()) {
    names.push_back("--" + option->long_name());
  }
  return names;
}

}  // namespace

bool parseOptions(const std::string& usage, po::options_description options,
                  const std::vector<std::string>& arguments, po::variables_map* values,
                  const char* bare) {
  options.add_options()("help,h", "this text");
  // Abbreviations would break scripts as soon as an option with the same beginning comes.
  constexpr int kStyle =
      po::command_line_style::default_style & ~po::command_line_style::allow_guessing;
  po::variables_map own;
  po::variables_map& map = values == nullptr ? own : *values;
  try {
    po::positional_options_description positional;
    if (bare != nullptr) {
      positional.add(bare, -1);
    }
    po::store(po::command_line_parser(arguments)
                  .options(options)
                  .positional(positional)
                  .style(kStyle)
                  .run(),
              map);
    if (map.count("help") > 0) {
      std::cout << usage << "\n\n" << options;
      return false;
    }
    po::notify(map);
  } catch (const po::unknown_option& error) {
    const std::string name = error.get_option_name();
    throw UsageError("unknown option '" + name + "'; did you mean '" +
                     nearestWord(name, longNames(options)) + "'?");
  } catch (const po::error& error) {
    throw UsageError(error.what());
  }
  return true;
}

}  // namespace evolin::cli
