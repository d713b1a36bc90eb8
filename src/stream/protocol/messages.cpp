// SPDX-License-Identifier: Apache-2.0
#include "stream/protocol/messages.h"

#include <array>
#include <cassert>
#include <cmath>
#include <cstring>
#include <utility>

#include "core/little_endian.h"
#include "stream/protocol/fields.h"

namespace lambent::stream {
namespace {

// Tolerance of a unit vector's length, for vectors sent in single precision.
constexpr float kUnitTolerance = 1e-3f;

/// The number of a message's type on the wire, and its sender.
template <class T>
struct Type;
template <>
struct Type<Hello> {
  static constexpr std::uint8_t kNumber = 1;
};
template <>
struct Type<PictureRequest> {
  static constexpr std::uint8_t kNumber = 2;
};
template <>
struct Type<CameraInput> {
  static constexpr std::uint8_t kNumber = 3;
};
template <>
struct Type<TimeOfDay> {
  static constexpr std::uint8_t kNumber = 33;
};
template <>
struct Type<SunInput> {
  static constexpr std::uint8_t kNumber = 34;
};
template <>
struct Type<LightInput> {
  static constexpr std::uint8_t kNumber = 35;
};
template <>
struct Type<ObjectInput> {
  static constexpr std::uint8_t kNumber = 36;
};
template <>
struct Type<Received> {
  static constexpr std::uint8_t kNumber = 4;
};
template <>
struct Type<LightReceived> {
  static constexpr std::uint8_t kNumber = 5;
};
template <>
struct Type<Interest> {
  static constexpr std::uint8_t kNumber = 6;
};
template <>
struct Type<Ping> {
  static constexpr std::uint8_t kNumber = 32;
};
template <>
struct Type<Welcome> {
  static constexpr std::uint8_t kNumber = 65;
};
template <>
struct Type<Picture> {
  static constexpr std::uint8_t kNumber = 66;
};
template <>
struct Type<LightPayload> {
  static constexpr std::uint8_t kNumber = 67;
};
template <>
struct Type<ServerStats> {
  static constexpr std::uint8_t kNumber = 68;
};
template <>
struct Type<Refusal> {
  static constexpr std::uint8_t kNumber = 69;
};
template <>
struct Type<InputsApplied> {
  static constexpr std::uint8_t kNumber = 70;
};

constexpr std::uint8_t kFirstOfBoth = 32, kFirstOfServer = 64;

/// Writes fields. Those of variable size are preceded by a word with their length.
class FieldWriter {
 public:
  explicit FieldWriter(ByteWriter& to) : to_(to) {}

  void word(const char*, std::uint32_t& value, std::uint32_t, std::uint32_t) { to_.u32(value); }
  void long_word(const char*, std::uint64_t& value) { to_.u64(value); }
  void real(const char*, float& value, float, float) { to_.f32(value); }
  template <class Vector>
  void reals(const char*, Vector& values, float, float) {
    for (int i = 0; i < values.length(); ++i) to_.f32(values[i]);
  }
  template <class Vector>
  void unit(const char* name, Vector& values) {
    reals(name, values, -1.0f, 1.0f);
  }
  void text(const char*, std::string& value, std::size_t most) {
    put(std::as_bytes(std::span(value)), most);
  }
  void bytes(const char*, std::vector<std::byte>& value, std::size_t most) { put(value, most); }
  template <class T>
  void list(const char*, std::vector<T>& values, std::size_t most) {
    assert(values.size() <= most);
    static_cast<void>(most);
    to_.u32(static_cast<std::uint32_t>(values.size()));
    for (T& value : values) fields(*this, value);
  }

 private:
  void put(std::span<const std::byte> value, std::size_t most) {
    assert(value.size() <= most);
    static_cast<void>(most);
    to_.u32(static_cast<std::uint32_t>(value.size()));
    to_.raw(value);
  }

  ByteWriter& to_;
};

/// Reads fields. After the first invalid field, nothing more is read.
class FieldReader {
 public:
  explicit FieldReader(std::span<const std::byte> from) : bytes_(from), from_(from) {}

  void word(const char* name, std::uint32_t& value, std::uint32_t low, std::uint32_t high) {
    if (!has(name, sizeof(std::uint32_t))) return;
    value = from_.u32();
    if (value < low || value > high) refuse(name, "is out of range");
  }
  void long_word(const char* name, std::uint64_t& value) {
    if (has(name, sizeof(std::uint64_t))) value = from_.u64();
  }
  void real(const char* name, float& value, float low, float high) {
    if (!has(name, sizeof(float))) return;
    value = from_.f32();
    // Written so that NaN fails
    if (!(value >= low && value <= high)) refuse(name, "is not finite, or out of range");
  }
  template <class Vector>
  void reals(const char* name, Vector& values, float low, float high) {
    for (int i = 0; i < values.length(); ++i) real(name, values[i], low, high);
  }
  template <class Vector>
  void unit(const char* name, Vector& values) {
    reals(name, values, -1.0f - kUnitTolerance, 1.0f + kUnitTolerance);
    if (cause_.empty() && !(std::abs(glm::length(values) - 1.0f) <= kUnitTolerance)) {
      refuse(name, "is not of unit length");
    }
  }
  void text(const char* name, std::string& value, std::size_t most) {
    const auto given = sized(name, most);
    value.assign(reinterpret_cast<const char*>(given.data()), given.size());
  }
  void bytes(const char* name, std::vector<std::byte>& value, std::size_t most) {
    const auto given = sized(name, most);
    value.assign(given.begin(), given.end());
  }
  template <class T>
  void list(const char* name, std::vector<T>& values, std::size_t most) {
    std::uint32_t count = 0;
    word(name, count, 0, static_cast<std::uint32_t>(most));
    for (std::uint32_t i = 0; i < count && cause_.empty(); ++i)
      fields(*this, values.emplace_back());
  }

  /// To be called last.
  Expected<void> finish() {
    if (cause_.empty() && from_.left() > 0) refuse("message", "is longer than its fields");
    if (cause_.empty()) return {};
    return fail("message", place_, cause_);
  }

 private:
  bool has(const char* name, std::size_t size) {
    if (cause_.empty() && from_.left() < size) refuse(name, "is cut off");
    return cause_.empty();
  }
  void refuse(const char* name, const char* cause) {
    if (!cause_.empty()) return;
    place_ = name;
    cause_ = cause;
  }
  std::span<const std::byte> sized(const char* name, std::size_t most) {
    std::uint32_t size = 0;
    word(name, size, 0, static_cast<std::uint32_t>(most));
    if (!has(name, size)) return {};
    const auto given = bytes_.subspan(bytes_.size() - from_.left(), size);
    from_ = ByteReader(bytes_.subspan(bytes_.size() - from_.left() + size));
    return given;
  }

  std::span<const std::byte> bytes_;
  ByteReader from_;
  std::string place_, cause_;
};

template <class T>
Expected<Message> parse_as(std::span<const std::byte> body) {
  T message;
  FieldReader reader(body);
  fields(reader, message);
  if (const auto fine = reader.finish(); !fine) return tl::unexpected(fine.error());
  return Message(std::move(message));
}

/// The parser of the type with this number; null where there is none.
template <std::size_t... kIndices>
auto parser_of(std::uint8_t number, std::index_sequence<kIndices...>) {
  Expected<Message> (*found)(std::span<const std::byte>) = nullptr;
  ((Type<std::variant_alternative_t<kIndices, Message>>::kNumber == number
        ? void(found = parse_as<std::variant_alternative_t<kIndices, Message>>)
        : void()),
   ...);
  return found;
}

}  // namespace

std::vector<std::byte> write_message(const Message& message) {
  return std::visit(
      [](auto copy) {
        ByteWriter to;
        to.u32(Type<decltype(copy)>::kNumber);
        to.u32(0);
        FieldWriter writer(to);
        fields(writer, copy);
        to.u32_at(sizeof(std::uint32_t), static_cast<std::uint32_t>(to.size() - kHeaderBytes));
        return to.take();
      },
      message);
}

Expected<Message> parse_message(std::span<const std::byte> bytes, Sender sender) {
  if (bytes.size() < kHeaderBytes) return fail("message", "header", "is cut off");
  ByteReader header(bytes);
  const std::uint32_t type = header.u32(), size = header.u32();
  if (size != bytes.size() - kHeaderBytes) {
    return fail("message", "size", "does not agree with what came");
  }
  const bool of_both = type >= kFirstOfBoth && type < kFirstOfServer;
  const Sender by = type < kFirstOfServer ? Sender::client : Sender::server;
  constexpr auto kTypes = std::make_index_sequence<std::variant_size_v<Message>>();
  const auto parse = type < 256 ? parser_of(static_cast<std::uint8_t>(type), kTypes) : nullptr;
  if (parse == nullptr || (!of_both && by != sender)) {
    return fail("message", "type", "is none that this side is sent");
  }
  return parse(bytes.subspan(kHeaderBytes));
}

}  // namespace lambent::stream
