// Takes a live stream's parts as they come, tells passes over the sequence apart and evaluates each
// on its own.
#pragma once

#include <array>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "evolin_ros/evaluation/pass_evaluation.h"

namespace evolin {

/// A stamp that an input has already had in this pass, or one before everything it has had, is a
/// jump back: that input has begun a new pass. Each input is followed on its own, because the last
/// parts of a pass may come after another input has begun the next. A stamp merely out of order is
/// taken where it belongs, at the start of a pass too if another input has had it in this pass; a
/// stamp that comes twice in a row, or the newest one again, is a duplicate: the first is taken.
/// The two newest passes are kept. What cannot be taken (duplicates, stamp 0, parts of an older
/// pass) is counted as dropped, of matches as skipped, and warned of; images, which bring nothing
/// but their stamp, leave no trace, depth and poses only where they have no stamp. Not safe for
/// several threads at once.
///
/// Lines or matches from another source than those before them are of other settings: a new pass
/// begins with the frame of such lines, or behind the newest lines for such matches, so that no
/// figure is of two. What has come of later frames goes along to the new pass. Where two sources
/// give lines of one stamp, or go back in time, they share the topic, and their change tells
/// nothing.
class StreamEvaluator {
 public:
  explicit StreamEvaluator(PassOptions options = {});

  EvaluationUpdate addImage(Stamp stamp);
  EvaluationUpdate addLines(LineSet lines);
  EvaluationUpdate addGroundTruth(const LineSet& ground_truth);
  EvaluationUpdate addMatches(const MatchSet& matches);

  /// While paused, lines, ground truth and matches are counted as skipped, images are not taken.
  void pause(bool paused) { paused_ = paused; }
  bool isPaused() const { return paused_; }

  /// Of all passes: a camera does not change with time's jumps.
  EvaluationUpdate setCamera(const Camera& camera);
  EvaluationUpdate addDepth(Stamp stamp, const DepthMap& depth);
  EvaluationUpdate addPose(const StampedPose& pose);

  /// The result of a task that an update gave out; one of a pass that is over, or of before a
  /// reset, is forgotten.
  EvaluationUpdate addResult(const EvaluationResult& result);

  /// A task that an update gave out will not be run.
  void skip(const EvaluationTask& task);

  /// Of the newest pass; passes count from 1.
  Report report(bool complete) const;

  /// Of the pass before it, which is complete; none when the newest is the first.
  std::optional<Report> previousReport() const;

  /// Of the pass that the newest one has pushed out of memory, with the parts that came after its
  /// successor had begun; given once.
  std::optional<Report> takeReleasedReport();

  /// The same as they are, to be reported on where nobody waits; null and none as above.
  const PassEvaluation* previous() const;
  std::optional<std::pair<int, PassEvaluation>> takeReleased();

  /// Whether the pass before the newest has begun to be that, or has got a part, since this was
  /// asked last.
  bool takePreviousChanged() { return std::exchange(previous_changed_, false); }

  /// Of the newest pass, cheap at any number of frames.
  CoverageCounts coverage() const { return current().coverage(); }

  /// For the report of the newest pass.
  void addNote(const std::string& text) { passes_.at(newest_).addNote(text); }

  bool hasPendingTasks() const;
  /// As PassEvaluation's, of the newest pass.
  void leaveOutLines(Stamp stamp) { passes_.at(newest_).leaveOutLines(stamp); }
  void leaveOutMatches(Stamp stamp) { passes_.at(newest_).leaveOutMatches(stamp); }
  bool waiting(const MayCome& may_come = {}) const;
  int pass() const { return newest_; }
  const PassEvaluation& current() const { return passes_.at(newest_); }

  /// Forgets everything, passes included.
  void reset();

 private:
  enum Input { kImage, kLines, kGroundTruth, kMatches, kDepth, kPose, kInputs };
  using Key = std::pair<Stamp, Stamp>;  ///< second stamp, first stamp (0 where there is one only)
  enum Fault { kNoStamp, kRepeated, kPassClosed, kSeveralSources, kBetweenSettings, kPaused };
  using AddTo = std::function<EvaluationUpdate(PassEvaluation*)>;
  struct Follower {
    int pass = 0;  ///< 0: nothing heard
    std::string source;
    std::string taken_source;  ///< of what was taken last
    int shared = 0;            ///< messages for which two sources seem to share the input
    Key last;
    std::set<Key> received;
  };

  /// The pass that a part belongs to, or none for a duplicate.
  std::optional<int> passOf(Input input, Key key);
  /// Whether a stamp before everything that the input has had belongs to the same pass all the
  /// same.
  bool startedOutOfOrder(Input input, Stamp stamp) const;
  /// Fills in where the update's tasks come from.
  EvaluationUpdate marked(EvaluationUpdate update, int pass) const;
  EvaluationUpdate add(Input input, Key key, const std::string& source, const AddTo& add);
  void openPass(EvaluationUpdate* update);
  bool isRepeated(const Follower& follower, Key key) const;
  bool changesSettings(Input input, Key key, const std::string& source) const;
  void beginSettings(Input input, Key key, const std::string& source, EvaluationUpdate* update);
  void crossBoundaries(Input input, Key key);
  bool isBetweenSettings(Input input, Key key, const std::string& source) const;
  void remember(Input input, Key key, const AddTo& add);
  void passOver(Input input, Key key, PassEvaluation* pass);
  PassEvaluation* passOf(std::uint64_t generation, int pass);
  PassEvaluation* enter(Input input, Key key, const std::string& source, EvaluationUpdate* update);
  void drop(Input input, Fault fault, const std::string& what, EvaluationUpdate* update);

  PassOptions options_;
  std::array<Follower, kInputs> followers_;
  std::set<std::pair<Input, Fault>> told_;
  std::set<std::pair<Input, Fault>> noted_;  ///< in the newest pass's report
  std::map<int, PassEvaluation> passes_;
  std::optional<std::pair<int, PassEvaluation>> released_;
  bool previous_changed_ = false;
  int newest_ = 1;
  std::optional<Camera> camera_;
  bool paused_ = false;
  struct Boundary {
    Stamp first;    ///< frame of the pass
    Stamp changed;  ///< of the part that came from another source; not later
  };
  std::map<int, Boundary> boundaries_;  ///< of the passes that a change of settings has begun
  /// Parts of the newest pass whose frames have no lines yet: they may belong to the next one.
  std::array<std::deque<std::pair<Key, AddTo>>, kInputs> ahead_;
  std::uint64_t generation_ = 0;
};

}  // namespace evolin
