// Digests that other programs give, too.
#include "evolin_ros/base/sha256.h"

#include <gtest/gtest.h>

#include "test/support/expect_error.h"
#include "test/support/temporary_folder.h"

namespace evolin {
namespace {

std::string digestOf(const std::string& text) {
  Sha256 hash;
  hash.add(text);
  return hash.digest();
}

/// The standard's own examples, and lengths around that of a block.
TEST(Sha256, KnownDigests) {
  EXPECT_EQ(digestOf(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(digestOf("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(digestOf("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(digestOf(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, PiecesMakeTheWhole) {
  std::string text;
  for (int i = 0; i < 300; ++i) {
    text += static_cast<char>(i);
  }
  for (const std::size_t piece : {1, 63, 64, 65, 128, 200}) {
    Sha256 hash;
    for (std::size_t at = 0; at < text.size(); at += piece) {
      hash.add(std::string_view(text).substr(at, piece));
    }
    EXPECT_EQ(hash.digest(), digestOf(text)) << piece;
    EXPECT_EQ(hash.digest(), digestOf(text)) << "asked twice";
  }
}

TEST(Sha256, OfAFile) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(sha256OfFile(folder.write("abc", "abc")), digestOf("abc"));
  const std::string large(3000001, 'x');
  EXPECT_EQ(sha256OfFile(folder.write("large", large)), digestOf(large));
  test::expectError([&] { sha256OfFile(folder.path() / "none"); }, {"none", "cannot be read"});
}

}  // namespace
}  // namespace evolin
