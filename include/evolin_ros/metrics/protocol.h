// Which of the two rule books a figure follows.
#pragma once

#include <string>

namespace evolin {

/// kEvolin reproduces the published Python library (2023), kPaper follows the article's formulas
/// where the two differ.
enum class Protocol { kEvolin, kPaper };

/// "evolin" or "paper".
std::string toString(Protocol protocol);

/// Throws Error naming the value and the accepted ones.
Protocol parseProtocol(const std::string& text);

}  // namespace evolin
