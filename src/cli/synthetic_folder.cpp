// Frames on all workers, files as they come.
#include "synthetic_folder.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <vector>

#include "command.h"
#include "evolin_ros/base/atomic_file.h"
#include "evolin_ros/base/text.h"
#include "evolin_ros/base/version.h"
#include "evolin_ros/dataset/evolin_writer.h"
#include "interrupt.h"
#include "parallel.h"
#include "progress.h"

namespace evolin::cli {

namespace {

std::string describeEdges(const synthetic::Scene& scene) {
  std::string text =
      "# physical edges: number x1 y1 z1 x2 y2 z2 (metres, world); the edge of an id of gt_ids/ is "
      "the id modulo " +
      std::to_string(scene.edges.size()) + "\n";
  for (std::size_t number = 0; number < scene.edges.size(); ++number) {
    const synthetic::Edge& edge = scene.edges[number];
    text += std::to_string(number);
    for (const synthetic::Vector3* end : {&edge.from, &edge.to}) {
      for (int axis = 0; axis < 3; ++axis) {
        text += " " + formatDouble((*end)[axis]);
      }
    }
    text += "\n";
  }
  return text;
}

}  // namespace

std::string describeSequence(const synthetic::SyntheticOptions& options) {
  return programVersion() + " synth\nframes " + std::to_string(options.frames) + "\nrate " +
         formatDouble(options.rate) + " Hz\nsize " + std::to_string(options.width) + "x" +
         std::to_string(options.height) + " px\nseed " + std::to_string(options.seed) + "\nnoise " +
         formatDouble(options.noise) + " grey levels\nblur " + formatDouble(options.blur) + " px\n";
}

void forEachFrame(std::size_t frames, int workers, bool quiet,
                  const std::function<void(std::size_t)>& make,
                  const std::function<void(std::size_t)>& take) {
  const InterruptGuard guard;
  std::optional<Progress> progress;
  if (!quiet) {
    progress.emplace("frames", frames);
  }
  const std::size_t batch = 2 * static_cast<std::size_t>(workers);
  for (std::size_t begin = 0; begin < frames; begin += batch) {
    const std::size_t count = std::min(batch, frames - begin);
    // It watches for signals itself and forgets older ones.
    if (guard.interrupted()) {
      throw Interrupted("interrupted; nothing was written");
    }
    forEachTask(count, workers,
                [&](std::size_t task, std::size_t /*worker*/) { make(begin + task); });
    for (std::size_t i = 0; i < count; ++i) {
      take(begin + i);
    }
    if (progress) {
      progress->update(begin + count);
    }
  }
  if (guard.interrupted()) {
    throw Interrupted("interrupted; nothing was written");
  }
  if (progress) {
    progress->finish(frames);
  }
}

std::size_t fillSyntheticFolder(const synthetic::SyntheticOptions& options, int workers, bool quiet,
                                const std::filesystem::path& folder) {
  const synthetic::SyntheticSequence sequence(options);
  EvolinWriter writer(folder);
  std::vector<std::size_t> lines(sequence.size());
  forEachFrame(
      sequence.size(), workers, quiet,
      [&](std::size_t number) {
        const SequenceFrame frame = sequence.frame(number);
        lines[number] = frame.ground_truth->size();
        writer.addFrame(number, frame);
      },
      [](std::size_t /*number*/) {});
  writer.finish();
  writeFileAtomically(folder / "edges.txt", describeEdges(sequence.scene()));
  writeFileAtomically(folder / kSynthMarker, describeSequence(options));
  return std::accumulate(lines.begin(), lines.end(), std::size_t{0});
}

}  // namespace evolin::cli
