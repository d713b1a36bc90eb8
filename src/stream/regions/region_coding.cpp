// SPDX-License-Identifier: Apache-2.0
#include "stream/regions/region_coding.h"

#include "core/little_endian.h"
#include "stream/light/message.h"

namespace lambent::stream {
namespace {

// What a step begins with.
constexpr std::size_t kStepBytes = 3 * sizeof(std::uint32_t);
constexpr std::uint32_t kFar = 1, kKey = 2, kAgeBits = 8;

}  // namespace

std::vector<std::byte> write_regions(bool whole, std::span<const RegionStep> steps) {
  ByteWriter out;
  out.u32(whole ? 1 : 0);
  out.u32(static_cast<std::uint32_t>(steps.size()));
  for (const RegionStep& step : steps) {
    out.u32(step.region);
    out.u32((step.rate == RegionRate::far ? kFar : 0) | (step.is_key ? kKey : 0) |
            step.age << kAgeBits);
    out.u32(static_cast<std::uint32_t>(step.coded.size()));
    out.raw(step.coded);
  }
  return out.take();
}

Expected<RegionBody> read_regions(std::span<const std::byte> body, std::size_t regions) {
  if (body.size() < 2 * sizeof(std::uint32_t)) return bad_stream("regions", "are cut short");
  ByteReader in(body);
  RegionBody read;
  const std::uint32_t whole = in.u32(), count = in.u32();
  if (whole > 1 || count > regions || (whole == 1 && count != regions)) {
    return bad_stream("regions", "are not as many as there are");
  }
  read.whole = whole == 1;
  std::span<const std::byte> rest = body.subspan(2 * sizeof(std::uint32_t));
  std::uint32_t least = 0;  // the next region is at least this one
  for (std::uint32_t i = 0; i < count; ++i) {
    if (rest.size() < kStepBytes) return bad_stream("regions", "are cut short");
    ByteReader head(rest);
    RegionStep step;
    step.region = head.u32();
    const std::uint32_t how = head.u32(), size = head.u32();
    step.rate = (how & kFar) != 0 ? RegionRate::far : RegionRate::near;
    step.is_key = (how & kKey) != 0;
    step.age = how >> kAgeBits;
    rest = rest.subspan(kStepBytes);
    const bool known_bits = (how & ((1u << kAgeBits) - 1u) & ~(kFar | kKey)) == 0;
    if (step.region < least || step.region >= regions || !known_bits ||
        (read.whole && !step.is_key)) {
      return bad_stream("regions", "are out of order, or of no stream");
    }
    if (rest.size() < size) return bad_stream("regions", "are cut short");
    step.coded = rest.first(size);
    rest = rest.subspan(size);
    least = step.region + 1;
    read.steps.push_back(step);
  }
  if (!rest.empty()) return bad_stream("regions", "go on after their end");
  return read;
}

}  // namespace lambent::stream
