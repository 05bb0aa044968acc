// Following parts of edges, and telling twins, on cases worked out by hand.
#include <gtest/gtest.h>

#include "part_names.h"
#include "twin_lines.h"

namespace evolin::synthetic {
namespace {

using Numbers = std::vector<std::uint32_t>;

VisibleLine reaching(std::size_t edge, double begin, double end) {
  VisibleLine line;
  line.edge = edge;
  line.reach = {begin, end};
  return line;
}

TEST(PartNames, CountPartsByEdge) {
  PartNames names(4);
  EXPECT_EQ(names.nextFrame({reaching(0, 0, 1), reaching(2, 0, 0.3), reaching(2, 0.5, 1)}),
            (Numbers{0, 0, 1}));
  EXPECT_EQ(names.nextFrame({}), Numbers{});
  EXPECT_EQ(names.nextFrame({reaching(1, 0, 1), reaching(2, 0.6, 1)}), (Numbers{0, 1}));
}

TEST(PartNames, TheLargerPieceStaysWhatTheWholeWas) {
  PartNames names(1);
  EXPECT_EQ(names.nextFrame({reaching(0, 0, 1)}), Numbers{0});
  EXPECT_EQ(names.nextFrame({reaching(0, 0, 0.4), reaching(0, 0.5, 1)}), (Numbers{1, 0}));
  // What comes between moves on, and the smaller piece becomes the larger one: nobody is renamed.
  EXPECT_EQ(names.nextFrame({reaching(0, 0, 0.7), reaching(0, 0.8, 1)}), (Numbers{1, 0}));
  // It has gone: the larger piece of before lends its name.
  EXPECT_EQ(names.nextFrame({reaching(0, 0, 1)}), Numbers{1});
}

TEST(PartNames, ALostPartIsFoundAgainButTakesNobodysPlace) {
  PartNames names(1);
  EXPECT_EQ(names.nextFrame({reaching(0, 0, 0.4), reaching(0, 0.6, 1)}), (Numbers{0, 1}));
  EXPECT_EQ(names.nextFrame({reaching(0, 0.3, 1)}), Numbers{1});
  // Part 0 overlaps more, but part 1 was there the frame before.
  EXPECT_EQ(names.nextFrame({reaching(0, 0.1, 0.4)}), Numbers{1});
  EXPECT_EQ(names.nextFrame({reaching(0, 0, 0.05), reaching(0, 0.1, 0.4)}), (Numbers{0, 1}));
}

TEST(PartNames, WhatWasNeverSeenIsNew) {
  PartNames names(1);
  EXPECT_EQ(names.nextFrame({reaching(0, 0, 0.4)}), Numbers{0});
  EXPECT_EQ(names.nextFrame({reaching(0, 0.5, 0.7)}), Numbers{1});
  EXPECT_EQ(names.nextFrame({reaching(0, 0.7, 0.9)}), Numbers{2});  // touching is not overlapping
}

LineSegment segment(double x1, double y1, double x2, double y2) {
  LineSegment line;
  line.x1 = x1;
  line.y1 = y1;
  line.x2 = x2;
  line.y2 = y2;
  return line;
}

void expectStretch(const LineSegment& line, const LineSegment& other, double begin, double end) {
  const EdgePart stretch = stretchNear(line, other, 2);
  EXPECT_NEAR(stretch.begin, begin, 1e-12);
  EXPECT_NEAR(stretch.end, end, 1e-12);
}

TEST(TwinLines, StretchNearIsTheOneInsideTheCapsule) {
  const LineSegment other = segment(10, 0, 50, 0);
  expectStretch(segment(20, 1, 40, 1), other, 0, 1);         // beside it all its way
  expectStretch(segment(0, 0, 100, 0), other, 0.08, 0.52);   // 2 px beyond both ends
  expectStretch(segment(100, 0, 0, 0), other, 0.48, 0.92);   // the other way round
  expectStretch(segment(30, -10, 30, 10), other, 0.4, 0.6);  // across
  expectStretch(segment(20, 0, 40, 10), other, 0, 0.2);      // away from it
  expectStretch(segment(11, 0, 49, 0), segment(10, 0, 50, 0), 0, 1);
  const EdgePart none = stretchNear(segment(10, 3, 50, 3), other, 2);
  EXPECT_GE(none.begin, none.end);
  const EdgePart beyond = stretchNear(segment(53, 0, 90, 0), other, 2);
  EXPECT_GE(beyond.begin, beyond.end);
}

ProjectedPart part(std::size_t edge, const LineSegment& line) {
  ProjectedPart projected;
  projected.edge = edge;
  projected.line = line;
  return projected;
}

TEST(TwinLines, OnlyTheStretchBesideTheLongerLineGoes) {
  ProjectedPart shorter = part(0, segment(100, 1, 160, 1));
  shorter.seen = {0.25, 0.75};
  shorter.exposed = {0.125, 1};
  shorter.depth1 = 1;
  shorter.depth2 = 3;
  const std::vector<VisibleLine> kept =
      withoutTwins({shorter, part(1, segment(0, 1, 128, 1)), part(2, segment(0, 9, 50, 9))});
  ASSERT_EQ(kept.size(), 3U);
  EXPECT_EQ(kept[0].edge, 0U);
  EXPECT_NEAR(kept[0].line.x1, 130, 1e-9);  // 2 px beyond the longer one's end
  EXPECT_EQ(kept[0].line.x2, 160);
  // Half of the way in the image, a quarter of the way in space, the near end first.
  EXPECT_NEAR(kept[0].reach.begin, 0.375, 1e-12);
  EXPECT_EQ(kept[0].reach.end, 1);
  EXPECT_EQ(kept[1].line.x2, 128);
  EXPECT_EQ(kept[2].line.length(), 50);
}

TEST(TwinLines, GoOnlyWhereALineThatStaysIsNear) {
  // 1 is the twin of 0 and goes; 2 is near to 1 alone and stays.
  const std::vector<VisibleLine> kept =
      withoutTwins({part(0, segment(0, 0, 100, 0)), part(1, segment(0, 1.5, 90, 1.5)),
                    part(2, segment(0, 3, 80, 3))});
  ASSERT_EQ(kept.size(), 2U);
  EXPECT_EQ(kept[0].edge, 0U);
  EXPECT_EQ(kept[1].edge, 2U);
}

TEST(TwinLines, MeetingAtACornerTakesNothingAway) {
  const std::vector<VisibleLine> kept =
      withoutTwins({part(0, segment(0, 0, 100, 0)), part(1, segment(0, 0, 50, 50)),
                    part(2, segment(100, 0, 130, 10))});
  ASSERT_EQ(kept.size(), 3U);
  EXPECT_EQ(kept[1].line.x1, 0);
  EXPECT_EQ(kept[2].line.x1, 100);
}

TEST(TwinLines, RestsBelowTenPixelsGoToo) {
  const std::vector<VisibleLine> kept =
      withoutTwins({part(0, segment(0, 0, 100, 0)), part(1, segment(60, 1, 111, 1))});
  ASSERT_EQ(kept.size(), 1U);
  EXPECT_EQ(kept[0].edge, 0U);
}

}  // namespace
}  // namespace evolin::synthetic
