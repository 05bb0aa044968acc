// The built-in synthetic sequence as a dataset folder.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>

#include "evolin_ros/dataset/synthetic/synthetic_sequence.h"

namespace evolin::cli {

/// Names what a folder was made from; 'evolin synth' replaces only folders that hold it.
constexpr const char* kSynthMarker = "synth.txt";

/// The marker's text: program version and options.
std::string describeSequence(const synthetic::SyntheticOptions& options);

/// Runs make(number) on all workers for a batch of frames at a time, then take(number) in order;
/// progress goes to standard error unless `quiet`. Throws Interrupted when the user presses Ctrl-C.
void forEachFrame(std::size_t frames, int workers, bool quiet,
                  const std::function<void(std::size_t)>& make,
                  const std::function<void(std::size_t)>& take);

/// Fills `folder`, the marker last. Returns the number of ground-truth lines in all frames. Throws
/// as forEachFrame(), and Error naming a file that cannot be written.
std::size_t fillSyntheticFolder(const synthetic::SyntheticOptions& options, int workers, bool quiet,
                                const std::filesystem::path& folder);

}  // namespace evolin::cli
