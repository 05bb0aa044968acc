// Folders of reports: new ones never shared, given ones of one owner, old passes removed.
#include "report_keeper.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <future>
#include <set>

#include "evolin_ros/evaluation/pass_evaluation.h"
#include "test/support/expect_error.h"
#include "test/support/temporary_folder.h"

namespace evolin::ros_shell {
namespace {

namespace fs = std::filesystem;

Report reportOfPass(int pass) {
  const PassEvaluation pass_evaluation{PassOptions()};
  Report report = pass_evaluation.report(true);
  report.pass = pass;
  return report;
}

/// ~ is elsewhere for as long as this lives.
class Home {
 public:
  Home() : before_(std::getenv("HOME") == nullptr ? "" : std::getenv("HOME")) {
    setenv("HOME", folder_.path().c_str(), 1);
  }
  ~Home() { setenv("HOME", before_.c_str(), 1); }
  Home(const Home&) = delete;
  Home& operator=(const Home&) = delete;

  fs::path path() const { return folder_.path(); }

 private:
  test::TemporaryFolder folder_;
  std::string before_;
};

TEST(ReportKeeper, NodesOfTheSameSecondHaveFoldersOfTheirOwn) {
  const Home home;
  std::vector<std::future<std::unique_ptr<ReportKeeper>>> starts;
  for (int i = 0; i < 8; ++i) {
    starts.push_back(std::async(std::launch::async, [i] {
      return std::make_unique<ReportKeeper>("", i % 2 == 0 ? "/a/judge" : "/b/judge");
    }));
  }
  std::vector<std::unique_ptr<ReportKeeper>> keepers;
  std::set<fs::path> folders;
  for (auto& start : starts) {
    keepers.push_back(start.get());
    EXPECT_TRUE(folders.insert(keepers.back()->folder()).second) << keepers.back()->folder();
    EXPECT_EQ(keepers.back()->folder().parent_path(), home.path() / ".ros" / "evolin_ros");
    EXPECT_FALSE(keepers.back()->replacesEarlier());
    EXPECT_NE(keepers.back()->folder().filename().string().find("_judge"), std::string::npos);
  }
}

TEST(ReportKeeper, AFolderHasOneOwnerAtATime) {
  const test::TemporaryFolder folder;
  auto first = std::make_unique<ReportKeeper>(folder.path().string(), "/first");
  test::expectError<Error>([&] { ReportKeeper(folder.path().string(), "/second"); },
                           {folder.path().string(), "/first (process ", "for /second alone"});
  first.reset();
  EXPECT_TRUE(fs::is_empty(folder.path()));
  EXPECT_NO_THROW(ReportKeeper(folder.path().string(), "/second"));
}

TEST(ReportKeeper, TheOneThatComesWaitsForTheOneThatGoes) {
  const test::TemporaryFolder folder;
  auto first = std::make_unique<ReportKeeper>(folder.path().string(), "/first");
  auto second = std::async(
      std::launch::async, [&] { return ReportKeeper(folder.path().string(), "/second").folder(); });
  EXPECT_EQ(second.wait_for(std::chrono::milliseconds(200)), std::future_status::timeout);
  first.reset();
  EXPECT_EQ(second.get(), folder.path());
}

TEST(ReportKeeper, EarlierPassesGoWithTheFirstWritingAndNothingElse) {
  const test::TemporaryFolder folder;
  {
    ReportKeeper keeper(folder.path().string(), "/run");
    keeper.write(reportOfPass(1), 3);
    keeper.write(reportOfPass(2), 3);
    keeper.write(reportOfPass(3), 3);
  }
  std::ofstream(folder.path() / "pass_2" / "mine.txt") << "kept";
  fs::create_directory(folder.path() / "pass_by");
  ReportKeeper keeper(folder.path().string(), "/run");
  EXPECT_TRUE(keeper.replacesEarlier());
  EXPECT_TRUE(fs::exists(folder.path() / "pass_1" / "report.json"));
  EXPECT_EQ(keeper.write(reportOfPass(1), 1), folder.path() / "report.json");
  EXPECT_FALSE(fs::exists(folder.path() / "pass_1"));
  EXPECT_FALSE(fs::exists(folder.path() / "pass_2" / "report.json"));
  EXPECT_TRUE(fs::exists(folder.path() / "pass_2" / "mine.txt"));
  EXPECT_TRUE(fs::exists(folder.path() / "pass_by"));

  keeper.write(reportOfPass(1), 2);
  keeper.write(reportOfPass(2), 2);
  EXPECT_TRUE(fs::exists(folder.path() / "pass_1" / "report.json"));
  keeper.startOver();
  keeper.write(reportOfPass(1), 1);
  EXPECT_FALSE(fs::exists(folder.path() / "pass_1"));
}

}  // namespace
}  // namespace evolin::ros_shell
