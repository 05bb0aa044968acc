// Index pairs are found by stamp alone.
#include "evolin_ros/dataset/association_folder.h"

#include <gtest/gtest.h>

#include "test/support/expect_error.h"
#include "test/support/temporary_folder.h"

namespace evolin {
namespace {

using test::expectError;

constexpr Stamp kSecond = kNanosecondsPerSecond;

class AssociationFolderTest : public ::testing::Test {
 protected:
  void writePairs(const std::string& where = "associations/") const {
    folder_.write(where + "0000_0001.csv", "0,1\n2,0\n");
    folder_.write(where + "0001_0002.csv", "");
  }

  test::TemporaryFolder folder_;
  const std::string stamps_ = "1.000000 images/0000.png\n1.500000 0001.csv\n2.000000 0002.csv\n";
};

TEST_F(AssociationFolderTest, FindsPairsWithinAMillisecond) {
  writePairs();
  folder_.write("stamps.txt", stamps_);
  const AssociationFolder folder(folder_.path());
  EXPECT_EQ(folder.size(), 2U);
  const IndexPairs pairs = {{0, 1}, {2, 0}};
  EXPECT_EQ(folder.at(kSecond, 3 * kSecond / 2), pairs);
  EXPECT_EQ(folder.at(kSecond + 900000, 3 * kSecond / 2 - 900000), pairs);
  EXPECT_FALSE(folder.at(kSecond + 1100000, 3 * kSecond / 2));
  // Recorded, and nothing was matched.
  EXPECT_EQ(folder.at(3 * kSecond / 2, 2 * kSecond), IndexPairs());
  EXPECT_FALSE(folder.at(kSecond, 2 * kSecond)) << "no file of these two";
  EXPECT_FALSE(folder.at(3 * kSecond / 2, kSecond)) << "the other way round";
}

TEST_F(AssociationFolderTest, TakesTheInnerFolderAndStampsOfAnotherPlace) {
  writePairs();
  folder_.write("stamps.txt", stamps_);
  EXPECT_EQ(AssociationFolder(folder_.path() / "associations").size(), 2U);
  const test::TemporaryFolder other;
  writePairs("bare/");
  EXPECT_EQ(AssociationFolder(folder_.path() / "bare", other.write("list.txt", stamps_)).size(),
            2U);
}

TEST_F(AssociationFolderTest, StemsMayHoldPointsAndUnderscores) {
  folder_.write("1.25_2.5_b.csv", "1,1\n");
  folder_.write("stamps.txt", "1.000000 rgb/1.25.png\n2.000000 2.5_b.csv\n");
  EXPECT_EQ(AssociationFolder(folder_.path()).at(kSecond, 2 * kSecond), (IndexPairs{{1, 1}}));
}

TEST_F(AssociationFolderTest, NamesWhatIsWrong) {
  expectError([&] { AssociationFolder(folder_.path() / "none"); }, {"none", "not a folder"});
  writePairs();
  expectError([&] { AssociationFolder(folder_.path()); }, {"no stamps.txt", "'stamp file'"});
  folder_.write("stamps.txt", "1.000000 0000.csv\n1.500000 0001.csv\n");
  expectError([&] { AssociationFolder(folder_.path()); },
              {"0001_0002.csv", "does not list", "FIRST_SECOND.csv"});
  folder_.write("stamps.txt", "1.000000 0000.csv\n1.500000 a/0000.png\n");
  expectError<ParseError>([&] { AssociationFolder(folder_.path()); }, {"stamps.txt", "'0000'"});
  folder_.write("stamps.txt", stamps_);
  folder_.write("associations/0000_0002.csv", "0,x\n");
  expectError<ParseError>([&] { AssociationFolder(folder_.path()); }, {"0000_0002.csv:1"});
}

}  // namespace
}  // namespace evolin
