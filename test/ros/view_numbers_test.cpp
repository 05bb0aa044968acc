// Figures in the margin: which entries are taken, what is not defined, and a size that stays.
#include "view_numbers.h"

#include <gtest/gtest.h>

#include <limits>

namespace evolin::ros_shell {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

evolin_ros::ClassificationEntry entry(const std::string& distance, double threshold,
                                      double precision) {
  evolin_ros::ClassificationEntry result;
  result.distance = distance;
  result.threshold = threshold;
  result.precision = precision;
  result.recall = precision / 2;
  result.f_score = precision / 4;
  result.average_precision = kNan;
  return result;
}

std::string value(const std::vector<ViewSection>& sections, const std::string& title,
                  const std::string& name) {
  for (const ViewSection& section : sections) {
    if (section.title.rfind(title, 0) == 0) {
      for (const ViewRow& row : section.rows) {
        if (row.name == name) {
          return row.value;
        }
      }
    }
  }
  return "(no row '" + name + "' under '" + title + "')";
}

std::vector<std::size_t> layout(const std::vector<ViewSection>& sections) {
  std::vector<std::size_t> rows;
  for (const ViewSection& section : sections) {
    rows.push_back(section.rows.size());
  }
  return rows;
}

TEST(ViewNumbers, NothingHeardIsADash) {
  const std::vector<ViewSection> sections = ViewNumbers(5).sections(0);
  for (const ViewSection& section : sections) {
    for (const ViewRow& row : section.rows) {
      EXPECT_EQ(row.value, row.name == "parts not shown" ? "0" : "-") << row.name;
    }
  }
}

TEST(ViewNumbers, TakesTheStructuralEntryAtItsThreshold) {
  evolin_ros::DetectionMetrics message;
  message.frames = 12;
  message.entries = {entry("orthogonal", 5, 0.9), entry("orthogonal", 10, 0.8),
                     entry("structural", 5, 0.6), entry("structural", 10, 0.4)};
  ViewNumbers five(5);
  five.take(message);
  EXPECT_EQ(value(five.sections(0), "detection, 12 frames", "precision"), "60.0 %");
  EXPECT_EQ(value(five.sections(0), "detection", "recall"), "30.0 %");
  EXPECT_EQ(value(five.sections(0), "detection", "F-score"), "15.0 %");
  EXPECT_EQ(value(five.sections(0), "detection", "average precision"), "-");
  ViewNumbers ten(10);
  ten.take(message);
  EXPECT_EQ(value(ten.sections(0), "detection", "precision"), "40.0 %");
  ViewNumbers seven(7);
  seven.take(message);
  EXPECT_EQ(value(seven.sections(0), "detection", "precision"), "-");
}

TEST(ViewNumbers, RatiosOfNoFrameAreNotResults) {
  evolin_ros::DetectionMetrics message;
  message.entries = {entry("structural", 5, 0)};
  ViewNumbers numbers(5);
  numbers.take(message);
  evolin_ros::AssociationMetrics association;
  association.entries = {entry("", kNan, 0)};
  numbers.takeTrue(association);
  EXPECT_EQ(value(numbers.sections(0), "detection", "precision"), "-");
  EXPECT_EQ(value(numbers.sections(0), "matches", "precision"), "-");
}

TEST(ViewNumbers, TellsWhenFiguresBeginAnew) {
  ViewNumbers numbers(5);
  evolin_ros::DetectionMetrics message;
  message.frames = 3;
  EXPECT_FALSE(numbers.take(message));
  EXPECT_FALSE(numbers.take(message));
  message.frames = 4;
  EXPECT_FALSE(numbers.take(message));
  message.frames = 0;
  EXPECT_TRUE(numbers.take(message));
}

TEST(ViewNumbers, ShowsEveryFamilyWithItsUnit) {
  ViewNumbers numbers(5);
  evolin_ros::HeatmapMetrics heatmap;
  heatmap.frames = 2;
  heatmap.entries = {entry("", kNan, 0.1), entry("", kNan, 0.8)};  // the last keeps most lines
  numbers.take(heatmap);
  evolin_ros::RepeatabilityMetrics repeatability;
  repeatability.frames = 7;
  repeatability.entries.resize(2);
  repeatability.entries[0].distance = "orthogonal";
  repeatability.entries[1].distance = "structural";
  repeatability.entries[1].threshold = 5;
  repeatability.entries[1].step = 10;
  repeatability.entries[1].repeatability = 0.345;
  repeatability.entries[1].localization_error = 1.234;
  numbers.take(repeatability);
  evolin_ros::PoseMetrics pose;
  pose.pairs = 9;
  pose.rotation_median = 0.456;
  pose.translation_median = std::numeric_limits<double>::infinity();
  pose.success_rate = 1;
  numbers.take(pose);
  evolin_ros::Coverage coverage;
  coverage.seen = 90;
  coverage.evaluated = 88;
  numbers.take(coverage);
  const std::vector<ViewSection> sections = numbers.sections(4);
  EXPECT_EQ(value(sections, "detection", "F-score on pixels"), "20.0 %");
  EXPECT_EQ(value(sections, "repeatability, step 10, 7 pairs", "found again"), "34.5 %");
  EXPECT_EQ(value(sections, "repeatability", "localisation error"), "1.23 px");
  EXPECT_EQ(value(sections, "relative pose, 9 pairs", "rotation, median"), "0.46 deg");
  EXPECT_EQ(value(sections, "relative pose", "translation, median"), "inf");
  EXPECT_EQ(value(sections, "relative pose", "within 1 deg, 5 cm"), "100.0 %");
  EXPECT_EQ(value(sections, "coverage", "frames evaluated"), "88 of 90");
  EXPECT_EQ(value(sections, "coverage", "parts not shown"), "4");
  EXPECT_EQ(layout(sections), layout(ViewNumbers(5).sections(0)));
}

TEST(ViewNumbers, ShowsTheMatchesOfWhichThereAreMore) {
  ViewNumbers numbers(5);
  evolin_ros::AssociationMetrics none;
  evolin_ros::AssociationMetrics some;
  some.frames = 3;
  some.entries = {entry("", kNan, 0.5)};
  numbers.takeTrue(none);
  numbers.takeDetected(some);
  EXPECT_EQ(value(numbers.sections(0), "matches (detected), 3 pairs", "precision"), "50.0 %");
  some.frames = 4;
  some.entries = {entry("", kNan, 1)};
  numbers.takeTrue(some);
  EXPECT_EQ(value(numbers.sections(0), "matches, 4 pairs", "precision"), "100.0 %");
}

}  // namespace
}  // namespace evolin::ros_shell
