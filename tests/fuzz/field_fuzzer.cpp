// SPDX-License-Identifier: Apache-2.0
// Feeds arbitrary bytes to the reader of field files, as they are and with their checksum mended,
// which no fuzzer would find. What is read must be fit to look up, and come out as it went in.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "field/file/field_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lambent;
  const auto* first = reinterpret_cast<const std::byte*>(data);
  std::vector<std::byte> bytes(first, first + size);
  const Expected<FieldFile> raw = decode_field("raw", bytes);
  if (!raw && raw.error().cause.empty()) std::abort();

  seal_field(bytes);
  const Expected<FieldFile> field = decode_field("sealed", bytes);
  if (!field) {
    if (field.error().cause.empty()) std::abort();
    return 0;
  }
  if (encode_field(*field) != bytes) std::abort();
  for (const FieldVolume& volume : field->volumes) {
    const ProbeStore store = volume.store();
    for (const vec3 direction : {vec3(1.0f, 0.0f, 0.0f), vec3(0.0f, -0.6f, -0.8f)}) {
      const vec3 light = store.irradiance(store.probes() - 1, direction);
      const vec2 seen = store.moments(store.probes() - 1, direction);
      if (std::isnan(light.x + light.y + light.z) || std::isnan(seen.x + seen.y)) std::abort();
    }
  }
  return 0;
}
