// Values of the parameter server as YAML and JSON, files with overrides, and paths.
#include "node_parameters.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/parameters.h"
#include "test/support/environment.h"
#include "test/support/expect_error.h"
#include "test/support/fuzz.h"
#include "test/support/temporary_folder.h"

namespace evolin::ros_shell {
namespace {

using test::expectError;
using test::Variable;
using XmlRpc::XmlRpcValue;

XmlRpcValue sampleValue() {
  XmlRpcValue value;
  value["flag"] = true;
  value["count"] = -7;
  value["scale"] = 0.1;
  value["name"] = "opencv_lsd";
  value["digits"] = "0012";
  value["list"][0] = 1;
  value["list"][1] = 2.5;
  value["list"][2] = "three";
  value["nested"]["deeper"]["x"] = 1e-9;
  return value;
}

TEST(ToYaml, KeepsScalarsListsAndMaps) {
  const YAML::Node node = toYaml(sampleValue());
  ASSERT_TRUE(node.IsMap());
  EXPECT_EQ(node.size(), 7U);
  EXPECT_TRUE(node["flag"].as<bool>());
  EXPECT_EQ(node["count"].as<int>(), -7);
  EXPECT_EQ(node["scale"].as<double>(), 0.1);
  EXPECT_EQ(node["name"].as<std::string>(), "opencv_lsd");
  EXPECT_EQ(node["digits"].as<std::string>(), "0012");
  ASSERT_TRUE(node["list"].IsSequence());
  ASSERT_EQ(node["list"].size(), 3U);
  EXPECT_EQ(node["list"][1].as<double>(), 2.5);
  EXPECT_EQ(node["list"][2].as<std::string>(), "three");
  EXPECT_EQ(node["nested"]["deeper"]["x"].as<double>(), 1e-9);
  EXPECT_TRUE(toYaml(XmlRpcValue()).IsNull());
}

TEST(ToYaml, IsReadByTheSameReaderAsAFile) {
  XmlRpcValue value;
  value["on"] = false;
  value["int"] = std::numeric_limits<int>::min();
  value["double"] = 1.0 / 3;
  value["text"] = "";
  ParameterReader reader(toYaml(value), "node");
  bool on = true;
  int integer = 0;
  double number = 0;
  std::string text = "x";
  reader.read("on", &on);
  reader.read("int", &integer);
  reader.read("double", &number);
  reader.read("text", &text);
  EXPECT_NO_THROW(reader.finish());
  EXPECT_FALSE(on);
  EXPECT_EQ(integer, std::numeric_limits<int>::min());
  EXPECT_EQ(number, 1.0 / 3);
  EXPECT_EQ(text, "");
}

TEST(ToYaml, RefusesBinaryDataAndDates) {
  char bytes[] = {1, 2, 3};
  XmlRpcValue value;
  value["a"]["b"] = XmlRpcValue(bytes, 3);
  expectError([&] { toYaml(value); }, {"binary data"});
  struct tm date = {};
  expectError([&] { toYaml(XmlRpcValue(&date)); }, {"date"});
}

TEST(ToJsonText, KeepsTypesAndIsStrict) {
  XmlRpcValue value = sampleValue();
  value["nan"] = std::numeric_limits<double>::quiet_NaN();
  value["infinity"] = -std::numeric_limits<double>::infinity();
  value["bytes"] = "caf\xE9";
  char bytes[] = {1, 2, 3};
  value["binary"] = XmlRpcValue(bytes, 3);
  const nlohmann::json json = nlohmann::json::parse(toJsonText(value));
  EXPECT_EQ(json["flag"], true);
  EXPECT_EQ(json["count"], -7);
  EXPECT_EQ(json["scale"], 0.1);
  EXPECT_EQ(json["digits"], "0012") << "text that looks like a number stays text";
  EXPECT_EQ(json["list"], nlohmann::json::parse(R"([1, 2.5, "three"])"));
  EXPECT_EQ(json["nested"]["deeper"]["x"], 1e-9);
  EXPECT_EQ(json["nan"], "nan");
  EXPECT_EQ(json["infinity"], "-inf");
  EXPECT_EQ(json["bytes"], "caf\xEF\xBF\xBD");
  EXPECT_TRUE(json["binary"].is_string());
  EXPECT_EQ(toJsonText(XmlRpcValue()), "null");
}

TEST(MergedParameters, LayOverridesOverTheFile) {
  const test::TemporaryFolder folder;
  const std::string file = folder.write("d.yaml", "a: 1\nb: [1, 2]\nc: {x: 1}\n").string();
  const YAML::Node merged = mergedParameters(file, YAML::Load("{b: 7, d: new}"));
  EXPECT_EQ(merged.size(), 4U);
  EXPECT_EQ(merged["a"].as<int>(), 1);
  EXPECT_EQ(merged["b"].as<int>(), 7);
  EXPECT_EQ(merged["c"]["x"].as<int>(), 1);
  EXPECT_EQ(merged["d"].as<std::string>(), "new");
  EXPECT_EQ(mergedParameters(file, YAML::Node())["b"].size(), 2U);
  EXPECT_EQ(mergedParameters("", YAML::Load("a: 3"))["a"].as<int>(), 3);
}

TEST(MergedParameters, AreAnEmptyMapWhereNothingIsGiven) {
  const test::TemporaryFolder folder;
  for (const std::string& config : {std::string(), folder.write("empty.yaml", "").string(),
                                    folder.write("comment.yaml", "# nothing\n").string(),
                                    folder.write("null.yaml", "~\n").string()}) {
    const YAML::Node merged = mergedParameters(config, YAML::Node());
    EXPECT_TRUE(merged.IsMap()) << config;
    EXPECT_EQ(merged.size(), 0U);
  }
}

TEST(MergedParameters, NameTheFileThatIsUnusable) {
  const test::TemporaryFolder folder;
  const std::string missing = (folder.path() / "missing.yaml").string();
  expectError([&] { mergedParameters(missing, YAML::Node()); }, {missing, "cannot be read"});
  const std::string here = folder.path().string();
  expectError([&] { mergedParameters(here, YAML::Node()); }, {here, "directory"});
  for (const char* content : {"[1, 2]\n", "just text\n", "12\n"}) {
    const std::string file = folder.write("other.yaml", content).string();
    expectError([&] { mergedParameters(file, YAML::Node()); }, {file, "expected a map"});
  }
  const std::string broken = folder.write("broken.yaml", "a: 1\nb: [1, 2\nc: 3\n").string();
  try {
    mergedParameters(broken, YAML::Node());
    ADD_FAILURE() << "a list without an end was taken";
  } catch (const ParseError& error) {
    EXPECT_EQ(error.file(), broken);
    EXPECT_GE(error.line(), 2);
  }
}

TEST(MergedParameters, AnswerAnyFileWithAMapOrOneError) {
  const test::TemporaryFolder folder;
  constexpr int kRounds = 800;
  test::Fuzzer fuzzer(5);
  test::FuzzCounts counts;
  const std::string valid =
      "# LSD\nrefine: advanced\nscale: 0.8   # relative\nlist: [1, 2, {a: b}]\n"
      "nested: {x: 1, y: &anchor [2, 3]}\nalias: *anchor\ntext: |\n  two\n  lines\n"
      "quoted: \"a\\tb\"\n? complex\n: value\n";
  const std::vector<std::string> nasty = {"a: *b\n",
                                          "&a {b: *a}\n",
                                          "&a [*a]\n",
                                          "{[1, 2]: 3}\n",
                                          "? {a: b}\n: c\n",
                                          "a: 1\na: 2\n",
                                          "--- 1\n--- {a: b}\n",
                                          "!!binary abc\n",
                                          "!local {a: 1}\n",
                                          "a: !!int x\n",
                                          "%YAML 9.9\n---\na: 1\n",
                                          "\t a: 1\n",
                                          "a: b: c\n",
                                          "- a\nb: 1\n",
                                          "<<: 1\n",
                                          "{",
                                          "]",
                                          "\"",
                                          "&",
                                          "*",
                                          "a: \"\\xZZ\"\n",
                                          std::string("a: 1\0b: 2", 9)};
  for (int round = 0; round < kRounds; ++round) {
    std::string text = fuzzer.below(4) == 0 ? fuzzer.randomBytes(200)
                       : fuzzer.below(4) == 0
                           ? nasty[fuzzer.below(nasty.size())] + nasty[fuzzer.below(nasty.size())]
                           : fuzzer.damaged(valid);
    if (round < static_cast<int>(nasty.size())) text = nasty[static_cast<std::size_t>(round)];
    const std::string file = folder.write("fuzz.yaml", text).string();
    test::countAnswer(
        [&] {
          const YAML::Node merged = mergedParameters(file, YAML::Load("{refine: none, extra: 1}"));
          ASSERT_TRUE(merged.IsMap());
          EXPECT_EQ(merged["extra"].as<int>(), 1);
          // What takes the map next must answer too.
          ParameterReader(merged, "fuzz").readMap("nested");
        },
        text, &counts);
  }
  EXPECT_GT(counts.errors, 100U);
  EXPECT_GT(counts.values, 100U);
  EXPECT_EQ(counts.values + counts.errors, static_cast<std::size_t>(kRounds));
}

TEST(ExpandPath, TakesTheHomeFolderForATilde) {
  const Variable home("HOME", "/home/somebody");
  EXPECT_EQ(expandPath("~"), "/home/somebody");
  EXPECT_EQ(expandPath("~/bags/a.bag"), "/home/somebody/bags/a.bag");
  EXPECT_EQ(expandPath("/a/~/b"), "/a/~/b");
  EXPECT_EQ(expandPath(""), "");
}

TEST(ExpandPath, TakesRelativePathsFromTheCallersFolder) {
  const Variable folder("PWD", "/called/from/here");
  EXPECT_EQ(expandPath("a.yaml"), "/called/from/here/a.yaml");
  EXPECT_EQ(expandPath("../a.yaml"), "/called/from/a.yaml");
  EXPECT_EQ(expandPath("~other/a"), "/called/from/here/~other/a");
  EXPECT_EQ(expandPath("/absolute/../a"), "/absolute/../a");
}

TEST(ExpandPath, LeavesPathsAloneWithoutTheVariables) {
  const Variable folder("PWD", std::nullopt);
  const Variable home("HOME", std::nullopt);
  EXPECT_EQ(expandPath("a.yaml"), "a.yaml");
  EXPECT_EQ(expandPath("~/a"), "/a");
}

std::string cameraOfWidth(int width) {
  return "width: " + std::to_string(width) + "\nheight: 480\nfx: 500\nfy: 500\ncx: 320\ncy: 240\n";
}

TEST(CameraOfParameter, APresetComesBeforeAFileOfItsName) {
  const test::TemporaryFolder presets;
  const test::TemporaryFolder here;
  presets.write("mine.yaml", cameraOfWidth(640));
  here.write("mine.yaml", cameraOfWidth(320));
  here.write("other.yaml", cameraOfWidth(160));
  const Variable folder("PWD", here.path().string());
  EXPECT_EQ(cameraOfParameter("mine", presets.path()).width, 640);
  EXPECT_EQ(cameraOfParameter("mine.yaml", presets.path()).width, 640);
  EXPECT_EQ(cameraOfParameter("./mine.yaml", presets.path()).width, 320);
  EXPECT_EQ(cameraOfParameter("other.yaml", presets.path()).width, 160);
  EXPECT_EQ(cameraOfParameter(presets.path() / "mine.yaml", presets.path()).width, 640);
}

TEST(CameraOfParameter, NamesBothPlacesWhereItLooked) {
  const test::TemporaryFolder presets;
  presets.write("mine.yaml", cameraOfWidth(640));
  const Variable folder("PWD", "/called/from/here");
  test::expectError([&] { cameraOfParameter("thine.yaml", presets.path()); },
                    {"thine.yaml", presets.path().string(), "/called/from/here/thine.yaml"});
  test::expectError([&] { cameraOfParameter("thine", presets.path()); }, {"thine", "mine"});
  test::expectError([&] { cameraOfParameter("../thine.yaml", presets.path()); },
                    {"/called/from/thine.yaml"});
}

}  // namespace
}  // namespace evolin::ros_shell
