// Cells of a matrix, and what its file is refused for.
#include "evolin_ros/benchmarking/matrix.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "evolin_ros/evaluation/evaluation_settings.h"
#include "test/support/expect_error.h"
#include "test/support/plugin_names.h"
#include "test/support/temporary_folder.h"

namespace evolin {
namespace {

using test::expectError;

class MatrixTest : public ::testing::Test {
 protected:
  BenchmarkMatrix read(const std::string& text) const {
    return readBenchmarkMatrix(folder_.write("matrix.yaml", text), {});
  }

  void expectRefusal(const std::string& text, std::initializer_list<std::string> words) const {
    expectError<ParseError>([&] { read(text); }, words);
  }

  static std::vector<std::string> ids(const BenchmarkMatrix& matrix) {
    std::vector<std::string> ids;
    for (const BenchmarkCell& cell : matrix.cells) {
      ids.push_back(cell.id);
    }
    return ids;
  }

  static std::vector<std::string> metricsOf(const BenchmarkCell& cell) {
    return cell.evaluation["metrics"].as<std::vector<std::string>>();
  }

  test::TemporaryFolder folder_;
  const std::string room_ = "sequences:\n- {name: room, synthetic: {frames: 3}}\n";
};

TEST_F(MatrixTest, CellsAreEveryCombinationThatMeasuresSomethingOfItsOwn) {
  const BenchmarkMatrix matrix = read(room_ +
                                      "detectors: [a, b]\nassociators: [x, y]\nsettings:\n"
                                      "- {name: lines, metrics: [detection, tracks]}\n"
                                      "- {name: truth, metrics: [association]}\n"
                                      "- {name: all, metrics: [pose], associate: detected}\n");
  EXPECT_EQ(ids(matrix), (std::vector<std::string>{"room--a--none--lines", "room--b--none--lines",
                                                   "room--none--x--truth", "room--none--y--truth",
                                                   "room--a--x--all", "room--a--y--all",
                                                   "room--b--x--all", "room--b--y--all"}));
  EXPECT_EQ(metricsOf(matrix.cells[0]), (std::vector<std::string>{"detection", "tracks"}));
}

TEST_F(MatrixTest, ASequenceNamesWhatMayBeAskedOfIt) {
  const BenchmarkMatrix matrix = read(
      "sequences:\n- {name: one, path: here, metrics: [detection, association]}\n"
      "- {name: two, path: there}\n"
      "detectors: [a]\nassociators: [x]\nsettings:\n"
      "- {name: s, metrics: [detection, repeatability, pose]}\n- {name: p, metrics: [pose]}\n");
  EXPECT_EQ(ids(matrix),
            (std::vector<std::string>{"one--a--none--s", "two--a--x--s", "two--none--x--p"}));
  EXPECT_EQ(metricsOf(matrix.cells[0]), std::vector<std::string>{"detection"});
}

TEST_F(MatrixTest, WithoutSettingsThereIsOneOfEverythingThatMethodsAllow) {
  const BenchmarkMatrix lines = read(room_ + "detectors: [a]\n");
  ASSERT_EQ(ids(lines), std::vector<std::string>{"room--a--none--all"});
  EXPECT_EQ(metricsOf(lines.cells[0]),
            (std::vector<std::string>{"detection", "heatmap", "repeatability", "tracks"}));
  EXPECT_EQ(ids(read(room_ + "associators: [x]\n")),
            std::vector<std::string>{"room--none--x--all"});
}

TEST_F(MatrixTest, SettingsChooseSequencesAndMethodsByName) {
  const BenchmarkMatrix matrix = read(
      "sequences:\n- {name: one, path: a}\n- {name: two, path: b}\n"
      "detectors: [a, b, c]\nsettings:\n"
      "- {name: s, metrics: [detection], detectors: [c, a], sequences: [two]}\n");
  EXPECT_EQ(ids(matrix), (std::vector<std::string>{"two--a--none--s", "two--c--none--s"}));
}

TEST_F(MatrixTest, ThresholdsOfADetectorGoWhereTheyBelong) {
  const std::string methods =
      "detectors:\n- {name: a, score_thresholds: {repeatability: 0.8, pose: 0.7}}\n- b\n"
      "associators: [x]\n";
  const BenchmarkMatrix matrix = read(room_ + methods +
                                      "settings:\n"
                                      "- {name: lines, metrics: [detection, repeatability]}\n"
                                      "- {name: poses, metrics: [pose], associate: detected}\n"
                                      "- {name: truth, metrics: [pose]}\n");
  ASSERT_EQ(matrix.cells.size(), 5U);
  const BenchmarkCell& lines = matrix.cells[0];
  EXPECT_EQ(lines.evaluation["repeatability_score_thresholds"].as<std::vector<double>>(),
            std::vector<double>{0.8});
  EXPECT_TRUE(lines.selection.keepsAll()) << "detection counts every line";
  EXPECT_FALSE(matrix.cells[1].evaluation["repeatability_score_thresholds"]);
  EXPECT_EQ(matrix.cells[2].selection.score_threshold, 0.7);
  EXPECT_TRUE(matrix.cells[3].selection.keepsAll()) << "b has none";
  EXPECT_TRUE(matrix.cells[4].selection.keepsAll()) << "the ground truth's lines";
  expectError(
      [&] {
        read(room_ + methods +
             "settings:\n- {name: s, metrics: [detection, pose], associate: detected}\n");
      },
      {"matrix.yaml:8", "'s'", "'a'", "a setting of its own"});
}

TEST_F(MatrixTest, TheNearerParameterWins) {
  const BenchmarkMatrix matrix = read(
      room_ +
      "evaluation: {bootstrap: 5, protocol: paper, frame_step: 2}\n"
      "detectors:\n- {name: a, evaluation: {heatmap_score_thresholds: [1, 2], frame_step: 4}}\n"
      "settings:\n- {name: s, metrics: [heatmap], evaluation: {bootstrap: 7, frame_step: 3}}\n");
  const YAML::Node& evaluation = matrix.cells[0].evaluation;
  EXPECT_EQ(evaluation["bootstrap"].as<int>(), 7);
  EXPECT_EQ(evaluation["protocol"].as<std::string>(), "paper");
  EXPECT_EQ(evaluation["frame_step"].as<int>(), 4);
  EXPECT_EQ(evaluation["heatmap_score_thresholds"].size(), 2U);
}

TEST_F(MatrixTest, InputsAreToldInTheWordsOfTheCommandLine) {
  const BenchmarkMatrix matrix = read(
      "sequences:\n- {name: f, path: data/f, pose_offset: -1, camera: icl, allow_missing: true,\n"
      "   same_rows: false, ground_truth: gt}\n- {name: b, bags: [a.bag, /b.bag]}\n"
      "detectors: [{name: d, recorded: 'out/{sequence}', label: D}]\n");
  const BenchmarkSequence& sequence = matrix.sequences[0];
  EXPECT_EQ(sequence.inputs.at(0), folder_.path() / "data/f");
  using Options = std::vector<std::pair<std::string, std::string>>;
  EXPECT_EQ(sequence.options, (Options{{"camera", "icl"},
                                       {"pose-offset", "-1"},
                                       {"ground-truth", (folder_.path() / "gt").string()},
                                       {"allow-missing", ""}}));
  EXPECT_EQ(matrix.sequences[1].inputs.at(0), folder_.path() / "a.bag");
  EXPECT_EQ(matrix.sequences[1].inputs.at(1), "/b.bag");
  EXPECT_EQ(matrix.detectors[0].plugin, "") << "recorded alone";
  EXPECT_EQ(matrix.detectors[0].recorded, (folder_.path() / "out/{sequence}").string());
  EXPECT_EQ(readBenchmarkMatrix(folder_.path() / "matrix.yaml", "/d").sequences[0].inputs.at(0),
            "/d/data/f");
}

TEST_F(MatrixTest, RefusalsNameLineKeyValueAndWhatWasExpected) {
  expectRefusal("sequences:\n- {name: r, synthetic: {frames: many}}\ndetectors: [a]\n",
                {"matrix.yaml:2", "'frames'", "'many'", "a whole number"});
  expectRefusal(room_ + "detectors:\n- name: a\n  labl: A\n",
                {"matrix.yaml:5", "'labl'", "'label'"});
  expectRefusal(room_ + "detectors: [a]\nsettings:\n- name: s\n  metrics: [speed]\n",
                {"matrix.yaml:6", "'speed'", "detection"});
  expectRefusal(room_ + "detectors: [a]\nevaluation:\n  bootstrap: -1\n",
                {"matrix.yaml:5", "'bootstrap'", "'-1'", "from 0"});
  expectRefusal(room_ + "detectors:\n- name: a\n  evaluation: {metrics: [pose]}\n",
                {"matrix.yaml:5", "metrics"});
  expectRefusal(room_ + "detectors: [a, b, a]\n", {"matrix.yaml:3", "'a'", "another"});
  expectRefusal(room_ + "detectors: [a--b]\n", {"matrix.yaml:3", "'a--b'"});
  expectRefusal(room_ + "detectors: [none]\n", {"'none'"});
  expectRefusal(room_ + "detectors: [../a]\n", {"'../a'"});
  expectRefusal(room_ + "detectors: a\n", {"matrix.yaml:3", "expected a list"});
  expectRefusal(room_ + "detectors: [a]\nsettings: [{name: s, detectors: [b]}]\n",
                {"matrix.yaml:4", "'b'", "'a'"});
  expectRefusal(room_ + "detectors: [a]\nsettings: [{name: s, detectors: [a, a]}]\n", {"twice"});
  expectRefusal(room_ + "detectors: [a]\nsettings: [{name: s, metrics: [pose]}]\n",
                {"matrix.yaml:4", "associators", "pose"});
  expectRefusal("detectors: [a]\n", {"sequences"});
  expectRefusal("sequences: [{name: r, path: x, synthetic: {}}]\n", {"matrix.yaml:1", "one of"});
  expectRefusal("sequences: [r]\n", {"matrix.yaml:1", "'path'"});
  expectRefusal("sequences: [{name: r, path: x, metrics: [pose]}]\ndetectors: [a]\n",
                {"has no cell"});
  expectRefusal("- 1\n", {"expected a map"});
}

std::set<std::string> pluginsOf(const std::vector<BenchmarkMethod>& methods) {
  std::set<std::string> names;
  for (const BenchmarkMethod& method : methods) {
    names.insert(method.plugin);
  }
  return names;
}

/// The methods of a plug-in description; what plays recorded results is none.
std::set<std::string> shippedPlugins(const std::string& file) {
  std::set<std::string> names =
      test::pluginNames(std::filesystem::path(EVOLIN_SOURCE_DIR) / "plugins" / file);
  EXPECT_EQ(names.erase("recorded"), 1U) << file;
  return names;
}

TEST_F(MatrixTest, ShippedMatricesAreWhole) {
  const std::filesystem::path folder =
      std::filesystem::path(EVOLIN_SOURCE_DIR) / "config" / "benchmark";
  const BenchmarkMatrix quick = readBenchmarkMatrix(folder / "quick.yaml", {});
  EXPECT_TRUE(quick.sequences.at(0).synthetic);
  EXPECT_EQ(pluginsOf(quick.detectors), shippedPlugins("detectors.xml"));
  EXPECT_EQ(pluginsOf(quick.associators), shippedPlugins("associators.xml"));
  const BenchmarkMatrix article = readBenchmarkMatrix(folder / "article.yaml", "/data");
  EXPECT_EQ(article.sequences.size(), 4U);
  EXPECT_GE(article.detectors.size(), 17U);
  EXPECT_EQ(article.associators.size(), 5U);
  std::size_t poses = 0;
  for (const BenchmarkMatrix* matrix : {&quick, &article}) {
    for (const BenchmarkCell& cell : matrix->cells) {
      ParameterReader reader(cell.evaluation, cell.id);
      readEvaluationSettings(&reader, cell.id, 0);
      EXPECT_NO_THROW(reader.finish()) << cell.id;
    }
  }
  for (const BenchmarkCell& cell : article.cells) {
    const std::vector<std::string> metrics = metricsOf(cell);
    const bool pose = std::find(metrics.begin(), metrics.end(), "pose") != metrics.end();
    poses += pose ? 1 : 0;
    EXPECT_FALSE(pose && article.sequences[cell.sequence].name == "fr1_desk");
    if (pose && detectorName(article, cell) == "hawp") {
      EXPECT_EQ(cell.selection.score_threshold, 0.7);
    }
  }
  EXPECT_EQ(poses, 3U * 3U * 5U) << "sequences, detectors, associators";
}

}  // namespace
}  // namespace evolin
