// Frames wait in the order of their lines; parts whose lines are still to come wait beside them.
#include "view_joiner.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "conversions.h"

namespace evolin::ros_shell {

namespace {

/// A stream that has been silent for so many pictures is not waited for.
constexpr std::size_t kSilent = 10;

/// The offset that a user would have to explain when nothing pairs.
std::string nearestOffset(const ros::Time& stamp,
                          const std::deque<sensor_msgs::ImageConstPtr>& images) {
  if (images.empty()) {
    return "no image is waiting";
  }
  double nearest = (images.front()->header.stamp - stamp).toSec();
  for (const sensor_msgs::ImageConstPtr& image : images) {
    const double offset = (image->header.stamp - stamp).toSec();
    nearest = std::abs(offset) < std::abs(nearest) ? offset : nearest;
  }
  return "the nearest image is " + std::to_string(nearest) + " s away";
}

}  // namespace

template <class Message>
ViewJoiner::Result ViewJoiner::addPart(const boost::shared_ptr<const Message>& message,
                                       Member<Message> member, Stream<Message>* stream,
                                       std::size_t* unpaired) {
  Result result;
  stream->silent_frames = 0;
  const auto frame = std::find_if(frames_.begin(), frames_.end(), [&](const ViewParts& candidate) {
    return candidate.lines->header.stamp == message->header.stamp;
  });
  if (frame == frames_.end()) {
    stream->spare.push_back(message);
    if (stream->spare.size() > capacity_) {
      ++*unpaired;
      stream->spare.pop_front();
    }
    return result;
  }
  if ((*frame).*member) {
    ++*unpaired;
  }
  (*frame).*member = message;
  // Whatever waits has come before it, and so would the lines of that.
  *unpaired += stream->spare.size();
  stream->spare.clear();
  advance(&result);
  return result;
}

template <class Message>
void ViewJoiner::takeSpare(Member<Message> member, Stream<Message>* stream, std::size_t* unpaired,
                           ViewParts* frame) const {
  const auto found = std::find_if(
      stream->spare.begin(), stream->spare.end(),
      [&](const auto& candidate) { return candidate->header.stamp == frame->lines->header.stamp; });
  if (found != stream->spare.end()) {
    frame->*member = *found;
    *unpaired += static_cast<std::size_t>(found - stream->spare.begin());
    stream->spare.erase(stream->spare.begin(), std::next(found));
  }
}

ViewJoiner::Result ViewJoiner::addImage(const sensor_msgs::ImageConstPtr& message) {
  return addPart<sensor_msgs::Image>(message, &ViewParts::image, &images_, &unpaired_.images);
}

ViewJoiner::Result ViewJoiner::addGroundTruth(const evolin_ros::LineArrayConstPtr& message) {
  return addPart<evolin_ros::LineArray>(message, &ViewParts::ground_truth, &ground_truths_,
                                        &unpaired_.ground_truths);
}

ViewJoiner::Result ViewJoiner::addMatches(const evolin_ros::LineMatchArrayConstPtr& message) {
  return addPart<evolin_ros::LineMatchArray>(message, &ViewParts::matches, &matches_,
                                             &unpaired_.matches);
}

ViewJoiner::Result ViewJoiner::addLines(const evolin_ros::LineArrayConstPtr& message) {
  Result result;
  const ros::Time stamp = message->header.stamp;
  if (last_lines_ && stamp == *last_lines_) {
    ++unpaired_.lines;
    result.problem = "lines at " + formatStamp(fromRos(stamp)) + " came twice; the first are shown";
    return result;
  }
  if (last_lines_ && stamp < *last_lines_) {
    startPass(&result);
  }
  last_lines_ = stamp;
  ViewParts frame;
  frame.lines = message;
  takeSpare(&ViewParts::image, &images_, &unpaired_.images, &frame);
  takeSpare(&ViewParts::ground_truth, &ground_truths_, &unpaired_.ground_truths, &frame);
  takeSpare(&ViewParts::matches, &matches_, &unpaired_.matches, &frame);
  frames_.push_back(std::move(frame));
  advance(&result);
  if (frames_.size() > capacity_) {
    release(&result);
  }
  return result;
}

ViewJoiner::Result ViewJoiner::flush() {
  Result result;
  while (std::any_of(frames_.begin(), frames_.end(),
                     [](const ViewParts& frame) { return frame.image != nullptr; })) {
    release(&result);
  }
  return result;
}

bool ViewJoiner::waits(const ViewParts& frame) const {
  const auto alive = [](const auto& stream) {
    return stream.silent_frames && *stream.silent_frames < kSilent;
  };
  return (!frame.ground_truth && alive(ground_truths_)) || (!frame.matches && alive(matches_));
}

void ViewJoiner::advance(Result* result) {
  while (!frames_.empty()) {
    const ViewParts& frame = frames_.front();
    const auto later_images = static_cast<std::size_t>(
        std::count_if(std::next(frames_.begin()), frames_.end(),
                      [](const ViewParts& later) { return later.image != nullptr; }));
    const bool ready = frame.image ? !waits(frame) || later_images >= patience_
                                   : later_images > 0;  // images come in order: its own is lost
    if (!ready) {
      return;
    }
    release(result);
  }
}

/// The oldest frame comes out, or is given up.
void ViewJoiner::release(Result* result) {
  ViewParts frame = std::move(frames_.front());
  frames_.pop_front();
  if (!frame.image) {
    ++unpaired_.lines;
    unpaired_.ground_truths += frame.ground_truth ? 1 : 0;
    unpaired_.matches += frame.matches ? 1 : 0;
    const ros::Time stamp = frame.lines->header.stamp;
    result->problem = "lines at " + formatStamp(fromRos(stamp)) +
                      " have no image of exactly this stamp (" +
                      nearestOffset(stamp, images_.spare) +
                      "); a picture needs both; raise ~queue_size if images are lost or late";
    return;
  }
  for (auto* silent : {&ground_truths_.silent_frames, &matches_.silent_frames}) {
    if (*silent) {
      ++**silent;
    }
  }
  frame.begins_pass = std::exchange(begins_pass_, false);
  result->frames.push_back(std::move(frame));
}

void ViewJoiner::startPass(Result* result) {
  while (!frames_.empty()) {
    release(result);
  }
  begins_pass_ = true;
}

}  // namespace evolin::ros_shell
