// SPDX-License-Identifier: Apache-2.0
#include "bench/workload.h"

#include <algorithm>
#include <cstdlib>
#include <numeric>

#include "bench/stage.h"
#include "core/parallel.h"
#include "field/field_access.h"
#include "field/placement/relocate.h"
#include "field/probes/probe_grid.h"
#include "field/probes/probe_store.h"
#include "field/schedule/schedule.h"
#include "field/transport/blend.h"
#include "field/transport/surfels.h"
#include "lambent/renderer.h"
#include "raytracing/camera_rays.h"
#include "raytracing/shade_hits.h"
#include "raytracing/solid_sides/find_solid_sides.h"
#include "raytracing/world_access.h"

namespace lambent::bench {
namespace {

constexpr std::size_t kRaysPerTask = 1152;  // as many as eight probes trace together
constexpr int kSettlingUpdates = 2;

}  // namespace

Workload::Workload(std::string scene_name, Scene made)
    : name(std::move(scene_name)),
      scene(std::move(made)),
      world(scene),
      camera(scene.cameras.front()),
      field(value_or_throw(IrradianceField::make(FieldSettings{}, open_bounds(world)))) {
  for (int i = 0; i < kSettlingUpdates; ++i) field.update(world);
}

Workload& workload() {
  static Workload work = [] {
    const char* asked = std::getenv("LAMBENT_BENCH_SCENE");
    const std::string name = asked != nullptr && *asked != '\0' ? asked : "atrium";
    return Workload(name, open_stage(name));
  }();
  return work;
}

TraceGroup trace_all_probes(const Workload& work) {
  const FieldSettings& settings = work.field.settings();
  TraceGroup group;
  group.rays = std::make_shared<RaySet>(settings, settings.rays_per_probe, 0u);
  group.probes.resize(store_of(work.field).probes());
  std::iota(group.probes.begin(), group.probes.end(), 0);
  trace_probe_rays(tracer_of(work.world), store_of(work.field), group);
  return group;
}

UpdateRays record_update_rays(const Workload& work, int update) {
  const FieldSettings& settings = work.field.settings();
  const ProbeStore& store = store_of(work.field);
  const RaySet set(settings, settings.rays_per_probe, static_cast<uint>(update));
  const SolidSides sides = find_solid_sides(work.world, place_grids(store));
  const ShadeHitsSettings shading = surfel_shading(settings, set, &sides);

  // Shade each probe's hits to record the shadow rays
  const std::vector<VolumeRole> roles(1);  // only the field's own grid
  const std::vector<int> probes = schedule_all(store, roles, statuses_of(work.field), settings,
                                               static_cast<std::uint32_t>(update))
                                      .probes;
  const std::size_t rays = set.directions.size();
  std::vector<std::vector<Ray>> shadows(probes.size());
  UpdateRays result;
  result.probe_rays.resize(probes.size() * rays);
  parallel_chunks(probes.size(), 8, [&](std::size_t begin, std::size_t end) {
    std::vector<Hit> hits(rays);
    std::vector<ShadedHit> shaded(rays);
    ShadeHitsScratch scratch;
    for (std::size_t k = begin; k < end; ++k) {
      const vec3 origin = store.probe_position_ws(probes[k]);
      const std::span<Ray> batch(&result.probe_rays[k * rays], rays);
      for (std::size_t i = 0; i < rays; ++i) batch[i] = probe_ray(origin, set.directions[i]);
      tracer_of(work.world).closest_hits(batch, hits);
      shade_hits(work.world, batch, hits, shading, first_ray_index(probes[k]), scratch, shaded);
      shadows[k] = scratch.shadow_rays;
    }
  });
  for (const std::vector<Ray>& part : shadows) {
    result.shadow_rays.insert(result.shadow_rays.end(), part.begin(), part.end());
  }
  return result;
}

std::vector<Ray> primary_rays(const Workload& work) {
  std::vector<Ray> rays(static_cast<std::size_t>(kWidth) * kHeight);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    rays[i] = camera_ray(work.camera, kWidth, kHeight, static_cast<float>(i % kWidth) + 0.5f,
                         static_cast<float>(i / kWidth) + 0.5f);
  }
  return rays;
}

std::vector<FieldQuery> pixel_queries(const Workload& work) {
  std::vector<FieldQuery> queries =
      visible_points(work.world, work.world.scene().cameras.front(), kWidth, kHeight).value();
  // Add default queries in place of pixels that show the sky, which cost as much as others
  queries.resize(static_cast<std::size_t>(kWidth) * kHeight);
  return queries;
}

double time_closest_hits(const Workload& work, std::span<const Ray> rays, std::vector<Hit>& hits) {
  hits.resize(rays.size());
  return time_ms([&] {
    parallel_chunks(rays.size(), kRaysPerTask, [&](std::size_t begin, std::size_t end) {
      tracer_of(work.world)
          .closest_hits(rays.subspan(begin, end - begin), {&hits[begin], end - begin});
    });
  });
}

double time_occlusions(const Workload& work, std::span<const Ray> rays,
                       std::vector<std::uint8_t>& occluded) {
  occluded.resize(rays.size());
  return time_ms([&] {
    parallel_chunks(rays.size(), kRaysPerTask, [&](std::size_t begin, std::size_t end) {
      tracer_of(work.world)
          .occlusions(rays.subspan(begin, end - begin), {&occluded[begin], end - begin});
    });
  });
}

}  // namespace lambent::bench
