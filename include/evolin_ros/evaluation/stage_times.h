// Where the time of a run goes, stage by stage.
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "evolin_ros/base/stop_watch.h"

namespace evolin {

enum class Stage {
  kDecode,  ///< from the recording to pixels
  kDetect,
  kDescribe,  ///< the associator's descriptions, where it makes them ahead of matching
  kMatch,
  kDetection,  ///< this and the following: metric families
  kHeatmap,
  kRepeatability,  ///< with the lifting of lines into space, also where only pose needs it
  kAssociation,    ///< of ground-truth lines and of detected ones
  kPose,
  kTracks,
  kReport,  ///< putting the report together
  kCount
};

/// "decode", "detect", ...
std::string toString(Stage stage);

/// Seconds on the clock on the wall, and of the calling thread on a processor: the two differ where
/// the thread waits, or shares the processor with others.
struct StageTime {
  double wall = 0;
  double processor = 0;

  StageTime& operator+=(const StageTime& other) {
    wall += other.wall;
    processor += other.processor;
    return *this;
  }
};

/// Both clocks from its construction on; to be read on the same thread.
class StageClock {
 public:
  StageClock();

  StageTime elapsed() const;

 private:
  StopWatch wall_;
  double processor_;
};

/// Times by stage, summed over threads.
class StageTimes {
 public:
  const StageTime& of(Stage stage) const { return times_[static_cast<std::size_t>(stage)]; }
  void add(Stage stage, const StageTime& time) { times_[static_cast<std::size_t>(stage)] += time; }
  void add(const StageTimes& other) {
    for (std::size_t i = 0; i < times_.size(); ++i) {
      times_[i] += other.times_[i];
    }
  }

  /// Runs `work`, adds the time it took, and gives what it returns.
  template <class Work>
  auto measure(Stage stage, const Work& work) {
    const Timer timer(this, stage);
    return work();
  }

 private:
  class Timer {
   public:
    Timer(StageTimes* times, Stage stage) : times_(times), stage_(stage) {}
    ~Timer() { times_->add(stage_, clock_.elapsed()); }
    Timer(const Timer&) = delete;
    Timer& operator=(const Timer&) = delete;

   private:
    StageTimes* times_;
    Stage stage_;
    StageClock clock_;
  };

  std::array<StageTime, static_cast<std::size_t>(Stage::kCount)> times_;
};

/// Of one run over a recording.
struct RunTiming {
  StageTimes stages;
  double wall = 0;      ///< s, from the first frame to the report
  double recorded = 0;  ///< s between the first and the last image, and one more frame
  std::size_t frames = 0;
  int threads = 1;
};

}  // namespace evolin
