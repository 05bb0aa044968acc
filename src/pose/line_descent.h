// One descent of Levenberg and Marquardt from the identity over a table of matched lines.
#pragma once

#include "evolin_ros/pose/evolin_pose.h"
#include "line_table.h"
#include "rigid_motion.h"

namespace evolin {

/// Damping as in g2o (Kuemmerle et al. 2011) after Nielsen 1999. `options` and `table` outlive the
/// object; the table holds the residuals of the last motion tried, also of a rejected one.
class LineDescent {
 public:
  LineDescent(const EvolinPoseOptions& options, LineTable* table);

  /// Goes back to the identity; to be called again when the table has changed. `huber`: with the
  /// kernel, which enters as a weight alone.
  void start(bool huber);

  /// The next accepted step, or the end.
  void step();

  bool finished() const { return finished_; }
  const Pose& motion() const { return motion_; }
  int iterations() const { return iterations_; }

  /// Whether the steps that are left will hardly change on which side of `gate` any match ends up,
  /// with a margin of several times what they would do if they went on shrinking as the last three
  /// did. Never so when fewer than min_active would stay: the motion itself is the answer then.
  bool isSettled(double gate);

  /// Covariance of the motion, scaled by the residuals, all weights being one.
  Matrix6d covariance();

 private:
  struct Trial {
    bool accepted;
    double gain;
  };

  LineSums sumUp(const Pose& motion, double delta);
  double stepsToReach() const;
  Trial tryStep();

  const EvolinPoseOptions& options_;
  LineTable* table_;
  double delta_ = 0;
  Pose motion_;
  LineSums sums_;  ///< of motion_
  double lambda_ = 0;
  double growth_ = 2;
  int steps_ = 0;  ///< since start()
  bool finished_ = true;
  bool straight_ = false;     ///< the last step took its first trial
  bool keep_ = false;         ///< the residuals, before the next are made
  double predicted_[3] = {};  ///< gains of the last three steps, the newest first
  int iterations_ = 0;
};

}  // namespace evolin
