// SHA-256 (FIPS 180-4), by which results name the data that they are of.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace evolin {

/// Throws Error where the cryptographic library of the system does not offer SHA-256.
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  Sha256(Sha256&& other) noexcept;
  Sha256& operator=(Sha256&& other) noexcept;

  void add(std::string_view bytes);

  /// The digest of everything added so far, 64 hexadecimal digits in lower case.
  std::string digest() const;

 private:
  class Context;  // OpenSSL's

  std::unique_ptr<Context> context_;
};

/// The digest of a file's content; throws Error naming a file that cannot be read.
std::string sha256OfFile(const std::filesystem::path& file);

}  // namespace evolin
