// SPDX-License-Identifier: Apache-2.0
// Based on: G. N. N. Martin, "Range encoding", Video and Data Recording Conference, 1979; the form
// with carries over bytes already written is that of LZMA. An adaptive binary arithmetic coder that
// uses integers only, so that encoder and decoder agree to the bit on all machines.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lambent::stream {

// The fixed-point 1 of probabilities, which must be above 0 and below this.
inline constexpr std::uint32_t kProbabilityOne = 1u << 16u;

// The range is refilled with a byte as soon as it is below this.
inline constexpr std::uint32_t kLeastRange = 1u << 24u;

// Maximum number of zero bytes at the end that encoders omit.
inline constexpr int kTrailingZeros = 4;

/// Writes decisions.
class RangeEncoder {
 public:
  static constexpr bool kWrites = true;

  /// Writes a decision that is a 1 with this probability, out of kProbabilityOne, and returns it.
  bool bit(std::uint32_t probability, bool value) {
    const auto bound = static_cast<std::uint32_t>((std::uint64_t{range_} * probability) >> 16u);
    if (value) {
      range_ = bound;
    } else {
      low_ += bound;
      range_ -= bound;
    }
    while (range_ < kLeastRange) {
      range_ <<= 8u;
      shift_low();
    }
    return value;
  }
  /// Writes the lowest `count` bits of a number, 0 to 32, each with probability 1/2.
  std::uint32_t bits(int count, std::uint32_t value) {
    for (int i = count - 1; i >= 0; --i) bit(kProbabilityOne / 2, (value >> i & 1u) != 0);
    return value;
  }

  /// The bytes of all decisions.
  std::vector<std::byte> finish() {
    // Any number within the range is valid: choose the one that ends in zeros, and omit these,
    // since decoders read zeros past the end
    low_ = (low_ + kLeastRange - 1) & ~std::uint64_t{kLeastRange - 1};
    for (int i = 0; i < 5; ++i) shift_low();
    for (int i = 0; i < kTrailingZeros && !bytes_.empty() && bytes_.back() == std::byte{0}; ++i) {
      bytes_.pop_back();
    }
    return std::move(bytes_);
  }

 private:
  /// Outputs the highest byte of `low_`. Bytes of 255 are delayed, since a carry may still change
  /// them.
  void shift_low() {
    if (low_ < 0xFF000000u || low_ > 0xFFFFFFFFu) {
      const auto carry = static_cast<std::uint8_t>(low_ >> 32u);
      for (; waiting_ > 0; --waiting_) {
        // The very first byte is always 0, and omitted
        if (started_) bytes_.push_back(static_cast<std::byte>(cache_ + carry));
        started_ = true;
        cache_ = 0xFF;
      }
      cache_ = static_cast<std::uint8_t>(low_ >> 24u);
    }
    ++waiting_;
    low_ = (low_ & 0x00FFFFFFu) << 8u;
  }

  std::vector<std::byte> bytes_;
  std::uint64_t low_ = 0;
  std::uint32_t range_ = 0xFFFFFFFFu;
  std::uint64_t waiting_ = 1;
  std::uint8_t cache_ = 0;
  bool started_ = false;
};

/// Reads decisions from any bytes, with zeros past their end.
class RangeDecoder {
 public:
  static constexpr bool kWrites = false;

  explicit RangeDecoder(std::span<const std::byte> bytes) : bytes_(bytes) {
    for (int i = 0; i < 4; ++i) code_ = code_ << 8u | next();
  }

  /// Reads a decision that is a 1 with this probability. The second argument is ignored.
  bool bit(std::uint32_t probability, bool /*value*/ = false) {
    const auto bound = static_cast<std::uint32_t>((std::uint64_t{range_} * probability) >> 16u);
    const bool value = code_ < bound;
    if (value) {
      range_ = bound;
    } else {
      code_ -= bound;
      range_ -= bound;
    }
    while (range_ < kLeastRange) {
      range_ <<= 8u;
      code_ = code_ << 8u | next();
    }
    return value;
  }

  std::uint32_t bits(int count, std::uint32_t /*value*/ = 0) {
    std::uint32_t value = 0;
    for (int i = 0; i < count; ++i) value = value << 1u | (bit(kProbabilityOne / 2) ? 1u : 0u);
    return value;
  }

  /// Whether more was read than the bytes and the zeros that an encoder omits: no encoder wrote
  /// these bytes.
  bool overrun() const { return past_end_ > kTrailingZeros; }
  /// Number of unread bytes.
  std::size_t left() const { return bytes_.size(); }

 private:
  std::uint32_t next() {
    if (bytes_.empty()) {
      ++past_end_;
      return 0;
    }
    const auto value = std::to_integer<std::uint32_t>(bytes_.front());
    bytes_ = bytes_.subspan(1);
    return value;
  }

  std::span<const std::byte> bytes_;
  std::uint32_t range_ = 0xFFFFFFFFu;
  std::uint32_t code_ = 0;
  std::uint64_t past_end_ = 0;
};

}  // namespace lambent::stream
