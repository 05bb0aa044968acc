// One run of a front-end and the evaluation over a recording, into a folder: what 'evolin run' does
// once and 'evolin benchmark' for every cell.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "evolin_ros/evaluation/sequence_run.h"
#include "evolin_ros/geometry/line_selection.h"
#include "method_choice.h"
#include "recording_input.h"

namespace evolin::cli {

/// Written into the folder last: program, input, whether the run came to its end.
constexpr const char* kRunMarker = "run.txt";

struct RunRequest {
  std::optional<MethodChoice> detector;  ///< none: no lines are detected
  std::string lines_name;    ///< of the lines in the report; "": the detector's own name
  std::string lines_folder;  ///< the detector's lines, recorded; "": it detects them itself
  LineSelection selection;
  std::optional<MethodChoice> associator;  ///< none: nothing is associated
  std::string matches_folder;  ///< the associator's matches, recorded; "": it finds them itself
  bool associate_ground_truth = true;                       ///< else the detected lines
  YAML::Node evaluation = YAML::Node(YAML::NodeType::Map);  ///< keys of readEvaluationSettings()
  int threads = 1;
  int worst_frames = 6;            ///< pictures of so many frames with the lowest F-score
  std::string hashes;              ///< of the input, JSON
  std::vector<std::string> notes;  ///< for the report, before the run's own
};

struct RunOutcome {
  std::string summary;  ///< the newest pass's report as a table for people
  bool interrupted = false;
};

/// The settings of `evaluation`; `owner` stands at the head of the ConfigError.
EvaluationSettings readEvaluation(const YAML::Node& evaluation, const std::string& owner);

/// A request's methods, and what they want of the frames.
struct ChosenFrontEnd {
  FrontEndOptions options;
  Needs needs;
};

/// `frame_step` is that of the evaluation; `loader` outlives the answer. Throws as the makers of
/// method_choice.h.
ChosenFrontEnd chooseFrontEnd(const RunRequest& request, int frame_step, PluginLoader* loader);

class SequenceJob {
 public:
  /// Opens everything, so that wrong parameters and absent methods are told before anything is
  /// written. `input` is checked; it and `loader` outlive the object. Throws as the makers of
  /// method_choice.h, readEvaluation() and RecordingInput::open().
  SequenceJob(RunRequest request, const RecordingInput& input, PluginLoader* loader);

  /// Images to come, as far as it is known.
  std::size_t images() const { return reader_->images(); }

  /// Writes one pass into `folder`, earlier ones into its pass_N. Callbacks and errors as
  /// runSequence(). Once.
  RunOutcome run(const std::filesystem::path& folder,
                 const std::function<void(std::size_t)>& progress,
                 const std::function<bool()>& interrupted);

 private:
  std::string parametersText() const;

  RunRequest request_;
  const RecordingInput& input_;
  SequenceRunOptions options_;
  std::unique_ptr<PartReader> reader_;
};

}  // namespace evolin::cli
