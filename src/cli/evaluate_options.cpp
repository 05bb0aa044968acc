// Shared options of `evaluate`, the rule against overwriting, and the output.
#include "evaluate_options.h"

#include <algorithm>
#include <boost/program_options/value_semantic.hpp>
#include <filesystem>
#include <iostream>
#include <system_error>
#include <thread>

#include "command.h"
#include "evolin_ros/base/atomic_file.h"
#include "evolin_ros/base/text.h"
#include "result_table.h"

namespace evolin::cli {

namespace po = boost::program_options;
namespace fs = std::filesystem;

namespace {

/// Lists the files of its folder that runs of this verb made, so that the next one may overwrite
/// them.
constexpr const char* kMarker = ".evolin-evaluate";

constexpr int kMaxThreads = 1024;

fs::path resultFile(const EvaluateOptions& options) {
  return fs::path(options.output) / options.output_file;
}

void requireRange(const std::string& option, int value, int low, int high) {
  if (value < low || value > high) {
    throw UsageError(option + " " + std::to_string(value) + ": expected " + std::to_string(low) +
                     " to " + std::to_string(high));
  }
}

/// File names of the marker; none where there is no marker.
std::vector<std::string> filesMade(const EvaluateOptions& options) {
  const fs::path marker = fs::path(options.output) / kMarker;
  std::error_code ignored;
  return fs::is_regular_file(marker, ignored) ? readLines(marker) : std::vector<std::string>();
}

bool wasMade(const EvaluateOptions& options) {
  const std::vector<std::string> made = filesMade(options);
  return std::find(made.begin(), made.end(), options.output_file) != made.end();
}

void markAsMade(const EvaluateOptions& options) {
  std::string list;
  for (const std::string& name : filesMade(options)) {
    list += name + "\n";
  }
  writeFileAtomically(fs::path(options.output) / kMarker, list + options.output_file + "\n");
}

void writeResult(const EvaluateOptions& options, const std::string& json) {
  writeFileAtomically(resultFile(options), json + "\n");
  if (!wasMade(options)) {
    markAsMade(options);
  }
  std::cerr << "written: " << resultFile(options).string() << '\n';
}

}  // namespace

void addEvaluateOptions(const std::string& default_file, EvaluateOptions* values,
                        po::options_description* description) {
  auto add = description->add_options();
  add("output,o", po::value(&values->output)->value_name("DIR"),
      "folder for the results file, made if missing; without it results go to standard output "
      "alone");
  add("output-file,O",
      po::value(&values->output_file)->value_name("FILE")->default_value(default_file),
      "name of the results file inside --output");
  add("format", po::value(&values->format)->value_name("json|table|csv"),
      "form of the results on standard output; default json, with --output table (curves are in "
      "json alone)");
  add("force", po::bool_switch(&values->force), "overwrite files that another program made");
  add("protocol",
      po::value(&values->protocol)->value_name("evolin|paper")->default_value(values->protocol),
      "reproduce the published implementation, or follow the article's formulas");
  add("threads", po::value(&values->threads)->value_name("N")->default_value(values->threads),
      "worker threads, 0: one a core; the results do not depend on it");
  add("bootstrap", po::value(&values->resamples)->value_name("N")->default_value(values->resamples),
      "add 95 % confidence intervals from N resamples of blocks of frames, 0: none");
  add("bootstrap-block",
      po::value(&values->block_length)->value_name("N")->default_value(values->block_length),
      "frames a block, 0: the cube root of their number");
  add("bootstrap-seed", po::value(&values->seed)->value_name("N")->default_value(values->seed),
      "seed of the resampling");
}

void checkEvaluateOptions(const EvaluateOptions& options) {
  protocolOf(options);
  const std::vector<std::string> formats = {"", "json", "table", "csv"};
  if (std::find(formats.begin(), formats.end(), options.format) == formats.end()) {
    throw UsageError("--format " + quote(options.format) + ": expected json, table or csv");
  }
  requireRange("--threads", options.threads, 0, kMaxThreads);
  requireRange("--bootstrap", options.resamples, 0, 10000000);
  requireRange("--bootstrap-block", options.block_length, 0, 1000000000);
  const fs::path name = options.output_file;
  if (name.empty() || name != name.filename() || name == "." || name == ".." || name == kMarker) {
    throw UsageError("--output-file " + quote(options.output_file) +
                     ": expected a file name without a folder");
  }
  if (options.output.empty() || options.force) {
    return;
  }
  std::error_code ignored;
  if (fs::exists(resultFile(options), ignored) && !wasMade(options)) {
    throw Error(resultFile(options).string() +
                ": exists and was not made by evolin evaluate; expected another --output, or "
                "--force to overwrite it");
  }
}

Protocol protocolOf(const EvaluateOptions& options) {
  try {
    return parseProtocol(options.protocol);
  } catch (const Error& error) {
    throw UsageError(std::string("--protocol: ") + error.what());
  }
}

int threadsFor(const EvaluateOptions& options, std::size_t tasks) {
  const unsigned wanted = options.threads > 0 ? static_cast<unsigned>(options.threads)
                                              : std::max(1U, std::thread::hardware_concurrency());
  return static_cast<int>(std::min<std::size_t>(wanted, std::max<std::size_t>(tasks, 1)));
}

namespace {

BootstrapOptions bootstrapOf(const EvaluateOptions& options) {
  BootstrapOptions bootstrap;
  bootstrap.resamples = options.resamples;
  bootstrap.block_length = options.block_length;
  bootstrap.seed = options.seed;
  return bootstrap;
}

}  // namespace

std::vector<ConfidenceInterval> intervalsFor(const EvaluateOptions& options, std::size_t frames,
                                             const WeightedFigures& figures) {
  return options.resamples == 0 ? std::vector<ConfidenceInterval>()
                                : blockBootstrap(frames, bootstrapOf(options), figures);
}

std::vector<ConfidenceInterval> intervalsForMany(const EvaluateOptions& options, std::size_t frames,
                                                 const FiguresOfResamples& figures) {
  return options.resamples == 0 ? std::vector<ConfidenceInterval>()
                                : blockBootstrapOfMany(frames, bootstrapOf(options), figures);
}

void deliverResults(const EvaluateOptions& options, const std::vector<PublishedEntry>& entries) {
  const std::string json = toPublishedJson(entries);
  if (!options.output.empty()) {
    writeResult(options, json);
  }
  const std::string format =
      !options.format.empty() ? options.format : (options.output.empty() ? "json" : "table");
  if (format == "json") {
    std::cout << json << '\n';
  } else {
    std::cout << (format == "csv" ? toCsv(entries) : toTable(entries));
  }
}

}  // namespace evolin::cli
