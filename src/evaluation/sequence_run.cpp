// Batches of the recording through front-end and evaluator.
#include "evolin_ros/evaluation/sequence_run.h"

#include <algorithm>
#include <iterator>

#include "evolin_ros/base/error.h"
#include "evolin_ros/evaluation/report_confidence.h"
#include "evolin_ros/evaluation/report_curves.h"
#include "evolin_ros/evaluation/stream_evaluator.h"

namespace evolin {

namespace {

/// The same for any number of threads, so that everything happens in the same order. Few enough
/// that their memory is used again before it has left the processor's caches.
constexpr std::size_t kImagesInBatch = 8;
constexpr std::size_t kPartsInBatch = 4096;

class Run : public FrontEndSink {
 public:
  explicit Run(const SequenceRunOptions& options)
      : options_(options),
        pool_(options.threads),
        front_end_(options.front_end, &pool_),
        evaluator_(options.evaluation.pass),
        runner_({options.evaluation.pass.evaluation.heatmap,
                 options.evaluation.pass.motion.pose_method}) {}

  /// False at the end of the recording.
  bool step(PartReader* reader) {
    std::vector<StreamPart> parts;
    bool more = true;
    times_.measure(Stage::kDecode, [&] {
      std::size_t images = 0;
      while (more && images < kImagesInBatch && parts.size() < kPartsInBatch) {
        std::optional<StreamPart> part = reader->next();
        more = part.has_value();
        if (more) {
          images += std::holds_alternative<ImagePart>(*part) ? 1 : 0;
          parts.push_back(std::move(*part));
        }
      }
    });
    front_end_.process(std::move(parts), this);
    runTasks();
    return more;
  }

  std::size_t images() const { return images_; }

  std::vector<Report> reports(bool complete) {
    if (const std::string note = front_end_.note(); !note.empty()) {
      evaluator_.addNote(note + (evaluator_.pass() > 1 ? " (of all passes)" : ""));
    }
    times_.measure(Stage::kReport, [&] {
      if (std::optional<Report> previous = evaluator_.previousReport()) {
        reports_.push_back(std::move(*previous));
      }
      reports_.push_back(evaluator_.report(complete));
      addCurves(evaluator_.current().evaluator().detection(), &reports_.back());
      if (options_.evaluation.bootstrap.resamples > 0) {
        addConfidence(evaluator_.current().evaluator().detection(), options_.evaluation.bootstrap,
                      &reports_.back());
      }
    });
    Report& report = reports_.back();
    if (reports_.size() == 1) {
      report.input_images = images_;
    }
    RunTiming timing;
    timing.stages = times_;
    timing.stages.add(front_end_.stageTimes());
    timing.stages.add(evaluator_.current().stageTimes());
    timing.wall = watch_.seconds();
    timing.recorded = recordedSeconds();
    timing.frames = images_;
    timing.threads = options_.threads;
    report.run = timing;
    return std::move(reports_);
  }

  void takeImage(const ImagePart& image) override {
    tell([&](FrontEndSink* observer) { observer->takeImage(image); });
    const Stamp stamp = image.frame.stamp;
    ++images_;
    first_ = std::min(stamp, first_.value_or(stamp));
    last_ = std::max(stamp, last_.value_or(stamp));
    take(evaluator_.addImage(stamp));
  }
  void takeCamera(const Camera& camera) override { take(evaluator_.setCamera(camera)); }
  void takeDepth(const DepthPart& depth) override {
    take(evaluator_.addDepth(depth.stamp, depth.depth));
  }
  void takePose(const StampedPose& pose) override { take(evaluator_.addPose(pose)); }
  void takeGroundTruth(const LineSet& ground_truth) override {
    tell([&](FrontEndSink* observer) { observer->takeGroundTruth(ground_truth); });
    take(evaluator_.addGroundTruth(ground_truth));
  }
  void takeLines(const LineSet& lines, const ImagePart& image) override {
    tell([&](FrontEndSink* observer) { observer->takeLines(lines, image); });
    take(evaluator_.addLines(lines));
  }
  void takeMatches(const MatchSet& matches, const Frame& first, const Frame& second) override {
    tell([&](FrontEndSink* observer) { observer->takeMatches(matches, first, second); });
    take(evaluator_.addMatches(matches));
  }
  void takeNote(const std::string& text) override { evaluator_.addNote(text); }

 private:
  template <class Tell>
  void tell(const Tell& say) {
    if (options_.observer != nullptr) {
      say(options_.observer);
    }
  }

  void take(EvaluationUpdate update) {
    std::move(update.tasks.begin(), update.tasks.end(), std::back_inserter(tasks_));
    if (update.new_pass) {
      runTasks();
      if (std::optional<Report> released = evaluator_.takeReleasedReport()) {
        reports_.push_back(std::move(*released));
      }
    }
  }

  void runTasks() {
    const std::vector<EvaluationTask> tasks = std::exchange(tasks_, {});
    std::vector<EvaluationResult> results(tasks.size());
    std::vector<StageTimes> times(pool_.size());
    pool_.forEach(tasks.size(), [&](std::size_t task, std::size_t worker) {
      const bool pose = std::holds_alternative<PoseTask>(tasks[task].work);
      times[worker].measure(pose ? Stage::kPose : Stage::kHeatmap,
                            [&] { results[task] = runner_.run(tasks[task]); });
    });
    for (const StageTimes& of_worker : times) {
      times_.add(of_worker);
    }
    for (const EvaluationResult& result : results) {
      evaluator_.addResult(result);
    }
  }

  /// With the time that the last image stands for.
  double recordedSeconds() const {
    if (images_ < 2 || *last_ <= *first_) {
      return 0;
    }
    const auto images = static_cast<double>(images_);
    return toSeconds(*last_ - *first_) * images / (images - 1);
  }

  const SequenceRunOptions& options_;
  StopWatch watch_;
  WorkerPool pool_;
  FrontEnd front_end_;
  StreamEvaluator evaluator_;
  TaskRunner runner_;
  StageTimes times_;
  std::vector<EvaluationTask> tasks_;
  std::vector<Report> reports_;  ///< of passes that are over
  std::size_t images_ = 0;
  std::optional<Stamp> first_;
  std::optional<Stamp> last_;
};

}  // namespace

SequenceRunResult runSequence(const SequenceRunOptions& options, PartReader* reader,
                              const std::function<void(std::size_t)>& progress,
                              const std::function<bool()>& interrupted) {
  Run run(options);
  SequenceRunResult result;
  bool more = true;
  while (more && !result.interrupted) {
    more = run.step(reader);
    progress(run.images());
    result.interrupted = more && interrupted();
  }
  if (run.images() == 0) {
    throw Error("no image is in the chosen part of the recording");
  }
  for (const std::string& note : reader->notes()) {
    run.takeNote(note);
  }
  result.reports = run.reports(!result.interrupted);
  return result;
}

}  // namespace evolin
