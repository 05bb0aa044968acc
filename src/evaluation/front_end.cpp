// Frames of a batch are worked on at once; order is restored before anything is given on.
#include "evolin_ros/evaluation/front_end.h"

#include "evolin_ros/base/error.h"

namespace evolin {

namespace {

/// Images whose ground truth may still come, and the other way round: they are recorded close to
/// each other.
constexpr std::size_t kMostWaiting = 64;

template <class Value>
void limit(std::map<Stamp, Value>* waiting) {
  while (waiting->size() > kMostWaiting) {
    waiting->erase(waiting->begin());
  }
}

/// `problem` says what kept `work` from its end; "" where nothing did.
template <class Work>
std::string problemOf(const Work& work) {
  try {
    work();
    return {};
  } catch (const std::exception& error) {  // plug-ins may throw anything
    return error.what();
  }
}

}  // namespace

FrontEnd::FrontEnd(FrontEndOptions options, WorkerPool* pool)
    : options_(std::move(options)), pool_(pool), worker_times_(pool->size()) {
  for (std::size_t worker = 0; worker < pool->size(); ++worker) {
    if (options_.make_detector) {
      detectors_.push_back(options_.make_detector());
    }
    if (options_.make_associator) {
      associators_.push_back(options_.make_associator());
    }
  }
}

bool FrontEnd::givesScores() const {
  return !detectors_.empty() && detectors_.front()->givesScores();
}

std::string FrontEnd::note() const {
  MatchCounts sum;
  for (const std::shared_ptr<LineAssociator>& associator : associators_) {
    for (const auto& [what, count] : associator->counts()) {
      sum[what] += count;
    }
  }
  return sum.empty() ? "" : "matches of " + options_.matches_source + ": " + toText(sum);
}

void FrontEnd::process(std::vector<StreamPart> parts, FrontEndSink* sink) {
  // A plug-in that asks for the camera gets the newest one before its image.
  for (StreamPart& part : parts) {
    if (const auto* camera = std::get_if<Camera>(&part)) {
      camera_ = *camera;
    } else if (auto* image = std::get_if<ImagePart>(&part); image != nullptr && camera_) {
      image->frame.camera = camera_;
    }
  }
  std::vector<Outcome> outcomes(parts.size());
  detect(parts, &outcomes);
  join(parts, &outcomes);
  match();
  collectTimes();
  give(parts, outcomes, sink);
  pairs_.clear();  // or the images of this batch would stay in memory beside those of the next
}

void FrontEnd::detect(const std::vector<StreamPart>& parts, std::vector<Outcome>* outcomes) {
  if (detectors_.empty()) {
    return;
  }
  std::vector<std::size_t> images;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const auto* image = std::get_if<ImagePart>(&parts[i]);
    if (image != nullptr && !image->frame.image.empty()) {
      images.push_back(i);
    }
  }
  pool_->forEach(images.size(), [&](std::size_t task, std::size_t worker) {
    const std::size_t part = images[task];
    detectIn(std::get<ImagePart>(parts[part]), worker, &(*outcomes)[part]);
  });
}

void FrontEnd::detectIn(const ImagePart& image, std::size_t worker, Outcome* outcome) {
  LineDetector& detector = *detectors_[worker];
  LineSet set;
  const StageClock clock;
  const std::string why =
      problemOf([&] { set.lines = selectLines(detector.detect(image.frame), options_.selection); });
  const StageTime time = clock.elapsed();
  worker_times_[worker].add(Stage::kDetect, time);
  set.processing_time = detector.processingTime().value_or(time.wall);
  if (!why.empty()) {
    outcome->problem = "no lines for image " + image.frame.name + " at " +
                       formatStamp(image.frame.stamp) + ": " + why;
    return;
  }
  set.stamp = image.frame.stamp;
  set.source = options_.lines_source;
  set.width = image.frame.image.cols;
  set.height = image.frame.image.rows;
  set.scored = detector.givesScores();
  if (!associators_.empty() && !options_.associate_ground_truth) {
    outcome->frame = std::make_shared<FrameLines>();
    outcome->frame->frame = image.frame;
    outcome->frame->lines = set.lines;
  }
  outcome->lines = std::move(set);
}

/// Finds the frames with lines in their order, and the pairs that they make.
void FrontEnd::join(const std::vector<StreamPart>& parts, std::vector<Outcome>* outcomes) {
  if (associators_.empty()) {
    return;
  }
  std::vector<std::shared_ptr<FrameLines>> frames;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    Outcome& outcome = (*outcomes)[i];
    if (options_.associate_ground_truth) {
      outcome.frame = joinTruth(parts[i]);
    }
    if (outcome.frame) {
      frames.push_back(outcome.frame);
      outcome.pair = extend(outcome.frame);
    }
  }
  describe(frames);
}

std::shared_ptr<FrameLines> FrontEnd::joinTruth(const StreamPart& part) {
  Stamp stamp = 0;
  if (const auto* image = std::get_if<ImagePart>(&part)) {
    if (image->frame.image.empty()) {
      return nullptr;
    }
    stamp = image->frame.stamp;
    waiting_images_[stamp] = image->frame;
  } else if (const auto* truth = std::get_if<LineSet>(&part)) {
    stamp = truth->stamp;
    waiting_truth_[stamp] = *truth;
    truth_source_ = truth->source;
  } else {
    return nullptr;
  }
  const auto image = waiting_images_.find(stamp);
  const auto truth = waiting_truth_.find(stamp);
  if (image == waiting_images_.end() || truth == waiting_truth_.end()) {
    limit(&waiting_images_);
    limit(&waiting_truth_);
    return nullptr;
  }
  auto frame = std::make_shared<FrameLines>();
  frame->frame = std::move(image->second);
  frame->lines = std::move(truth->second.lines);
  waiting_images_.erase(image);
  waiting_truth_.erase(truth);
  return frame;
}

/// The place in pairs_ of the pair that ends with this frame.
std::optional<std::size_t> FrontEnd::extend(const std::shared_ptr<FrameLines>& frame) {
  // A jump back in time: frames of two passes must never meet.
  if (!window_.empty() && frame->frame.stamp <= window_.back()->frame.stamp) {
    window_.clear();
    pairs_begun_ = 0;
  }
  const auto step = static_cast<std::size_t>(options_.frame_step);
  std::optional<std::size_t> place;
  if (window_.size() == step) {
    Pair pair;
    pair.first = window_.front();
    pair.second = frame;
    // Pairs that share a frame are `step` apart, so that those of one phase share none.
    pair.phase = pairs_begun_++ / step % 2;
    place = pairs_.size();
    pairs_.push_back(std::move(pair));
    window_.pop_front();
  }
  window_.push_back(frame);
  return place;
}

void FrontEnd::describe(const std::vector<std::shared_ptr<FrameLines>>& frames) {
  pool_->forEach(frames.size(), [&](std::size_t task, std::size_t worker) {
    worker_times_[worker].measure(Stage::kDescribe, [&] {
      // What is wrong with a frame is told with the pairs that it is in.
      problemOf([&] { associators_[worker]->describe(*frames[task]); });
    });
  });
}

/// A description belongs to one thread at a time.
void FrontEnd::match() {
  for (const std::size_t phase : {std::size_t{0}, std::size_t{1}}) {
    std::vector<Pair*> of_phase;
    for (Pair& pair : pairs_) {
      if (pair.phase == phase) {
        of_phase.push_back(&pair);
      }
    }
    pool_->forEach(of_phase.size(), [&](std::size_t task, std::size_t worker) {
      matchPair(worker, of_phase[task]);
    });
  }
}

void FrontEnd::matchPair(std::size_t worker, Pair* pair) {
  MatchSet& set = pair->matches;
  set.first_stamp = pair->first->frame.stamp;
  set.stamp = pair->second->frame.stamp;
  set.source = options_.matches_source;
  set.lines_source = options_.associate_ground_truth ? truth_source_ : options_.lines_source;
  const StageClock clock;
  const std::string why =
      problemOf([&] { set.matches = associators_[worker]->match(*pair->first, *pair->second); });
  const StageTime time = clock.elapsed();
  set.processing_time = time.wall;
  worker_times_[worker].add(Stage::kMatch, time);
  if (!why.empty()) {
    pair->problem = "no matches for the images at " + formatStamp(set.first_stamp) + " and " +
                    formatStamp(set.stamp) + ": " + why;
  }
}

void FrontEnd::collectTimes() {
  for (StageTimes& times : worker_times_) {
    times_.add(times);
    times = StageTimes();
  }
}

void FrontEnd::give(const std::vector<StreamPart>& parts, const std::vector<Outcome>& outcomes,
                    FrontEndSink* sink) {
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Outcome& outcome = outcomes[i];
    if (const auto* image = std::get_if<ImagePart>(&parts[i])) {
      sink->takeImage(*image);
      for (const std::string& problem : {image->problem, outcome.problem}) {
        if (!problem.empty()) {
          sink->takeNote(problem);
        }
      }
      if (outcome.lines) {
        sink->takeLines(*outcome.lines, *image);
      }
    } else if (const auto* camera = std::get_if<Camera>(&parts[i])) {
      sink->takeCamera(*camera);
    } else if (const auto* depth = std::get_if<DepthPart>(&parts[i])) {
      sink->takeDepth(*depth);
    } else if (const auto* pose = std::get_if<StampedPose>(&parts[i])) {
      sink->takePose(*pose);
    } else {
      sink->takeGroundTruth(std::get<LineSet>(parts[i]));
    }
    if (!outcome.pair) {
      continue;
    }
    const Pair& pair = pairs_[*outcome.pair];
    if (pair.problem.empty()) {
      sink->takeMatches(pair.matches, pair.first->frame, pair.second->frame);
    } else {
      sink->takeNote(pair.problem);
    }
  }
}

}  // namespace evolin
