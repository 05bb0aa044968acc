// Each family is resampled over what its figures are sums or medians of: frames, or pairs of
// frames.
#include "evolin_ros/evaluation/report_confidence.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <set>
#include <utility>

#include "evolin_ros/metrics/resampled_pose_errors.h"
#include "evolin_ros/metrics/resampled_precision.h"
#include "evolin_ros/metrics/resampled_repeatability.h"

namespace evolin {

namespace {

/// Rows of figures and how they come from the sequence; `interval` of each is still to be found.
class Resampling {
 public:
  explicit Resampling(const BootstrapOptions& options) : options_(options) {}

  /// What `figures` refers to must live until run().
  void add(std::size_t count, std::vector<FigureInterval> names, WeightedFigures figures) {
    addOfMany(count, std::move(names), [figures = std::move(figures)](const Weights& resamples) {
      std::vector<std::vector<double>> rows;
      rows.reserve(resamples.size());
      for (const std::vector<std::uint32_t>& weights : resamples) {
        rows.push_back(figures(weights));
      }
      return rows;
    });
  }

  void addOfMany(std::size_t count, std::vector<FigureInterval> names, FiguresOfResamples figures) {
    if (count > 0 && !names.empty()) {
      parts_.push_back({count, std::move(names), std::move(figures)});
    }
  }

  /// All figures in the order in which they were added.
  std::vector<FigureInterval> run() {
    std::set<std::size_t> counts;
    for (const Part& part : parts_) {
      counts.insert(part.count);
    }
    for (const std::size_t count : counts) {
      runPartsOf(count);
    }
    std::vector<FigureInterval> all;
    for (Part& part : parts_) {
      std::move(part.names.begin(), part.names.end(), std::back_inserter(all));
    }
    return all;
  }

 private:
  using Weights = std::vector<std::vector<std::uint32_t>>;

  struct Part {
    std::size_t count;  ///< of frames or pairs
    std::vector<FigureInterval> names;
    FiguresOfResamples figures;
  };

  /// Equal counts are drawn from alike, so that one drawing serves them all.
  void runPartsOf(std::size_t count) {
    BootstrapOptions options = options_;
    options.block_length =
        static_cast<int>(std::min(static_cast<std::size_t>(options.block_length), count));
    const std::vector<ConfidenceInterval> intervals =
        blockBootstrapOfMany(count, options, [this, count](const Weights& resamples) {
          std::vector<std::vector<double>> rows(resamples.size());
          for (const Part& part : parts_) {
            if (part.count == count) {
              const std::vector<std::vector<double>> more = part.figures(resamples);
              for (std::size_t row = 0; row < rows.size(); ++row) {
                rows[row].insert(rows[row].end(), more[row].begin(), more[row].end());
              }
            }
          }
          return rows;
        });
    auto interval = intervals.begin();
    for (Part& part : parts_) {
      if (part.count == count) {
        for (FigureInterval& name : part.names) {
          name.interval = *interval++;
        }
      }
    }
  }

  BootstrapOptions options_;
  std::vector<Part> parts_;
};

FigureInterval named(const char* family, const char* figure) {
  FigureInterval interval;
  interval.family = family;
  interval.figure = figure;
  return interval;
}

template <class Counts>
void appendRatios(const Counts& counts, std::vector<double>* figures) {
  figures->insert(figures->end(), {counts.precision(), counts.recall(), counts.fScore()});
}

DetectedAssociation weightedSum(const std::vector<DetectedPairRecord>& pairs,
                                const std::vector<std::uint32_t>& weights) {
  DetectedAssociation sum;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    for (std::uint32_t copy = 0; copy < weights[i]; ++copy) {
      sum += pairs[i].counts;
    }
  }
  return sum;
}

void addDetection(const VectorizedMetrics& detection, Resampling* resampling) {
  std::vector<FigureInterval> names;
  std::vector<std::vector<Classification>> frames;
  for (std::size_t i = 0; i < detection.settings().size(); ++i) {
    for (const char* figure : {"precision", "recall", "f_score", "average_precision"}) {
      names.push_back(named("detection", figure));
      names.back().distance = detection.settings()[i].distance;
      names.back().threshold = detection.settings()[i].threshold;
    }
    frames.push_back(detection.frameClassifications(i));
  }
  resampling->addOfMany(
      detection.frames(), std::move(names),
      [frames = std::move(frames), resampled = ResampledPrecision(detection.ranking())](
          const std::vector<std::vector<std::uint32_t>>& resamples) mutable {
        const auto precisions = resampled.averagePrecisions(resamples);
        std::vector<std::vector<double>> rows(resamples.size());
        for (std::size_t row = 0; row < rows.size(); ++row) {
          for (std::size_t i = 0; i < frames.size(); ++i) {
            appendRatios(evolin::weightedSum(frames[i], resamples[row]), &rows[row]);
            rows[row].push_back(
                precisions[row][i].value_or(std::numeric_limits<double>::quiet_NaN()));
          }
        }
        return rows;
      });
}

void addHeatmap(const Report& report, Resampling* resampling) {
  const std::vector<double>& thresholds = report.heatmap.score_thresholds;
  std::vector<FigureInterval> names;
  std::vector<std::vector<Classification>> frames(report.heatmap.counts.size());
  std::size_t count = 0;
  for (const FrameRecord& frame : report.frames) {
    if (frame.heatmap.size() != frames.size()) {
      continue;
    }
    ++count;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      frames[i].push_back(frame.heatmap[i]);
    }
  }
  for (std::size_t i = 0; i < frames.size(); ++i) {
    for (const char* figure : {"precision", "recall", "f_score"}) {
      names.push_back(named("heatmap", figure));
      if (!thresholds.empty()) {
        names.back().score_threshold = thresholds[i];
      }
    }
  }
  if (!thresholds.empty()) {
    names.push_back(named("heatmap", "average_precision"));
    names.push_back(named("heatmap", "max_f_score"));
  }
  const bool has_thresholds = !thresholds.empty();
  resampling->add(
      count, std::move(names),
      [has_thresholds, frames = std::move(frames)](const std::vector<std::uint32_t>& weights) {
        std::vector<Classification> sums;
        std::vector<double> figures;
        for (const std::vector<Classification>& counts : frames) {
          sums.push_back(evolin::weightedSum(counts, weights));
          appendRatios(sums.back(), &figures);
        }
        if (has_thresholds) {
          const HeatmapSummary summary = summarizeHeatmap(sums);
          figures.insert(figures.end(), {summary.average_precision, summary.max_f_score});
        }
        return figures;
      });
}

void addAssociations(const Report& report, Resampling* resampling) {
  const auto names_of = [](const char* family) {
    return std::vector<FigureInterval>{named(family, "precision"), named(family, "recall"),
                                       named(family, "f_score")};
  };
  std::vector<Classification> pairs;
  for (const PairRecord& record : report.pair_records) {
    pairs.push_back(record.counts);
  }
  const std::size_t count = pairs.size();
  resampling->add(count, names_of("association"),
                  [pairs = std::move(pairs)](const std::vector<std::uint32_t>& weights) {
                    std::vector<double> figures;
                    appendRatios(evolin::weightedSum(pairs, weights), &figures);
                    return figures;
                  });
  resampling->add(report.detected_pair_records.size(), names_of("association_detected"),
                  [&report](const std::vector<std::uint32_t>& weights) {
                    std::vector<double> figures;
                    appendRatios(weightedSum(report.detected_pair_records, weights), &figures);
                    return figures;
                  });
}

/// The row's own figures of every pair of its step.
std::vector<PairRepeatability> pairsOf(const Report& report, std::size_t row) {
  const std::vector<RepeatabilityRow>& rows = report.repeatability.rows;
  const RepeatabilitySetting& setting = rows[row].setting;
  const bool by_score = setting.score_threshold.has_value();
  const auto place = static_cast<std::size_t>(
      std::count_if(rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(row),
                    [&](const RepeatabilityRow& earlier) {
                      return earlier.setting.frame_step == setting.frame_step &&
                             earlier.setting.score_threshold.has_value() == by_score;
                    }));
  std::vector<PairRepeatability> pairs;
  for (const RepeatabilityRecord& record : report.repeatability.records) {
    const std::vector<PairRepeatability>& results = by_score ? record.by_score : record.pair;
    if (record.frame_step == setting.frame_step && place < results.size()) {
      pairs.push_back(results[place]);
    }
  }
  return pairs;
}

void addRepeatability(const Report& report, Resampling* resampling) {
  for (std::size_t row = 0; row < report.repeatability.rows.size(); ++row) {
    const std::vector<PairRepeatability> pairs = pairsOf(report, row);
    std::vector<FigureInterval> names = {named("repeatability", "repeatability"),
                                         named("repeatability", "localization_error")};
    const RepeatabilitySetting& setting = report.repeatability.rows[row].setting;
    for (FigureInterval& name : names) {
      name.step = setting.frame_step;
      name.distance = setting.distance;
      name.threshold = setting.distance_threshold;
      name.score_threshold = setting.score_threshold;
    }
    resampling->add(pairs.size(), std::move(names),
                    [resampled = ResampledRepeatability(pairs, report.protocol)](
                        const std::vector<std::uint32_t>& weights) {
                      const RepeatabilityFigures figures = resampled.figures(weights);
                      return std::vector<double>{figures.repeatability, figures.localization_error};
                    });
  }
}

void addPose(const Report& report, Resampling* resampling) {
  PoseErrorMetrics errors;
  for (const PoseRecord& record : report.pose.records) {
    errors.addPair(record.pair);
  }
  resampling->add(
      errors.pairs(),
      {named("pose", "rotation_median_deg"), named("pose", "translation_angle_median_deg"),
       named("pose", "translation_median_m")},
      [resampled = errors.resampled()](const std::vector<std::uint32_t>& weights) {
        const PoseErrors medians = resampled.medians(weights);
        return std::vector<double>{medians.rotation, medians.translation_angle,
                                   medians.translation};
      });
}

}  // namespace

void addConfidence(const VectorizedMetrics& detection, const BootstrapOptions& options,
                   Report* report) {
  ReportConfidence confidence;
  confidence.options = options;
  Resampling resampling(options);
  const auto wants = [report](MetricFamily family) { return report->families.count(family) != 0; };
  if (wants(MetricFamily::kDetection)) {
    addDetection(detection, &resampling);
  }
  if (wants(MetricFamily::kHeatmap)) {
    addHeatmap(*report, &resampling);
  }
  if (wants(MetricFamily::kRepeatability)) {
    addRepeatability(*report, &resampling);
  }
  if (wants(MetricFamily::kAssociation)) {
    addAssociations(*report, &resampling);
  }
  if (wants(MetricFamily::kPose)) {
    addPose(*report, &resampling);
  }
  confidence.figures = resampling.run();
  report->confidence = std::move(confidence);
}

}  // namespace evolin
