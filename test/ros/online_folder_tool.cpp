// Writes what the test of evaluate.launch needs: the drawn sequence as an EVOLIN folder, another
// annotation of it, and the figures that each way of evaluating must give.
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "online_support.h"
#include "test/support/drawn_sequence.h"

namespace {

using evolin::test::Expected;

nlohmann::json toJson(const evolin::Classification& counts) {
  return {{"true_positives", counts.true_positives},
          {"predicted", counts.predicted},
          {"ground_truth", counts.ground_truth}};
}

nlohmann::json toJson(const Expected& expected) {
  nlohmann::json entries = nlohmann::json::array();
  for (const evolin::DetectionEntry& entry : expected.detection) {
    entries.push_back({{"distance", toString(entry.setting.distance)},
                       {"threshold", entry.setting.threshold},
                       {"counts", toJson(entry.counts)},
                       {"average_precision", nullptr}});
    if (entry.average_precision) {
      entries.back()["average_precision"] = *entry.average_precision;
    }
  }
  return {{"frames", expected.frames.size()},
          {"entries", entries},
          {"pairs", expected.pairs.size()},
          {"association", toJson(expected.association)}};
}

/// The same sequence with every other annotated line taken away.
std::vector<evolin::SequenceFrame> withHalfOfTheLines(std::vector<evolin::SequenceFrame> frames) {
  for (evolin::SequenceFrame& frame : frames) {
    evolin::LineSegments kept;
    for (const evolin::LineSegment& line : *frame.ground_truth) {
      if (line.id % 2 == 0) {
        kept.push_back(line);
      }
    }
    frame.ground_truth = kept;
  }
  return frames;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: online_folder_tool FOLDER\n";
    return 2;
  }
  try {
    const std::filesystem::path folder = argv[1];
    const auto frames = evolin::test::drawSequence();
    const auto halved = withHalfOfTheLines(frames);
    evolin::test::writeEvolinFolder(frames, folder / "sequence");
    evolin::test::writeAnnotations(halved, folder / "halved");
    const std::vector<evolin::SequenceFrame> part(frames.begin() + 3, frames.begin() + 9);
    nlohmann::json expected;
    expected["whole"] = toJson(evolin::test::evaluateInProcess(frames));
    expected["halved"] = toJson(evolin::test::evaluateInProcess(halved));
    expected["frames_3_to_8"] = toJson(evolin::test::evaluateInProcess(part));
    std::ofstream(folder / "expected.json") << expected.dump(1) << "\n";
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "online_folder_tool: " << error.what() << "\n";
    return 1;
  }
}
