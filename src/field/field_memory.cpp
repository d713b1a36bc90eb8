// SPDX-License-Identifier: Apache-2.0
#include "field/field_memory.h"

#include "field/correction/correction_table.h"
#include "field/field_state.h"
#include "field/probes/probe_store.h"
#include "field/probes/volumes.h"
#include "field/transport/surfels.h"

namespace lambent {
namespace {

// The number of arrays with a vec4 for each texel of the probes that exist at once: the light and
// the last estimates of the field, and in the solve the iterates, their differences and the steps
// from which it extrapolates.
constexpr std::uint64_t kLightCopies = 20;
// The number of those that every rank has for all probes: the light and the last estimates.
constexpr std::uint64_t kLightCopiesOnAll = 2;

std::uint64_t tile_bytes(int texels, std::uint64_t texel_bytes) {
  const auto side = static_cast<std::uint64_t>(texels) + 2;
  return side * side * texel_bytes;
}

}  // namespace

FieldMemory field_memory(const FieldSettings& s, std::uint64_t probes) {
  const auto irradiance_texel =
      sizeof(uint) * words_of_irradiance(static_cast<uint>(s.irradiance_format));
  const std::uint64_t distance_texel = s.distance_format == DistanceFormat::rg32f ? 8 : 4;
  const auto texels = static_cast<std::uint64_t>(s.irradiance_texels) * s.irradiance_texels;
  FieldMemory memory;
  memory.probes = probes;
  memory.bytes_per_probe_on_all = tile_bytes(s.irradiance_texels, irradiance_texel) +
                                  tile_bytes(s.distance_texels, distance_texel) +
                                  kLightCopiesOnAll * texels * sizeof(vec4) + sizeof(ProbeTrace) +
                                  sizeof(ProbeStatus) + sizeof(ClassificationInput);
  memory.bytes_per_probe =
      memory.bytes_per_probe_on_all + (kLightCopies - kLightCopiesOnAll) * texels * sizeof(vec4);
  if (s.corrections) {
    memory.bytes_per_probe_on_all += CorrectionTable::bytes_per_probe_on_all();
    memory.bytes_per_probe += CorrectionTable::bytes_per_probe();
  }
  memory.bytes_per_ray = sizeof(Surfel) + sizeof(SurfelLookup) + sizeof(Hit);
  return memory;
}

Expected<FieldMemory> planned_memory(const FieldSettings& settings, const Bounds& scene_bounds) {
  const Expected<std::vector<Volume>> volumes = plan_volumes(settings, scene_bounds);
  if (!volumes) return tl::unexpected(volumes.error());
  std::uint64_t probes = 0;
  for (const Volume& volume : *volumes) {
    probes += static_cast<std::uint64_t>(probe_count(volume.grid));
  }
  return field_memory(settings, probes);
}

}  // namespace lambent
