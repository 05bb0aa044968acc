// `evolin benchmark` as a user meets it: the reports of 'evolin run', nothing done twice, failures
// told, and a benchmark that is killed again and again ending where an undisturbed one does.
#include <gtest/gtest.h>

#include <chrono>
#include <random>
#include <thread>

#include "child_process.h"
#include "render_command.h"
#include "run_command.h"
#include "synth_command.h"
#include "test/cli/benchmark_fixture.h"

namespace evolin::cli {
namespace {

namespace fs = std::filesystem;
using test::BenchmarkTest;
using test::figuresOf;
using test::Outcome;
using test::readJson;

TEST_F(BenchmarkTest, ACellIsARunOfItsOwn) {
  writeMatrix(small_);
  const Outcome outcome = run("out", {"--jobs", "2"});
  ASSERT_EQ(outcome.status, kExitDone) << outcome.err;
  EXPECT_NE(outcome.out.find("5 cells: 5 finished"), std::string::npos) << outcome.out;
  EXPECT_TRUE(fs::exists(path("out/benchmark.txt")));
  EXPECT_EQ(entries("out/detections"), (std::set<std::string>{"room--lsd", "room--segments"}));

  ASSERT_EQ(test::runCaptured({synthCommand()}, {"synth", "--output", path("room"), "--frames", "6",
                                                 "--size", "160x120"})
                .status,
            kExitDone);
  const Outcome alone = test::runCaptured(
      {runCommand()},
      {"run", "--input", path("room"), "--output", path("run"), "--detector", "lsd", "--associator",
       "lbd", "--associate", "detected", "--metrics", "association,pose", "--bootstrap", "20",
       "--set", "repeatability_steps=[1]", "--threads", "3"});
  ASSERT_EQ(alone.status, kExitDone) << alone.err;
  const Json of_cell = report("out", "room--lsd--lbd--poses");
  const Json of_run = readJson(path("run/report.json"));
  EXPECT_EQ(figuresOf(of_cell), figuresOf(of_run));
  EXPECT_EQ(of_cell.at("provenance").at("parameters").at("detector"), "lsd");
  EXPECT_EQ(entries("out/cells").size(), 5U) << "nothing hidden is left";
  std::set<std::string> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(path("run"))) {
    files.insert(entry.path().filename().string());
  }
  files.insert("cell.json");
  std::set<std::string> files_of_cell;
  for (const fs::directory_entry& entry :
       fs::directory_iterator(path("out/cells/room--lsd--lbd--poses"))) {
    files_of_cell.insert(entry.path().filename().string());
  }
  EXPECT_EQ(files_of_cell, files);

  const Json record = cell("out", "room--segments--none--lines");
  EXPECT_EQ(record.at("state"), "finished");
  EXPECT_EQ(record.at("detector"), "segments");
  EXPECT_EQ(record.at("content_hash").get<std::string>().size(), 64U);
  EXPECT_TRUE(record.at("error").is_null());
  // The times are those of the detection, not of reading its files.
  const Json timing = report("out", "room--lsd--none--lines").at("timing").at("detector");
  EXPECT_EQ(timing.at("frames"), 6);
  EXPECT_EQ(timing, report("out", "room--lsd--lbd--poses").at("timing").at("detector"));
}

TEST_F(BenchmarkTest, OnlyWhatIsMissingOrChangedRunsAgain) {
  writeMatrix(small_);
  ASSERT_EQ(run("out", {"--quiet"}).status, kExitDone);
  const auto first = figures("out");
  Outcome again = run("out");
  EXPECT_EQ(again.status, kExitDone);
  EXPECT_EQ(again.err, "") << "nothing was to be done";
  fs::remove_all(path("out/cells/room--lsd--none--lines"));
  again = run("out");
  EXPECT_NE(again.err.find("[1/1] room--lsd--none--lines finished"), std::string::npos)
      << again.err;
  std::string changed = small_;
  changed.replace(changed.find("name: truth"), 11, "name: truth, evaluation: {protocol: paper}");
  writeMatrix(changed);
  again = run("out");
  EXPECT_NE(again.err.find("[1/1] room--none--lbd--truth finished"), std::string::npos)
      << again.err;
  EXPECT_EQ(report("out", "room--none--lbd--truth").at("protocol"), "paper");
  writeMatrix(small_);
  ASSERT_EQ(run("out").status, kExitDone);
  EXPECT_EQ(figures("out"), first);
  folder_.write("out/detections/room--lsd/lines/0000.csv", "1,2,30,40\n");
  folder_.write("out/detections/room--lsd/scores/0000.csv", "1\n");
  const Outcome alone = run("out", {"--force", "--cell", "room--lsd--none--lines"});
  EXPECT_NE(alone.err.find("[1/1] room--lsd--none--lines finished"), std::string::npos)
      << alone.err;
  EXPECT_NE(figures("out"), first) << "the lines that are there";
  again = run("out", {"--force"});
  EXPECT_NE(again.err.find("[7/7]"), std::string::npos)
      << "five cells, two detections: " << again.err;
  EXPECT_EQ(figures("out"), first) << "the lines are found anew";
}

TEST_F(BenchmarkTest, AChangedInputIsAnotherContent) {
  ASSERT_EQ(test::runCaptured({synthCommand()}, {"synth", "--output", path("room"), "--frames", "3",
                                                 "--size", "96x72"})
                .status,
            kExitDone);
  writeMatrix(
      "sequences: [{name: room, path: room}]\ndetectors: [hough_p]\n"
      "settings: [{name: s, metrics: [detection]}]\n");
  ASSERT_EQ(run("out").status, kExitDone);
  const Json before = cell("out", "room--hough_p--none--s").at("content_hash");
  EXPECT_EQ(run("out").err, "");
  fs::copy_file(path("room/images/0000.png"), path("room/images/0001.png"),
                fs::copy_options::overwrite_existing);
  ASSERT_EQ(run("out").status, kExitDone);
  EXPECT_NE(cell("out", "room--hough_p--none--s").at("content_hash"), before);
}

TEST_F(BenchmarkTest, WhatFailsAndWhatIsNotThereIsToldAndKeepsNothingBack) {
  ASSERT_EQ(test::runCaptured({synthCommand()}, {"synth", "--output", path("broken"), "--frames",
                                                 "3", "--size", "96x72"})
                .status,
            kExitDone);
  folder_.write("broken/images/0001.png", "no picture");
  writeMatrix(
      "sequences:\n- {name: broken, path: broken}\n"
      "- {name: room, synthetic: {frames: 3, width: 96, height: 72}}\n"
      "- {name: absent, path: nowhere}\n"
      "detectors: [lsd, {name: theirs, recorded: 'theirs/{sequence}'}, lsdd,\n"
      "  {name: network, plugin: mlsd, parameters: {model: none.onnx}}]\n"
      "settings: [{name: s, metrics: [detection]}]\n");
  const Outcome outcome = run("out");
  EXPECT_EQ(outcome.status, kExitFailed);
  EXPECT_EQ(states("out"),
            (std::map<std::string, std::string>{{"absent--lsd--none--s", "unavailable"},
                                                {"absent--lsdd--none--s", "unavailable"},
                                                {"absent--network--none--s", "unavailable"},
                                                {"absent--theirs--none--s", "unavailable"},
                                                {"broken--lsd--none--s", "failed"},
                                                {"broken--lsdd--none--s", "unavailable"},
                                                {"broken--network--none--s", "unavailable"},
                                                {"broken--theirs--none--s", "unavailable"},
                                                {"room--lsd--none--s", "finished"},
                                                {"room--lsdd--none--s", "unavailable"},
                                                {"room--network--none--s", "unavailable"},
                                                {"room--theirs--none--s", "unavailable"}}));
  EXPECT_NE(outcome.out.find("failed  broken--lsd--none--s: detection broken--lsd: "),
            std::string::npos)
      << outcome.out;
  EXPECT_NE(outcome.out.find("0001.png"), std::string::npos) << outcome.out;
  // Two pieces of the broken sequence, one of which never began, and three of the whole one.
  EXPECT_NE(outcome.err.find("[5/5]"), std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.err.find("[6/"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.out.find("did you mean 'lsd'?"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("nowhere is not there"), std::string::npos) << outcome.out;
  EXPECT_EQ(cell("out", "broken--lsd--none--s").at("state"), "failed");
  EXPECT_NE(cell("out", "room--theirs--none--s").at("error").get<std::string>().find("theirs/room"),
            std::string::npos);

  // Lines of another program take the place of a plug-in; a failed cell is tried again.
  fs::create_directories(path("theirs"));
  fs::copy(path("out/detections/room--lsd"), path("theirs/room"), fs::copy_options::recursive);
  const Outcome again = run("out");
  EXPECT_EQ(again.status, kExitFailed);
  EXPECT_NE(again.err.find("detection broken--lsd FAILED"), std::string::npos) << again.err;
  const Json theirs = report("out", "room--theirs--none--s");
  EXPECT_EQ(theirs.at("detection").at("entries"),
            report("out", "room--lsd--none--s").at("detection").at("entries"));
  EXPECT_EQ(theirs.at("timing").at("detector"),
            report("out", "room--lsd--none--s").at("timing").at("detector"));

  // Pictures are of the same lines; of lines that are gone only a plug-in can be asked again.
  const auto render = [this](const std::string& id) {
    return test::runCaptured({renderCommand()}, {"render", "--run", path("out/cells/" + id), "-q",
                                                 "--output", path("pictures")});
  };
  const Outcome pictures = render("room--theirs--none--s");
  EXPECT_EQ(pictures.status, kExitDone) << pictures.err;
  EXPECT_NE(pictures.out.find("3 pictures"), std::string::npos) << pictures.out;
  fs::remove_all(path("theirs"));
  const Outcome gone = render("room--theirs--none--s");
  EXPECT_EQ(gone.status, kExitFailed);
  EXPECT_NE(gone.err.find("theirs/room, which is not there any more"), std::string::npos)
      << gone.err;
  fs::remove_all(path("out/detections"));
  const Outcome anew = render("room--lsd--none--s");
  EXPECT_EQ(anew.status, kExitDone) << anew.err;
}

TEST_F(BenchmarkTest, ListAndCellLetOthersRunTheMatrix) {
  writeMatrix(small_);
  Outcome outcome = run("out", {"--list"});
  EXPECT_EQ(outcome.status, kExitDone);
  EXPECT_FALSE(fs::exists(path("out"))) << "listing makes nothing";
  EXPECT_NE(outcome.out.find("room--none--lbd--truth       pending"), std::string::npos)
      << outcome.out;
  outcome = run("out", {"--detection", "room--lsd", "--quiet"});
  ASSERT_EQ(outcome.status, kExitDone) << outcome.err;
  EXPECT_EQ(entries("out/detections"), std::set<std::string>{"room--lsd"});
  for (const char* id : {"room--lsd--lbd--poses", "room--none--lbd--truth"}) {
    ASSERT_EQ(run("out", {"--cell", id, "--quiet"}).status, kExitDone);
  }
  const Json list = Json::parse(run("out", {"--list", "--format", "json"}).out);
  std::map<std::string, std::string> states;
  for (const Json& cell : list.at("cells")) {
    states[cell.at("id")] = cell.at("state");
    EXPECT_EQ(cell.at("content_hash").get<std::string>().size(), 64U);
  }
  EXPECT_EQ(states.at("room--lsd--lbd--poses"), "finished");
  EXPECT_EQ(states.at("room--lsd--none--lines"), "pending");
  EXPECT_EQ(list.at("cells").at(0).at("detection"), "room--lsd");
  EXPECT_EQ(list.at("detections").at(0).at("made"), true);
  EXPECT_EQ(list.at("detections").at(1).at("made"), false);
  outcome = run("out", {"--collect"});
  EXPECT_NE(outcome.out.find("5 cells: 2 finished, 3 pending"), std::string::npos) << outcome.out;
  EXPECT_EQ(this->states("out"), states);
}

TEST_F(BenchmarkTest, RefusalsNameWhatIsWrong) {
  writeMatrix(small_);
  const auto expectStatus = [](const Outcome& outcome, int status, const std::string& word) {
    EXPECT_EQ(outcome.status, status) << outcome.err;
    EXPECT_NE(outcome.err.find(word), std::string::npos) << outcome.err;
  };
  expectStatus(run("out", {"--cell", "room--lsd--none--line"}), kExitWrongUse,
               "did you mean 'room--lsd--none--lines'?");
  expectStatus(run("out", {"--jobs", "-1"}), kExitWrongUse, "--jobs");
  expectStatus(run("out", {"--list", "--collect"}), kExitWrongUse, "at most one");
  expectStatus(run("out", {"--collect", "--force"}), kExitWrongUse, "--force");
  expectStatus(run("out", {"--detection", "room--lsd", "--force"}), kExitWrongUse, "--force");
  expectStatus(run("out", {"--list", "--format", "xml"}), kExitWrongUse, "'xml'");
  folder_.write("precious/file.txt", "x");
  expectStatus(run("precious"), kExitFailed, "benchmark.txt");
  std::string wrong = small_;
  wrong.replace(wrong.find("label: LSD"), 10, "parameters: {scael: 2}");
  writeMatrix(wrong);
  expectStatus(run("out"), kExitFailed, "'scale'");
  expectStatus(run("out"), kExitFailed, "matrix.yaml:5");
}

TEST_F(BenchmarkTest, CtrlCKeepsWhatIsDone) {
  writeMatrix(small_);
  // In a process of its own, which may be sent signals.
  ChildProcess benchmark([&] {
    return std::to_string(runProgram({benchmarkCommand()}, command("out", {"--quiet"})));
  });
  const fs::path first = folder_.path() / "out/cells/room--lsd--none--lines/cell.json";
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!fs::exists(first)) {
    ASSERT_LT(std::chrono::steady_clock::now(), deadline) << "no cell was finished in a minute";
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  benchmark.interrupt();
  while (!benchmark.advance()) {
  }
  EXPECT_EQ(benchmark.result().text, std::to_string(kExitInterrupted));
  EXPECT_TRUE(fs::exists(first));
  const Outcome rest = run("out");
  EXPECT_EQ(rest.status, kExitDone) << rest.err;
  EXPECT_EQ(figures("out").size(), 5U);
}

TEST_F(BenchmarkTest, KilledFiveTimesItEndsWithTheSameFigures) {
  writeMatrix(small_);
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_EQ(run("undisturbed", {"--quiet"}).status, kExitDone);
  const std::chrono::duration<double> whole = std::chrono::steady_clock::now() - begin;
  const auto seed = static_cast<unsigned>(begin.time_since_epoch().count());
  RecordProperty("seed", std::to_string(seed));
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> moment(0, whole.count() / 3);
  for (int kill = 0; kill < 5; ++kill) {
    // ~ChildProcess kills it, and the system its own children with it.
    ChildProcess benchmark([&] {
      return std::to_string(
          runProgram({benchmarkCommand()}, command("killed", {"--quiet", "--jobs", "2"})));
    });
    std::this_thread::sleep_for(std::chrono::duration<double>(moment(random)));
  }
  const Outcome last = run("killed", {"--quiet"});
  ASSERT_EQ(last.status, kExitDone) << last.err << " seed " << seed;
  EXPECT_EQ(figures("killed"), figures("undisturbed")) << "seed " << seed;
  EXPECT_EQ(entries("killed/cells"), entries("undisturbed/cells")) << "nothing hidden is left";
  EXPECT_EQ(entries("killed/detections"), entries("undisturbed/detections"));
}

}  // namespace
}  // namespace evolin::cli
