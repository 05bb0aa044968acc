// Lines are paired in their own order; images wait for them.
#include "frame_lines_joiner.h"

#include <algorithm>
#include <cmath>

#include "conversions.h"

namespace evolin::ros_shell {

namespace {

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

FrameLinesJoiner::Result FrameLinesJoiner::addImage(const sensor_msgs::ImageConstPtr& image) {
  Result result;
  images_.push_back(image);
  pair(&result);
  if (images_.size() > capacity_) {
    images_.pop_front();
  }
  return result;
}

FrameLinesJoiner::Result FrameLinesJoiner::addLines(const evolin_ros::LineArrayConstPtr& lines) {
  Result result;
  const ros::Time stamp = lines->header.stamp;
  if (last_lines_ && stamp == *last_lines_) {
    return result;
  }
  pass_ += last_lines_ && stamp < *last_lines_ ? 1 : 0;
  last_lines_ = stamp;
  lines_.push_back({lines, pass_});
  pair(&result);
  if (lines_.size() > capacity_) {
    const ros::Time oldest = lines_.front().message->header.stamp;
    result.problem = "lines at " + formatStamp(fromRos(oldest)) +
                     " have no image of exactly this stamp (" + nearestOffset(oldest, images_) +
                     "); matches need both; raise ~queue_size if images come late";
    result.left_out.push_back(lines_.front().message->header);
    lines_.pop_front();
  }
  return result;
}

void FrameLinesJoiner::pair(Result* result) {
  // Lines whose image has not come hold nobody up once a later pair is complete.
  for (auto lines = lines_.begin(); lines != lines_.end();) {
    const auto image = std::find_if(images_.begin(), images_.end(), [&](const auto& candidate) {
      return candidate->header.stamp == lines->message->header.stamp;
    });
    if (image == images_.end()) {
      ++lines;
      continue;
    }
    if (lines != lines_.begin()) {
      result->problem = "lines at " + formatStamp(fromRos(lines_.front().message->header.stamp)) +
                        " and up to the next complete frame are passed over: their image never "
                        "came (raise ~queue_size if images are lost)";
      for (auto passed = lines_.begin(); passed != lines; ++passed) {
        result->left_out.push_back(passed->message->header);
      }
    }
    result->complete.push_back({*image, lines->message, lines->pass != paired_pass_});
    paired_pass_ = lines->pass;
    images_.erase(images_.begin(), std::next(image));
    lines = lines_.erase(lines_.begin(), std::next(lines));
  }
}

}  // namespace evolin::ros_shell
