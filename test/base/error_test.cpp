// Claims about the exceptions: what their messages name and how one catches them.
#include "evolin_ros/base/error.h"

#include <gtest/gtest.h>

#include <string>

namespace evolin {
namespace {

TEST(ParseError, NamesFileAndLine) {
  const ParseError error("lines/0001.csv", 7, "expected 4 columns");
  EXPECT_STREQ(error.what(), "lines/0001.csv:7: expected 4 columns");
  EXPECT_EQ(error.file(), "lines/0001.csv");
  EXPECT_EQ(error.line(), 7);
}

TEST(ParseError, LeavesOutLineZero) {
  EXPECT_STREQ(ParseError("a.csv", 0, "is empty").what(), "a.csv: is empty");
}

TEST(ConfigError, NamesOwnerAndKey) {
  const ConfigError error("detector lsd", "scale", "expected a number");
  EXPECT_STREQ(error.what(), "detector lsd: parameter 'scale': expected a number");
  EXPECT_EQ(error.key(), "scale");
}

TEST(ConfigError, WithoutKeySpeaksOfAllParameters) {
  EXPECT_STREQ(ConfigError("detector lsd", "", "expected a map").what(),
               "detector lsd: expected a map");
}

TEST(GroundTruthError, NamesFrameAndRow) {
  const GroundTruthError error("0003", 12, "zero length");
  EXPECT_STREQ(error.what(), "ground truth of frame 0003, row 12: zero length");
  EXPECT_EQ(error.frame(), "0003");
  EXPECT_EQ(error.row(), 12U);
}

TEST(Error, IsTheRootOfAll) {
  EXPECT_THROW(throw ParseError("f", 1, "m"), Error);
  EXPECT_THROW(throw ConfigError("o", "k", "m"), Error);
  EXPECT_THROW(throw UnavailableError("m"), Error);
  EXPECT_THROW(throw GroundTruthError("f", 0, "m"), Error);
  EXPECT_THROW(throw Error("m"), std::runtime_error);
}

}  // namespace
}  // namespace evolin
