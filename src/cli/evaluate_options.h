// Options that all metric families of `evaluate` share, and what becomes of their results.
#pragma once

#include <boost/program_options/options_description.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "evolin_ros/metrics/bootstrap.h"
#include "evolin_ros/metrics/protocol.h"
#include "published_json.h"

namespace evolin::cli {

struct EvaluateOptions {
  std::string output;  ///< folder; empty: results go to standard output alone
  std::string output_file;
  std::string format;
  bool force = false;
  std::string protocol = "evolin";
  int threads = 0;    ///< 0: one a core
  int resamples = 0;  ///< of the bootstrap; 0: no intervals
  int block_length = 0;
  std::uint64_t seed = 1;
};

/// Adds --output, --output-file, --format, --force, --protocol, --threads and the bootstrap's,
/// bound to `values`, which must live as long as the description.
void addEvaluateOptions(const std::string& default_file, EvaluateOptions* values,
                        boost::program_options::options_description* description);

/// Checks what can be checked before the work starts; the output folder is not made yet. Throws
/// UsageError for values out of range, and Error when a file would be overwritten that no earlier
/// run of `evaluate` made.
void checkEvaluateOptions(const EvaluateOptions& options);

Protocol protocolOf(const EvaluateOptions& options);

/// Workers to use for `tasks` pieces of work.
int threadsFor(const EvaluateOptions& options, std::size_t tasks);

/// One interval a figure, or none at all when --bootstrap was not given.
std::vector<ConfidenceInterval> intervalsFor(const EvaluateOptions& options, std::size_t frames,
                                             const WeightedFigures& figures);

/// The same for figures that are found quicker for many resamples at a time.
std::vector<ConfidenceInterval> intervalsForMany(const EvaluateOptions& options, std::size_t frames,
                                                 const FiguresOfResamples& figures);

/// Writes DIR/FILE where --output was given, so that later runs may overwrite that file, and prints
/// the results in the asked form.
void deliverResults(const EvaluateOptions& options, const std::vector<PublishedEntry>& entries);

}  // namespace evolin::cli
