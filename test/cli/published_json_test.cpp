// The published list format, read back by Python's own json module.
#include "published_json.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <memory>
#include <string>

#include "result_table.h"
#include "test/support/temporary_folder.h"

namespace evolin::cli {
namespace {

PublishedEntry valueEntry(const std::string& name, double value) {
  PublishedEntry entry;
  entry.name = name;
  entry.value = value;
  return entry;
}

/// What python3 prints for `script` with the text in the file sys.argv[1].
std::string runPython(const std::string& script, const std::string& text) {
  const test::TemporaryFolder folder;
  const std::string script_file = folder.write("read.py", script).string();
  const std::string text_file = folder.write("text.json", text).string();
  const std::string command = "/usr/bin/python3 " + script_file + " " + text_file + " 2>&1";
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::string output;
  for (int byte = std::fgetc(pipe.get()); byte != EOF; byte = std::fgetc(pipe.get())) {
    output += static_cast<char>(byte);
  }
  return output;
}

bool hasPython() { return std::system("/usr/bin/python3 -c pass > /dev/null 2>&1") == 0; }

TEST(PublishedJson, OfNothingIsAnEmptyList) { EXPECT_EQ(toPublishedJson({}), "[]"); }

TEST(PublishedJson, KeepsThePublishedOrderOfKeys) {
  PublishedEntry entry = valueEntry("precision", 0.25);
  entry.distance = "orthogonal";
  entry.distance_threshold = 5;
  entry.score_threshold = 0.3;
  entry.frames_step = 10;
  entry.threshold = 3;
  EXPECT_EQ(toPublishedJson({entry}),
            R"([{"name": "precision", "additional_information": {"distance_information": )"
            R"({"distance": "orthogonal", "distance_threshold": 5.0}, "threshold_information": )"
            R"({"threshold": 3.0}, "frames_step_information": {"step": 10}, )"
            R"("score_information": {"score_threshold": 0.3}}, "value": 0.25}])");
}

TEST(PublishedJson, WritesNullWithoutAdditionalInformation) {
  EXPECT_EQ(toPublishedJson({valueEntry("recall", 1)}),
            R"([{"name": "recall", "additional_information": null, "value": 1.0}])");
}

TEST(PublishedJson, WritesCurvesAndIntervals) {
  PublishedEntry entry = valueEntry("pr_curve", 0);
  entry.value = Curve{{0.5, 1}, {1, 0.75}};
  entry.confidence_interval = ConfidenceInterval{0.95, 0.125, 0.5};
  EXPECT_EQ(toPublishedJson({entry}),
            R"([{"name": "pr_curve", "additional_information": {"confidence_interval": )"
            R"({"level": 0.95, "low": 0.125, "high": 0.5}}, "values": {"x": [0.5, 1.0], )"
            R"("y": [1.0, 0.75]}}])");
}

TEST(PublishedJson, WritesLiteralsForWhatIsNotFinite) {
  const double infinity = std::numeric_limits<double>::infinity();
  const std::string text =
      toPublishedJson({valueEntry("a", infinity), valueEntry("b", -infinity),
                       valueEntry("c", std::numeric_limits<double>::quiet_NaN())});
  EXPECT_NE(text.find("\"value\": Infinity}"), std::string::npos) << text;
  EXPECT_NE(text.find("\"value\": -Infinity}"), std::string::npos) << text;
  EXPECT_NE(text.find("\"value\": NaN}"), std::string::npos) << text;
}

TEST(PublishedJson, IsWhatPythonWouldWrite) {
  if (!hasPython()) {
    GTEST_SKIP() << "no /usr/bin/python3 here";
  }
  const double infinity = std::numeric_limits<double>::infinity();
  std::vector<PublishedEntry> entries = {valueEntry("quote \" backslash \\ tab \t", infinity),
                                         valueEntry("b", -infinity),
                                         valueEntry("c", std::numeric_limits<double>::quiet_NaN())};
  PublishedEntry curve = valueEntry("numbers", 0);
  curve.value = Curve{{0.1, 1.0 / 3, 1e-4, 1.5e-4, 123456789.0, 0.30000000000000004, 5},
                      {2.0 / 3, 1e15, -0.0, 1e-300, 4.9e-324, 1.7976931348623157e308, 1e22}};
  entries.push_back(curve);
  // Read and written again by Python: number for number and key for key the same objects.
  const std::string output = runPython(
      "import json, sys, math\n"
      "entries = json.load(open(sys.argv[1]))\n"
      "assert [e['name'] for e in entries] == ['quote \" backslash \\\\ tab \\t', 'b', 'c', "
      "'numbers']\n"
      "assert entries[0]['value'] == math.inf and entries[1]['value'] == -math.inf\n"
      "assert math.isnan(entries[2]['value'])\n"
      "v = entries[3]['values']\n"
      "assert v['x'] == [0.1, 1 / 3, 1e-4, 1.5e-4, 123456789.0, 0.1 + 0.2, 5.0], v['x']\n"
      "assert v['y'] == [2 / 3, 1e15, 0.0, 1e-300, 5e-324, 1.7976931348623157e308, 1e22], v['y']\n"
      "assert math.copysign(1, v['y'][2]) == -1\n"
      "assert all(type(x) is float for x in v['x'] + v['y'])\n"
      "assert list(entries[0]) == ['name', 'additional_information', 'value']\n"
      "text = open(sys.argv[1]).read()\n"
      "assert all(repr(x) in text for x in v['x']), text\n"
      "print('same')\n",
      toPublishedJson(entries));
  EXPECT_EQ(output, "same\n");
}

TEST(ResultTable, HasARowForEachSettingAndAColumnForEachName) {
  PublishedEntry precision = valueEntry("precision", 0.5);
  precision.distance = "structural";
  precision.distance_threshold = 5;
  PublishedEntry recall = precision;
  recall.name = "recall";
  recall.value = 0.25;
  recall.confidence_interval = ConfidenceInterval{0.95, 0.2, 0.3};
  PublishedEntry other = precision;
  other.distance_threshold = 10;
  PublishedEntry curve = precision;
  curve.name = "pr_curve";
  curve.value = Curve{{1}, {1}};
  EXPECT_EQ(toTable({precision, recall, other, curve}),
            "distance    distance_threshold  precision                   recall\n"
            "structural                   5     0.5000  0.2500 [0.2000, 0.3000]\n"
            "structural                  10     0.5000                        -\n");
  EXPECT_EQ(toCsv({precision, recall, curve}),
            "name,distance,distance_threshold,score_threshold,step,threshold,value,low,high,"
            "reason\n"
            "precision,structural,5,,,,0.5,,,\n"
            "recall,structural,5,,,,0.25,0.2,0.3,\n");
}

TEST(ResultTable, SaysWhyThereIsNoValue) {
  PublishedEntry precision = valueEntry("precision", 0);
  precision.undefined = "nothing was found";
  precision.confidence_interval = ConfidenceInterval{0.95, 0, 0};
  PublishedEntry score = precision;
  score.name = "fscore";
  PublishedEntry area = valueEntry("area", std::nan(""));
  area.undefined = "no scores";
  const std::vector<PublishedEntry> entries = {precision, valueEntry("recall", 0), score, area};
  EXPECT_EQ(toTable(entries),
            "precision  recall  fscore  area\n        -  0.0000       -     -\n"
            "no value for precision, fscore: nothing was found\nno value for area: no scores\n");
  EXPECT_EQ(toCsv({precision}),
            "name,distance,distance_threshold,score_threshold,step,threshold,value,low,high,"
            "reason\nprecision,,,,,,,,,nothing was found\n");
  EXPECT_NE(toPublishedJson({area}).find("\"value\": NaN"), std::string::npos);
}

TEST(ResultTable, HoldsValuesThatDependOnNothing) {
  EXPECT_EQ(toTable({valueEntry("precision", 1), valueEntry("recall", 0)}),
            "precision  recall\n   1.0000  0.0000\n");
}

}  // namespace
}  // namespace evolin::cli
