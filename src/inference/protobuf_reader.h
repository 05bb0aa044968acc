// Steps through one message in protocol buffers' wire format.
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

namespace evolin::protobuf {

/// The bytes are no message of that format.
class Malformed : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Wire types of the format.
enum class Wire : std::uint8_t { kVarint = 0, kFixed64 = 1, kBytes = 2, kFixed32 = 5 };

struct Field {
  std::uint32_t number = 0;
  Wire wire = Wire::kVarint;
  std::uint64_t value = 0;  ///< of the number types
  std::string_view bytes;   ///< of kBytes: points into the message
};

/// Reads a field at a time; throws Malformed where the bytes end early or make no sense.
class Reader {
 public:
  explicit Reader(std::string_view message) : rest_(message) {}

  /// False at the end.
  bool next(Field* field) {
    if (rest_.empty()) {
      return false;
    }
    const std::uint64_t tag = varint();
    if ((tag >> 3U) == 0 || (tag >> 3U) > 0x1FFFFFFFU) {
      throw Malformed("no valid field number");
    }
    field->number = static_cast<std::uint32_t>(tag >> 3U);
    field->wire = static_cast<Wire>(tag & 7U);
    field->bytes = {};
    field->value = 0;
    switch (field->wire) {
      case Wire::kVarint:
        field->value = varint();
        return true;
      case Wire::kFixed64:
        field->value = fixed(8);
        return true;
      case Wire::kFixed32:
        field->value = fixed(4);
        return true;
      case Wire::kBytes:
        field->bytes = take(varint());
        return true;
    }
    throw Malformed("no valid wire type");
  }

  /// The numbers of a packed field's bytes, or of the whole reader.
  std::uint64_t varint() {
    std::uint64_t value = 0;
    for (unsigned shift = 0; shift < 64; shift += 7) {
      const auto byte = static_cast<std::uint8_t>(take(1).front());
      value |= static_cast<std::uint64_t>(byte & 0x7FU) << shift;
      if ((byte & 0x80U) == 0) {
        return value;
      }
    }
    throw Malformed("a number of more than ten bytes");
  }

  bool atEnd() const { return rest_.empty(); }

 private:
  std::string_view take(std::uint64_t size) {
    if (size > rest_.size()) {
      throw Malformed("ends " + std::to_string(size - rest_.size()) + " bytes early");
    }
    const std::string_view taken = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return taken;
  }

  std::uint64_t fixed(std::size_t size) {
    const std::string_view bytes = take(size);
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < size; ++i) {
      value |= static_cast<std::uint64_t>(static_cast<std::uint8_t>(bytes[i])) << (8 * i);
    }
    return value;
  }

  std::string_view rest_;
};

/// Calls `visit(number)` for each whole number of a repeated field, packed or one by one.
template <typename Visit>
void visitNumbers(const Field& field, Visit visit) {
  if (field.wire != Wire::kBytes) {
    visit(field.value);
    return;
  }
  for (Reader packed(field.bytes); !packed.atEnd();) {
    visit(packed.varint());
  }
}

}  // namespace evolin::protobuf
