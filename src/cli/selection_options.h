// --score-threshold, --min-length and --max-lines: which of a detector's lines count.
#pragma once

#include <boost/program_options/options_description.hpp>
#include <boost/program_options/value_semantic.hpp>

#include "command.h"
#include "evolin_ros/geometry/line_selection.h"

namespace evolin::cli {

struct SelectionOptions {
  LineSelection selection;
  int max_lines = 0;

  void describe(boost::program_options::options_description* description) {
    namespace po = boost::program_options;
    auto add = description->add_options();
    add("score-threshold", po::value(&selection.score_threshold)->value_name("T"),
        "keep detected lines with score > T; without it all");
    add("min-length", po::value(&selection.min_length)->value_name("PX")->default_value(0),
        "keep detected lines of at least this length, pixels");
    add("max-lines", po::value(&max_lines)->value_name("N")->default_value(0),
        "keep the N best lines of an image, by score or else by length; 0: all");
  }

  /// Throws UsageError.
  void check() {
    if (!(selection.min_length >= 0)) {
      throw UsageError("--min-length: expected pixels of at least 0");
    }
    if (max_lines < 0) {
      throw UsageError("--max-lines: expected 0 or more");
    }
    selection.max_lines = static_cast<std::size_t>(max_lines);
  }
};

}  // namespace evolin::cli
