// SPDX-License-Identifier: Apache-2.0
// Offsets and sizes in a field file (docs/field-format.md).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "field/probes/irradiance_encoding.h"
#include "lambent/field.h"

namespace lambent {

inline constexpr std::array<char, 8> kFieldMagic = {'L', 'A', 'M', 'B', 'E', 'N', 'T', 'F'};

// Offsets and sizes [bytes].
inline constexpr std::size_t kChecksumOffset = 12;
inline constexpr std::size_t kSizeOffset = 16;  // the checksum covers everything from here on
inline constexpr std::size_t kHeaderBytes = 64;
inline constexpr std::size_t kVolumeHeaderBytes = 144;
inline constexpr std::size_t kRecordBytes = 24;
inline constexpr std::size_t kCorrectionBlockBytes = 104;

/// The number of words of the tiles of all probes.
inline std::uint64_t tile_words(std::uint64_t probes, int texels, int words_per_texel) {
  const auto edge = static_cast<std::uint64_t>(texels) + 2;
  return probes * edge * edge * static_cast<std::uint64_t>(words_per_texel);
}

inline int words_per_texel(IrradianceFormat format) {
  return words_of_irradiance(static_cast<std::uint32_t>(format));
}
inline int words_per_texel(DistanceFormat format) {
  return format == DistanceFormat::rg32f ? 2 : 1;
}

}  // namespace lambent
