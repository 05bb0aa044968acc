// SHA-256 (FIPS 180-4), by which results name the data that they are of.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace evolin {

class Sha256 {
 public:
  void add(std::string_view bytes);

  /// The digest of everything added so far, 64 hexadecimal digits in lower case.
  std::string digest() const;

 private:
  void addBlock(const std::uint8_t* block);

  std::array<std::uint32_t, 8> state_ = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                         0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<std::uint8_t, 64> rest_ = {};  ///< of a block that is not full yet
  std::size_t rest_size_ = 0;
  std::uint64_t size_ = 0;  ///< bytes
};

/// The digest of a file's content; throws Error naming a file that cannot be read.
std::string sha256OfFile(const std::filesystem::path& file);

}  // namespace evolin
