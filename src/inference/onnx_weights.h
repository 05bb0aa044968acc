// The weights of an ONNX file: whether each has the elements that its shape asks for.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace evolin {

constexpr std::uintmax_t kLargestOnnxFile = 2147483647;  ///< bytes: what protocol buffers allow
constexpr std::uint64_t kLargestOnnxSide = 1U << 24U;    ///< of a tensor

/// The name of a TensorProto (ONNX: onnx.proto3) whose elements are all there, in the message
/// itself and of a type that networks of ours have. Throws protobuf::Malformed for any other.
std::string nameOfWholeWeight(std::string_view message);

}  // namespace evolin
