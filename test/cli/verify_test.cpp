// `verify: pose` as a user meets it: in run, associate and benchmark over the built-in sequence.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "associate_command.h"
#include "benchmark_command.h"
#include "run_command.h"
#include "synth_command.h"
#include "test/cli/outcome.h"
#include "test/support/temporary_folder.h"

namespace evolin::cli {
namespace {

using Json = nlohmann::json;
using test::Outcome;

class VerifyTest : public ::testing::Test {
 protected:
  VerifyTest() {
    const Outcome made = runVerb(
        {"synth", "--output", path("room"), "--frames", "8", "--size", "320x240", "--rate", "5"});
    EXPECT_EQ(made.status, kExitDone) << made.err;
  }

  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }

  static Outcome runVerb(const std::vector<std::string>& arguments) {
    return test::runCaptured({synthCommand(), runCommand(), associateCommand(), benchmarkCommand()},
                             arguments);
  }

  Json readReport(const std::string& folder) const {
    std::ifstream stream(path(folder + "/report.json"));
    return Json::parse(stream);
  }

  Json reportOf(const std::string& associator, const std::string& output,
                const std::string& threads) const {
    const Outcome outcome =
        runVerb({"run", "--quiet", "--input", path("room"), "--detector", "hough_p", "--associator",
                 associator, "--metrics", "association", "--bootstrap", "0", "--threads", threads,
                 "--output", path(output)});
    EXPECT_EQ(outcome.status, kExitDone) << outcome.err;
    return readReport(output);
  }

  test::TemporaryFolder folder_;
};

std::string notesOf(const Json& report) { return report.at("notes").dump(); }

TEST_F(VerifyTest, DropsWrongMatchesAndTellsHowMany) {
  const Json alone = reportOf("lbd:cross_check=false", "alone", "1").at("association");
  const Json report = reportOf("lbd:cross_check=false,verify=pose", "verified", "1");
  const Json& verified = report.at("association");
  EXPECT_EQ(verified.at("pairs"), alone.at("pairs"));
  EXPECT_GT(verified.at("precision").get<double>(), alone.at("precision").get<double>());
  EXPECT_GE(verified.at("recall").get<double>(), 0.9 * alone.at("recall").get<double>());
  const std::string notes = notesOf(report);
  EXPECT_NE(notes.find("7 pairs of frames verified"), std::string::npos) << notes;
  EXPECT_NE(verified.at("source"), alone.at("source")) << "another setting, another name";

  const Json again = reportOf("lbd:cross_check=false,verify=pose", "threads", "3");
  EXPECT_EQ(again.at("association"), verified) << "whatever the number of threads";
  EXPECT_EQ(notesOf(again), notes);
}

TEST_F(VerifyTest, APairWithoutAMotionIsEvaluatedWithoutMatches) {
  const Json report = reportOf("random:verify=pose", "chance", "2");
  EXPECT_EQ(report.at("association").at("pairs"), 7);
  EXPECT_EQ(report.at("association").at("recall"), 0);
  EXPECT_NE(notesOf(report).find("7 pairs of frames without a motion"), std::string::npos)
      << notesOf(report);
}

TEST_F(VerifyTest, AssociatePrintsTheCountsAndRefusesWhatIsNoParameter) {
  const std::vector<std::string> verb = {"associate",  "--quiet",  "--input",
                                         path("room"), "--output", path("out")};
  std::vector<std::string> good = verb;
  good.insert(good.end(), {"--associator", "lbd_binary:verify=pose,verify_threshold=2"});
  const Outcome outcome = runVerb(good);
  ASSERT_EQ(outcome.status, kExitDone) << outcome.err;
  EXPECT_NE((outcome.out + outcome.err).find("7 pairs of frames verified"), std::string::npos)
      << outcome.out << outcome.err;
  std::vector<std::string> bad = verb;
  bad.insert(bad.end(), {"--associator", "lbd_binary:verify=pose,verify_treshold=2"});
  const Outcome refused = runVerb(bad);
  EXPECT_EQ(refused.status, kExitFailed);
  EXPECT_NE(refused.err.find("verify_threshold"), std::string::npos) << refused.err;
}

TEST_F(VerifyTest, ABenchmarkHasItAsARowOfItsOwn) {
  folder_.write("matrix.yaml",
                "evaluation: {bootstrap: 0}\n"
                "sequences:\n- {name: room, synthetic: {frames: 8, rate: 5, width: 320, height: "
                "240}}\n"
                "associators:\n- {name: lbd}\n"
                "- {name: lbd_verified, plugin: lbd, parameters: {verify: pose}}\n"
                "settings:\n- {name: truth, metrics: [association]}\n");
  const Outcome outcome =
      runVerb({"benchmark", "--quiet", "--config", path("matrix.yaml"), "--output", path("bench")});
  ASSERT_EQ(outcome.status, kExitDone) << outcome.out << outcome.err;
  const Json alone = readReport("bench/cells/room--none--lbd--truth");
  const Json verified = readReport("bench/cells/room--none--lbd_verified--truth");
  EXPECT_EQ(notesOf(alone).find("verified"), std::string::npos) << notesOf(alone);
  EXPECT_NE(notesOf(verified).find("7 pairs of frames verified"), std::string::npos)
      << notesOf(verified);
  EXPECT_GE(verified.at("association").at("precision").get<double>(),
            alone.at("association").at("precision").get<double>());
}

}  // namespace
}  // namespace evolin::cli
