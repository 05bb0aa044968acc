// Small ONNX files, written byte by byte.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "evolin_ros/base/sha256.h"

namespace evolin::test {

/// The wire format of protocol buffers, as far as ONNX needs it.
namespace onnx {

inline std::string varint(std::uint64_t value) {
  std::string bytes;
  for (; value >= 0x80; value >>= 7U) {
    bytes += static_cast<char>((value & 0x7FU) | 0x80U);
  }
  return bytes + static_cast<char>(value);
}

inline std::string number(unsigned field, std::uint64_t value) {
  return varint(field << 3U) + varint(value);
}

inline std::string bytes(unsigned field, const std::string& content) {
  return varint((field << 3U) | 2U) + varint(content.size()) + content;
}

/// A float tensor with its data.
inline std::string weight(const std::string& name, const std::vector<int>& shape,
                          const std::vector<float>& values) {
  std::string message;
  for (const int side : shape) {
    message += number(1, static_cast<std::uint64_t>(side));
  }
  std::string raw(values.size() * sizeof(float), '\0');
  std::memcpy(raw.data(), values.data(), raw.size());
  return message + number(2, 1) + bytes(8, name) + bytes(9, raw);
}

/// A graph's input or output; a side of -1 is left open.
inline std::string value(const std::string& name, const std::vector<int>& shape) {
  std::string sides;
  for (const int side : shape) {
    sides += bytes(1, side < 0 ? bytes(2, "open") : number(1, static_cast<std::uint64_t>(side)));
  }
  return bytes(1, name) + bytes(2, bytes(1, number(1, 1) + bytes(2, sides)));
}

inline std::string node(const std::string& type, const std::vector<std::string>& inputs,
                        const std::string& output) {
  std::string message;
  for (const std::string& input : inputs) {
    message += bytes(1, input);
  }
  return message + bytes(2, output) + bytes(3, output) + bytes(4, type);
}

/// A whole file; `record` writes the sum of the graph beside it.
inline std::string model(const std::string& graph, bool record = true) {
  Sha256 sum;
  sum.add(graph);
  const std::string property = bytes(14, bytes(1, "evolin.graph_sha256") + bytes(2, sum.digest()));
  return number(1, 4) + bytes(7, graph) + bytes(8, number(2, 9)) + (record ? property : "");
}

/// output = max(0, input) of [1, 3, size, size].
inline std::string reluGraph(int size) {
  return bytes(1, node("Relu", {"image"}, "maps")) + bytes(2, "test") +
         bytes(11, value("image", {1, 3, size, size})) +
         bytes(12, value("maps", {1, 3, size, size}));
}

}  // namespace onnx
}  // namespace evolin::test
