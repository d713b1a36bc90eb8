// SPDX-License-Identifier: Apache-2.0
#include "stream/regions/region_coding.h"

#include <array>

#include "core/little_endian.h"
#include "stream/light/message.h"

namespace lambent::stream {
namespace {

constexpr std::uint32_t kFar = 1, kKey = 2, kAgeBits = 2;

// Variable-length numbers: seven bits per byte, the lowest first; the eighth bit means that more
// follow.
constexpr std::uint32_t kSeven = 7, kMore = 1u << kSeven;

void write_number(std::uint32_t number, ByteWriter& out) {
  while (number >= kMore) {
    out.raw(std::array{static_cast<std::byte>(number | kMore)});
    number >>= kSeven;
  }
  out.raw(std::array{static_cast<std::byte>(number)});
}

/// Reads a number from the front; returns false unless there is one of at most 28 bits.
bool read_number(std::span<const std::byte>& from, std::uint32_t& number) {
  number = 0;
  for (std::uint32_t shift = 0; shift < 4 * kSeven && !from.empty(); shift += kSeven) {
    const auto byte = std::to_integer<std::uint32_t>(from.front());
    from = from.subspan(1);
    number |= (byte & (kMore - 1)) << shift;
    if (byte < kMore) return true;
  }
  return false;
}

}  // namespace

std::vector<std::byte> write_regions(bool whole, std::span<const RegionStep> steps) {
  ByteWriter out;
  write_number(whole ? 1 : 0, out);
  write_number(static_cast<std::uint32_t>(steps.size()), out);
  std::uint32_t next = 0;
  for (const RegionStep& step : steps) {
    write_number(step.region - next, out);
    next = step.region + 1;
    write_number(
        (step.rate == RegionRate::far ? kFar : 0) | (step.is_key ? kKey : 0) | step.age << kAgeBits,
        out);
    write_number(static_cast<std::uint32_t>(step.coded.size()), out);
    out.raw(step.coded);
  }
  return out.take();
}

Expected<RegionBody> read_regions(std::span<const std::byte> body, std::size_t regions) {
  const auto is_short = [] { return bad_stream("regions", "are cut short"); };
  std::span<const std::byte> rest = body;
  std::uint32_t whole = 0, count = 0;
  if (!read_number(rest, whole) || !read_number(rest, count)) return is_short();
  if (whole > 1 || count > regions || (whole == 1 && count != regions)) {
    return bad_stream("regions", "are not as many as there are");
  }
  RegionBody read;
  read.whole = whole == 1;
  std::uint32_t next = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    RegionStep step;
    std::uint32_t left_out = 0, how = 0, size = 0;
    if (!read_number(rest, left_out) || !read_number(rest, how) || !read_number(rest, size)) {
      return is_short();
    }
    step.region = next + left_out;
    next = step.region + 1;
    step.rate = (how & kFar) != 0 ? RegionRate::far : RegionRate::near;
    step.is_key = (how & kKey) != 0;
    step.age = how >> kAgeBits;
    if (step.region >= regions || (read.whole && !step.is_key)) {
      return bad_stream("regions", "are none that there are, or no keys");
    }
    if (rest.size() < size) return is_short();
    step.coded = rest.first(size);
    rest = rest.subspan(size);
    read.steps.push_back(step);
  }
  if (!rest.empty()) return bad_stream("regions", "go on after their end");
  return read;
}

}  // namespace lambent::stream
