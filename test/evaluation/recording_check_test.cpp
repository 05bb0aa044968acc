// A sound recording has no doubts; each fault is found and named.
#include "evolin_ros/evaluation/recording_check.h"

#include <gtest/gtest.h>

#include "test/support/drawn_sequence.h"

namespace evolin {
namespace {

/// What a reader gives of drawn frames; a test spoils it.
struct Recording {
  std::vector<SequenceFrame> frames = test::drawSequence();
  bool depth = true;
  bool ids = true;
  float depth_scale = 1;

  RecordingCheck check() const {
    RecordingCheck check;
    for (const SequenceFrame& drawn : frames) {
      const Frame& frame = drawn.frame;
      if (frame.camera) {
        check.add(*frame.camera);
      }
      if (frame.pose) {
        check.add(StampedPose{frame.stamp, *frame.pose});
      }
      if (depth) {
        check.add(DepthPart{*drawn.depth_stamp, DepthMap(frame.depth * depth_scale)});
      }
      if (drawn.ground_truth) {
        LineSet truth;
        truth.stamp = frame.stamp;
        truth.width = frame.image.cols;
        truth.height = frame.image.rows;
        truth.lines = *drawn.ground_truth;
        for (LineSegment& line : truth.lines) {
          line.id = ids ? line.id : kNoId;
        }
        check.add(truth);
      }
      check.add(ImagePart{frame, frame.image.empty() ? "spoilt" : ""});
    }
    return check;
  }
};

std::vector<std::string> textsOf(const RecordingCheck& check, Finding::Level level) {
  std::vector<std::string> texts;
  for (const Finding& finding : check.findings()) {
    if (finding.level == level) {
      texts.push_back(finding.subject + ": " + finding.text + "; " + finding.advice);
    }
  }
  return texts;
}

void expectOnly(const RecordingCheck& check, Finding::Level level,
                const std::vector<std::string>& words) {
  const std::vector<std::string> texts = textsOf(check, level);
  ASSERT_EQ(texts.size(), 1U) << ::testing::PrintToString(texts);
  for (const std::string& word : words) {
    EXPECT_NE(texts[0].find(word), std::string::npos) << word << " is not in " << texts[0];
  }
}

std::string lacks(const RecordingCheck& check, MetricFamily family) {
  for (const FamilyReadiness& readiness : check.readiness()) {
    if (readiness.family == family) {
      return readiness.lacks;
    }
  }
  return "not listed";
}

TEST(RecordingCheck, ASoundRecordingHasNoDoubts) {
  const RecordingCheck check = Recording().check();
  EXPECT_EQ(textsOf(check, Finding::Level::kDoubt), std::vector<std::string>());
  EXPECT_EQ(textsOf(check, Finding::Level::kMissing), std::vector<std::string>());
  const std::vector<std::string> good = textsOf(check, Finding::Level::kGood);
  ASSERT_EQ(good.size(), 6U);
  EXPECT_EQ(good[0], "images: 12, 320x240 colour, 30 Hz; ");
  for (const MetricFamily family : allMetricFamilies()) {
    EXPECT_EQ(lacks(check, family), "");
  }
}

TEST(RecordingCheck, GapsAndJumpsOfImages) {
  Recording recording;
  recording.frames.erase(recording.frames.begin() + 4);
  expectOnly(recording.check(), Finding::Level::kDoubt, {"1 gaps", "0.067 s"});
  recording = Recording();
  recording.frames.push_back(recording.frames.back());
  recording.frames.back().frame.pose.reset();
  expectOnly(recording.check(), Finding::Level::kDoubt, {"1 stamps repeat"});
}

TEST(RecordingCheck, UnreadableImages) {
  Recording recording;
  recording.frames[5].frame.image.release();
  recording.frames[5].ground_truth.reset();
  const auto doubts = textsOf(recording.check(), Finding::Level::kDoubt);
  ASSERT_EQ(doubts.size(), 2U);
  EXPECT_NE(doubts[0].find("1 of 12 images cannot be read: spoilt"), std::string::npos);
  EXPECT_NE(doubts[1].find("11 of 12 images have annotated lines"), std::string::npos);
}

TEST(RecordingCheck, IntrinsicsOfAnotherCamera) {
  Recording recording;
  for (SequenceFrame& frame : recording.frames) {
    frame.frame.camera->width = 640;
  }
  expectOnly(recording.check(), Finding::Level::kDoubt, {"320x240", "640x240", "--camera"});
  recording = Recording();
  recording.frames[3].frame.camera->fx += 1;
  expectOnly(recording.check(), Finding::Level::kDoubt, {"1 messages have other intrinsics"});
}

TEST(RecordingCheck, DepthInAnotherUnit) {
  Recording recording;
  recording.depth_scale = 1000;
  expectOnly(recording.check(), Finding::Level::kDoubt, {"median", " m", "--depth-factor"});
}

TEST(RecordingCheck, DepthTooFarFromItsImage) {
  Recording recording;
  recording.frames.resize(1);
  *recording.frames[0].depth_stamp += 21000000;
  expectOnly(recording.check(), Finding::Level::kDoubt, {"0 of 1 images", "0.02 s"});
}

TEST(RecordingCheck, WhatIsMissingIsMissingForItsMetrics) {
  Recording recording;
  recording.depth = false;
  RecordingCheck check = recording.check();
  expectOnly(check, Finding::Level::kMissing, {"depth", "--depth-topic"});
  EXPECT_EQ(lacks(check, MetricFamily::kRepeatability), "depth");
  EXPECT_EQ(lacks(check, MetricFamily::kDetection), "");
  recording = Recording();
  for (SequenceFrame& frame : recording.frames) {
    frame.frame.camera.reset();
    frame.frame.pose.reset();
    frame.ground_truth.reset();
  }
  check = recording.check();
  EXPECT_EQ(textsOf(check, Finding::Level::kMissing).size(), 3U);
  EXPECT_EQ(lacks(check, MetricFamily::kPose), "intrinsics, poses");
  EXPECT_EQ(lacks(check, MetricFamily::kHeatmap), "ground-truth lines");
  EXPECT_EQ(lacks(RecordingCheck(), MetricFamily::kTracks), "images");
}

TEST(RecordingCheck, GroundTruthThatBreaksARule) {
  Recording recording;
  (*recording.frames[2].ground_truth)[1].x2 = 321;
  (*recording.frames[3].ground_truth)[0] = {5, 5, 5, 5};
  RecordingCheck check = recording.check();
  expectOnly(check, Finding::Level::kDoubt,
             {"2 frames", "row 1 at " + formatStamp(recording.frames[2].frame.stamp),
              "outside the image"});
  recording = Recording();
  recording.ids = false;
  check = recording.check();
  expectOnly(check, Finding::Level::kDoubt, {"12 frames have lines without ids", "--same-rows"});
  EXPECT_EQ(lacks(check, MetricFamily::kAssociation), "ids of the ground-truth lines");
}

}  // namespace
}  // namespace evolin
