// Brings the parts of a picture together by the exact stamp of their image: image, lines, ground
// truth, matches; within a bounded memory, and counting what never pairs.
#pragma once

#include <evolin_ros/LineArray.h>
#include <evolin_ros/LineMatchArray.h>
#include <sensor_msgs/Image.h>

#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <vector>

namespace evolin::ros_shell {

/// `image` and `lines` are there, the rest may be null.
struct ViewParts {
  sensor_msgs::ImageConstPtr image;
  evolin_ros::LineArrayConstPtr lines;
  evolin_ros::LineArrayConstPtr ground_truth;
  evolin_ros::LineMatchArrayConstPtr matches;  ///< of this image with an earlier one
  bool begins_pass = false;  ///< time jumped back: what is remembered of earlier frames is void
};

/// Messages that were part of no picture.
struct UnpairedParts {
  std::size_t images = 0;
  std::size_t lines = 0;
  std::size_t ground_truths = 0;
  std::size_t matches = 0;

  std::size_t sum() const { return images + lines + ground_truths + matches; }
};

/// The stream of lines leads: a stamp of it that lies before the last one is a jump back in time,
/// the same stamp again is a repeat and is left out. Frames come out in order. One that has its
/// image waits for its ground truth and its matches while those streams are alive, but not longer
/// than until `patience` later frames have their images. One thread at a time.
class ViewJoiner {
 public:
  struct Result {
    std::vector<ViewParts> frames;
    std::string problem;  ///< for the log: what had to be left out and why
  };

  /// Keeps at most `capacity` messages of each kind.
  ViewJoiner(std::size_t capacity, std::size_t patience)
      : capacity_(capacity), patience_(patience) {}

  Result addImage(const sensor_msgs::ImageConstPtr& message);
  Result addLines(const evolin_ros::LineArrayConstPtr& message);
  Result addGroundTruth(const evolin_ros::LineArrayConstPtr& message);
  Result addMatches(const evolin_ros::LineMatchArrayConstPtr& message);

  /// The stream has a publisher: it is taken for alive before its first message.
  void expectGroundTruth() { expect(&ground_truths_.silent_frames); }
  void expectMatches() { expect(&matches_.silent_frames); }

  /// Frames that have their image, whatever else they wait for: when nothing comes any more.
  Result flush();

  /// Since the beginning, over all passes.
  const UnpairedParts& unpaired() const { return unpaired_; }

 private:
  /// One kind of part: those whose lines have not come, by arrival.
  template <class Message>
  struct Stream {
    std::deque<boost::shared_ptr<const Message>> spare;
    std::optional<std::size_t>
        silent_frames;  ///< pictures since its last message; none: no message
  };

  static void expect(std::optional<std::size_t>* silent_frames) {
    *silent_frames = silent_frames->value_or(0);
  }

  template <class Message>
  using Member = boost::shared_ptr<const Message> ViewParts::*;

  template <class Message>
  Result addPart(const boost::shared_ptr<const Message>& message, Member<Message> member,
                 Stream<Message>* stream, std::size_t* unpaired);
  template <class Message>
  void takeSpare(Member<Message> member, Stream<Message>* stream, std::size_t* unpaired,
                 ViewParts* frame) const;

  bool waits(const ViewParts& frame) const;
  void advance(Result* result);
  void release(Result* result);
  void startPass(Result* result);

  std::size_t capacity_;
  std::size_t patience_;
  std::deque<ViewParts> frames_;  ///< all have lines, by stamp
  Stream<sensor_msgs::Image> images_;
  Stream<evolin_ros::LineArray> ground_truths_;
  Stream<evolin_ros::LineMatchArray> matches_;
  std::optional<ros::Time> last_lines_;
  bool begins_pass_ = false;
  UnpairedParts unpaired_;
};

}  // namespace evolin::ros_shell
