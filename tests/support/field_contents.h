// SPDX-License-Identifier: Apache-2.0
// What fields hold, to the bit.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "field/field_access.h"
#include "field/field_state.h"
#include "support/field_scenes.h"

namespace lambent::test {

/// Everything that updates and files read of a field.
struct Contents {
  std::vector<uint> words;        // of the store: offsets, irradiance, distances
  std::vector<glm::vec4> light;   // before it is encoded
  std::vector<float> statistics;  // of each probe
  std::vector<float> looked_up;   // what corrections were learned as
  std::vector<double> updates;    // what the updates told
  std::uint64_t rays = 0;

  bool operator==(const Contents&) const = default;
};

inline void add_all(std::span<const uint> words, std::vector<uint>& to) {
  to.insert(to.end(), words.begin(), words.end());
}

inline Contents contents_of(const IrradianceField& field, const Stage& stage) {
  const FieldAccess::State& state = FieldAccess::state_of(field);
  Contents contents;
  add_all(state.data.store.offset_words(), contents.words);
  add_all(state.data.store.irradiance_words(), contents.words);
  add_all(state.data.store.distance_words(), contents.words);
  contents.light.assign(state.data.light.begin(), state.data.light.end());
  for (const ProbeStatus& status : state.statuses) {
    contents.statistics.push_back(static_cast<float>(status.state));
    contents.statistics.push_back(status.samples);
    contents.statistics.push_back(status.variance);
  }
  for (const glm::vec3& light : look_up(field, seen_points(stage))) {
    contents.looked_up.insert(contents.looked_up.end(), {light.x, light.y, light.z});
  }
  return contents;
}

/// Updates a field so often. Adds what the updates tell.
inline void update(IrradianceField& field, const Stage& stage, const UpdateRequest& request,
                   int updates, Contents& told) {
  for (int i = 0; i < updates; ++i) {
    const UpdateStatistics statistics = field.update(stage.world, request);
    told.updates.insert(told.updates.end(), {statistics.residual, statistics.change});
    told.rays += statistics.probe_rays + statistics.shadow_rays + statistics.correction_rays;
  }
}

/// What a field holds after some updates on these ranks.
inline Contents updated(const Stage& stage, const FieldSettings& settings, Ranks& ranks,
                        int updates = 3) {
  IrradianceField field = make_field(stage, settings, 0);
  share_work(field, ranks);
  Contents told;
  update(field, stage, {}, updates, told);
  Contents contents = contents_of(field, stage);
  contents.updates = std::move(told.updates);
  contents.rays = told.rays;
  return contents;
}

}  // namespace lambent::test
