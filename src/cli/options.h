// Reading a verb's options, the same way everywhere.
#pragma once

#include <boost/program_options/options_description.hpp>
#include <boost/program_options/variables_map.hpp>
#include <string>
#include <vector>

#include "command.h"

namespace evolin::cli {

/// Reads `arguments` by `options` into the variables that `options` is bound to; "--help" ("-h") is
/// added. Returns false after printing `usage` and the options to standard output because help was
/// asked for. Throws UsageError for an unknown option (naming the nearest one), a positional
/// argument, a missing or malformed value, or a required option that is absent. `bare` names the
/// option that words without one belong to; null: no such words.
bool parseOptions(const std::string& usage, boost::program_options::options_description options,
                  const std::vector<std::string>& arguments,
                  boost::program_options::variables_map* values = nullptr,
                  const char* bare = nullptr);

}  // namespace evolin::cli
