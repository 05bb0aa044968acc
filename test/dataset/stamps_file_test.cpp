// Claims about stamps.txt: what is written is read back, what is wrong is named with its line.
#include "evolin_ros/dataset/stamps_file.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "evolin_ros/base/error.h"
#include "test/support/fuzz.h"
#include "test/support/shared_data.h"
#include "test/support/temporary_folder.h"

namespace evolin {
namespace {

bool sameEntries(const std::vector<StampedFile>& a, const std::vector<StampedFile>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i].stamp != b[i].stamp || a[i].file != b[i].file) return false;
  }
  return true;
}

std::string messageFor(const std::string& content) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.write("stamps.txt", content);
  try {
    readStampsFile(file);
  } catch (const ParseError& error) {
    // The folder's name differs from run to run.
    return std::string(error.what()).substr(folder.path().string().size() + 1);
  }
  ADD_FAILURE() << "no ParseError for " << content;
  return "";
}

TEST(ReadStampsFile, SkipsCommentsAndBlankLines) {
  const test::TemporaryFolder folder;
  const auto entries = readStampsFile(
      folder.write("stamps.txt",
                   "# color images\n#\n\n  # more\n1305031453.359684 rgb/1305031453.359684.png\r\n"
                   "\t1305031453.5\t rgb/with two  spaces.png  \n"));
  EXPECT_TRUE(sameEntries(entries, {{1305031453359684000, "rgb/1305031453.359684.png"},
                                    {1305031453500000000, "rgb/with two  spaces.png"}}));
}

TEST(ReadStampsFile, TakesAnEmptyFileAsNoEntries) {
  const test::TemporaryFolder folder;
  EXPECT_TRUE(readStampsFile(folder.write("a", "")).empty());
  EXPECT_TRUE(readStampsFile(folder.write("b", "# nothing\n")).empty());
}

TEST(ReadStampsFile, NamesLineAndValue) {
  EXPECT_EQ(messageFor("1.0 a\n2.0\n"), "stamps.txt:2: expected 'stamp file', got '2.0'");
  EXPECT_EQ(messageFor("# c\nsoon a.png\n"),
            "stamps.txt:2: expected a stamp in decimal seconds, got 'soon'");
  EXPECT_EQ(messageFor("1e9 a.png\n"),
            "stamps.txt:1: expected a stamp in decimal seconds, got '1e9'");
  EXPECT_EQ(messageFor(std::string("1 a\0b", 5)),
            "stamps.txt:1: expected the name of a file, got 'a?b'");
  EXPECT_EQ(messageFor("2.0 a\n1.5 b\n"),
            "stamps.txt:2: stamp 1.500000 is not after the one before, 2.000000; expected "
            "increasing stamps");
  EXPECT_EQ(messageFor("2.0 a\n\n2.0 b\n"),
            "stamps.txt:3: stamp 2.000000 is not after the one before, 2.000000; expected "
            "increasing stamps");
  EXPECT_THROW(readStampsFile("/no/such/stamps.txt"), ParseError);
}

TEST(WriteStampsFile, ReadsBackTheSame) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "lines" / "stamps.txt";
  const std::vector<StampedFile> entries = {
      {-5, "a.csv"}, {1305031453359684001, "two words.csv"}, {1305031453359684002, "#odd,name"}};
  writeStampsFile(file, entries);
  EXPECT_TRUE(sameEntries(readStampsFile(file), entries));
  writeStampsFile(file, {});
  EXPECT_TRUE(readStampsFile(file).empty());
}

TEST(WriteStampsFile, RefusesWhatWouldNotReadBack) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "stamps.txt";
  EXPECT_THROW(writeStampsFile(file, {{2, "a"}, {2, "b"}}), Error);
  for (const std::string name : {"", " a", "a ", "a\nb", "a\r"}) {
    EXPECT_THROW(writeStampsFile(file, {{1, name}}), Error) << name;
  }
  EXPECT_FALSE(std::filesystem::exists(file));
}

TEST(FindNearest, TakesTheNearerNeighbourWithinTolerance) {
  const std::vector<StampedFile> entries = {{100, "a"}, {200, "b"}, {310, "c"}};
  const auto name_at = [&](Stamp stamp, Stamp tolerance) {
    const StampedFile* found = findNearest(entries, stamp, tolerance);
    return found == nullptr ? std::string("none") : found->file;
  };
  EXPECT_EQ(name_at(200, 0), "b");
  EXPECT_EQ(name_at(201, 0), "none");
  EXPECT_EQ(name_at(249, 100), "b");
  EXPECT_EQ(name_at(256, 100), "c");
  EXPECT_EQ(name_at(150, 50), "a");  // as near to both: the earlier
  EXPECT_EQ(name_at(0, 100), "a");
  EXPECT_EQ(name_at(0, 99), "none");
  EXPECT_EQ(name_at(400, 90), "c");
  EXPECT_EQ(name_at(400, 89), "none");
  EXPECT_EQ(name_at(200, -1), "none");
  EXPECT_EQ(findNearest({}, 0, 100), nullptr);
}

TEST(FindNearest, SurvivesTheEndsOfTime) {
  constexpr Stamp kLargest = std::numeric_limits<Stamp>::max();
  constexpr Stamp kSmallest = std::numeric_limits<Stamp>::min();
  const std::vector<StampedFile> entries = {{kSmallest, "a"}, {kLargest, "b"}};
  EXPECT_EQ(findNearest(entries, 1, kLargest)->file, "b");
  EXPECT_EQ(findNearest({entries[0]}, kLargest, kLargest), nullptr);
  EXPECT_EQ(findNearest({entries[1]}, kSmallest, kLargest), nullptr);
}

TEST(ReadStampsFile, ReadsTheListsOfTum) {
  EVOLIN_REQUIRE_SHARED_DATA();
  const std::filesystem::path data = test::sharedFolder() / "data";
  const auto cabinet = readStampsFile(data / "tum_fr3_cabinet_sample" / "rgb.txt");
  EXPECT_EQ(cabinet.size(), 58U);
  const auto desk = readStampsFile(data / "tum_fr1_desk_sample" / "rgb.txt");
  ASSERT_GT(desk.size(), 9U);
  EXPECT_EQ(desk[0].file.substr(0, 4), "rgb/");
  EXPECT_EQ(desk[0].file.substr(4), formatStamp(desk[0].stamp) + ".png");
}

TEST(ReadStampsFile, AnswersAnyBytesWithEntriesOrOneError) {
  const std::string valid =
      "# timestamp filename\n1305031452.791720 rgb/1305031452.791720.png\n"
      "1305031452.823674 rgb/1305031452.823674.png\n1305031452.859642 rgb/last one.png\n";
  const test::TemporaryFolder folder;
  test::Fuzzer fuzzer(31);
  test::FuzzCounts counts;
  for (int i = 0; i < 4000; ++i) {
    const std::string content = i % 5 == 0 ? fuzzer.randomBytes(300) : fuzzer.damaged(valid);
    const std::filesystem::path file = folder.write("stamps.txt", content);
    test::countAnswer(
        [&] {
          const std::vector<StampedFile> entries = readStampsFile(file);
          writeStampsFile(file, entries);
          EXPECT_TRUE(sameEntries(readStampsFile(file), entries));
        },
        content, &counts);
  }
  EXPECT_GT(counts.values, 500U);
  EXPECT_GT(counts.errors, 1000U);
}

}  // namespace
}  // namespace evolin
