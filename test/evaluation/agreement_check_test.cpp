// A recording that fits is left alone; each way to read it wrongly is named.
#include "evolin_ros/evaluation/agreement_check.h"

#include <gtest/gtest.h>

#include <functional>

#include "evolin_ros/dataset/synthetic/synthetic_sequence.h"
#include "test/support/shared_data.h"

namespace evolin {
namespace {

constexpr int kFrames = 28;

/// The built-in room, small, rendered once for all tests.
const std::vector<SequenceFrame>& roomFrames() {
  static const std::vector<SequenceFrame> frames = [] {
    synthetic::SyntheticOptions options;
    options.frames = kFrames;
    options.rate = 10;  // larger and less even steps than at 30 Hz
    options.width = 320;
    options.height = 240;
    const synthetic::SyntheticSequence sequence(options);
    std::vector<SequenceFrame> rendered;
    for (int i = 0; i < kFrames; ++i) {
      rendered.push_back(sequence.frame(static_cast<std::size_t>(i)));
    }
    return rendered;
  }();
  return frames;
}

struct Spoil {
  int frames = 0;           ///< image i is given the pose of image i + frames
  double seconds = 0;       ///< added to the stamps of poses
  double depth = 1;         ///< depth is multiplied with it
  bool inverted = false;    ///< poses world to camera
  bool flipped = false;     ///< the sign of fy
  bool still = false;       ///< all images are the first
  bool unrelated = false;   ///< poses of another motion
  bool depth_last = false;  ///< depth comes after its image
  bool poses = true;
};

std::vector<Finding> findingsOf(const Spoil& spoil) {
  const std::vector<SequenceFrame>& frames = roomFrames();
  AgreementCheck check(frames.size());
  for (int i = 0; i < kFrames; ++i) {
    const Frame& frame = frames[static_cast<std::size_t>(spoil.still ? 0 : i)].frame;
    const Stamp stamp = frames[static_cast<std::size_t>(i)].frame.stamp;
    Camera camera = *frame.camera;
    camera.fy *= spoil.flipped ? -1 : 1;
    check.add(camera);
    const int posed = spoil.still ? 0 : (spoil.unrelated ? i * 11 % kFrames : i + spoil.frames);
    if (spoil.poses && posed >= 0 && posed < kFrames) {
      const Pose pose = *frames[static_cast<std::size_t>(posed)].frame.pose;
      check.add(StampedPose{stamp + std::llround(spoil.seconds * kNanosecondsPerSecond),
                            spoil.inverted ? inverse(pose) : pose});
    }
    const cv::Mat metres = frame.depth * spoil.depth;
    const DepthPart depth{stamp, DepthMap(metres)};
    Frame image = frame;
    image.stamp = stamp;
    if (!spoil.depth_last) {
      check.add(depth);
    }
    check.add(ImagePart{image, ""});
    if (spoil.depth_last) {
      check.add(depth);
    }
  }
  return check.findings();
}

void expectDoubt(const Spoil& spoil, const std::string& text, const std::string& advice) {
  const std::vector<Finding> findings = findingsOf(spoil);
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].level, Finding::Level::kDoubt) << findings[0].text;
  EXPECT_EQ(findings[0].subject, "agreement");
  EXPECT_EQ(findings[0].text.rfind(text + ": so images", 0), 0U) << findings[0].text;
  EXPECT_NE(findings[0].advice.find(advice), std::string::npos) << findings[0].advice;
}

TEST(AgreementCheck, ARecordingThatFitsIsSaidToFit) {
  for (const bool depth_last : {false, true}) {
    Spoil spoil;
    spoil.depth_last = depth_last;
    const std::vector<Finding> findings = findingsOf(spoil);
    ASSERT_EQ(findings.size(), 1U);
    EXPECT_EQ(findings[0].level, Finding::Level::kGood) << findings[0].text;
    EXPECT_NE(findings[0].text.find("fit best as given"), std::string::npos) << findings[0].text;
    EXPECT_EQ(findings[0].advice, "");
  }
}

TEST(AgreementCheck, PosesOfOtherFramesAreNamed) {
  Spoil spoil;
  spoil.frames = 1;
  expectDoubt(spoil, "the poses of 1 frame earlier", "lower --pose-offset by 1");
  spoil.frames = -2;
  expectDoubt(spoil, "the poses of 2 frames later", "raise --pose-offset by 2");
}

TEST(AgreementCheck, PosesOfAnotherClockAreNamed) {
  Spoil spoil;
  spoil.seconds = 0.03;
  expectDoubt(spoil, "the poses of 0.03 s later",
              "the stamps of the poses are 0.03 s too late: move them");
}

TEST(AgreementCheck, PosesOfTheOtherConventionAreNamed) {
  Spoil spoil;
  spoil.inverted = true;
  expectDoubt(spoil, "the poses inverted", "expected is camera to world");
}

TEST(AgreementCheck, TheOtherSignOfFyIsNamed) {
  Spoil spoil;
  spoil.flipped = true;
  expectDoubt(spoil, "fy with the other sign", "look at fy of the camera");
}

TEST(AgreementCheck, AWrongDepthFactorIsNamed) {
  Spoil spoil;
  spoil.depth = 5;
  expectDoubt(spoil, "depth multiplied with 0.2", "divide the depth factor by 0.2");
  spoil.depth = 0.8;
  expectDoubt(spoil, "depth multiplied with 1.25", "divide the depth factor by 1.25");
}

TEST(AgreementCheck, SeveralMistakesAreNamedTogether) {
  Spoil spoil;
  spoil.inverted = true;
  spoil.frames = 1;
  spoil.depth = 0.2;
  expectDoubt(spoil, "the poses of 1 frame earlier, the poses inverted, depth multiplied with 5",
              "lower --pose-offset by 1");
}

TEST(AgreementCheck, WhereNothingMovesNothingIsExcluded) {
  Spoil spoil;
  spoil.still = true;
  const std::vector<Finding> findings = findingsOf(spoil);
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].level, Finding::Level::kGood);
  EXPECT_NE(findings[0].text.find("too small or too even to exclude: the poses of 1 frame earlier"),
            std::string::npos)
      << findings[0].text;
}

TEST(AgreementCheck, WhatNoMistakeExplainsIsSaid) {
  Spoil spoil;
  spoil.unrelated = true;
  const std::vector<Finding> findings = findingsOf(spoil);
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].level, Finding::Level::kDoubt) << findings[0].text;
  EXPECT_EQ(findings[0].text.rfind("images, depth and poses do not fit", 0), 0U)
      << findings[0].text;
}

TEST(AgreementCheck, WithoutPosesThereIsNothingToSay) {
  Spoil spoil;
  spoil.poses = false;
  EXPECT_TRUE(findingsOf(spoil).empty());
}

TEST(AgreementCheck, PosesThatAreNeverNearAnImageAreSaid) {
  Spoil spoil;
  spoil.seconds = 100;
  const std::vector<Finding> findings = findingsOf(spoil);
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].level, Finding::Level::kDoubt);
  EXPECT_EQ(findings[0].text.rfind("cannot be measured: 0 pairs of images 1 apart", 0), 0U)
      << findings[0].text;
}

TEST(AgreementCheck, TheRealSampleLagsByOneFrame) {
  EVOLIN_REQUIRE_SHARED_DATA();
  const auto reader = openFolderParts(test::sharedFolder() / "data" / "icl_nuim_lr_sample", {}, {});
  AgreementCheck check(reader->images());
  while (const std::optional<StreamPart> part = reader->next()) {
    check.add(*part);
  }
  const std::vector<Finding> findings = check.findings();
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].level, Finding::Level::kDoubt);
  EXPECT_EQ(findings[0].text.rfind("the poses of 1 frame earlier: so images", 0), 0U)
      << findings[0].text;
}

}  // namespace
}  // namespace evolin
