// SPDX-License-Identifier: Apache-2.0
// Where a field's probes stand and what they are for: relocation and classification.
#include "core/parallel.h"
#include "field/distances.h"
#include "field/field_state.h"
#include "field/relocate.h"
#include "lambent/world.h"

namespace lambent {
namespace {

constexpr std::size_t kProbesPerTask = 16;

}  // namespace

void IrradianceField::State::place(const World& world, std::span<const int> probes) {
  const std::vector<std::uint8_t> moving = moving_instances(world.scene());
  if (settings.relocation) {
    const std::vector<int> moved =
        relocate_probes(world.scene(), world.tracer(), probes, moving, store);
    for (const int probe : moved) forget_place(probe);
  }
  find_reaches(world, probes);
}

/// Has a probe forget what it knows of its surroundings; its light stays until it is traced.
void IrradianceField::State::forget_place(int probe) {
  const std::vector<vec2> nothing(
      static_cast<std::size_t>(settings.distance_texels) * settings.distance_texels, vec2(0.0f));
  records[probe].samples = 0.0f;
  traces[probe] = {};
  store.blend_moments(probe, nothing, 1.0f, 0u);
}

void IrradianceField::State::find_reaches(const World& world, std::span<const int> probes,
                                          bool learn_distances) {
  const std::vector<std::uint8_t> moving = moving_instances(world.scene());
  const DistanceBlend blend(settings, sight_directions());
  parallel_chunks(probes.size(), kProbesPerTask, [&](std::size_t begin, std::size_t end) {
    std::vector<Sight> around(sight_directions().size());
    std::vector<SeenDistance> seen(around.size());
    std::vector<vec2> moments(blend.texels());
    for (std::size_t k = begin; k < end; ++k) {
      const int probe = probes[k];
      const ProbeGrid& grid = store.grid_of(probe);
      look_around(world.scene(), world.tracer(), store.probe_position_ws(probe), grid.axes, moving,
                  around);
      reaches[probe] =
          probe_reach(around, store.probe_offset(probe) * grid.spacing, vec3(0.0f), grid.spacing);
      if (!learn_distances) continue;
      for (std::size_t i = 0; i < around.size(); ++i) {
        seen[i] = {around[i].distance, around[i].back_face};
      }
      blend.moments(seen, max_probe_distance(grid), moments);
      store.blend_moments(probe, moments, 1.0f, salt());
    }
  });
}

void IrradianceField::State::classify(const World& world) {
  // An exact number of bounces is carried through all probes at once
  if (settings.max_bounces >= 0) return;
  std::vector<Bounds> moving;
  const std::vector<Instance>& instances = world.scene().instances;
  for (int i = 0; i < static_cast<int>(instances.size()); ++i) {
    if (instances[i].dynamic) moving.push_back(world.instance_bounds(i));
  }
  classify_probes(store, reaches, moving, records);
}

}  // namespace lambent
