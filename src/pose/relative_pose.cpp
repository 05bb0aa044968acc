// Names of strategies and failures.
#include "evolin_ros/pose/relative_pose.h"

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/text.h"

namespace evolin {

std::string toString(PoseStrategy strategy) {
  return strategy == PoseStrategy::kEvolin ? "evolin" : "robust";
}

PoseStrategy parsePoseStrategy(const std::string& text) {
  for (const PoseStrategy strategy : {PoseStrategy::kEvolin, PoseStrategy::kRobust}) {
    if (text == toString(strategy)) {
      return strategy;
    }
  }
  throw Error("pose strategy " + quote(text) + ": expected evolin or robust");
}

std::string toString(PoseFailure failure) {
  switch (failure) {
    case PoseFailure::kNone:
      return "none";
    case PoseFailure::kTooFewMatches:
      return "too few matches";
    case PoseFailure::kDegenerate:
      return "degenerate lines";
    case PoseFailure::kNoConsensus:
      return "no consensus";
    case PoseFailure::kNotFinite:
      return "not finite";
  }
  return "unknown";
}

}  // namespace evolin
