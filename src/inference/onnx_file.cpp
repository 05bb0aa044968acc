// Following an ONNX file's structure; field numbers are those of onnx.proto3.
#include "evolin_ros/inference/onnx_file.h"

#include <algorithm>
#include <fstream>
#include <set>
#include <string_view>

#include "evolin_ros/base/error.h"
#include "evolin_ros/base/sha256.h"
#include "evolin_ros/base/text.h"
#include "onnx_weights.h"
#include "protobuf_reader.h"

namespace evolin {
namespace {

using protobuf::Field;
using protobuf::Malformed;
using protobuf::Reader;
using protobuf::visitNumbers;
using protobuf::Wire;

constexpr const char* kDigestProperty = "evolin.graph_sha256";

std::string digestOf(std::string_view bytes) {
  Sha256 sum;
  sum.add(bytes);
  return sum.digest();
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
          weights_.insert(nameOfWholeWeight(field.bytes));
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
        nameOfWholeWeight(field.bytes);
      } else if (field.number == 8 && field.wire == Wire::kBytes) {  // whole numbers
        visitNumbers(field, [](std::uint64_t) {});
      }
    }
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
        if (field.value > kLargestOnnxSide) {
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
  if (size == 0 || size > kLargestOnnxFile) {
    throw ParseError(file.string(), 0,
                     "has " + std::to_string(size) + " bytes; expected an ONNX file of at most " +
                         std::to_string(kLargestOnnxFile));
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
