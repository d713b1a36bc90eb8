// SPDX-License-Identifier: Apache-2.0
// Made-up states of light streams, for tests of their coding and for the fuzzer.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "stream/light/geometry.h"
#include "stream/light/light_state.h"

namespace lambent::test {

/// Two volumes of probes, some of them not lit.
inline stream::LightLayout made_layout(int texels) {
  stream::LightLayout layout;
  layout.texels = texels;
  layout.add_volume({4, 3, 2});
  layout.add_volume({2, 2, 2});
  for (const int dark : {0, 7, 25}) layout.lit[dark] = 0;
  return layout;
}

/// Numbers of lit probes, mostly small.
inline std::vector<std::int32_t> made_levels(const stream::LightLayout& layout,
                                             std::mt19937& random) {
  std::vector<std::int32_t> levels(layout.probes() * layout.numbers());
  for (int probe = 0; probe < layout.probes(); ++probe) {
    if (layout.lit[probe] == 0 || random() % 3 == 0) continue;
    for (std::size_t i = 0; i < layout.numbers(); ++i) {
      if (random() % 4 != 0) continue;
      const auto size = static_cast<std::int32_t>(random() % (random() % 50 == 0 ? 100000 : 4));
      levels[probe * layout.numbers() + i] = random() % 2 == 0 ? size : -size;
    }
  }
  return levels;
}

/// No light.
inline stream::LightState dark_state(const stream::LightLayout& layout) {
  stream::LightState state;
  state.update = 1;
  state.unit = 0.01f;
  state.coefficients.resize(layout.probes() * layout.numbers());
  state.history.resize(layout.probes());
  return state;
}

/// The geometry of two volumes, one of which has scrolled.
inline stream::FieldGeometry made_geometry(std::mt19937& random) {
  stream::FieldGeometry geometry;
  geometry.irradiance_texels = 2;
  geometry.distance_texels = 5;
  const FieldGrid grid{{-1.0f, 0.5f, 2.0f}, {0.5f, 1.0f, 0.25f}, {4, 3, 2}};
  geometry.volumes = {{still_grid(grid), {true, 1}},
                      {still_grid({{0.0f, 0.0f, 0.0f}, glm::vec3(2.0f), {2, 2, 2}}), {false, 0}}};
  geometry.volumes[0].grid.scroll = {3, 0, 1};
  geometry.volumes[1].grid.first = 24;
  for (int probe = 0; probe < 32; ++probe) {
    const auto number = static_cast<float>(probe);
    geometry.offsets.push_back(probe % 3 == 0 ? 0 : encode_probe_offset(vec3(0.01f * number)));
    geometry.states.push_back(static_cast<ProbeState>(probe % 6));
    for (std::size_t t = 0; t < geometry.tile(); ++t) {
      const bool blank = probe % 6 == 0;
      geometry.moments.push_back({static_cast<std::uint8_t>(blank ? 0 : 1 + random() % 127),
                                  static_cast<std::uint8_t>(blank ? 0 : random() % 64)});
    }
  }
  for (int i = 0; i < 9; ++i) {
    stream::CodedCorrectionBlock& block = geometry.corrections.emplace_back();
    block.key = correction_key({i / 3 - 1, 5 - i, i % 3}, i / 2, i % 3, i / 5);
    for (stream::CodedCorrection& cell : block.cells) {
      if (random() % 2 == 0) continue;
      cell = {static_cast<std::uint8_t>(1 + random() % 63),
              static_cast<std::uint8_t>(random() % 256), static_cast<std::uint8_t>(random() % 16)};
    }
  }
  return geometry;
}

}  // namespace lambent::test
