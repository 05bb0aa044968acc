// Where a pass takes its matches from: messages, or the ids of the lines.
#include <algorithm>
#include <string>
#include <utility>

#include "evolin_ros/evaluation/pass_evaluation.h"

namespace evolin {

EvaluationUpdate PassEvaluation::addLines(LineSet lines) {
  if (!id_matcher_) {
    return takeLines(std::move(lines));
  }
  const LineSet kept = lines;
  EvaluationUpdate update = takeLines(std::move(lines));
  matchByIds(kept, id_matcher_->add(kept), &update);
  return update;
}

EvaluationUpdate PassEvaluation::addMatches(MatchSet matches) {
  if (!id_matcher_) {
    return takeMatches(std::move(matches));
  }
  EvaluationUpdate update;
  ++pair_counts_.skipped;
  noteOnce("matches of " + formatStamp(matches.first_stamp) + " and " + formatStamp(matches.stamp) +
               ": matches_from is ids, so that messages with matches are left out and count as "
               "skipped pairs",
           &foreign_matches_told_, &update);
  return update;
}

void PassEvaluation::matchByIds(const LineSet& lines, IdMatcher::Result result,
                                EvaluationUpdate* update) {
  const std::string frame = "lines of frame " + formatStamp(lines.stamp) + ": ";
  if (result.jumped_back) {
    note(frame + "they come after later ones; they are matched by id with none before them",
         update);
  }
  if (result.repeated > 0 && !wants(MetricFamily::kTracks)) {  // which tells of it, too
    note(frame + std::to_string(result.repeated) +
             " repeat an id of the same frame; the first line of an id alone is matched",
         update);
  }
  if (result.without_ids) {
    ++pair_counts_.skipped;
    newest_matches_ = std::max(lines.stamp, newest_matches_.value_or(lines.stamp));
    noteOnce(frame +
                 "there, or in the frame that they are to be matched with, is no line with an id; "
                 "such pairs count as skipped (matches_from is ids)",
             &missing_ids_told_, update);
  }
  if (result.matches) {
    update->append(takeMatches(std::move(*result.matches)));
  }
}

void PassEvaluation::noteOnce(const std::string& text, bool* told, EvaluationUpdate* update) {
  if (!std::exchange(*told, true)) {
    note(text, update);
  }
}

}  // namespace evolin
