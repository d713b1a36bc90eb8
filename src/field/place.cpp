// SPDX-License-Identifier: Apache-2.0
// Where a field's probes stand and what they are for: relocation and classification.
#include <algorithm>
#include <utility>

#include "core/parallel.h"
#include "field/field_state.h"
#include "field/relocate.h"

namespace lambent {
namespace {

constexpr std::size_t kProbesPerTask = 16;

/// One flag an instance: it moves.
std::vector<std::uint8_t> moving_instances(const Scene& scene) {
  std::vector<std::uint8_t> moving(scene.instances.size());
  for (std::size_t i = 0; i < moving.size(); ++i) moving[i] = scene.instances[i].dynamic ? 1 : 0;
  return moving;
}

}  // namespace

void IrradianceField::State::place(const World& world, std::span<const int> probes) {
  const std::vector<std::uint8_t> moving = moving_instances(world.scene());
  if (settings.relocation) {
    const std::vector<int> moved =
        relocate_probes(world.scene(), world.tracer(), probes, moving, store);
    const std::vector<vec2> nothing(
        static_cast<std::size_t>(settings.distance_texels) * settings.distance_texels, vec2(0.0f));
    for (const int probe : moved) {
      records[probe].samples = 0.0f;
      traces[probe] = {};
      store.blend_moments(probe, nothing, 1.0f, 0u);
    }
  }
  find_reaches(world, probes);
}

void IrradianceField::State::find_reaches(const World& world, std::span<const int> probes) {
  classified = false;
  const std::vector<std::uint8_t> moving = moving_instances(world.scene());
  parallel_chunks(probes.size(), kProbesPerTask, [&](std::size_t begin, std::size_t end) {
    std::vector<Sight> seen(sight_directions().size());
    for (std::size_t k = begin; k < end; ++k) {
      const vec3 position = store.probe_position_ws(probes[k]);
      const vec3 home = probe_position(store.grid(), probe_coords(store.grid(), probes[k]));
      look_around(world.scene(), world.tracer(), position, moving, seen);
      reaches[probes[k]] = probe_reach(seen, position, home, store.grid().spacing);
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
  if (!classified) {
    classify_probes(store.grid(), reaches, moving, records);
    agenda.changed_all();
  } else if (moving != moved_to) {
    // States differ where something that moved on was or is
    const std::size_t most = std::max(moved_to.size(), moving.size());
    for (std::size_t i = 0; i < most; ++i) {
      const Bounds before = i < moved_to.size() ? moved_to[i] : Bounds{};
      const Bounds now = i < moving.size() ? moving[i] : Bounds{};
      if (before == now) continue;
      for (const Bounds& box : {before, now}) {
        for (const int probe :
             classify_probes_near(box, store.grid(), reaches, moving, records)) {
          agenda.changed(probe);
        }
      }
    }
  }
  moved_to = std::move(moving);
  classified = true;
}

}  // namespace lambent
