// Depth, pose and camera find their image wherever the recording has them.
#include "evolin_ros/evaluation/complete_frames.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "test/support/expect_error.h"

namespace evolin {
namespace {

constexpr Stamp kMillisecond = kNanosecondsPerSecond / 1000;

class Parts : public PartReader {
 public:
  /// Counts in `*read` what was asked for.
  Parts(std::vector<StreamPart> parts, const Needs& offers, std::size_t* read = nullptr)
      : parts_(std::move(parts)), offers_(offers), read_(read) {}

  std::optional<StreamPart> next() override {
    if (read_ != nullptr) {
      ++*read_;
    }
    return next_ < parts_.size() ? std::optional<StreamPart>(parts_[next_++]) : std::nullopt;
  }
  std::size_t images() const override { return 0; }
  std::vector<std::string> notes() const override { return {}; }
  std::string provenance() const override { return "{}"; }
  Needs offers() const override { return offers_; }

 private:
  std::vector<StreamPart> parts_;
  std::size_t next_ = 0;
  Needs offers_;
  std::size_t* read_;
};

ImagePart image(Stamp stamp) {
  ImagePart part;
  part.frame.stamp = stamp;
  part.frame.image = cv::Mat(2, 2, CV_8UC1, cv::Scalar(1));
  return part;
}

/// `units` of a millimetre everywhere but at the first pixel.
DepthPart depth(Stamp stamp, int units) {
  cv::Mat stored(2, 2, CV_16UC1, cv::Scalar(units));
  stored.at<std::uint16_t>(0, 0) = 0;
  return {stamp, DepthMap(stored, 1000)};
}

StampedPose pose(Stamp stamp, double x) {
  StampedPose stamped;
  stamped.stamp = stamp;
  stamped.pose.translation.x() = x;
  return stamped;
}

Camera camera(double fx) {
  Camera camera;
  camera.fx = fx;
  return camera;
}

std::vector<StreamPart> read(std::vector<StreamPart> parts, const Needs& needs,
                             bool with_motion = true) {
  const auto reader =
      completeFrames(std::make_unique<Parts>(std::move(parts), Needs{true, true, true}), needs,
                     {with_motion, true});
  std::vector<StreamPart> all;
  while (std::optional<StreamPart> part = reader->next()) {
    all.push_back(std::move(*part));
  }
  EXPECT_FALSE(reader->next().has_value()) << "the end stays the end";
  return all;
}

TEST(CompleteFrames, GiveAnImageWhatIsRecordedBehindIt) {
  const std::vector<StreamPart> parts =
      read({image(100 * kMillisecond), camera(500), pose(90 * kMillisecond, 1),
            depth(105 * kMillisecond, 2000), pose(110 * kMillisecond, 3),
            depth(120 * kMillisecond, 4000), image(130 * kMillisecond)},
           {true, true, true});
  ASSERT_EQ(parts.size(), 7U);
  const std::vector<std::size_t> kinds = {0, 1, 3, 2, 3, 2, 0};  // as they came
  for (std::size_t i = 0; i < parts.size(); ++i) {
    EXPECT_EQ(parts[i].index(), kinds[i]) << i;
  }
  const Frame& first = std::get<ImagePart>(parts[0]).frame;
  ASSERT_EQ(first.depth.type(), CV_32FC1);
  EXPECT_EQ(first.depth.at<float>(1, 1), 2.0F);
  EXPECT_TRUE(std::isnan(first.depth.at<float>(0, 0)));
  ASSERT_TRUE(first.pose.has_value());
  EXPECT_DOUBLE_EQ(first.pose->translation.x(), 2);
  ASSERT_TRUE(first.camera.has_value());
  EXPECT_EQ(first.camera->fx, 500);
  const Frame& last = std::get<ImagePart>(parts[6]).frame;
  EXPECT_EQ(last.depth.at<float>(1, 1), 4.0F) << "10 ms away";
  EXPECT_FALSE(last.pose.has_value()) << "behind the last pose";
}

TEST(CompleteFrames, LeaveOutWhatIsNotNeededAndPartsThatAreNotWanted) {
  const std::vector<StreamPart> parts =
      read({depth(0, 1000), pose(0, 1), camera(500), image(0)}, {false, false, true}, false);
  ASSERT_EQ(parts.size(), 2U) << "camera and image";
  const Frame& frame = std::get<ImagePart>(parts[1]).frame;
  EXPECT_TRUE(frame.depth.empty());
  EXPECT_TRUE(frame.pose.has_value());
}

TEST(CompleteFrames, DoNotReadAheadForEverOrTakeDepthOfAnotherTime) {
  std::vector<StreamPart> recorded = {depth(0, 1000), camera(500)};
  for (int i = 10; i < 200; ++i) {
    recorded.emplace_back(image(i * 33 * kMillisecond));
  }
  std::size_t asked = 0;
  std::size_t read = 0;
  auto source = std::make_unique<Parts>(recorded, Needs{true, true, true}, &read);
  const auto reader = completeFrames(std::move(source), {true, true, false}, {});
  bool found = false;
  for (; !found; ++asked) {
    const std::optional<StreamPart> part = reader->next();
    ASSERT_TRUE(part.has_value());
    if (const auto* first = std::get_if<ImagePart>(&*part)) {
      found = true;
      EXPECT_TRUE(first->frame.depth.empty());
      EXPECT_FALSE(first->frame.pose.has_value());
    }
  }
  EXPECT_EQ(asked, 3U);
  EXPECT_LE(read, 2U + 66U);
  std::size_t rest = 0;
  while (reader->next()) {
    ++rest;
  }
  EXPECT_EQ(rest, 189U);
}

/// Image i of a pass of one image a 33 ms, with the depth i + `first` (in metres) and the pose
/// x = i + `first`, recorded behind it.
void addPass(Stamp begin, int images, int first, std::vector<StreamPart>* parts) {
  for (int i = 0; i < images; ++i) {
    const Stamp stamp = begin + i * 33 * kMillisecond;
    parts->emplace_back(image(stamp));
    parts->emplace_back(depth(stamp, (i + first) * 100));
    parts->emplace_back(pose(stamp, i + first));
  }
}

void expectImages(const std::vector<StreamPart>& parts, const std::vector<int>& expected) {
  std::vector<int> found;
  for (const StreamPart& part : parts) {
    if (const auto* image = std::get_if<ImagePart>(&part)) {
      const Frame& frame = image->frame;
      ASSERT_FALSE(frame.depth.empty()) << "image " << found.size();
      ASSERT_TRUE(frame.pose.has_value()) << "image " << found.size();
      EXPECT_EQ(std::lround(frame.depth.at<float>(1, 1) * 10), frame.pose->translation.x());
      found.push_back(static_cast<int>(frame.pose->translation.x()));
    }
  }
  EXPECT_EQ(found, expected);
}

std::vector<int> numbers(int first, int count) {
  std::vector<int> all(static_cast<std::size_t>(count));
  std::iota(all.begin(), all.end(), first);
  return all;
}

TEST(CompleteFrames, GiveEveryPassItsOwnWhenTimeJumpsBack) {
  constexpr int kMany = 300;  // more than are kept
  std::vector<StreamPart> recorded;
  addPass(kNanosecondsPerSecond, kMany, 1, &recorded);
  addPass(kNanosecondsPerSecond, kMany, 1 + kMany, &recorded);
  const std::vector<StreamPart> parts = read(recorded, {true, false, true});
  EXPECT_EQ(parts.size(), recorded.size());
  expectImages(parts, numbers(1, 2 * kMany));
}

TEST(CompleteFrames, GiveImagesThatWaitWhatThereIsBeforeAPassBegins) {
  const Stamp later = 100 * kNanosecondsPerSecond;
  // The last image of the first pass would wait for a pose behind it, the first one of the second
  // has depth and pose before it.
  const std::vector<StreamPart> parts =
      read({pose(later, 1), image(later), depth(later + kMillisecond, 100),
            image(later + 50 * kMillisecond), depth(later + 50 * kMillisecond, 200),
            depth(kNanosecondsPerSecond, 300), pose(kNanosecondsPerSecond, 3),
            image(kNanosecondsPerSecond)},
           {true, false, true}, false);
  ASSERT_EQ(parts.size(), 3U);
  const Frame& waiting = std::get<ImagePart>(parts[1]).frame;
  EXPECT_EQ(waiting.depth.at<float>(1, 1), 0.2F);
  EXPECT_FALSE(waiting.pose.has_value());
  const Frame& first = std::get<ImagePart>(parts[2]).frame;
  ASSERT_FALSE(first.depth.empty());
  EXPECT_EQ(first.depth.at<float>(1, 1), 0.3F);
  ASSERT_TRUE(first.pose.has_value());
  EXPECT_EQ(first.pose->translation.x(), 3);
}

TEST(CompleteFrames, SwappedImagesAreNoJumpOfTime) {
  std::vector<StreamPart> recorded;
  addPass(kNanosecondsPerSecond, 12, 1, &recorded);
  std::swap(recorded[3 * 5], recorded[3 * 6]);
  expectImages(read(recorded, {true, false, true}), {1, 2, 3, 4, 5, 7, 6, 8, 9, 10, 11, 12});
}

TEST(CompleteFrames, RefuseARecordingWithoutWhatIsNeeded) {
  const auto complete = [](const Needs& needs, const Needs& offers) {
    return completeFrames(std::make_unique<Parts>(std::vector<StreamPart>(), offers), needs, {});
  };
  test::expectError<UnavailableError>(
      [&] {
        complete({true, true, true}, {false, true, true});
      },
      {"needs depth", "has no depth"});
  test::expectError<UnavailableError>(
      [&] {
        complete({true, true, true}, {true, true, false});
      },
      {"needs poses", "has no poses"});
  test::expectError<UnavailableError>(
      [&] {
        complete({true, true, true}, {true, false, true});
      },
      {"needs camera", "has no camera"});
  EXPECT_NE(complete({false, false, true}, {false, false, true}), nullptr);
}

}  // namespace
}  // namespace evolin
