// A bag whose recorder was killed has everything but its index: chunk after chunk, read in order
// (http://wiki.ros.org/Bags/Format/2.0).
#include <rosbag/bag.h>
#include <rosbag/chunked_file.h>
#include <rosbag/stream.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <map>
#include <set>

#include "bag_source.h"
#include "conversions.h"
#include "evolin_ros/base/text.h"

namespace evolin::ros_shell {

namespace {

constexpr std::uint8_t kOpMessage = 0x02;
constexpr std::uint8_t kOpChunk = 0x05;
constexpr std::uint8_t kOpConnection = 0x07;

/// Nothing that a recorder writes in one piece is larger.
constexpr std::uint32_t kLargest = 1U << 30U;

std::uint32_t littleEndian(const char* bytes) {
  std::uint32_t value = 0;
  for (int i = 3; i >= 0; --i) {
    value = (value << 8U) | static_cast<std::uint8_t>(bytes[i]);
  }
  return value;
}

/// Bytes that may end anywhere.
class Cursor {
 public:
  Cursor(char* begin, std::size_t size) : at_(begin), left_(size) {}

  /// False when no whole number is left.
  bool take(std::uint32_t* value) {
    if (left_ < 4) {
      return false;
    }
    *value = littleEndian(at_);
    at_ += 4;
    left_ -= 4;
    return true;
  }

  /// Bytes behind their length; false when they are not all there.
  bool take(char** bytes, std::uint32_t* size) {
    if (!take(size) || *size > left_) {
      return false;
    }
    *bytes = at_;
    at_ += *size;
    left_ -= *size;
    return true;
  }

 private:
  char* at_;
  std::size_t left_;
};

using Fields = std::map<std::string, std::string>;

Fields readFields(char* bytes, std::uint32_t size) {
  Fields fields;
  Cursor cursor(bytes, size);
  char* field = nullptr;
  std::uint32_t length = 0;
  while (cursor.take(&field, &length)) {
    const std::string text(field, length);
    const std::size_t equals = text.find('=');
    if (equals != std::string::npos) {
      fields[text.substr(0, equals)] = text.substr(equals + 1);
    }
  }
  return fields;
}

std::uint8_t opOf(const Fields& fields) {
  const auto op = fields.find("op");
  return op == fields.end() || op->second.empty() ? 0
                                                  : static_cast<std::uint8_t>(op->second.front());
}

std::uint32_t numberOf(const Fields& fields, const std::string& name) {
  const auto field = fields.find(name);
  return field == fields.end() || field->second.size() < 4 ? 0 : littleEndian(field->second.data());
}

Stamp timeOf(const Fields& fields) {
  const auto field = fields.find("time");
  if (field == fields.end() || field->second.size() < 8) {
    return 0;
  }
  const char* const bytes = field->second.data();
  return static_cast<Stamp>(littleEndian(bytes)) * kNanosecondsPerSecond + littleEndian(bytes + 4);
}

struct Connection {
  std::string topic;
  std::string type;
  std::string md5;
};

/// Reads the file's chunks one after the other.
class ChunkReader {
 public:
  explicit ChunkReader(const std::filesystem::path& file)
      : file_(file, std::ios::binary), size_(std::filesystem::file_size(file)) {
    constexpr char kMagic[] = "#ROSBAG V2.0\n";
    std::string magic(sizeof kMagic - 1, ' ');
    file_.read(magic.data(), static_cast<std::streamsize>(magic.size()));
    if (!file_ || magic != kMagic) {
      throw Error(file.string() + ": cannot be read as a bag: it begins with " + quote(magic) +
                  ", expected '#ROSBAG V2.0'");
    }
  }

  /// Decompressed; false behind the last chunk that is whole.
  bool next(std::vector<char>* chunk) {
    while (true) {
      std::vector<char> head;
      std::vector<char> data;
      if (!takeRecord(&head, &data)) {
        return false;
      }
      const Fields fields = readFields(head.data(), static_cast<std::uint32_t>(head.size()));
      if (opOf(fields) != kOpChunk) {
        continue;
      }
      return unpack(fields, &data, chunk);
    }
  }

 private:
  bool takeRecord(std::vector<char>* head, std::vector<char>* data) {
    return takeBytes(head) && takeBytes(data);
  }

  bool takeBytes(std::vector<char>* bytes) {
    char length[4];
    if (!file_.read(length, sizeof length)) {
      return false;
    }
    const std::uint32_t size = littleEndian(length);
    const auto left = size_ - static_cast<std::uintmax_t>(file_.tellg());
    if (size > kLargest || size > left) {
      return false;
    }
    bytes->resize(size);
    return static_cast<bool>(file_.read(bytes->data(), size));
  }

  bool unpack(const Fields& fields, std::vector<char>* data, std::vector<char>* chunk) {
    const auto compression = fields.find("compression");
    const std::uint32_t size = numberOf(fields, "size");
    // Of a chunk that was being written its size is not filled in.
    if (compression == fields.end() || size == 0 || size > kLargest || data->empty()) {
      return false;
    }
    if (compression->second == "none") {
      *chunk = std::move(*data);
      return true;
    }
    const bool bz2 = compression->second == "bz2";
    if (!bz2 && compression->second != "lz4") {
      return false;
    }
    chunk->resize(size);
    try {
      streams_.getStream(bz2 ? rosbag::compression::BZ2 : rosbag::compression::LZ4)
          ->decompress(reinterpret_cast<std::uint8_t*>(chunk->data()), size,
                       reinterpret_cast<std::uint8_t*>(data->data()),
                       static_cast<unsigned>(data->size()));
    } catch (const std::exception&) {
      return false;
    }
    return true;
  }

  std::ifstream file_;
  std::uintmax_t size_;
  rosbag::ChunkedFile no_file_;  ///< the streams want one, though not for memory
  rosbag::StreamFactory streams_{&no_file_};
};

/// Messages of all chunks in the order in which they were recorded.
class MessageReader {
 public:
  struct Record {
    const Connection* connection;
    Stamp time;
    std::uint8_t* bytes;
    std::uint32_t size;
  };

  explicit MessageReader(const std::filesystem::path& file) : chunks_(file) {}

  std::optional<Record> next() {
    while (true) {
      char* head = nullptr;
      std::uint32_t head_size = 0;
      char* data = nullptr;
      std::uint32_t data_size = 0;
      if (!cursor_.take(&head, &head_size) || !cursor_.take(&data, &data_size)) {
        if (!chunks_.next(&chunk_)) {
          return std::nullopt;
        }
        cursor_ = Cursor(chunk_.data(), chunk_.size());
        continue;
      }
      const Fields fields = readFields(head, head_size);
      const std::uint32_t number = numberOf(fields, "conn");
      if (opOf(fields) == kOpConnection) {
        Fields inner = readFields(data, data_size);
        const auto topic = fields.find("topic");
        connections_[number] = {topic == fields.end() ? "" : topic->second, inner["type"],
                                inner["md5sum"]};
      } else if (opOf(fields) == kOpMessage && connections_.count(number) != 0) {
        return Record{&connections_[number], timeOf(fields), reinterpret_cast<std::uint8_t*>(data),
                      data_size};
      }
    }
  }

 private:
  ChunkReader chunks_;
  std::vector<char> chunk_;
  Cursor cursor_{nullptr, 0};
  std::map<std::uint32_t, Connection> connections_;
};

class UnindexedBag : public BagSource {
 public:
  explicit UnindexedBag(std::filesystem::path file) : file_(std::move(file)) {
    std::map<std::string, BagTopic> by_name;
    std::size_t messages = 0;
    MessageReader reader(file_);
    while (const auto record = reader.next()) {
      BagTopic& topic = by_name[record->connection->topic];
      topic.name = record->connection->topic;
      topic.type = record->connection->type;
      ++topic.messages;
      ++messages;
      begin_ = messages == 1 ? record->time : std::min(begin_, record->time);
      end_ = std::max(end_, record->time);
    }
    for (auto& [name, topic] : by_name) {
      topics_.push_back(topic);
    }
    problem_ = file_.string() + ": has no index (was its recording cut off?); read as far as it " +
               "goes: " + std::to_string(messages) + " messages, " +
               formatDouble(toSeconds(end_ - begin_)) + " s; 'rosbag reindex' mends the bag";
  }

  const std::vector<BagTopic>& topics() const override { return topics_; }

  void peek(const std::string& topic, const std::function<bool(const BagMessage&)>& look) override {
    MessageReader reader(file_);
    while (const auto record = reader.next()) {
      if (record->connection->topic == topic && !look(messageOf(*record))) {
        return;
      }
    }
  }

  void choose(const std::vector<std::string>& topics, const BagWindow& window) override {
    chosen_ = {topics.begin(), topics.end()};
    from_ = begin_ + fromSeconds(window.start);
    to_ = window.duration ? from_ + fromSeconds(*window.duration) : end_;
    reader_.emplace(file_);
  }

  std::optional<BagMessage> next() override {
    while (reader_) {
      const auto record = reader_->next();
      if (!record) {
        break;
      }
      if (chosen_.count(record->connection->topic) != 0 && record->time >= from_ &&
          record->time <= to_) {
        return messageOf(*record);
      }
    }
    return std::nullopt;
  }

  std::string problem() const override { return problem_; }

 private:
  static BagMessage messageOf(const MessageReader::Record& record) {
    const Connection& connection = *record.connection;
    return BagMessage(connection.topic, connection.type, connection.md5, record.bytes, record.size);
  }

  std::filesystem::path file_;
  std::vector<BagTopic> topics_;
  std::string problem_;
  Stamp begin_ = 0;
  Stamp end_ = 0;
  std::set<std::string> chosen_;
  Stamp from_ = 0;
  Stamp to_ = 0;
  std::optional<MessageReader> reader_;
};

}  // namespace

std::unique_ptr<BagSource> openUnindexedBag(const std::filesystem::path& file) {
  return std::make_unique<UnindexedBag>(file);
}

}  // namespace evolin::ros_shell
