// Counting what a TensorProto holds; field numbers are those of onnx.proto3.
#include "onnx_weights.h"

#include "evolin_ros/base/text.h"
#include "protobuf_reader.h"

namespace evolin {
namespace {

using protobuf::Field;
using protobuf::Malformed;
using protobuf::Reader;
using protobuf::visitNumbers;
using protobuf::Wire;

constexpr std::uint64_t kInThisFile = 0;  // of TensorProto.DataLocation

/// Bytes of one element of TensorProto.DataType; 0 for the types that networks of ours never have.
std::uint64_t elementSize(std::uint64_t type) {
  switch (type) {
    case 1:   // float
    case 6:   // int32
    case 12:  // uint32
      return 4;
    case 2:  // uint8
    case 3:  // int8
    case 9:  // bool
      return 1;
    case 4:   // uint16
    case 5:   // int16
    case 10:  // float16
      return 2;
    case 7:   // int64
    case 11:  // double
    case 13:  // uint64
      return 8;
    default:
      return 0;
  }
}

/// Where a TensorProto keeps its elements besides `raw_data`.
enum class TypedData : std::uint32_t {
  kNone = 0,
  kFloats = 4,
  kInt32s = 5,  ///< and whatever is shorter
  kInt64s = 7,
  kDoubles = 10,
  kUint64s = 11  ///< and uint32
};

TypedData typedDataOf(std::uint64_t type) {
  switch (type) {
    case 1:
      return TypedData::kFloats;
    case 7:
      return TypedData::kInt64s;
    case 11:
      return TypedData::kDoubles;
    case 12:
    case 13:
      return TypedData::kUint64s;
    default:
      return elementSize(type) > 0 ? TypedData::kInt32s : TypedData::kNone;
  }
}

/// Elements in such a field, packed or one by one.
std::uint64_t elementsIn(const Field& field, TypedData data) {
  if (data == TypedData::kFloats || data == TypedData::kDoubles) {
    const std::uint64_t size = data == TypedData::kFloats ? 4 : 8;
    const Wire single = data == TypedData::kFloats ? Wire::kFixed32 : Wire::kFixed64;
    if (field.wire == single) {
      return 1;
    }
    if (field.wire != Wire::kBytes || field.bytes.size() % size != 0) {
      throw Malformed("weights that are no whole numbers of elements");
    }
    return field.bytes.size() / size;
  }
  if (field.wire != Wire::kBytes && field.wire != Wire::kVarint) {
    throw Malformed("weights that are no whole numbers");
  }
  std::uint64_t count = 0;
  visitNumbers(field, [&count](std::uint64_t) { ++count; });
  return count;
}

}  // namespace

std::string nameOfWholeWeight(std::string_view message) {
  Reader reader(message);
  Field field;
  std::string name;
  std::uint64_t elements = 1;
  std::uint64_t type = 0;
  TypedData typed = TypedData::kNone;
  std::uint64_t typed_elements = 0;
  std::uint64_t raw_bytes = 0;
  while (reader.next(&field)) {
    switch (field.number) {
      case 1:
        visitNumbers(field, [&elements](std::uint64_t side) {
          if (side > kLargestOnnxSide || elements * side > kLargestOnnxFile) {
            throw Malformed("a weight too large to be true");
          }
          elements *= side;
        });
        break;
      case 2:
        type = field.value;
        break;
      case static_cast<std::uint32_t>(TypedData::kFloats):
      case static_cast<std::uint32_t>(TypedData::kInt32s):
      case static_cast<std::uint32_t>(TypedData::kInt64s):
      case static_cast<std::uint32_t>(TypedData::kDoubles):
      case static_cast<std::uint32_t>(TypedData::kUint64s):
        if (typed != TypedData::kNone && typed != static_cast<TypedData>(field.number)) {
          throw Malformed("a weight with elements of two types");
        }
        typed = static_cast<TypedData>(field.number);
        typed_elements += elementsIn(field, typed);
        break;
      case 8:
        name = field.bytes;
        break;
      case 9:
        raw_bytes = field.bytes.size();
        break;
      case 14:
        if (field.wire == Wire::kVarint && field.value == kInThisFile) {
          break;
        }
        [[fallthrough]];
      case 13:
        throw Malformed("weights in other files, which are not supported");
      default:
        break;
    }
  }
  const std::uint64_t size = elementSize(type);
  if (size == 0) {
    throw Malformed("the weight " + quote(name) + " is of type " + std::to_string(type) +
                    ", which is not supported");
  }
  if (typed_elements > 0 && (raw_bytes > 0 || typed != typedDataOf(type))) {
    throw Malformed("the weight " + quote(name) +
                    " has elements besides its bytes, or of another type than its own");
  }
  if (typed_elements > 0 ? typed_elements != elements : raw_bytes != elements * size) {
    throw Malformed("the weight " + quote(name) + " has " +
                    (typed_elements > 0 ? std::to_string(typed_elements) + " elements"
                                        : std::to_string(raw_bytes) + " bytes") +
                    " instead of " +
                    std::to_string(typed_elements > 0 ? elements : elements * size));
  }
  return name;
}

}  // namespace evolin
