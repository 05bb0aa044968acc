// The figures under the paths that docs/WATCHING.md gives to rqt_plot, read as a user reads them:
// by rostopic echo.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <future>
#include <optional>

#include "evolin_ros/base/text.h"
#include "online_stream.h"
#include "test/support/drawn_sequence.h"

namespace evolin::test {
namespace {

constexpr char kDocumentedSpace[] = "/evolin";

/// "TOPIC/a:b" names the fields a and b. Of all rqt_plot lines of the document.
std::vector<std::string> documentedFields() {
  const std::filesystem::path document =
      std::filesystem::path(EVOLIN_SOURCE_DIR) / "docs" / "WATCHING.md";
  std::vector<std::string> fields;
  for (const std::string& line : readLines(document)) {
    const std::vector<std::string_view> words = splitWords(line);
    if (words.size() < 2 || words[0] != "rqt_plot") {
      continue;
    }
    const std::vector<std::string_view> names = split(words[1], ':');
    const std::string first(names[0]);
    fields.push_back(first);
    for (std::size_t i = 1; i < names.size(); ++i) {
      fields.push_back(first.substr(0, first.rfind('/') + 1) + std::string(names[i]));
    }
  }
  return fields;
}

/// The first number that rostopic echo prints; whatever else it prints is a failure.
double echo(const std::string& path) {
  // catkin's environment of tests is written before there is a folder of Python messages, and then
  // lacks it for as long as the build lives.
  const std::string command = "PYTHONPATH='" EVOLIN_PYTHON_DIR "':\"$PYTHONPATH\" timeout " +
                              std::to_string(static_cast<int>(kPatience)) + " rostopic echo -n1 '" +
                              path + "' 2>&1";
  FILE* const pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) {
    ADD_FAILURE() << "cannot run: " << command;
    return NAN;
  }
  std::string output;
  std::array<char, 256> part{};
  while (std::fgets(part.data(), part.size(), pipe) != nullptr) {
    output += part.data();
  }
  const int status = pclose(pipe);
  const std::vector<std::string_view> lines = split(output, '\n');
  const std::optional<double> value = parseDouble(lines[0]);
  EXPECT_EQ(status, 0) << command << "\n" << output;
  EXPECT_TRUE(value) << command << "\n" << output;
  return value.value_or(NAN);
}

/// The paths of the document below another namespace.
std::string in(const std::string& space, const std::string& field) {
  return space + field.substr(std::string(kDocumentedSpace).size());
}

std::map<std::string, double> echoAll(const std::string& space,
                                      const std::vector<std::string>& fields) {
  constexpr std::size_t kAtOnce = 4;
  std::map<std::string, double> values;
  for (std::size_t begin = 0; begin < fields.size(); begin += kAtOnce) {
    std::map<std::string, std::future<double>> answers;
    for (std::size_t i = begin; i < std::min(begin + kAtOnce, fields.size()); ++i) {
      answers.emplace(fields[i], std::async(std::launch::async, echo, in(space, fields[i])));
    }
    for (auto& [field, answer] : answers) {
      values[field] = answer.get();
    }
  }
  return values;
}

TEST(OnlinePlot, EveryDocumentedFigureIsANumberAtItsPlace) {
  const std::vector<SequenceFrame> frames = drawSequence();
  Bench bench;
  ASSERT_TRUE(bench.play(frames));
  bench.call("finish");
  const nlohmann::json report = bench.report();

  const std::vector<std::string> fields = documentedFields();
  ASSERT_GE(fields.size(), 20U);
  for (const std::string& field : fields) {
    ASSERT_EQ(field.rfind(std::string(kDocumentedSpace) + "/", 0), 0U) << field;
  }
  const std::map<std::string, double> values = echoAll(bench.space(), fields);
  const nlohmann::json& structural = report.at("detection").at("entries").at(3);
  EXPECT_EQ(structural.at("distance"), "structural");
  EXPECT_EQ(structural.at("threshold"), 5);
  const std::string detection = "/evolin/metrics/detection/cumulative/entries[3]/";
  const std::string association = "/evolin/metrics/association/cumulative/entries[0]/";
  for (const char* figure : {"precision", "recall", "f_score"}) {
    EXPECT_NEAR(values.at(detection + figure), structural.at(figure).get<double>(), 1e-9);
    EXPECT_GT(values.at(detection + figure), 0);
    EXPECT_NEAR(values.at(association + figure), report.at("association").at(figure).get<double>(),
                1e-9);
  }
  EXPECT_EQ(values.at("/evolin/coverage/evaluated"), static_cast<double>(frames.size()));
  EXPECT_EQ(values.at("/evolin/coverage/seen"), static_cast<double>(frames.size()));
  EXPECT_GT(values.at("/evolin/metrics/heatmap/cumulative/entries[0]/f_score"), 0);
}

/// The texts between single quotes.
std::vector<std::string> quotedIn(const std::string& text) {
  const std::vector<std::string_view> pieces = split(text, '\'');
  std::vector<std::string> quoted;
  for (std::size_t i = 1; i < pieces.size(); i += 2) {
    quoted.emplace_back(pieces[i]);
  }
  return quoted;
}

TEST(OnlinePlot, ThePerspectiveShowsDocumentedFigures) {
  const nlohmann::json perspective =
      readReport(std::filesystem::path(EVOLIN_SOURCE_DIR) / "rviz" / "evaluate.perspective");
  const nlohmann::json& manager = perspective.at("groups").at("pluginmanager");
  const auto setting = [&](const std::string& plugin, const std::string& key) {
    const nlohmann::json& keys =
        manager.at("groups").at(plugin).at("groups").at("plugin").at("keys");
    EXPECT_EQ(keys.at(key).at("type"), "repr");
    return quotedIn(keys.at(key).at("repr"));
  };
  EXPECT_EQ(manager.at("keys").at("running-plugins").at("repr"),
            "{'rqt_image_view/ImageView': [1], 'rqt_plot/Plot': [1, 2]}");
  EXPECT_EQ(setting("plugin__rqt_image_view__ImageView__1", "topic"),
            std::vector<std::string>{std::string(kDocumentedSpace) + "/overlay"});
  const std::vector<std::string> documented = documentedFields();
  for (const char* plugin : {"plugin__rqt_plot__Plot__1", "plugin__rqt_plot__Plot__2"}) {
    const std::vector<std::string> topics = setting(plugin, "topics");
    EXPECT_GE(topics.size(), 2U);
    for (const std::string& topic : topics) {
      EXPECT_EQ(std::count(documented.begin(), documented.end(), topic), 1) << topic;
    }
  }
}

TEST(OnlinePlot, FiguresOfAFrameCanBeFollowed) {
  Bench bench;
  std::future<double> answer = std::async(
      std::launch::async, echo, bench.space() + "/metrics/detection/frame/entries[3]/f_score");
  ASSERT_TRUE(bench.manager().waitForListener("metrics/detection/frame"));
  ASSERT_TRUE(bench.play({drawFrame({}, 0)}));
  const double value = answer.get();
  EXPECT_GE(value, 0);
  EXPECT_LE(value, 1);
}

}  // namespace
}  // namespace evolin::test
