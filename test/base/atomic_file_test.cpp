// Claims about files that are there as a whole or not at all.
#include "evolin_ros/base/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include "evolin_ros/base/error.h"
#include "test/support/temporary_folder.h"

namespace evolin {
namespace {

std::string contentOf(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::vector<std::string> namesIn(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

using Names = std::vector<std::string>;

/// Lets no file of the process grow past `bytes`, the way a full disk does.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit = {bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  void (*handler_)(int);
  rlimit before_{};
};

TEST(WriteFileAtomically, WritesTheBytesAndNothingElse) {
  const test::TemporaryFolder folder;
  const std::string bytes("a\0\r\nb", 5);
  writeFileAtomically(folder.path() / "report.json", bytes);
  EXPECT_EQ(contentOf(folder.path() / "report.json"), bytes);
  EXPECT_EQ(namesIn(folder.path()), Names{"report.json"});
  writeFileAtomically(folder.path() / "report.json", "");
  EXPECT_EQ(contentOf(folder.path() / "report.json"), "");
}

TEST(WriteFileAtomically, MakesMissingFolders) {
  const test::TemporaryFolder folder;
  writeFileAtomically(folder.path() / "a" / "b" / "c.csv", "1");
  EXPECT_EQ(contentOf(folder.path() / "a" / "b" / "c.csv"), "1");
}

TEST(WriteFileAtomically, GoesThroughALinkedFolder) {
  const test::TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "real");
  std::filesystem::create_directory_symlink(folder.path() / "real", folder.path() / "link");
  writeFileAtomically(folder.path() / "link" / "c.csv", "1");
  EXPECT_EQ(contentOf(folder.path() / "real" / "c.csv"), "1");
}

TEST(WriteFileAtomically, GivesThePermissionsOfAnyNewFile) {
  const test::TemporaryFolder folder;
  const mode_t mask = umask(022);
  writeFileAtomically(folder.path() / "f", "1");
  umask(mask);
  struct stat status {};
  ASSERT_EQ(stat((folder.path() / "f").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0644U);
}

TEST(WriteFileAtomically, TakesALongNameAndOneWithoutExtension) {
  const test::TemporaryFolder folder;
  const std::string name(250, 'n');
  writeFileAtomically(folder.path() / name, "1");
  EXPECT_EQ(namesIn(folder.path()), Names{name});
}

TEST(WriteFileAtomically, NamesTheFileAndTheReason) {
  const test::TemporaryFolder folder;
  const std::filesystem::path blocker = folder.write("blocker", "x");
  const std::filesystem::path target = blocker / "f.csv";
  try {
    writeFileAtomically(target, "1");
    FAIL() << "wrote below a file";
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()),
              target.string() + ": cannot make its folder: Not a directory");
  }
  std::filesystem::create_directory(folder.path() / "taken");
  try {
    writeFileAtomically(folder.path() / "taken", "1");
    FAIL() << "wrote over a folder";
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()),
              (folder.path() / "taken").string() + ": cannot be written: Is a directory");
  }
  EXPECT_THROW(writeFileAtomically("", "1"), Error);
  EXPECT_THROW(writeFileAtomically(folder.path() / "", "1"), Error);
  EXPECT_THROW(writeFileAtomically(folder.path() / "..", "1"), Error);
  EXPECT_EQ(namesIn(folder.path()), (Names{"blocker", "taken"}));
}

TEST(WriteFileAtomically, LeavesTheOldFileWhenTheDiskIsFull) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.write("report.json", "old");
  {
    const FileSizeLimit limit(4096);
    try {
      writeFileAtomically(file, std::string(100000, 'x'));
      FAIL() << "wrote past the limit";
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()), file.string() + ": cannot be written: File too large");
    }
  }
  EXPECT_EQ(contentOf(file), "old");
  EXPECT_EQ(namesIn(folder.path()), Names{"report.json"});
}

TEST(WriteFileAtomically, NeverShowsAPartToAReader) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "report.json";
  const std::size_t size = 200000;
  writeFileAtomically(file, std::string(size, '0'));
  std::atomic<bool> done{false};
  std::vector<std::thread> writers;
  for (const char digit : {'1', '2'}) {
    writers.emplace_back([&, digit] {
      for (int i = 0; i < 100; ++i) writeFileAtomically(file, std::string(size, digit));
      done = true;
    });
  }
  int reads = 0;
  do {
    const std::string content = contentOf(file);
    EXPECT_EQ(content, std::string(size, content.empty() ? '?' : content[0]));
    ++reads;
  } while (!done && !::testing::Test::HasFailure());
  for (std::thread& writer : writers) writer.join();
  EXPECT_GT(reads, 0);
  EXPECT_EQ(namesIn(folder.path()), Names{"report.json"});
}

TEST(TemporaryFile, AppearsUnderTheFinalNameOnCommitOnly) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "out.bag";
  TemporaryFile temporary(file);
  EXPECT_EQ(temporary.path().parent_path(), folder.path());
  EXPECT_EQ(temporary.path().extension(), ".bag");
  std::ofstream(temporary.path()) << "content";
  EXPECT_FALSE(std::filesystem::exists(file));
  temporary.commit();
  EXPECT_EQ(contentOf(file), "content");
  EXPECT_EQ(namesIn(folder.path()), Names{"out.bag"});
}

TEST(TemporaryFile, GoesAwayWithoutCommit) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.write("out.bag", "old");
  {
    TemporaryFile temporary(file);
    std::ofstream(temporary.path()) << "half";
  }
  EXPECT_EQ(contentOf(file), "old");
  EXPECT_EQ(namesIn(folder.path()), Names{"out.bag"});
}

TEST(TemporaryFile, HasItsOwnNameEachTime) {
  const test::TemporaryFolder folder;
  const TemporaryFile one(folder.path() / "f.csv");
  const TemporaryFile two(folder.path() / "f.csv");
  EXPECT_NE(one.path(), two.path());
}

TEST(TemporaryFile, ThrowsWhenTheRenameFails) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "f.csv";
  {
    TemporaryFile temporary(file);
    std::filesystem::create_directory(file);
    EXPECT_THROW(temporary.commit(), Error);
  }
  EXPECT_EQ(namesIn(folder.path()), Names{"f.csv"});
}

}  // namespace
}  // namespace evolin
