// Which depth belongs to which image, from depth_associations.txt.
#include "evolin_ros/dataset/depth_associations.h"

#include <gtest/gtest.h>

#include "evolin_ros/base/error.h"
#include "test/support/expect_error.h"
#include "test/support/temporary_folder.h"

namespace evolin {
namespace {

using Rows = std::vector<std::optional<std::size_t>>;
using test::expectError;

class DepthAssociationsTest : public ::testing::Test {
 protected:
  Rows read(const std::string& text) const {
    return readDepthAssociations(folder_.write("list.txt", text), 3, 4);
  }

  void expectRefused(const std::string& text, std::initializer_list<std::string> words) const {
    expectError<ParseError>([&] { read(text); }, words);
  }

  test::TemporaryFolder folder_;
};

TEST_F(DepthAssociationsTest, MapImagesToDepths) {
  EXPECT_EQ(read("0 1\n2 3\n"), (Rows{1, std::nullopt, 3}));
  EXPECT_EQ(read("# image depth\n\n1.0 0.000e+00\r\n"), (Rows{std::nullopt, 0, std::nullopt}));
  EXPECT_EQ(read("0 2\n1 2\n"), (Rows{2, 2, std::nullopt}));
  EXPECT_EQ(read(""), Rows(3));
}

TEST_F(DepthAssociationsTest, RowsKeepTheOrderOfTheFile) {
  const std::vector<DepthAssociation> rows =
      readDepthAssociationRows(folder_.write("list.txt", "# list\n2 1\n\n0 3\n"), 3, 4);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].image, 2U);
  EXPECT_EQ(rows[0].depth, 1U);
  EXPECT_EQ(rows[0].line, 2);
  EXPECT_EQ(rows[1].image, 0U);
  EXPECT_EQ(rows[1].depth, 3U);
  EXPECT_EQ(rows[1].line, 4);
}

TEST_F(DepthAssociationsTest, NameFileLineAndValueOfBadRows) {
  expectRefused("0 0\n1\n", {"list.txt:2", "1 fields", "'1'"});
  expectRefused("0 0 0\n", {"list.txt:1", "3 fields"});
  expectRefused("0 0\n3 0\n", {"list.txt:2", "image index", "'3'", "the folder has 3"});
  expectRefused("0 4\n", {"list.txt:1", "depth index", "'4'", "the folder has 4"});
  expectRefused("-1 0\n", {"'-1'"});
  expectRefused("0.5 0\n", {"'0.5'"});
  expectRefused("nan 0\n", {"'nan'"});
  expectRefused("a 0\n", {"'a'"});
  expectRefused("1 0\n1 1\n", {"list.txt:2", "'1'", "twice"});
  expectError<ParseError>([&] { readDepthAssociations(folder_.path() / "absent.txt", 3, 4); },
                          {"absent.txt"});
}

}  // namespace
}  // namespace evolin
