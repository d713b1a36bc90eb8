// SPDX-License-Identifier: Apache-2.0
// The current geometry of a field, and its changes since it was sent.
#include <cmath>

#include "core/parallel.h"
#include "field/field_access.h"
#include "field/field_state.h"
#include "stream/light/geometry.h"

namespace lambent::stream {
namespace {

constexpr std::size_t kChunk = 64;  // probes per task

/// Calls visit(texel, moments [m, m^2]) for the texels of a probe's tile, as from
/// ProbeStore::moments_texel.
template <class Visit>
void for_each_moments(const ProbeStore& store, const ProbeGrid& grid, int probe, Visit visit) {
  const int n = store.distance_texels(), words = store.words_per_distance_texel();
  const float unit = distance_unit(grid);
  const uint* tile =
      &store.distance_words()[static_cast<std::size_t>(probe) * (n + 2) * (n + 2) * words];
  for (int y = 0; y < n; ++y) {
    const uint* word = tile + ((y + 1) * (n + 2) + 1) * words;
    for (int x = 0; x < n; ++x, word += words) {
      const vec2 moments = words == 1 ? decode_half2(word[0])
                                      : vec2(uintBitsToFloat(word[0]), uintBitsToFloat(word[1]));
      visit(y * n + x, moments * vec2(unit, unit * unit));
    }
  }
}

void copy_probe(const FieldAccess::State& field, int probe, FieldGeometry& geometry) {
  const ProbeStore& store = field.data.store;
  const ProbeGrid& grid = store.grid_of(probe);
  const float longest = max_probe_distance(grid);
  geometry.offsets[probe] = store.offset_words()[probe];
  geometry.states[probe] = field.statuses[probe].state;
  for_each_moments(store, grid, probe, [&](int t, const vec2& moments) {
    geometry.moments[probe * geometry.tile() + t] = encode_moments(moments, longest);
  });
}

bool is_lit(ProbeState state) {
  return state != ProbeState::off;
}

/// Whether the error of distances that were sent exceeds the threshold.
bool is_off(const ProbeStore& store, const FieldGeometry& sent, int probe, float threshold) {
  const ProbeGrid& grid = store.grid_of(probe);
  const float longest = max_probe_distance(grid);
  float means = 0.0f, deviations = 0.0f;
  const CodedMoments* then = &sent.moments[probe * sent.tile()];
  for_each_moments(store, grid, probe, [&](int t, const vec2& now) {
    const float deviation = std::sqrt(std::max(now.y - now.x * now.x, 0.0f));
    const float of_mean = now.x - decode_mean(then[t], longest);
    const float of_deviation = deviation - decode_deviation(then[t], longest);
    means += of_mean * of_mean;
    deviations += of_deviation * of_deviation;
  });
  const float most = threshold * smallest_spacing(grid);
  return std::max(means, deviations) > most * most * static_cast<float>(sent.tile());
}

}  // namespace

FieldGeometry kind_of(const IrradianceField& field) {
  const FieldAccess::State& state = FieldAccess::state_of(field);
  const ProbeStore& store = state.data.store;
  FieldGeometry geometry;
  geometry.irradiance_texels = store.irradiance_texels();
  geometry.distance_texels = store.distance_texels();
  for (int v = 0; v < store.volumes(); ++v) {
    geometry.volumes.push_back({store.grid(v), state.volumes.roles[v]});
  }
  return geometry;
}

FieldGeometry geometry_of(const IrradianceField& field) {
  const ProbeStore& store = store_of(field);
  const FieldAccess::State& state = FieldAccess::state_of(field);
  FieldGeometry geometry = kind_of(field);
  geometry.offsets.resize(store.probes());
  geometry.states.resize(store.probes());
  geometry.moments.resize(store.probes() * geometry.tile());
  parallel_chunks(store.probes(), kChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t probe = begin; probe < end; ++probe) {
      copy_probe(state, static_cast<int>(probe), geometry);
    }
  });
  geometry.corrections = corrections_of(field);
  return geometry;
}

std::vector<CodedCorrectionBlock> corrections_of(const IrradianceField& field) {
  const FieldAccess::State& state = FieldAccess::state_of(field);
  state.backend->fetch_corrections();
  return encode_corrections(state.data.correction.blocks());
}

std::vector<int> follow(const IrradianceField& field, float threshold, int first, int stride,
                        FieldGeometry& sent) {
  const ProbeStore& store = store_of(field);
  const FieldAccess::State& state = FieldAccess::state_of(field);
  for (int v = 0; v < store.volumes(); ++v) sent.volumes[v].grid = store.grid(v);
  std::vector<std::uint8_t> changed(store.probes());
  parallel_chunks(store.probes(), kChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const int probe = static_cast<int>(i);
      const bool moved = store.offset_words()[i] != sent.offsets[i] ||
                         is_lit(state.statuses[i].state) != is_lit(sent.states[i]);
      if (!moved && (probe % stride != first || !is_off(store, sent, probe, threshold))) continue;
      changed[i] = 1;
      copy_probe(state, probe, sent);
    }
  });
  std::vector<int> probes;
  for (int probe = 0; probe < store.probes(); ++probe) {
    if (changed[probe] != 0) probes.push_back(probe);
  }
  return probes;
}

}  // namespace lambent::stream
