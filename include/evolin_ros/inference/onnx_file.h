// What an ONNX file says about itself before anybody runs it: inputs, outputs, and whether its
// bytes are those that its maker wrote.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace evolin {

/// A network's input or output. A side is -1 where the file leaves it open (a batch of any size).
struct TensorInfo {
  std::string name;
  std::vector<int> shape;
};

/// "'maps' [1, 5, 256, 256]"; an open side is '?'.
std::string toText(const TensorInfo& tensor);

struct OnnxFile {
  std::vector<std::uint8_t> bytes;  ///< the whole file
  std::vector<TensorInfo> inputs;   ///< without the weights that old files list among them
  std::vector<TensorInfo> outputs;
  std::string digest;           ///< SHA-256 of the whole file
  std::string graph_digest;     ///< SHA-256 of its graph
  std::string recorded_digest;  ///< what the metadata property `evolin.graph_sha256` says, or ""

  /// Whether the maker recorded a sum of the graph and the graph still has it.
  bool isAsRecorded() const { return !recorded_digest.empty() && recorded_digest == graph_digest; }
};

/// Reads the file and follows its structure (ONNX: onnx.proto3) through all nodes and weights of
/// the graph: every node's inputs are the graph's inputs, weights or outputs of earlier nodes, and
/// every weight has as many bytes, or elements of its type, as its shape asks for. Graphs within a
/// node (branches, loops) are not followed. Throws ParseError naming the file for anything else,
/// for a file cut short, a folder, or one above 2 GB.
OnnxFile readOnnxFile(const std::filesystem::path& file);

}  // namespace evolin
