// SPDX-License-Identifier: Apache-2.0
// The field's passes on a Vulkan device: blending rays into 4,096 probes, and lookups at every
// pixel of a picture.
#include <algorithm>
#include <ctime>
#include <limits>
#include <memory>
#include <numeric>
#include <thread>

#include "bench/workload.h"
#include "field/field_access.h"
#include "field/lookup/visibility.h"
#include "field/probes/volumes.h"
#include "field/vulkan/device_solver.h"
#include "lambent/vulkan.h"
#include "raytracing/vulkan/device_world.h"
#include "raytracing/world_access.h"
#include "vulkan/device.h"

namespace lambent::bench {
namespace {

constexpr int kVulkanRepetitions = 15;
constexpr int kRays = 144;
constexpr glm::ivec3 kProbeCount{16, 16, 16};

/// The device; null if there is none.
std::shared_ptr<vulkan::Device> shared_device() {
  static const auto opened = vulkan::open_device();
  return opened ? *opened : nullptr;
}
const vulkan::Device* device() {
  return shared_device().get();
}

/// Times recorded commands, after one run that is not counted.
template <class Record>
void time_on_device(benchmark::State& state, Record record) {
  device()->run(record);
  Median ms;
  double least = std::numeric_limits<double>::infinity();
  double least_busy = least;
  for (auto _ : state) {
    const std::clock_t before = std::clock();
    const double elapsed = time_ms([&] { device()->run(record); });
    const double busy = static_cast<double>(std::clock() - before) * 1e3 / CLOCKS_PER_SEC;
    state.SetIterationTime(elapsed * 1e-3);
    ms.add(elapsed);
    least = std::min(least, elapsed);
    least_busy = std::min(least_busy, busy);
  }
  // For a software device, the time that it would take if nothing else were running
  if (description(*device()).software) {
    state.counters["busy_ms"] = least_busy / std::thread::hardware_concurrency();
  }
  state.counters["median_ms"] = ms.value();
  state.counters["least_ms"] = least;
  state.SetLabel(description(*device()).name);
}

/// 4,096 probes with tiles of the published size, and the hits of their rays.
struct ProbeBlend {
  explicit ProbeBlend(const FieldSettings& settings)
      : store(still_grid(fit_grid(settings, open_bounds(workload().world)).value()), settings),
        field(*device(), settings, store),
        solver(field) {
    std::vector<int> probes(store.probes());
    std::iota(probes.begin(), probes.end(), 0);
    group.rays = std::make_shared<RaySet>(settings, settings.rays_per_probe, 0u);
    group.probes = probes;
    trace_probe_rays(tracer_of(workload().world), store, group);
    std::vector<ProbeTrace> traces(probes.size());
    shade_surfels(workload().world, solid_sides_by_winding(workload().scene), store, group,
                  settings, traces);
    find_surfel_lookups(store, {}, probes, traces);
    field.write_surfels(probes, traces);
    std::vector<HitRecord> records;
    for (const Hit& hit : group.hits)
      records.push_back({hit.distance, 0, 0, {}, 1u, hit.sample_weight});
    hits = vulkan::upload(*device(), records, "hits");
    blend_weights =
        vulkan::upload(*device(), std::vector<float>(probes.size(), 0.1f), "blend_weights");
    received = vulkan::Buffer(*device(), probes.size() * field.tile_texels() * sizeof(vec4),
                              vulkan::Memory::device, "received");
    list = field.list(probes);
    field.reserve_seen(list);
    solver.reserve(list);
  }

  static FieldSettings settings() {
    FieldSettings settings;
    settings.probe_count = kProbeCount;
    settings.rays_per_probe = kRays;
    settings.irradiance_texels = 8;
    settings.distance_texels = 16;
    return settings;
  }
  static ProbeBlend& published() {
    static ProbeBlend blend(settings());
    return blend;
  }
  /// Tiles of the default size.
  static ProbeBlend& usual() {
    static ProbeBlend blend([] {
      FieldSettings usual = settings();
      usual.irradiance_texels = FieldSettings{}.irradiance_texels;
      usual.distance_texels = FieldSettings{}.distance_texels;
      return usual;
    }());
    return blend;
  }

  DeviceTransport transport() const {
    return {{field.light().address()}, {field.light().address()}, {}, {received.address()}};
  }

  ProbeStore store;
  FieldResources field;
  DeviceSolver solver;
  TraceGroup group;
  vulkan::Buffer hits, blend_weights, received;
  DeviceProbes list;
};

/// Irradiance and distances, from rays to encoded tiles, without gathering light at surfels.
void vulkan_blend(benchmark::State& state, ProbeBlend& (*blend_of)()) {
  if (device() == nullptr) return state.SkipWithError("no Vulkan device");
  ProbeBlend& blend = blend_of();
  const DeviceGroup all = {0, blend.list.count(), kRays};
  time_on_device(state, [&](vulkan::Recorder& to) {
    blend.field.record_seen_distances(to, blend.list, all, {blend.hits.address()});
    blend.field.record_blend_distances(to, blend.list, {blend.blend_weights.address()}, 1u);
    blend.field.record_receive(to, blend.list, blend.transport());
    blend.field.record_store_light(to, blend.list, 1u);
  });
  state.counters["probes"] = static_cast<double>(blend.list.count());
}

void vulkan_blend_published_tiles(benchmark::State& state) {
  vulkan_blend(state, ProbeBlend::published);
}
void vulkan_blend_usual_tiles(benchmark::State& state) {
  vulkan_blend(state, ProbeBlend::usual);
}

/// One iteration of the solve: gathering light at surfels, and blending it into probes.
void vulkan_solve(benchmark::State& state) {
  if (device() == nullptr) return state.SkipWithError("no Vulkan device");
  ProbeBlend& blend = ProbeBlend::usual();
  time_on_device(state, [&](vulkan::Recorder& to) {
    blend.field.record_transport(to, blend.list, blend.transport());
  });
}

void vulkan_find_lookups(benchmark::State& state) {
  if (device() == nullptr) return state.SkipWithError("no Vulkan device");
  ProbeBlend& blend = ProbeBlend::usual();
  time_on_device(state, [&](vulkan::Recorder& to) { blend.field.record_lookups(to, blend.list); });
}

void vulkan_lookup(benchmark::State& state) {
  if (device() == nullptr) return state.SkipWithError("no Vulkan device");
  const Workload& work = workload();
  const FieldResources field(*device(), work.field.settings(), store_of(work.field));
  const std::vector<FieldQuery> queries = pixel_queries(work);
  const vulkan::Buffer in = vulkan::upload(*device(), queries, "queries");
  const vulkan::Buffer out(*device(), queries.size() * sizeof(vec3), vulkan::Memory::device, "E");
  time_on_device(state, [&](vulkan::Recorder& to) {
    field.record_lookup(to, {in.address()}, static_cast<std::uint32_t>(queries.size()),
                        {out.address()});
  });
  state.counters["lookups"] = static_cast<double>(queries.size());
}

/// Lookups with visibility by rays.
void lookup_by_rays(benchmark::State& state, Visibility visibility) {
  if (device() == nullptr) return state.SkipWithError("no Vulkan device");
  const Workload& work = workload();
  static const World there(work.scene, shared_device());
  const DeviceWorld& world = *device_world_of(there);
  FieldSettings settings = work.field.settings();
  settings.visibility = visibility;
  const ProbeStore& store = store_of(work.field);
  const FieldResources field(world.device(), settings, store);
  std::vector<int> probes(store.probes());
  std::iota(probes.begin(), probes.end(), 0);
  const std::vector<int> cells = cells_around(store, probes);
  const std::vector<FieldQuery> queries = pixel_queries(work);
  const vulkan::Buffer lowest = vulkan::upload(world.device(), cells, "cells");
  const vulkan::Buffer in = vulkan::upload(world.device(), queries, "queries");
  const vulkan::Buffer out(world.device(), queries.size() * sizeof(vec3), vulkan::Memory::device,
                           "E");
  world.device().run([&](vulkan::Recorder& to) {
    to.bind_textures(world.scene().textures());
    field.record_cell_visibility(to, world.tracer(), {lowest.address()},
                                 static_cast<int>(cells.size()));
  });
  const vulkan::Buffer rays(world.device(), sizeof(uint), vulkan::Memory::readback, "rays");
  time_on_device(state, [&](vulkan::Recorder& to) {
    to.bind_textures(world.scene().textures());
    field.record_lookup(to, {in.address()}, static_cast<std::uint32_t>(queries.size()),
                        {out.address()}, &world.tracer());
    field.take_ray_count(to, rays);
  });
  state.counters["lookups"] = static_cast<double>(queries.size());
  state.counters["rays"] = rays.as<uint>().front();
}

void vulkan_lookup_hybrid(benchmark::State& state) {
  lookup_by_rays(state, Visibility::hybrid);
}
void vulkan_lookup_exact(benchmark::State& state) {
  lookup_by_rays(state, Visibility::exact);
}

void timed(benchmark::internal::Benchmark* bench) {
  bench->UseManualTime()->Iterations(kVulkanRepetitions)->Unit(benchmark::kMillisecond);
}

BENCHMARK(vulkan_blend_published_tiles)->Apply(timed);
BENCHMARK(vulkan_blend_usual_tiles)->Apply(timed);
BENCHMARK(vulkan_solve)->Apply(timed);
BENCHMARK(vulkan_find_lookups)->Apply(timed);
BENCHMARK(vulkan_lookup)->Apply(timed);
BENCHMARK(vulkan_lookup_hybrid)->Apply(timed);
BENCHMARK(vulkan_lookup_exact)->Apply(timed);

}  // namespace
}  // namespace lambent::bench
