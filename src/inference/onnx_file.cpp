// Following an ONNX file's structure; field numbers are those of onnx.proto3.
#include "evolin_ros/inference/onnx_file.h"

#include <algorithm>
#include <fstream>
#include <set>
#include <string_view>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/sha256.h"
#include "evolin_ros/base/text.h"
#include "protobuf_reader.h"

namespace evolin {
namespace {

using protobuf::Field;
using protobuf::Malformed;
using protobuf::Reader;
using protobuf::Wire;

constexpr std::uintmax_t kLargestFile = 2147483647;  // what protocol buffers allow
constexpr std::uint64_t kLargestSide = 1U << 24U;
constexpr const char* kDigestProperty = "evolin.graph_sha256";

std::string digestOf(std::string_view bytes) {
  Sha256 sum;
  sum.add(bytes);
  return sum.digest();
}

std::vector<std::uint64_t> numbersOf(const Field& field) {
  std::vector<std::uint64_t> numbers;
  if (field.wire != Wire::kBytes) {
    numbers.push_back(field.value);
    return numbers;
  }
  Reader packed(field.bytes);
  while (!packed.atEnd()) {
    numbers.push_back(packed.varint());
  }
  return numbers;
}

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
  return numbersOf(field).size();
}

/// Follows a GraphProto.
class Graph {
 public:
  explicit Graph(OnnxFile* file) : file_(file) {}

  void read(std::string_view message) {
    Reader reader(message);
    Field field;
    std::vector<std::string_view> nodes;
    while (reader.next(&field)) {
      switch (field.number) {
        case 1:
          nodes.push_back(field.bytes);
          break;
        case 5:
          weights_.insert(weight(field.bytes));
          break;
        case 11:
          file_->inputs.push_back(valueInfo(field.bytes));
          break;
        case 12:
          file_->outputs.push_back(valueInfo(field.bytes));
          break;
        default:
          break;
      }
    }
    std::vector<TensorInfo>* inputs = &file_->inputs;
    inputs->erase(
        std::remove_if(inputs->begin(), inputs->end(),
                       [this](const TensorInfo& input) { return weights_.count(input.name) > 0; }),
        inputs->end());
    for (const TensorInfo& input : *inputs) {
      known_.insert(input.name);
    }
    known_.insert(weights_.begin(), weights_.end());
    for (const std::string_view node : nodes) {
      readNode(node);
    }
    for (const TensorInfo& output : file_->outputs) {
      if (known_.count(output.name) == 0) {
        throw Malformed("nothing makes the output " + quote(output.name));
      }
    }
    if (nodes.empty() || inputs->empty() || file_->outputs.empty()) {
      throw Malformed("a graph without nodes, inputs or outputs");
    }
  }

 private:
  void readNode(std::string_view message) {
    Reader reader(message);
    Field field;
    std::vector<std::string> made;
    std::string type;
    std::size_t inputs = 0;
    while (reader.next(&field)) {
      if (field.number == 1) {
        const std::string name(field.bytes);
        // An optional input that is left out has no name.
        if (!name.empty() && known_.count(name) == 0) {
          throw Malformed("a node takes " + quote(name) + ", which nothing before it makes");
        }
        ++inputs;
      } else if (field.number == 2) {
        made.emplace_back(field.bytes);
      } else if (field.number == 4) {
        type = field.bytes;
      } else if (field.number == 5) {
        readAttribute(field.bytes);
      }
    }
    if (type.empty() || made.empty() || (inputs == 0 && type != "Constant")) {
      throw Malformed("a node without a type, inputs or outputs");
    }
    known_.insert(made.begin(), made.end());
  }

  void readAttribute(std::string_view message) {
    Reader reader(message);
    Field field;
    while (reader.next(&field)) {
      if (field.number == 5 || field.number == 10) {  // a tensor, and several
        weight(field.bytes);
      } else if (field.number == 8 && field.wire == Wire::kBytes) {  // whole numbers
        numbersOf(field);
      }
    }
  }

  /// The name of a TensorProto whose data are complete.
  std::string weight(std::string_view message) {
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
          for (const std::uint64_t side : numbersOf(field)) {
            if (side > kLargestSide || elements * side > kLargestFile) {
              throw Malformed("a weight too large to be true");
            }
            elements *= side;
          }
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
        case 13:
        case 14:
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

  /// ValueInfoProto {name, type {tensor {element type, shape {side {value | name}}}}}
  static TensorInfo valueInfo(std::string_view message) {
    TensorInfo info;
    Field field;
    for (Reader reader(message); reader.next(&field);) {
      if (field.number == 1) {
        info.name = field.bytes;
      } else if (field.number == 2) {
        readType(field.bytes, &info);
      }
    }
    return info;
  }

  static void readType(std::string_view message, TensorInfo* info) {
    Field field;
    for (Reader type(message); type.next(&field);) {
      if (field.number != 1) {
        throw Malformed("the tensor " + quote(info->name) + " is none");
      }
      for (Reader tensor(field.bytes); tensor.next(&field);) {
        if (field.number != 2) {
          continue;
        }
        for (Reader shape(field.bytes); shape.next(&field);) {
          if (field.number == 1) {
            info->shape.push_back(readSide(field.bytes));
          }
        }
      }
    }
  }

  static int readSide(std::string_view message) {
    int side = -1;
    Field field;
    for (Reader reader(message); reader.next(&field);) {
      if (field.number == 1 && field.value > 0) {
        if (field.value > kLargestSide) {
          throw Malformed("a tensor too large to be true");
        }
        side = static_cast<int>(field.value);
      }
    }
    return side;
  }

  OnnxFile* file_;
  std::set<std::string> weights_;
  std::set<std::string> known_;
};

void readProperty(std::string_view message, OnnxFile* file) {
  std::string key;
  std::string value;
  Field field;
  for (Reader reader(message); reader.next(&field);) {
    if (field.number == 1) {
      key = field.bytes;
    } else if (field.number == 2) {
      value = field.bytes;
    }
  }
  if (key == kDigestProperty) {
    file->recorded_digest = value;
  }
}

std::vector<std::uint8_t> readBytes(const std::filesystem::path& file) {
  std::error_code reason;
  const std::uintmax_t size = std::filesystem::file_size(file, reason);
  if (reason) {
    throw ParseError(file.string(), 0, "cannot be read: " + reason.message());
  }
  if (size == 0 || size > kLargestFile) {
    throw ParseError(file.string(), 0,
                     "has " + std::to_string(size) + " bytes; expected an ONNX file of at most " +
                         std::to_string(kLargestFile));
  }
  std::vector<std::uint8_t> bytes(size);
  std::ifstream stream(file, std::ios::binary);
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): streams know only char
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  if (!stream) {
    throw ParseError(file.string(), 0, "cannot be read");
  }
  return bytes;
}

}  // namespace

std::string toText(const TensorInfo& tensor) {
  std::string text = quote(tensor.name) + " [";
  for (std::size_t i = 0; i < tensor.shape.size(); ++i) {
    text += (i == 0 ? "" : ", ");
    text += tensor.shape[i] < 0 ? "?" : std::to_string(tensor.shape[i]);
  }
  return text + "]";
}

OnnxFile readOnnxFile(const std::filesystem::path& file) {
  OnnxFile onnx;
  onnx.bytes = readBytes(file);
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): text and bytes are one here
  const std::string_view message(reinterpret_cast<const char*>(onnx.bytes.data()),
                                 onnx.bytes.size());
  onnx.digest = digestOf(message);
  try {
    std::size_t graphs = 0;
    Field field;
    for (Reader model(message); model.next(&field);) {
      if (field.number == 7 && field.wire == Wire::kBytes) {
        if (++graphs > 1) {
          throw Malformed("more than one graph");
        }
        onnx.graph_digest = digestOf(field.bytes);
        Graph(&onnx).read(field.bytes);
      } else if (field.number == 14) {
        readProperty(field.bytes, &onnx);
      }
    }
    if (graphs == 0) {
      throw Malformed("no graph in it");
    }
  } catch (const Malformed& error) {
    throw ParseError(file.string(), 0,
                     std::string("is no whole ONNX file (") + error.what() +
                         "); it may be cut short or damaged: get it again");
  }
  return onnx;
}

}  // namespace evolin
