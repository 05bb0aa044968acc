// Seeded damage to input files, and the claim that a parser answers each with a value or one Error.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <exception>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "evolin_ros/base/error.h"

namespace evolin::test {

/// Makes inputs that no writer of the format would make; the same seed gives the same inputs.
class Fuzzer {
 public:
  explicit Fuzzer(unsigned seed) : random_(seed) {}

  std::size_t below(std::size_t end) {
    return std::uniform_int_distribution<std::size_t>(0, end - 1)(random_);
  }

  std::string randomBytes(std::size_t most) {
    std::string bytes(below(most + 1), '\0');
    for (char& byte : bytes) byte = static_cast<char>(below(256));
    return bytes;
  }

  /// `valid` after one to four changes: bytes replaced, removed, inserted or repeated, a cut,
  /// pieces that parsers stumble on, other line ends, a byte order mark.
  std::string damaged(std::string valid) {
    for (std::size_t left = 1 + below(4); left > 0; --left) damageOnce(&valid);
    return valid;
  }

 private:
  void damageOnce(std::string* text) {
    static const std::vector<std::string> kPieces = {",",
                                                     "\n",
                                                     "\r\n",
                                                     "\n\n",
                                                     " ",
                                                     "\t",
                                                     "nan",
                                                     "inf",
                                                     "-",
                                                     "1e999",
                                                     "0x1p3",
                                                     "1e",
                                                     ".",
                                                     "#",
                                                     "\x80",
                                                     "+-1",
                                                     "--1",
                                                     "1;2",
                                                     "9223372036854775808",
                                                     "1,5",
                                                     std::string(1, '\0'),
                                                     "\xEF\xBB\xBF",
                                                     "\f"};
    const std::size_t at = below(text->size() + 1);
    switch (below(8)) {
      case 0:
        if (at < text->size()) (*text)[at] = static_cast<char>(below(256));
        break;
      case 1:
        text->erase(at, 1 + below(8));
        break;
      case 2:
        text->insert(at, kPieces[below(kPieces.size())]);
        break;
      case 3:
        text->insert(at, text->substr(below(text->size() + 1), below(40)));
        break;
      case 4:
        text->resize(at);
        break;
      case 5:
        text->insert(at, std::string(below(5000), static_cast<char>('0' + below(10))));
        break;
      case 6:
        for (std::size_t i = text->find('\n'); i != std::string::npos;
             i = text->find('\n', i + 2)) {
          text->insert(i, "\r");
        }
        break;
      default:
        text->insert(0, "\xEF\xBB\xBF");
    }
  }

  std::mt19937 random_;
};

/// How many inputs a parser took and how many it refused.
struct FuzzCounts {
  std::size_t values = 0;
  std::size_t errors = 0;
};

/// Runs `parse`; fails the test for any exception that is not an evolin::Error.
template <typename Parse>
void countAnswer(const Parse& parse, std::string_view input, FuzzCounts* counts) {
  try {
    parse();
    ++counts->values;
  } catch (const Error& error) {
    ++counts->errors;
    EXPECT_FALSE(std::string_view(error.what()).empty());
  } catch (const std::exception& other) {
    ADD_FAILURE() << "not an evolin::Error but '" << other.what() << "' for "
                  << ::testing::PrintToString(std::string(input.substr(0, 200)));
  }
}

}  // namespace evolin::test
