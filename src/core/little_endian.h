// SPDX-License-Identifier: Apache-2.0
// Numbers as little-endian bytes, whatever the machine's own order.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace lambent {

static_assert(sizeof(float) == sizeof(std::uint32_t), "floats are written as IEEE 754 words");

/// Appends numbers to a growing list of bytes.
class ByteWriter {
 public:
  void u32(std::uint32_t value) { put(value, sizeof(value)); }
  void u64(std::uint64_t value) { put(value, sizeof(value)); }
  void i32(std::int32_t value) { u32(static_cast<std::uint32_t>(value)); }
  void f32(float value) { u32(std::bit_cast<std::uint32_t>(value)); }
  void u32s(std::span<const std::uint32_t> values) {
    if constexpr (std::endian::native == std::endian::little) {
      raw(std::as_bytes(values));
    } else {
      for (const std::uint32_t value : values) u32(value);
    }
  }
  void f32s(std::span<const float> values) {
    if constexpr (std::endian::native == std::endian::little) {
      raw(std::as_bytes(values));
    } else {
      for (const float value : values) f32(value);
    }
  }
  void raw(std::span<const std::byte> bytes) {
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  }
  /// Overwrites the number at `offset`.
  void u32_at(std::size_t offset, std::uint32_t value) { put_at(offset, value, sizeof(value)); }
  void u64_at(std::size_t offset, std::uint64_t value) { put_at(offset, value, sizeof(value)); }

  std::size_t size() const { return bytes_.size(); }
  std::span<const std::byte> bytes() const { return bytes_; }
  void clear() { bytes_.clear(); }
  std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  void put(std::uint64_t value, std::size_t size) {
    bytes_.resize(bytes_.size() + size);
    put_at(bytes_.size() - size, value, size);
  }
  void put_at(std::size_t offset, std::uint64_t value, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i) {
      bytes_[offset + i] = static_cast<std::byte>(value >> (8 * i));
    }
  }

  std::vector<std::byte> bytes_;
};

/// Reads numbers one after the other. Callers must check `left` first: reading past the end is a
/// bug.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  std::size_t left() const { return bytes_.size(); }
  std::uint8_t u8() { return static_cast<std::uint8_t>(get(1)); }
  std::uint32_t u32() { return static_cast<std::uint32_t>(get(sizeof(std::uint32_t))); }
  std::uint64_t u64() { return get(sizeof(std::uint64_t)); }
  float f32() { return std::bit_cast<float>(u32()); }
  void u32s(std::span<std::uint32_t> values) {
    if constexpr (std::endian::native == std::endian::little) {
      if (!values.empty()) std::memcpy(values.data(), bytes_.data(), values.size_bytes());
      bytes_ = bytes_.subspan(values.size_bytes());
    } else {
      for (std::uint32_t& value : values) value = u32();
    }
  }

 private:
  std::uint64_t get(std::size_t size) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < size; ++i) {
      value |= std::to_integer<std::uint64_t>(bytes_[i]) << (8 * i);
    }
    bytes_ = bytes_.subspan(size);
    return value;
  }

  std::span<const std::byte> bytes_;
};

}  // namespace lambent
