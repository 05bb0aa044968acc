// What our own detectors owe besides test/detection/awkward_images.h: equality with golden lines,
// reuse, independence, and lines that lie in the image.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string>
#include <vector>

#include "test/detection/awkward_images.h"
#include "test/support/allocations.h"
#include "test/support/fuzz_images.h"
#include "test/support/golden.h"

namespace evolin::test {

/// The greater distance of the endpoints, in the order that makes it the smaller.
inline double endpointDistance(const LineSegment& a, const LineSegment& b) {
  const double straight =
      std::max(std::hypot(a.x1 - b.x1, a.y1 - b.y1), std::hypot(a.x2 - b.x2, a.y2 - b.y2));
  const double crossed =
      std::max(std::hypot(a.x1 - b.x2, a.y1 - b.y2), std::hypot(a.x2 - b.x1, a.y2 - b.y1));
  return std::min(straight, crossed);
}

/// Of all golden frames together.
struct GoldenAgreement {
  std::size_t golden = 0;
  std::size_t found = 0;
  std::size_t near = 0;         ///< golden lines with one of ours within a pixel, one to one
  std::size_t same_scores = 0;  ///< of those: the score within the tolerance

  double nearShare() const { return static_cast<double>(near) / static_cast<double>(golden); }
  double scoreShare() const { return static_cast<double>(same_scores) / static_cast<double>(near); }
  double countRatio() const { return static_cast<double>(found) / static_cast<double>(golden); }
};

/// Compares with golden/classical/`name`; scores must agree within `score_tolerance` times the
/// golden one (unless it is negative: then scores are not read).
inline GoldenAgreement compareWithGolden(LineDetector* detector, const std::string& name,
                                         double score_tolerance) {
  GoldenAgreement agreement;
  for (int frame = 0; frame < kGoldenFrames; ++frame) {
    const LineSegments lines = detector->detect(goldenGray(frame));
    const std::string file = goldenStem(frame) + ".csv";
    const LineSegments golden = readLinesCsv(goldenFolder() / name / "lines" / file);
    std::vector<double> scores;
    if (score_tolerance >= 0) {
      scores = readScoresCsv(goldenFolder() / name / "scores" / file);
    }
    std::vector<bool> taken(lines.size(), false);
    for (std::size_t g = 0; g < golden.size(); ++g) {
      std::size_t nearest = lines.size();
      for (std::size_t k = 0; k < lines.size(); ++k) {
        if (!taken[k] &&
            (nearest == lines.size() ||
             endpointDistance(lines[k], golden[g]) < endpointDistance(lines[nearest], golden[g]))) {
          nearest = k;
        }
      }
      if (nearest < lines.size() && endpointDistance(lines[nearest], golden[g]) <= 1) {
        taken[nearest] = true;
        ++agreement.near;
        if (!scores.empty() && std::abs(lines[nearest].score - scores[g]) <=
                                   score_tolerance * std::abs(scores[g]) + 1e-9) {
          ++agreement.same_scores;
        }
      }
    }
    agreement.golden += golden.size();
    agreement.found += lines.size();
  }
  return agreement;
}

inline void expectEqualLines(const LineSegments& lines, const LineSegments& others,
                             const std::string& what) {
  ASSERT_EQ(lines.size(), others.size()) << what;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const LineSegment& a = lines[i];
    const LineSegment& b = others[i];
    ASSERT_TRUE(a.x1 == b.x1 && a.y1 == b.y1 && a.x2 == b.x2 && a.y2 == b.y2) << what << " " << i;
    ASSERT_TRUE(a.score == b.score || (!a.hasScore() && !b.hasScore())) << what << " " << i;
  }
}

/// Images that are hard on line detectors, with their names.
inline std::vector<NamedImage> adversarialImages() { return patterns({160, 120}); }

/// Lines have a length and lie in the image (to the outer edge of its pixels).
inline void expectLinesInImage(const LineSegments& lines, cv::Size size, const std::string& what) {
  for (const LineSegment& line : lines) {
    ASSERT_GT(line.length(), 0) << what;
    for (const double x : {line.x1, line.x2}) {
      ASSERT_TRUE(x >= -0.5 && x <= size.width - 0.5) << what << " " << x;
    }
    for (const double y : {line.y1, line.y2}) {
      ASSERT_TRUE(y >= -0.5 && y <= size.height - 0.5) << what << " " << y;
    }
  }
}

/// Sound lines in the image for all adversarial images.
inline void expectSurvivesAdversarialImages(LineDetector* detector) {
  for (const auto& [name, image] : adversarialImages()) {
    Frame frame;
    frame.image = image;
    const LineSegments lines = detector->detect(frame);
    expectSound(lines, *detector, name);
    expectLinesInImage(lines, image.size(), name);
  }
}

/// With each of the parameter sets (YAML) it survives awkward and adversarial images.
template <typename Detector>
void expectExtremeParametersWork(std::initializer_list<const char*> parameter_sets) {
  for (const char* parameters : parameter_sets) {
    SCOPED_TRACE(parameters);
    Detector detector;
    detector.configure(YAML::Load(parameters));
    expectSurvivesAwkwardImages(&detector);
    expectSurvivesAdversarialImages(&detector);
  }
}

/// Both edges of an upright bar, each longer than `least_length` of its 100 pixels and upright but
/// for `tilt` pixels, and nothing else.
inline void expectFindsBothSidesOfABar(LineDetector* detector, double least_length, double tilt) {
  Frame frame;
  frame.image = cv::Mat(100, 120, CV_8UC1, cv::Scalar(30));
  frame.image.colRange(50, 70).setTo(220);
  const LineSegments lines = detector->detect(frame);
  ASSERT_EQ(lines.size(), 2U);
  for (const LineSegment& line : lines) {
    EXPECT_NEAR(line.x1, line.x2, tilt);
    EXPECT_GT(line.length(), least_length);
    EXPECT_NEAR(std::abs(line.x1 - 59.5), 10, 0.51);
  }
}

/// compareWithGolden() without scores: at least `near_share` within a pixel, as many lines as there
/// are but for the share `count_tolerance`. Records the share as `near_share`.
inline void expectNearGolden(LineDetector* detector, const std::string& name, double near_share,
                             double count_tolerance) {
  const GoldenAgreement agreement = compareWithGolden(detector, name, -1);
  EXPECT_GE(agreement.nearShare(), near_share);
  EXPECT_NEAR(agreement.countRatio(), 1, count_tolerance);
  ::testing::Test::RecordProperty("near_share", std::to_string(agreement.nearShare()));
}

/// Two instances that see images of changing sizes in different orders find the same in each, and
/// so does one that sees it alone.
template <typename Detector>
void expectIndependentOfOtherFrames() {
  std::vector<Frame> frames;
  for (const auto& [name, image] : adversarialImages()) {
    Frame frame;
    frame.name = name;
    frame.image = image;
    frames.push_back(frame);
  }
  Frame large;
  large.name = "quadrilateral";
  large.image = quadrilateralImage();
  frames.push_back(large);
  Frame small;
  small.name = "small";
  small.image = quadrilateralImage()(cv::Rect(40, 20, 90, 70));
  frames.insert(frames.begin() + 3, small);
  Detector forwards;
  Detector backwards;
  forwards.configure(YAML::Node());
  backwards.configure(YAML::Node());
  std::vector<LineSegments> first(frames.size());
  std::vector<LineSegments> second(frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const std::size_t j = frames.size() - 1 - i;
    first[i] = forwards.detect(frames[i]);
    second[j] = backwards.detect(frames[j]);
  }
  std::size_t found = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    Detector alone;
    alone.configure(YAML::Node());
    const LineSegments lines = alone.detect(frames[i]);
    expectEqualLines(first[i], lines, frames[i].name);
    expectEqualLines(second[i], lines, frames[i].name);
    expectLinesInImage(lines, frames[i].image.size(), frames[i].name);
    expectSound(lines, alone, frames[i].name);
    found += lines.size();
  }
  EXPECT_GT(found, 20U) << "hardly any line to compare";
}

/// Once it has seen them, a detector goes through the same images again without allocating more
/// than `most` times a frame (its result).
inline void expectReusesMemory(LineDetector* detector, std::size_t most) {
  const auto images = adversarialImages();
  Frame frame;
  for (const auto& [name, image] : images) {
    frame.image = image;
    detector->detect(frame);
  }
  for (const auto& [name, image] : images) {
    frame.image = image;
    const std::size_t before = allocations();
    const LineSegments lines = detector->detect(frame);
    EXPECT_LE(allocations() - before, most) << name << ", " << lines.size() << " lines";
  }
}

/// `min_length`, `max_lines`, `score_threshold` as parameters select from what is found without.
template <typename Detector>
void expectSelects() {
  Frame frame;
  frame.image = quadrilateralImage();
  Detector all;
  all.configure(YAML::Node());
  const LineSegments lines = all.detect(frame);
  ASSERT_GT(lines.size(), 3U);
  Detector few;
  few.configure(YAML::Load("{max_lines: 2}"));
  EXPECT_EQ(few.detect(frame).size(), 2U);
  std::vector<double> lengths;
  for (const LineSegment& line : lines) {
    lengths.push_back(line.length());
  }
  std::sort(lengths.begin(), lengths.end());
  const double middle = (lengths[1] + lengths[2]) / 2;
  YAML::Node parameters;
  parameters["min_length"] = middle;
  Detector longer;
  longer.configure(parameters);
  const LineSegments kept = longer.detect(frame);
  EXPECT_EQ(kept.size(), lines.size() - 2);
  for (const LineSegment& line : kept) {
    EXPECT_GE(line.length(), middle);
  }
}

}  // namespace evolin::test
