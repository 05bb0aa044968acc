// Any input ends in a document or one ParseError that names file and line.
#include "evolin_ros/base/yaml_file.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "evolin_ros/base/error.h"
#include "test/support/expect_error.h"
#include "test/support/fuzz.h"
#include "test/support/temporary_folder.h"

namespace evolin {
namespace {

using test::expectError;

/// The line of the ParseError; fails the test when there is none.
int refusedLine(const std::string& text) {
  try {
    parseYaml(text, "x.yaml");
  } catch (const ParseError& error) {
    EXPECT_EQ(error.file(), "x.yaml");
    return error.line();
  }
  ADD_FAILURE() << "was taken: " << ::testing::PrintToString(text);
  return -1;
}

TEST(ParseYaml, GivesTheDocument) {
  const YAML::Node node = parseYaml("a: 1\nb: [x, {c: 2}]", "x.yaml");
  EXPECT_EQ(node["a"].as<int>(), 1);
  EXPECT_EQ(node["b"][1]["c"].as<int>(), 2);
  EXPECT_TRUE(parseYaml("", "x.yaml").IsNull());
  EXPECT_TRUE(parseYaml("# nothing", "x.yaml").IsNull());
}

TEST(ParseYaml, NamesFileAndLineOfWhatIsNotYaml) {
  expectError([] { parseYaml("a: 1\nb: [1, 2\nc: 3\n", "x.yaml"); }, {"x.yaml:", "not valid YAML"});
  EXPECT_GE(refusedLine("a: 1\nb: [1, 2\nc: 3\n"), 2);
  EXPECT_EQ(refusedLine("a: 1\nb: \"no end"), 2);
}

TEST(ParseYaml, EndsWhereAColonIsTheLastCharacterInBrackets) {
  for (const char* text : {"[:", "{:", "{a:", "[[a:", "x: [1, {a:", "a: {b: c,\n  d:"}) {
    EXPECT_GE(refusedLine(text), 1) << text;
  }
}

TEST(ParseYaml, RefusesAColonBeforeAClosingBracket) {
  expectError([] { parseYaml("a: 1\nb: [x:]\n", "x.yaml"); }, {"x.yaml:2", "':]'", "a space"});
  EXPECT_EQ(refusedLine("[:]"), 1);
  EXPECT_EQ(refusedLine("a: 1\r\n\r\n{a:]}"), 3);
  EXPECT_EQ(refusedLine("# a comment\r[a:]"), 1);
  // Within quotes, perhaps, but what of it is a comment takes more than this line to tell.
  EXPECT_EQ(refusedLine("a: [\"b\n # c\", d:]"), 2);
  EXPECT_EQ(refusedLine("a: [b#c:]"), 1);
  EXPECT_TRUE(parseYaml("[a: ]", "x.yaml")[0].IsMap());
}

TEST(ParseYaml, TakesAColonBeforeAClosingBracketInComments) {
  const YAML::Node node = parseYaml("# [low:]\na: 1  # [low:]\nb: 2\t# c#:]", "x.yaml");
  EXPECT_EQ(node.size(), 2U);
  EXPECT_EQ(node["b"].as<int>(), 2);
}

TEST(ParseYaml, RefusesControlCharactersAndUtf16) {
  expectError([] { parseYaml(std::string("a: 1\nb: \0", 9), "x.yaml"); },
              {"x.yaml:2", "control character 0", "UTF-8"});
  EXPECT_EQ(refusedLine("a: 1\n\n[a:\x04"), 3);
  EXPECT_EQ(refusedLine("a: \x1B"), 1);
  expectError([] { parseYaml("\xFF\xFE:", "x.yaml"); }, {"x.yaml:1", "UTF-16"});
  expectError([] { parseYaml("\xFE\xFF:", "x.yaml"); }, {"x.yaml:1", "UTF-16"});
  EXPECT_EQ(parseYaml("a:\t1\r\nb: caf\xC3\xA9\r\n", "x.yaml").size(), 2U);
}

TEST(ParseYaml, AnswersAnyTextWithADocumentOrOneError) {
  // What flow collections are made of, so that random text has deep and broken ones.
  const std::vector<std::string> pieces = {"[", "]", "{",  "}",  ":", ": ",  ",",    "a", "\"",
                                           "'", "#", " #", "\n", "?", "- ",  "!",    "&", "*b",
                                           "|", ">", "%",  "\t", " ", "...", "---\n"};
  test::Fuzzer fuzzer(11);
  test::FuzzCounts counts;
  for (int round = 0; round < 20000; ++round) {
    std::string text;
    for (std::size_t left = fuzzer.below(12); left > 0; --left) {
      text += pieces[fuzzer.below(pieces.size())];
    }
    if (round % 50 == 0) text = fuzzer.damaged(text);
    test::countAnswer([&] { parseYaml(text, "fuzz.yaml"); }, text, &counts);
  }
  EXPECT_GT(counts.values, 1000U);
  EXPECT_GT(counts.errors, 1000U);
}

TEST(ReadYamlFile, ReadsFilesOfEveryEditor) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("bom.yaml",
                                 "\xEF\xBB\xBF"
                                 "a: 1\r\nb: [2]");
  const YAML::Node node = readYamlFile(file);
  EXPECT_EQ(node["a"].as<int>(), 1);
  EXPECT_EQ(node["b"][0].as<int>(), 2);
}

TEST(ReadYamlFile, NamesTheFileThatCannotBeRead) {
  const test::TemporaryFolder folder;
  const std::string missing = (folder.path() / "missing.yaml").string();
  expectError([&] { readYamlFile(missing); }, {missing, "cannot be read"});
  const std::string here = folder.path().string();
  expectError([&] { readYamlFile(here); }, {here, "cannot be read", "directory"});
}

}  // namespace
}  // namespace evolin
