// SPDX-License-Identifier: Apache-2.0
// The parts of an update that relocate and classify probes.
#include <algorithm>
#include <iterator>
#include <utility>

#include "core/parallel.h"
#include "field/field_state.h"
#include "field/placement/relocate.h"
#include "field/transport/distances.h"
#include "lambent/world.h"
#include "raytracing/boxes.h"
#include "raytracing/places/closed_regions.h"
#include "raytracing/places/places.h"
#include "raytracing/solid_sides/find_solid_sides.h"
#include "raytracing/world_access.h"

namespace lambent {
namespace {

constexpr std::size_t kProbesPerTask = 16;

// Probes near edited static geometry are relocated after this many updates without another edit
// there. Otherwise an instance that an engine moves in every frame, but does not mark as dynamic,
// would relocate probes in every frame.
constexpr int kRestUpdates = 8;

// The extent of a box around everything [m]: large, but small enough that adding a cell's size is
// exact enough.
constexpr float kFar = 1e15f;
const Bounds kEverywhere{vec3(-kFar), vec3(kFar)};

/// The boxes of all that moved.
std::vector<Bounds> moved_boxes(std::span<const WorldChanges> changes) {
  std::vector<Bounds> moved;
  for (const WorldChanges& change : changes) {
    moved.insert(moved.end(), change.moved.begin(), change.moved.end());
  }
  return moved;
}

/// Whether a change makes a light or an emissive surface shine in a closed region.
bool lights_closed_region(const World& world, std::span<const WorldChanges> changes,
                          const SolidSides& sides) {
  std::vector<vec3> points;
  bool emission = false;
  for (const WorldChanges& change : changes) {
    for (const WorldChanges::LightChange& light : change.lights) {
      if (light.after && light.after->type != Light::Type::directional) {
        points.push_back(light.after->position_ws);
      }
    }
    emission |= change.emission;
  }
  if (emission) {
    const std::vector<vec3> lit = points_lit_by_emitters(world);
    points.insert(points.end(), lit.begin(), lit.end());
  }
  return !points.empty() && lights_closed_places(world, sides.open_space, points);
}

}  // namespace

/// Also forgets the corrections around these probes: all hold light of when it was dark there.
void IrradianceField::State::reset_opened_probes(std::span<const OpenPlaces> before,
                                                 std::uint64_t revision) {
  // The last grids of places are those of the volumes
  const std::vector<OpenPlaces>& now = data.solid_sides.open_space;
  const std::size_t volumes_there = data.store.grids().size();
  if (before.size() != now.size() || now.size() < volumes_there) return;
  std::vector<float> kept(statuses.size(), 1.0f);
  for (int probe = 0; probe < data.store.probes(); ++probe) {
    const std::size_t places = now.size() - volumes_there + data.store.volume_of(probe);
    const vec3 position_ws = data.store.probe_grid_position_ws(probe);
    if (before[places].is_open(position_ws) || !now[places].is_open(position_ws)) continue;
    reset_history(probe, revision, statuses, scheduling.scheduler);
    kept[probe] = 0.0f;
  }
  backend->forget_corrections(kept);
}

bool IrradianceField::State::find_solid_sides(const World& world) {
  const auto changes = world.changes_since(placement.solid_revision);
  placement.solid_revision = world.revision();
  const bool made = data.solid_sides.fits(world.scene());
  SolidSearch& search = placement.solid;
  const std::vector<Bounds> moved = changes ? moved_boxes(*changes) : std::vector<Bounds>();
  search.moved |= !changes || !moved.empty();
  search.needed =
      search.needed || !made || !changes ||
      lights_closed_region(world, *changes, data.solid_sides) ||
      (!moved.empty() && opens_closed_region(world, moved, data.solid_sides.open_space));
  // After a search that found nothing new, wait: lamps inside of things may flicker or move in
  // every update
  const bool waits = made && search.in_vain && updates - search.update < kRestUpdates;
  if (!search.needed || waits) return false;

  SolidSides before = std::move(data.solid_sides);
  const std::vector<PlaceGrid> grids = place_grids(data.store);
  // A volume that extends out of a room is meant to light its outside, too. Volumes that follow the
  // viewer always extend out of the scene, which means nothing
  const bool outside_counts = !follows_viewer() && reach_out_of_scene(world, grids);
  data.solid_sides =
      lambent::find_solid_sides(world, grids, outside_counts,
                                search.moved ? std::span<const OpenPlaces>()
                                             : std::span<const OpenPlaces>(before.open_space));
  backend->push_solid_sides();
  search = {.in_vain = made && data.solid_sides.words == before.words, .update = updates};
  // Where a dark room had counted as solid matter, all probes are placed again
  if (made && !search.in_vain) placement.open_before = std::move(before.open_space);
  return true;
}

std::vector<int> IrradianceField::State::place_probes(const World& world,
                                                      std::span<const int> probes) {
  const std::vector<std::uint8_t> moving = moving_instances(world.scene());
  std::vector<int> moved;
  if (settings.relocation) {
    // Start on the grid, so that the result depends on the scene only, not on where probes stood
    // before
    const std::vector<uint> before(data.store.offset_words().begin(),
                                   data.store.offset_words().end());
    for (const int probe : probes) data.store.set_probe_offset(probe, vec3(0.0f));
    relocate_probes({world.scene(), tracer_of(world), data.solid_sides, moving},
                    data.share.own(probes), data.store);
    data.share.gather(data.store.offset_words());
    for (const int probe : probes) {
      if (data.store.offset_words()[probe] != before[probe]) moved.push_back(probe);
    }
    for (const int probe : moved) reset_probe(probe, data, statuses, scheduling.scheduler);
  }
  update_classification_inputs(world, probes);
  backend->push_places(moved);
  return moved;
}

std::uint64_t IrradianceField::State::update_cell_visibility(const World& world,
                                                             std::span<const int> probes) {
  if (settings.visibility != Visibility::hybrid) return 0;
  const std::vector<int> cells = cells_around(data.store, probes);
  return backend->update_cell_visibility(world, cells);
}

void IrradianceField::State::initialize_relocated(const World& world, std::span<const int> moved,
                                                  UpdateStatistics& statistics) {
  // The pending edits do not count as applied to relocated probes, which have no surfels
  std::vector<int> still_updated;
  std::set_difference(edits.pending.updated.begin(), edits.pending.updated.end(), moved.begin(),
                      moved.end(), std::back_inserter(still_updated));
  edits.pending.updated = std::move(still_updated);
  update_classification_inputs(world, moved, /*learn_distances=*/true);
  backend->push_places(moved);
  statistics.shadow_rays += update_cell_visibility(world, moved);
  statistics.shadow_rays += backend->find_lookups(world, moved, data.traced_probes());
}

/// Places probes near edits that have stopped, or all where what is solid differs. Returns whether
/// it did.
bool IrradianceField::State::relocate_edited(const World& world, UpdateStatistics& statistics) {
  // Note the static geometry that was edited since the last update
  const auto changes = world.changes_since(placement.placed_revision);
  placement.placed_revision = world.revision();
  if (!changes) placement.edited_places = {{kEverywhere, updates}};
  for (std::size_t i = 0; changes && i < changes->size(); ++i) {
    for (const Bounds& box : (*changes)[i].rebuilt) {
      const auto known =
          std::find_if(placement.edited_places.begin(), placement.edited_places.end(),
                       [&](const EditedPlace& p) { return overlap(p.box, box); });
      if (known == placement.edited_places.end()) {
        placement.edited_places.push_back({box, updates});
      } else {
        known->box.add(box);
        known->update = updates;
      }
    }
  }

  const std::vector<int> near = placement.open_before ? all_probes() : probes_where_edits_stopped();
  if (near.empty()) return false;
  const std::vector<int> moved = place_probes(world, near);
  if (!moved.empty()) initialize_relocated(world, moved, statistics);
  for (const int probe : moved) inherit_history(probe, world);
  if (placement.open_before) reset_opened_probes(*placement.open_before, world.revision());
  placement.open_before.reset();
  return true;
}

/// The probes near places where edits have stopped, which are edited places no longer.
std::vector<int> IrradianceField::State::probes_where_edits_stopped() {
  const auto at_rest =
      std::partition(placement.edited_places.begin(), placement.edited_places.end(),
                     [&](const EditedPlace& p) { return updates - p.update < kRestUpdates; });
  if (at_rest == placement.edited_places.end()) return {};
  std::vector<int> near;
  for (int probe = 0; probe < data.store.probes(); ++probe) {
    const vec3 grid_position = data.store.probe_grid_position_ws(probe);
    const ProbeGrid& grid = data.store.grid_of(probe);
    if (std::any_of(at_rest, placement.edited_places.end(),
                    [&](const EditedPlace& p) { return may_light(p.box, grid_position, grid); })) {
      near.push_back(probe);
    }
  }
  placement.edited_places.erase(at_rest, placement.edited_places.end());
  return near;
}

/// Keeps the light of a relocated probe as the start of its new average. It counts as many samples
/// as the fixed rays would, so that the few rays of the probe's next update do not replace all of
/// it.
void IrradianceField::State::inherit_history(int probe, const World& world) {
  ProbeStatus& status = statuses[probe];
  status = {};
  // A probe in open air gets no samples, so that it is traced at once and not in its turn
  if (placement.classification_inputs[probe].lights_surface) {
    status.samples = static_cast<float>(fixed_ray_directions().size()) /
                     static_cast<float>(settings.rays_per_probe);
  }
  status.last_traced = static_cast<std::uint32_t>(updates);
  status.revision = world.revision();
  scheduling.scheduler.mark_changed(probe);
}

/// Discards a probe's surfels, stored distances and samples. Its light stays until it is traced.
void reset_probe(int probe, ProbeData& data, std::span<ProbeStatus> statuses,
                 ProbeScheduler& scheduler) {
  const std::vector<vec2> nothing(
      static_cast<std::size_t>(data.settings.distance_texels) * data.settings.distance_texels,
      vec2(0.0f));
  statuses[probe].samples = 0.0f;
  data.traces[probe] = {};
  scheduler.mark_changed(probe);
  data.store.blend_moments(probe, nothing, 1.0f, 0u);
}

void IrradianceField::State::update_classification_inputs(const World& world,
                                                          std::span<const int> probes,
                                                          bool learn_distances) {
  placement.classified = false;
  const std::vector<std::uint8_t> moving = moving_instances(world.scene());
  const DistanceBlend blend(settings, fixed_ray_directions());
  const std::size_t directions = fixed_ray_directions().size();
  const auto learn = [&](int probe, std::span<const FixedRayHit> around) {
    const ProbeGrid& grid = data.store.grid_of(probe);
    placement.classification_inputs[probe] = classification_input(
        around, data.store.probe_offset(probe) * grid.spacing, vec3(0.0f), grid.spacing);
    if (!learn_distances) return;
    std::vector<RayDistance> seen;
    for (const FixedRayHit& hit : around) seen.push_back({hit.distance, hit.from_inside != 0});
    std::vector<vec2> moments(blend.texels());
    blend.moments(seen, max_probe_distance(grid), moments);
    data.store.blend_moments(probe, moments, 1.0f, dither_seed());
  };
  const std::size_t batch = viewpoints_of_batch(tracer_of(world));
  const std::span<const int> own = data.share.own(probes);
  parallel_chunks(own.size(), batch, [&](std::size_t first, std::size_t last) {
    std::vector<Viewpoint> viewpoints;
    for (std::size_t k = first; k < last; ++k) {
      viewpoints.push_back({data.store.probe_position_ws(own[k]), data.store.grid_of(own[k]).axes});
    }
    std::vector<FixedRayHit> around(viewpoints.size() * directions);
    trace_fixed_rays({world.scene(), tracer_of(world), data.solid_sides, moving}, viewpoints,
                     around);
    // A device traces large batches, whose results all cores work on
    parallel_chunks(viewpoints.size(), kProbesPerTask, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        learn(own[first + k], {&around[k * directions], directions});
      }
    });
  });
  data.share.gather(std::span(placement.classification_inputs));
  if (learn_distances) data.share.gather(data.store.distance_words());
}

void classify(const World& world, const ProbeStore& store, PlacementState& placement,
              std::span<ProbeStatus> statuses, ProbeScheduler& scheduler) {
  std::vector<Bounds> moving;
  const std::vector<Instance>& instances = world.scene().instances;
  for (int i = 0; i < static_cast<int>(instances.size()); ++i) {
    if (instances[i].dynamic) moving.push_back(world.instance_bounds(i));
  }
  if (!placement.classified) {
    classify_probes(store, placement.classification_inputs, moving, statuses);
    scheduler.mark_all_changed();
  } else if (moving != placement.moved_to) {
    // Only probes near the old or new bounds of a dynamic instance can have another state
    const std::size_t most = std::max(placement.moved_to.size(), moving.size());
    for (std::size_t i = 0; i < most; ++i) {
      const Bounds before = i < placement.moved_to.size() ? placement.moved_to[i] : Bounds{};
      const Bounds now = i < moving.size() ? moving[i] : Bounds{};
      if (before == now) continue;
      for (const Bounds& box : {before, now}) {
        for (const int probe :
             classify_probes_near(box, store, placement.classification_inputs, moving, statuses)) {
          scheduler.mark_changed(probe);
        }
      }
    }
  }
  placement.moved_to = std::move(moving);
  placement.classified = true;
}

}  // namespace lambent
