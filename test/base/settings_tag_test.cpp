// Which settings share a tag and which do not.
#include "evolin_ros/base/settings_tag.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace evolin {
namespace {

std::string tagOf(const std::string& yaml) { return settingsTag(YAML::Load(yaml)); }

TEST(SettingsTag, IsEmptyForTheDefaults) {
  EXPECT_EQ(settingsTag(YAML::Node()), "");
  EXPECT_EQ(tagOf("{}"), "");
}

TEST(SettingsTag, IsAHashAndEightDigits) {
  const std::string tag = tagOf("{a: 1}");
  ASSERT_EQ(tag.size(), 9U);
  EXPECT_EQ(tag[0], '#');
  EXPECT_EQ(tag.find_first_not_of("0123456789abcdef", 1), std::string::npos);
}

TEST(SettingsTag, DoesNotDependOnOrderOrQuotes) {
  EXPECT_EQ(tagOf("{a: 1, b: {c: x, d: [1, 2]}}"), tagOf("{b: {d: [\"1\", 2], c: 'x'}, a: 1}"));
}

TEST(SettingsTag, DiffersForEveryOtherContent) {
  const std::set<std::string> tags = {
      tagOf("{a: 1}"),        tagOf("{a: 2}"),        tagOf("{b: 1}"),    tagOf("{a: 1, b: 1}"),
      tagOf("{a: [1]}"),      tagOf("{a: [1, 1]}"),   tagOf("{a: [11]}"), tagOf("{a: [[1], 1]}"),
      tagOf("{a: [[1, 1]]}"), tagOf("{a: {1: 1}}"),   tagOf("{a: }"),     tagOf("{a: ''}"),
      tagOf("{a: []}"),       tagOf("{a: [1, [1]]}"), tagOf("{a: {}}")};
  EXPECT_EQ(tags.size(), 15U);
}

}  // namespace
}  // namespace evolin
