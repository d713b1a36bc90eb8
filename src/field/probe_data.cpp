// SPDX-License-Identifier: Apache-2.0
#include "field/probe_data.h"

#include <algorithm>

#include "field/probes/tile_fit.h"

namespace lambent {
namespace {

int probes_of(std::span<const ProbeGrid> volumes) {
  int probes = 0;
  for (const ProbeGrid& grid : volumes) probes += probe_count(grid);
  return probes;
}

}  // namespace

ProbeData::ProbeData(std::span<const ProbeGrid> volumes, const FieldSettings& field_settings)
    : settings(field_settings),
      share(probes_of(volumes)),
      store(volumes, field_settings),
      tile_fit(tile_texels(), tile_texels(), tile_fit_matrix(settings.irradiance_texels)),
      traces(store.probes()),
      correction(store.probes()),
      cell_visibility(store.probes()),
      light(static_cast<std::size_t>(store.probes()) * tile_texels(), vec4(0.0f)),
      last_irradiance_estimate(light.size(), vec4(0.0f)),
      last_estimate_is_coarse(store.probes(), 0) {}

std::vector<int> ProbeData::traced_probes() const {
  std::vector<int> traced;
  for (int probe = 0; probe < store.probes(); ++probe) {
    if (traces[probe].rays != nullptr) traced.push_back(probe);
  }
  return traced;
}

void ProbeData::clear() {
  store.clear();
  correction = CorrectionTable(store.probes());
  cell_visibility = CellVisibility(store.probes());
  std::fill(traces.begin(), traces.end(), ProbeTrace{});
  std::fill(light.begin(), light.end(), vec4(0.0f));
  std::fill(last_estimate_is_coarse.begin(), last_estimate_is_coarse.end(), std::uint8_t{0});
  std::fill(last_irradiance_estimate.begin(), last_irradiance_estimate.end(), vec4(0.0f));
}

}  // namespace lambent
