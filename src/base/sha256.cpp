// OpenSSL's, which takes the processor's own instructions where it has them.
#include "evolin_ros/base/sha256.h"

#include <openssl/evp.h>

#include <array>
#include <fstream>
#include <utility>
#include <vector>

#include "evolin_ros/base/error.h"

namespace evolin {

namespace {

/// OpenSSL's functions return 1.
void check(int result) {
  if (result != 1) {
    throw Error("SHA-256: OpenSSL does not offer it here; expected a build that does");
  }
}

}  // namespace

class Sha256::Context {
 public:
  Context() : context_(EVP_MD_CTX_new()) {
    check(context_ != nullptr ? 1 : 0);
    check(EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr));
  }

  Context(const Context& other) : context_(EVP_MD_CTX_new()) {
    check(context_ != nullptr ? 1 : 0);
    check(EVP_MD_CTX_copy_ex(context_.get(), other.context_.get()));
  }

  Context& operator=(const Context&) = delete;

  void add(std::string_view bytes) {
    check(EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size()));
  }

  /// Nothing may be added any more.
  std::string finish() {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned size = 0;
    check(EVP_DigestFinal_ex(context_.get(), digest.data(), &size));
    constexpr char kDigits[] = "0123456789abcdef";
    std::string text;
    for (unsigned i = 0; i < size; ++i) {
      text += {kDigits[digest[i] >> 4U], kDigits[digest[i] & 0xfU]};
    }
    return text;
  }

 private:
  struct Free {
    void operator()(EVP_MD_CTX* context) const { EVP_MD_CTX_free(context); }
  };

  std::unique_ptr<EVP_MD_CTX, Free> context_;
};

Sha256::Sha256() : context_(std::make_unique<Context>()) {}
Sha256::~Sha256() = default;
Sha256::Sha256(Sha256&& other) noexcept = default;
Sha256& Sha256::operator=(Sha256&& other) noexcept = default;

void Sha256::add(std::string_view bytes) { context_->add(bytes); }

std::string Sha256::digest() const { return Context(*context_).finish(); }

std::string sha256OfFile(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::vector<char> buffer(1U << 18U);  // stays in the processor's cache
  Sha256 hash;
  while (stream) {
    stream.read(buffer.data(), static_cast<std::streamsize>(buffer.size()));
    hash.add({buffer.data(), static_cast<std::size_t>(stream.gcount())});
  }
  if (!stream.eof()) {
    throw Error(file.string() + ": cannot be read");
  }
  return hash.digest();
}

}  // namespace evolin
