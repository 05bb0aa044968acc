// `evolin benchmark`.
#include "benchmark_command.h"

#include <algorithm>
#include <boost/program_options/value_semantic.hpp>
#include <iostream>
#include <memory>
#include <optional>

#include "benchmark_list.h"
#include "benchmark_runner.h"
#include "evolin_ros/base/atomic_file.h"
#include "evolin_ros/base/parameters.h"
#include "evolin_ros/base/text.h"
#include "evolin_ros/base/version.h"
#include "file_lock.h"
#include "options.h"
#include "thread_option.h"

namespace evolin::cli {

namespace fs = std::filesystem;
namespace po = boost::program_options;

namespace {

constexpr const char* kUsage =
    "Runs every detector with every associator over every sequence of a matrix, and again only "
    "what is missing or changed: a cell is known by a digest of its inputs, parameters and the "
    "program's version. DIR gets cells/ID as 'evolin run' writes it with cell.json, detections/ID "
    "(lines, found once for all cells), sequences/NAME (synthetic ones) and matrix.json. Cells "
    "that fail are reported at the end and tried again by the next start; Ctrl-C keeps what is "
    "done. docs/BENCHMARK.md tells the form of the matrix.\n\n"
    "Usage: evolin benchmark --config FILE --output DIR [OPTIONS]";

constexpr const char* kMarker = "benchmark.txt";
constexpr double kPatience = 10;  // s for processes of a killed benchmark to go

struct BenchmarkOptions {
  std::string config;
  std::string output;
  std::string data;
  int jobs = 1;
  std::vector<std::string> cells;
  std::vector<std::string> detections;
  bool list = false;
  bool collect = false;
  std::string format = "table";
  bool force = false;
  bool quiet = false;
};

po::options_description describe(BenchmarkOptions* options) {
  po::options_description description("Options");
  auto add = description.add_options();
  add("config,c", po::value(&options->config)->value_name("FILE")->required(),
      "matrix of sequences, detectors, associators and settings, YAML");
  add("output,o", po::value(&options->output)->value_name("DIR"),
      "folder of the benchmark, a new one or that of an earlier start");
  add("data", po::value(&options->data)->value_name("DIR"),
      "folder that relative paths of the matrix start from; without it the matrix's own");
  add("jobs,j", po::value(&options->jobs)->value_name("N")->default_value(1),
      "cells at once, each on one thread, 0: one a core; results do not depend on it, measured "
      "times may");
  add("list", po::bool_switch(&options->list), "print the cells and their states, run none");
  add("format", po::value(&options->format)->value_name("FORM")->default_value(options->format),
      "of --list: table or json");
  add("cell", po::value(&options->cells)->value_name("ID")->composing(),
      "run this cell (and what it needs) alone; again for more");
  add("detection", po::value(&options->detections)->value_name("ID")->composing(),
      "find the lines of one detector on one sequence alone (SEQUENCE--DETECTOR)");
  add("collect", po::bool_switch(&options->collect),
      "run nothing; matrix.json and the summary from the cells that are there");
  add("force", po::bool_switch(&options->force),
      "detect and run again what is finished; with --cell that cell alone, on the lines that are "
      "there");
  add("quiet,q", po::bool_switch(&options->quiet), "no progress");
  return description;
}

void check(BenchmarkOptions* options) {
  if (options->jobs < 0) {
    throw UsageError("--jobs: is " + std::to_string(options->jobs) + ", expected 0 or more");
  }
  options->jobs = checkedThreads(options->jobs);
  if (options->format != "table" && options->format != "json") {
    throw UsageError("--format: is " + quote(options->format) + ", expected table or json");
  }
  const int ways = int(options->list) + int(options->collect) + int(!options->cells.empty()) +
                   int(!options->detections.empty());
  if (ways > 1) {
    throw UsageError("expected at most one of --list, --collect, --cell and --detection");
  }
  if (options->force && (options->list || options->collect || !options->detections.empty())) {
    throw UsageError(
        "--force goes with a whole benchmark or with --cell, not with --list, "
        "--collect or --detection");
  }
  if (options->output.empty() && !options->list) {
    throw UsageError("the option '--output' is required but missing");
  }
}

class Benchmark {
 public:
  explicit Benchmark(const BenchmarkOptions& options)
      : options_(options),
        matrix_(readBenchmarkMatrix(options.config, options.data)),
        root_(options.output.empty() ? fs::path()
                                     : fs::absolute(options.output).lexically_normal()) {}

  int run() {
    if (options_.list) {
      return list();
    }
    prepareFolder();
    const bool alone = options_.cells.empty() && options_.detections.empty();
    const FileLock lock(root_ / ".lock", alone ? LockKind::kExclusive : LockKind::kShared,
                        kPatience, root_.string() + ": another 'evolin benchmark' works there");
    if (alone) {
      removeLeftovers();
    }
    look();
    if (alone && options_.force) {
      forgetDetections();
    }
    if (!options_.detections.empty()) {
      return runDetectionsAlone();
    }
    return alone ? runAll() : runCellsAlone();
  }

 private:
  int list() {
    if (!root_.empty() && !fs::exists(root_ / kMarker)) {
      root_.clear();  // nothing was run there, and nothing is to be made there
    }
    look();
    std::cout << (options_.format == "json" ? cellsJson(context(), records_) : cellTable(records_));
    return kExitDone;
  }

  BenchmarkContext context() const { return {matrix_, plan_, root_}; }

  void prepareFolder() const {
    if (fs::exists(root_) &&
        (!fs::is_directory(root_) || (!fs::is_empty(root_) && !fs::exists(root_ / kMarker)))) {
      throw Error(root_.string() + ": exists and holds no " + kMarker +
                  " of an earlier benchmark, expected a new or an empty folder");
    }
    if (!fs::exists(root_ / kMarker)) {
      writeFileAtomically(root_ / kMarker, programVersion() + " benchmark\n");
    }
  }

  /// What killed processes have left; nobody else works here.
  void removeLeftovers() const {
    for (const char* name : {"cells", "detections", "sequences"}) {
      if (!fs::is_directory(root_ / name)) {
        continue;
      }
      std::vector<fs::path> leftovers;
      for (const fs::directory_entry& entry : fs::directory_iterator(root_ / name)) {
        if (entry.is_directory() && entry.path().filename().string().front() == '.') {
          leftovers.push_back(entry.path());
        }
      }
      for (const fs::path& leftover : leftovers) {
        fs::remove_all(leftover);
      }
    }
  }

  /// Those of the matrix that can be made again here; nobody else works here.
  void forgetDetections() const {
    for (const PlannedDetection& detection : plan_.detections) {
      fs::remove_all(detectionFolder(root_, detection.id));
    }
  }

  void look() {
    plan_ = makePlan(matrix_, root_);
    for (std::size_t cell = 0; cell < matrix_.cells.size(); ++cell) {
      records_.push_back(stateNow(cell));
    }
  }

  CellRecord stateNow(std::size_t cell) const {
    CellRecord record = recordOf(matrix_, matrix_.cells[cell]);
    record.content_hash = plan_.cells[cell].content_hash;
    if (!plan_.cells[cell].unavailable.empty()) {
      record.state = CellState::kUnavailable;
      record.error = plan_.cells[cell].unavailable;
      return record;
    }
    return root_.empty() ? record : stateOf(record, cellFolder(root_, record.id));
  }

  void writeMatrix() const {
    writeFileAtomically(root_ / kMatrixFile, matrixJson(matrix_, records_));
  }

  std::vector<std::size_t> toRun(const std::vector<std::size_t>& places) const {
    std::vector<std::size_t> wanted;
    for (const std::size_t place : places) {
      const CellState state = records_[place].state;
      if (state != CellState::kUnavailable && (options_.force || state != CellState::kFinished)) {
        wanted.push_back(place);
      }
    }
    return wanted;
  }

  /// Without hiding what an earlier start has found.
  void recordUnavailable() const {
    for (std::size_t cell = 0; cell < records_.size(); ++cell) {
      const std::optional<CellRecord> found = readCellRecord(cellFolder(root_, records_[cell].id));
      if (records_[cell].state == CellState::kUnavailable &&
          (!found || found->state != CellState::kFinished)) {
        recordCell(context(), cell, CellState::kUnavailable, records_[cell].error);
      }
    }
  }

  int runAll() {
    std::vector<std::size_t> places(records_.size());
    for (std::size_t place = 0; place < places.size(); ++place) {
      places[place] = place;
    }
    bool complete = true;
    if (!options_.collect) {
      writeMatrix();
      recordUnavailable();
      complete = runCells(context(), toRun(places), {options_.jobs, options_.quiet},
                          [this](std::size_t cell) {
                            records_[cell] = stateNow(cell);
                            writeMatrix();
                          });
    }
    writeMatrix();
    std::cout << summaryOf(records_);
    if (!complete) {
      throw Interrupted("interrupted; what is done stands in " + options_.output +
                        ", the same command goes on");
    }
    return statusOf(places);
  }

  int statusOf(const std::vector<std::size_t>& places) const {
    std::size_t finished = 0;
    for (const std::size_t place : places) {
      if (records_[place].state == CellState::kFailed) {
        return kExitFailed;
      }
      finished += records_[place].state == CellState::kFinished ? 1 : 0;
    }
    return finished > 0 ? kExitDone : kExitFailed;
  }

  int runCellsAlone() {
    std::vector<std::size_t> places;
    for (const std::string& id : options_.cells) {
      places.push_back(placeOf("--cell", id, records_));
    }
    for (const std::size_t place : places) {
      if (records_[place].state == CellState::kUnavailable) {
        throw Error(records_[place].id + " is not available: " + records_[place].error);
      }
    }
    const bool complete = runCells(context(), toRun(places), {options_.jobs, options_.quiet},
                                   [this](std::size_t cell) { records_[cell] = stateNow(cell); });
    if (!complete) {
      throw Interrupted("interrupted");
    }
    for (const std::size_t place : places) {
      std::cout << records_[place].id << " " << toString(records_[place].state)
                << (records_[place].error.empty() ? "" : ": " + records_[place].error) << "\n";
    }
    return statusOf(places);
  }

  int runDetectionsAlone() {
    std::vector<std::size_t> places;
    for (const std::string& id : options_.detections) {
      places.push_back(placeOf("--detection", id, plan_.detections));
    }
    if (!runDetections(context(), places, {options_.jobs, options_.quiet})) {
      throw Interrupted("interrupted");
    }
    return kExitDone;
  }

  template <class Entry>
  static std::size_t placeOf(const std::string& option, const std::string& id,
                             const std::vector<Entry>& entries) {
    std::vector<std::string> known;
    for (const Entry& entry : entries) {
      known.push_back(entry.id);
    }
    const auto found = std::find(known.begin(), known.end(), id);
    if (found == known.end()) {
      throw UsageError(option + ": is " + quote(id) + ", which is not in the matrix" +
                       (known.empty() ? "" : "; did you mean '" + nearestWord(id, known) + "'?") +
                       " (--list prints all)");
    }
    return static_cast<std::size_t>(found - known.begin());
  }

  const BenchmarkOptions& options_;
  BenchmarkMatrix matrix_;
  fs::path root_;
  BenchmarkPlan plan_;
  std::vector<CellRecord> records_;  ///< by cell
};

int runBenchmark(const std::vector<std::string>& arguments) {
  BenchmarkOptions options;
  if (!parseOptions(kUsage, describe(&options), arguments)) {
    return kExitDone;
  }
  check(&options);
  return Benchmark(options).run();
}

}  // namespace

Command benchmarkCommand() {
  return {"benchmark", "a matrix of methods and sequences, resumable", runBenchmark};
}

}  // namespace evolin::cli
