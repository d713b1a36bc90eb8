// SPDX-License-Identifier: Apache-2.0
#include "field/probe_memory.h"

#include <algorithm>

#include "field/probes/tile_fit.h"

namespace lambent {

ProbeMemory::ProbeMemory(std::span<const ProbeGrid> volumes, const FieldSettings& field_settings)
    : settings(field_settings),
      store(volumes, field_settings),
      tile_fit(tile_texels(), tile_texels(), tile_fit_matrix(settings.irradiance_texels)),
      traces(store.probes()),
      sights(store.probes()),
      light(static_cast<std::size_t>(store.probes()) * tile_texels(), vec4(0.0f)),
      told(light.size(), vec4(0.0f)) {}

std::vector<int> ProbeMemory::traced_probes() const {
  std::vector<int> traced;
  for (int probe = 0; probe < store.probes(); ++probe) {
    if (traces[probe].rays != nullptr) traced.push_back(probe);
  }
  return traced;
}

void ProbeMemory::clear() {
  store.clear();
  sights = ProbeSights(store.probes());
  std::fill(traces.begin(), traces.end(), ProbeTrace{});
  std::fill(light.begin(), light.end(), vec4(0.0f));
  std::fill(told.begin(), told.end(), vec4(0.0f));
}

}  // namespace lambent
