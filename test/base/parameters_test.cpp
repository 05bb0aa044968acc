// Claims about parameters: every wrong one is refused by name, with what would be right.
#include "evolin_ros/base/parameters.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/yaml_file.h"
#include "test/support/fuzz.h"

namespace evolin {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The message of the ConfigError that `action` throws; fails the test when it throws none.
template <typename Action>
std::string messageOf(const Action& action) {
  try {
    action();
  } catch (const ConfigError& error) {
    return error.what();
  }
  ADD_FAILURE() << "no ConfigError";
  return "";
}

template <typename Value, typename... Limits>
Value readOne(const std::string& yaml, Value value, Limits... limits) {
  ParameterReader(YAML::Load(yaml), "detector x").read("p", &value, limits...);
  return value;
}

TEST(ParameterReader, LeavesAbsentValuesAlone) {
  for (const YAML::Node& node : {YAML::Node(), YAML::Node(YAML::NodeType::Undefined),
                                 YAML::Node(YAML::NodeType::Map), YAML::Load("")}) {
    ParameterReader reader(node, "x");
    int count = 3;
    bool flag = true;
    double scale = 0.5;
    std::string name = "lsd";
    reader.read("count", &count);
    reader.read("flag", &flag);
    reader.read("scale", &scale, 0, 1);
    reader.read("name", &name, {"a"});
    EXPECT_NO_THROW(reader.finish());
    EXPECT_EQ(count, 3);
    EXPECT_TRUE(flag);
    EXPECT_EQ(scale, 0.5);
    EXPECT_EQ(name, "lsd");
  }
}

TEST(ParameterReader, TreatsAMissingChildAsNoParameters) {
  const YAML::Node parent = YAML::Load("a: 1");
  ParameterReader reader(parent["missing"], "x");
  EXPECT_NO_THROW(reader.finish());
}

TEST(ParameterReader, ReadsEveryType) {
  ParameterReader reader(YAML::Load("{count: 7, flag: off, scale: 1e-3, name: fld}"), "x");
  int count = 0;
  bool flag = true;
  double scale = 0;
  std::string name;
  reader.read("count", &count);
  reader.read("flag", &flag);
  reader.read("scale", &scale);
  reader.read("name", &name, {"lsd", "fld"});
  EXPECT_NO_THROW(reader.finish());
  EXPECT_EQ(count, 7);
  EXPECT_FALSE(flag);
  EXPECT_EQ(scale, 0.001);
  EXPECT_EQ(name, "fld");
}

TEST(ParameterReader, ReadsNodesThatAProgramMade) {
  YAML::Node node;
  node["p"] = 0.1;
  double value = 0;
  ParameterReader(node, "x").read("p", &value);
  EXPECT_EQ(value, 0.1);
  node["p"] = kInfinity;
  ParameterReader(node, "x").read("p", &value);
  EXPECT_EQ(value, kInfinity);
  node["p"] = true;
  bool flag = false;
  ParameterReader(node, "x").read("p", &flag);
  EXPECT_TRUE(flag);
}

TEST(ParameterReader, RefusesWhatIsNoMap) {
  EXPECT_EQ(messageOf([] { ParameterReader(YAML::Load("[1, 2]"), "detector x"); }),
            "detector x: expected a map of parameters, got a list");
  EXPECT_EQ(messageOf([] { ParameterReader(YAML::Load("word"), "detector x"); }),
            "detector x: expected a map of parameters, got 'word'");
  EXPECT_EQ(messageOf([] { ParameterReader(YAML::Load("{[1]: 2}"), "detector x"); }),
            "detector x: expected names as keys, got a list");
}

TEST(ParameterReader, RefusesAKeyGivenTwice) {
  EXPECT_EQ(messageOf([] { ParameterReader(YAML::Load("{p: 1, q: 2, p: 3}"), "detector x"); }),
            "detector x: parameter 'p': given twice; expected each parameter once");
}

TEST(ParameterReader, ReadsAllWordsOfYamlForBooleans) {
  for (const std::string yes : {"true", "True", "TRUE", "yes", "on", "Yes", "ON"}) {
    EXPECT_TRUE(readOne("p: " + yes, false)) << yes;
  }
  for (const std::string no : {"false", "False", "no", "off", "Off", "NO"}) {
    EXPECT_FALSE(readOne("p: " + no, true)) << no;
  }
  for (const std::string other : {"1", "0", "maybe", "tRuE", "1.0", "~", "[true]", "{a: true}"}) {
    EXPECT_THROW(readOne("p: " + other, false), ConfigError) << other;
  }
  EXPECT_EQ(messageOf([] { readOne("p: 1", false); }),
            "detector x: parameter 'p': expected true or false (also yes, no, on, off), got '1'");
}

TEST(ParameterReader, KeepsWholeNumbersInsideTheRange) {
  EXPECT_EQ(readOne("p: 1", 0, 1, 3), 1);
  EXPECT_EQ(readOne("p: 3", 0, 1, 3), 3);
  EXPECT_EQ(readOne("p: -2147483648", 0), std::numeric_limits<int>::min());
  for (const std::string bad : {"0", "4", "3.5", "3.0", "abc", "2147483648", "99999999999999999999",
                                "1e0", "true", "", "~", "[1]", "{a: 1}", "0x1"}) {
    EXPECT_THROW(readOne("p: " + bad, 0, 1, 3), ConfigError) << bad;
  }
  EXPECT_THROW(readOne("p: 2147483648", 0), ConfigError);
  EXPECT_THROW(readOne("p: -2147483649", 0), ConfigError);
  EXPECT_EQ(messageOf([] { readOne("p: 3.5", 0, 1, 3); }),
            "detector x: parameter 'p': expected a whole number from 1 to 3, got '3.5'");
  EXPECT_EQ(messageOf([] { readOne("p: [1]", 0, 1, 3); }),
            "detector x: parameter 'p': expected a whole number from 1 to 3, got a list");
}

TEST(ParameterReader, KeepsNumbersInsideTheRange) {
  EXPECT_EQ(readOne("p: 0", 0.5, 0.0, 1.0), 0.0);
  EXPECT_EQ(readOne("p: 1", 0.5, 0.0, 1.0), 1.0);
  EXPECT_EQ(readOne("p: '0.25'", 0.5, 0.0, 1.0), 0.25);
  for (const std::string bad : {"-0.1", "1.1", "abc", ".nan", "nan", ".inf", "-.inf", "inf",
                                "1e999", "~", "", "[0.5]", "{a: 0.5}", "0,5"}) {
    EXPECT_THROW(readOne("p: " + bad, 0.5, 0.0, 1.0), ConfigError) << bad;
  }
  EXPECT_EQ(messageOf([] { readOne("p: 1.5", 0.5, 0.0, 1.0); }),
            "detector x: parameter 'p': expected a number from 0 to 1, got '1.5'");
  EXPECT_EQ(messageOf([] { readOne("p: -1", 0.5, 0.25); }),
            "detector x: parameter 'p': expected a number of at least 0.25, got '-1'");
  EXPECT_EQ(messageOf([] { readOne("p: 9", 0.5, -kInfinity, 8.0); }),
            "detector x: parameter 'p': expected a number of at most 8, got '9'");
  EXPECT_EQ(messageOf([] { readOne("p: x", 0.5); }),
            "detector x: parameter 'p': expected a number, got 'x'");
}

TEST(ParameterReader, TakesInfinityWhereTheRangeDoesAndNeverNan) {
  EXPECT_EQ(readOne("p: .inf", 0.0), kInfinity);
  EXPECT_EQ(readOne("p: -.INF", 0.0), -kInfinity);
  EXPECT_EQ(readOne("p: inf", 0.0, 0.0), kInfinity);
  EXPECT_THROW(readOne("p: -inf", 0.0, 0.0), ConfigError);
  EXPECT_THROW(readOne("p: .nan", 0.0), ConfigError);
  EXPECT_THROW(readOne("p: nan", 0.0), ConfigError);
}

TEST(ParameterReader, TakesOnlyAcceptedWords) {
  const auto read = [](const std::string& yaml) {
    std::string value = "kept";
    ParameterReader(YAML::Load(yaml), "x").read("mode", &value, {"fast", "exact"});
    return value;
  };
  EXPECT_EQ(read("mode: exact"), "exact");
  EXPECT_EQ(messageOf([&] { read("mode: exakt"); }),
            "x: parameter 'mode': expected one of fast, exact, got 'exakt'; did you mean 'exact'?");
  EXPECT_EQ(messageOf([&] { read("mode: [fast]"); }),
            "x: parameter 'mode': expected one of fast, exact, got a list");
  EXPECT_EQ(messageOf([&] { read("mode:"); }),
            "x: parameter 'mode': expected one of fast, exact, got nothing");
  EXPECT_EQ(readOne("p: any text", std::string()), "any text");
  EXPECT_EQ(readOne("p: ''", std::string("old")), "");
  EXPECT_THROW(readOne("p: {a: b}", std::string()), ConfigError);
}

TEST(ParameterReader, TakesAnEmptyListOnlyWhereThatIsAccepted) {
  const YAML::Node node = YAML::Load("{none: [], some: [1.5]}");
  std::vector<double> none = {1, 2};
  ParameterReader reader(node, "test");
  reader.read("none", &none, 0, 10, ParameterReader::EmptyList::kAccepted);
  EXPECT_TRUE(none.empty());
  reader.read("some", &none, 0, 10, ParameterReader::EmptyList::kAccepted);
  EXPECT_EQ(none, std::vector<double>{1.5});
  EXPECT_THROW(reader.read("none", &none, 0, 10), ConfigError);
  EXPECT_EQ(none, std::vector<double>{1.5}) << "the old value stays";
}

TEST(ParameterReader, KeepsTheOldValueOnError) {
  int count = 5;
  EXPECT_THROW(ParameterReader(YAML::Load("p: 11"), "x").read("p", &count, 0, 10), ConfigError);
  EXPECT_EQ(count, 5);
}

TEST(ParameterReader, NamesUnknownKeysWithTheNearestKnownOne) {
  ParameterReader reader(YAML::Load("{scale: 1, sigma_scal: 2}"), "detector lsd");
  double scale = 0;
  double sigma = 0;
  reader.read("scale", &scale);
  reader.read("sigma_scale", &sigma);
  EXPECT_EQ(messageOf([&] { reader.finish(); }),
            "detector lsd: parameter 'sigma_scal': unknown; did you mean 'sigma_scale'? Known "
            "parameters: scale, sigma_scale");
  const ParameterReader none(YAML::Load("{a: 1}"), "detector y");
  EXPECT_EQ(messageOf([&] { none.finish(); }),
            "detector y: parameter 'a': unknown; there are no parameters here");
}

TEST(ParameterReader, DoesNotChangeTheNodeItReads) {
  const YAML::Node node = YAML::Load("{a: 1}");
  ParameterReader reader(node, "x");
  int value = 0;
  reader.read("absent", &value);
  reader.read("a", &value);
  reader.finish();
  EXPECT_EQ(node.size(), 1U);
}

TEST(NearestWord, HasTheSmallestEditDistance) {
  EXPECT_EQ(nearestWord("treshold", {"scale", "threshold", "hold"}), "threshold");
  EXPECT_EQ(nearestWord("ab", {"abc", "abd"}), "abc");
  EXPECT_EQ(nearestWord("", {"long", "x"}), "x");
  EXPECT_EQ(nearestWord("kitten", {"sitting", "mitten"}), "mitten");
  EXPECT_EQ(nearestWord("x", {}), "");
}

TEST(ParameterReader, AnswersDamagedYamlWithValuesOrOneError) {
  const std::string valid = "count: 7\nflag: yes\nscale: 0.25\nname: lsd\n";
  test::Fuzzer fuzzer(21);
  test::FuzzCounts counts;
  for (int i = 0; i < 3000; ++i) {
    const std::string text = fuzzer.damaged(valid);
    YAML::Node node;
    try {
      node = parseYaml(text, "x.yaml");
    } catch (const ParseError&) {
      continue;  // not YAML
    }
    test::countAnswer(
        [&] {
          ParameterReader reader(node, "x");
          int count = 0;
          bool flag = false;
          double scale = 0;
          std::string name;
          reader.read("count", &count, 0, 10);
          reader.read("flag", &flag);
          reader.read("scale", &scale, 0, 1);
          reader.read("name", &name, {"lsd", "fld"});
          reader.finish();
          EXPECT_TRUE(count >= 0 && count <= 10);
          EXPECT_TRUE(scale >= 0 && scale <= 1);
        },
        text, &counts);
  }
  EXPECT_GT(counts.values, 100U);
  EXPECT_GT(counts.errors, 500U);
}

}  // namespace
}  // namespace evolin
