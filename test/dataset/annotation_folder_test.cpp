// Annotation folders: look-up by name and by time, scores, and ids chained from pairs.
#include "evolin_ros/dataset/annotation_folder.h"

#include <gtest/gtest.h>

#include <string>

#include "test/support/expect_error.h"
#include "test/support/shared_data.h"
#include "test/support/temporary_folder.h"

namespace evolin {
namespace {

using test::expectError;
using test::TemporaryFolder;

using Ids = std::vector<std::int64_t>;

Ids idsOf(const AnnotationFolder& folder, const std::string& stem) {
  Ids ids;
  const std::optional<LineSegments> lines = folder.byName(stem);
  for (const LineSegment& line : lines.value()) {
    ids.push_back(line.id);
  }
  return ids;
}

std::string lines(int count) {
  std::string text;
  for (int i = 0; i < count; ++i) {
    text += std::to_string(i) + ",0,9," + std::to_string(i) + "\n";
  }
  return text;
}

// Frames a, b and c with 2, 3 and 2 lines in gt_lines/.
class Annotated : public TemporaryFolder {
 public:
  Annotated() {
    write("gt_lines/a.csv", lines(2));
    write("gt_lines/b.csv", lines(3));
    write("gt_lines/c.csv", lines(2));
  }
};

TEST(AnnotationFolder, FindsLineFilesInTheFolderOrInside) {
  const Annotated folder;
  for (const auto& path : {folder.path(), folder.path() / "gt_lines"}) {
    const AnnotationFolder annotations(path);
    EXPECT_EQ(annotations.size(), 3U);
    EXPECT_EQ(annotations.names(), (std::vector<std::string>{"a", "b", "c"}));
    ASSERT_TRUE(annotations.byName("b").has_value());
    EXPECT_EQ(annotations.byName("b")->size(), 3U);
    EXPECT_FALSE(annotations.byName("d").has_value());
  }
}

TEST(AnnotationFolder, NamesAFolderWithoutLineFiles) {
  const TemporaryFolder folder;
  expectError([&] { AnnotationFolder annotations(folder.path() / "none"); },
              {"none", "not a folder"});
  expectError([&] { AnnotationFolder annotations(folder.path()); },
              {folder.path().string(), "*.csv", "gt_lines/"});
}

TEST(AnnotationFolder, NamesTheMalformedRow) {
  const Annotated folder;
  folder.write("gt_lines/b.csv", "1,2,3,4\n1,2,3\n");
  expectError<ParseError>([&] { AnnotationFolder annotations(folder.path()); }, {"b.csv:2"});
}

TEST(AnnotationFolder, HasNoLookUpByTimeWithoutStamps) {
  const Annotated folder;
  const AnnotationFolder annotations(folder.path());
  EXPECT_FALSE(annotations.hasStamps());
  EXPECT_FALSE(annotations.firstStamp().has_value());
  EXPECT_EQ(annotations.unlisted(), 0U);
  expectError([&] { annotations.at(0); }, {"no stamps.txt", "stamp file"});
}

TEST(AnnotationFolder, FindsLinesWithinAMillisecond) {
  const Annotated folder;
  folder.write("stamps.txt", "1.5 rgb/a.png\n2.5 c.csv\n");
  const AnnotationFolder annotations(folder.path());
  ASSERT_TRUE(annotations.hasStamps());
  EXPECT_EQ(annotations.firstStamp(), std::optional<Stamp>(1500000000));
  EXPECT_EQ(annotations.lastStamp(), std::optional<Stamp>(2500000000));
  EXPECT_EQ(annotations.unlisted(), 1U);
  EXPECT_EQ(annotations.at(1501000000)->size(), 2U);
  EXPECT_EQ(annotations.at(1499000000)->size(), 2U);
  EXPECT_FALSE(annotations.at(1501000001).has_value());
  EXPECT_FALSE(annotations.at(2000000000).has_value());
}

TEST(AnnotationFolder, TakesAnotherStampsFileWhenGiven) {
  const Annotated folder;
  folder.write("stamps.txt", "1.5 a.png\n");
  const auto other = folder.write("elsewhere/times.txt", "7.5 b.png\n");
  const AnnotationFolder annotations(folder.path(), other);
  EXPECT_FALSE(annotations.at(1500000000).has_value());
  EXPECT_EQ(annotations.at(7500000000)->size(), 3U);
}

TEST(AnnotationFolder, TakesStemsThatHoldAPoint) {
  const TemporaryFolder folder;
  folder.write("1305031453.359684.csv", lines(1));
  folder.write("stamps.txt", "1305031453.359684 1305031453.359684\n");
  const AnnotationFolder annotations(folder.path());
  EXPECT_TRUE(annotations.byName("1305031453.359684").has_value());
  EXPECT_TRUE(annotations.at(1305031453359684000).has_value());
}

TEST(AnnotationFolder, RefusesEntriesWithoutALineFile) {
  const Annotated folder;
  folder.write("stamps.txt", "1.5 a.png\n2.5 z.png\n");
  expectError<ParseError>([&] { AnnotationFolder annotations(folder.path()); },
                          {"stamps.txt", "z.png", "z.csv"});
  folder.write("stamps.txt", "1.5 a.png\n2.5 a.png\n");
  expectError<ParseError>([&] { AnnotationFolder annotations(folder.path()); },
                          {"stamps.txt", "'a'", "1.5", "2.5"});
  folder.write("stamps.txt", "# nothing\n");
  expectError<ParseError>([&] { AnnotationFolder annotations(folder.path()); },
                          {"stamps.txt", "no entries"});
}

TEST(AnnotationFolder, ReadsScoresInsideAndBesideLines) {
  const TemporaryFolder folder;
  folder.write("lines/0.csv", lines(2));
  folder.write("scores/0.csv", "0.5\n0.25\n");
  folder.write("stamps.txt", "3 0.csv\n");
  for (const auto& path : {folder.path(), folder.path() / "lines", folder.path() / "lines/"}) {
    const AnnotationFolder annotations(path);
    EXPECT_TRUE(annotations.hasScores()) << path;
    EXPECT_EQ(annotations.at(3000000000)->at(1).score, 0.25);
    EXPECT_EQ(annotations.byName("0")->at(1).id, kNoId);
  }
}

TEST(AnnotationFolder, WantsAScoreForEveryLine) {
  const TemporaryFolder folder;
  folder.write("lines/0.csv", lines(2));
  folder.write("lines/1.csv", lines(2));
  folder.write("scores/0.csv", "0.5\n0.25\n");
  expectError([&] { AnnotationFolder annotations(folder.path()); }, {"scores/1.csv", "frame 1"});
  folder.write("scores/1.csv", "0.5\n");
  expectError<ParseError>([&] { AnnotationFolder annotations(folder.path()); }, {"scores/1.csv"});
}

TEST(AnnotationIds, AreAbsentWithoutPairs) {
  const Annotated folder;
  const AnnotationFolder annotations(folder.path());
  EXPECT_FALSE(annotations.hasIds());
  EXPECT_EQ(idsOf(annotations, "b"), Ids({-1, -1, -1}));
}

TEST(AnnotationIds, ChainPairsThroughFramesAndFolders) {
  const Annotated folder;
  folder.write("gt_associations_step1/a_b.csv", "0,2\n");
  folder.write("gt_associations_step1/b_c.csv", "2,1\n0,0\n");
  for (const auto& path : {folder.path(), folder.path() / "gt_lines"}) {
    const AnnotationFolder annotations(path);
    EXPECT_TRUE(annotations.hasIds());
    EXPECT_EQ(idsOf(annotations, "a"), Ids({0, 1}));
    EXPECT_EQ(idsOf(annotations, "b"), Ids({2, 3, 0}));
    EXPECT_EQ(idsOf(annotations, "c"), Ids({2, 0}));
  }
  folder.write("gt_associations_step2/a_c.csv", "1,0\n");
  const AnnotationFolder annotations(folder.path());
  EXPECT_EQ(idsOf(annotations, "a"), Ids({0, 1}));
  EXPECT_EQ(idsOf(annotations, "b"), Ids({1, 2, 0}));
  EXPECT_EQ(idsOf(annotations, "c"), Ids({1, 0}));
}

TEST(AnnotationIds, AcceptTheSamePairTwice) {
  const Annotated folder;
  folder.write("gt_associations/a_b.csv", "0,0\n0,0\n");
  EXPECT_EQ(idsOf(AnnotationFolder(folder.path()), "b"), Ids({0, 2, 3}));
}

TEST(AnnotationIds, RefuseAChainWithTwoLinesOfOneFrame) {
  const Annotated folder;
  folder.write("gt_associations/a_b.csv", "0,0\n1,1\n");
  folder.write("gt_associations/a_c.csv", "0,0\n");
  folder.write("gt_associations/b_c.csv", "2,1\n1,0\n");
  expectError<ParseError>([&] { AnnotationFolder annotations(folder.path()); },
                          {"b_c.csv:2", "pair 1,0", "lines 0 and 1 of frame a"});
  folder.write("gt_associations/a_b.csv", "0,0\n0,1\n");
  expectError<ParseError>([&] { AnnotationFolder annotations(folder.path()); },
                          {"a_b.csv:2", "frame b"});
}

TEST(AnnotationIds, RefuseIndicesAndFramesThatAreNotThere) {
  const Annotated folder;
  folder.write("gt_associations/a_b.csv", "0,0\n1,3\n");
  expectError<ParseError>([&] { AnnotationFolder annotations(folder.path()); },
                          {"a_b.csv:2", "index 3", "3 lines of frame b"});
  folder.write("gt_associations/a_b.csv", "");
  folder.write("gt_associations/a_z.csv", "0,0\n");
  expectError<ParseError>([&] { AnnotationFolder annotations(folder.path()); },
                          {"a_z.csv", "annotated frames"});
}

TEST(AnnotationIds, FindStemsThatHoldUnderscores) {
  const TemporaryFolder folder;
  folder.write("gt_lines/left_0.csv", lines(1));
  folder.write("gt_lines/left_1.csv", lines(1));
  folder.write("gt_associations/left_0_left_1.csv", "0,0\n");
  EXPECT_EQ(idsOf(AnnotationFolder(folder.path()), "left_1"), Ids({0}));
}

TEST(AnnotationIds, AreNotTakenFromBesideAFolderOfPredictions) {
  const Annotated folder;
  folder.write("gt_associations/a_b.csv", "0,0\n");
  folder.write("predictions/a.csv", lines(1));
  EXPECT_FALSE(AnnotationFolder(folder.path() / "predictions").hasIds());
}

TEST(AnnotationIds, AreRowsWhenAskedForAndFramesHaveEquallyManyLines) {
  const TemporaryFolder folder;
  folder.write("a.csv", lines(2));
  folder.write("b.csv", lines(2));
  EXPECT_EQ(idsOf(AnnotationFolder(folder.path(), {}, true), "b"), Ids({0, 1}));
  folder.write("c.csv", lines(3));
  folder.write("d.csv", lines(1));
  expectError([&] { AnnotationFolder annotations(folder.path(), {}, true); },
              {"c.csv", "3 lines, expected 2"});
}

TEST(AnnotationFolder, ReadsTheRealSample) {
  EVOLIN_REQUIRE_SHARED_DATA();
  const std::filesystem::path sample = test::sharedFolder() / "data/icl_nuim_lr_sample";
  const AnnotationFolder annotations(sample);
  EXPECT_EQ(annotations.size(), 10U);
  EXPECT_EQ(idsOf(annotations, "0009").at(56), 56);
  const AnnotationFolder scored(sample / "predictions/scored");
  EXPECT_TRUE(scored.hasScores());
  EXPECT_FALSE(scored.hasIds());
  EXPECT_EQ(scored.byName("0000")->size(), 1000U);
  EXPECT_FALSE(AnnotationFolder(sample / "predictions/unscored").hasScores());
}

}  // namespace
}  // namespace evolin
