// Digests change with what is in files and with their names, and with nothing else.
#include "evolin_ros/benchmarking/digest_cache.h"

#include <gtest/gtest.h>

#include <chrono>

#include "evolin_ros/base/sha256.h"
#include "test/support/expect_error.h"
#include "test/support/temporary_folder.h"

namespace evolin {
namespace {

namespace fs = std::filesystem;
using Places = std::vector<fs::path>;

class DigestCacheTest : public ::testing::Test {
 protected:
  std::string digest(const std::string& name) {
    return DigestCache(folder_.path() / "digests.txt").digestOf(Places{folder_.path() / name});
  }

  /// Long ago, so that the digest may be remembered.
  static void age(const fs::path& file) {
    fs::last_write_time(file, fs::file_time_type::clock::now() - std::chrono::hours(1));
  }

  test::TemporaryFolder folder_;
};

TEST_F(DigestCacheTest, AFolderIsItsFilesByNameAndContent) {
  folder_.write("a/one.txt", "1");
  folder_.write("a/sub/two.txt", "2");
  const std::string first = digest("a");
  folder_.write("b/one.txt", "1");
  folder_.write("b/sub/two.txt", "2");
  folder_.write("b/.hidden", "x");
  folder_.write("b/.git/x", "x");
  EXPECT_EQ(digest("b"), first) << "wherever it stands, without hidden files";
  folder_.write("b/sub/two.txt", "3");
  EXPECT_NE(digest("b"), first);
  folder_.write("b/sub/two.txt", "2");
  fs::rename(folder_.path() / "b/one.txt", folder_.path() / "b/uno.txt");
  EXPECT_NE(digest("b"), first);
  fs::rename(folder_.path() / "b/uno.txt", folder_.path() / "b/one.txt");
  EXPECT_EQ(digest("b"), first);
  fs::remove(folder_.path() / "b/one.txt");
  EXPECT_NE(digest("b"), first);
}

TEST_F(DigestCacheTest, WhatIsRememberedIsNotReadAgainUnlessItChanged) {
  const fs::path file = folder_.write("data.bag", "first");
  age(file);
  const fs::file_time_type time = fs::last_write_time(file);
  {
    DigestCache cache(folder_.path() / "digests.txt");
    EXPECT_EQ(cache.digestOf(file), sha256OfFile(file));
    cache.save();
  }
  // Of the same size and time: only a cache that does not read it can miss the change.
  folder_.write("data.bag", "other");
  fs::last_write_time(file, time);
  DigestCache again(folder_.path() / "digests.txt");
  EXPECT_NE(again.digestOf(file), sha256OfFile(file));
  age(file);
  EXPECT_EQ(again.digestOf(file), sha256OfFile(file)) << "another time: read again";
}

TEST_F(DigestCacheTest, FilesOfThisMomentAreNotRemembered) {
  const fs::path file = folder_.write("data.bag", "first");
  {
    DigestCache cache(folder_.path() / "digests.txt");
    cache.digestOf(file);
    cache.save();
  }
  EXPECT_EQ(fs::file_size(folder_.path() / "digests.txt"), 0U);
}

TEST_F(DigestCacheTest, ABrokenCacheIsNoCache) {
  folder_.write("digests.txt", "nonsense\n" + std::string(70, 'x') + "\n\n");
  const fs::path file = folder_.write("data.bag", "first");
  EXPECT_EQ(DigestCache(folder_.path() / "digests.txt").digestOf(file), sha256OfFile(file));
}

TEST_F(DigestCacheTest, WhatIsNotThereIsNamed) {
  test::expectError([&] { digest("nowhere"); }, {"nowhere", "not there"});
}

}  // namespace
}  // namespace evolin
