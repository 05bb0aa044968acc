// A whole evaluation over a recording, as fast as the machine allows.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "evolin_ros/evaluation/evaluation_settings.h"
#include "evolin_ros/evaluation/front_end.h"
#include "evolin_ros/evaluation/report.h"

namespace evolin {

struct SequenceRunOptions {
  EvaluationSettings evaluation;
  FrontEndOptions front_end;
  int threads = 1;
  /// Is told of images, lines, ground truth and matches as well, in the recording's order; outlives
  /// the run. None: nobody else wants to know.
  FrontEndSink* observer = nullptr;
};

struct SequenceRunResult {
  std::vector<Report> reports;  ///< by pass; the last is the newest's
  bool interrupted = false;
};

/// Calls `progress` with the number of images that are done, and stops early once `interrupted`
/// says so; what is done is reported, marked as not complete. The reports are those of a
/// StreamEvaluator that got every part, the same for any number of threads but for measured times.
/// Throws what the makers of plug-ins and the reader throw, and Error when the recording has no
/// image.
SequenceRunResult runSequence(const SequenceRunOptions& options, PartReader* reader,
                              const std::function<void(std::size_t)>& progress,
                              const std::function<bool()>& interrupted);

}  // namespace evolin
