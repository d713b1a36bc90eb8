// SPDX-License-Identifier: Apache-2.0
#include "field/vulkan/vulkan_field_backend.h"

#include <algorithm>
#include <cassert>
#include <numeric>

#include "shared/color.h"
#include "vulkan/device_memory.h"
#include "vulkan/recorder.h"

namespace lambent {
namespace {

using vulkan::Buffer;
using vulkan::Recorder;

// The most rays that are in memory at a time: enough to fill any device, in about 40 MB.
constexpr int kMaxBatchRays = 1 << 18;

// The sum of all importance, in the fixed-point numbers in which it is summed. Rounding each
// summand to the nearest number adds less than the range that is left to 2^32.
constexpr double kMaxScattered = 2147483648.0;

// The most passes of a command buffer that are timed, besides two per group of rays.
constexpr std::uint32_t kTimedPasses = 16;

/// Splits a list into groups that trace the same ray set, each small enough for kMaxBatchRays.
std::vector<DeviceGroup> groups_of_rays(const FieldResources& field, const DeviceProbes& list) {
  std::vector<DeviceGroup> groups;
  for (int first = 0; first < list.count();) {
    const auto rays = field.rays_of(list.probes[first]);
    const int most = std::max(kMaxBatchRays / rays->rays(), 1);
    int end = first + 1;
    while (end < list.count() && end - first < most && field.rays_of(list.probes[end]) == rays) {
      ++end;
    }
    groups.push_back({first, end - first, rays->rays()});
    first = end;
  }
  return groups;
}

/// Buffers into which the numbers of shadow and visibility rays are read back.
struct RayCounts {
  explicit RayCounts(const vulkan::Device& device)
      : shadows(device, sizeof(uint), vulkan::Memory::readback, "shadow rays"),
        lookups(device, sizeof(uint), vulkan::Memory::readback, "rays of lookups") {}

  std::uint64_t sum() const {
    return std::uint64_t{shadows.as<uint>().front()} + lookups.as<uint>().front();
  }

  Buffer shadows, lookups;
};

/// Adds the times of passes to the results, by the passes' names.
void assign_pass_times(const std::vector<vulkan::DevicePassTime>& times, DeviceTraced& traced) {
  for (const vulkan::DevicePassTime& time : times) {
    if (time.name == "trace") traced.trace_ms = time.ms;
    if (time.name == "shade") traced.shade_ms = time.ms;
    if (time.name == "solve") traced.solve_ms = time.ms;
    if (time.name == "blend") traced.blend_ms = time.ms;
  }
}

}  // namespace

VulkanFieldBackend::VulkanFieldBackend(const World& world, const FieldSettings& settings,
                                       const ProbeStore& store)
    : device_(world.on_device()->shared_device()),
      settings_(settings),
      field_(*device_, settings, store),
      solver_(field_),
      shading_(*device_) {}

bool VulkanFieldBackend::is_on(const World& world) const {
  return world.on_device() != nullptr && &world.on_device()->device() == device_.get();
}

void VulkanFieldBackend::set_distances(const ProbeStore& store, std::span<const int> probes) {
  field_.write_distances(store, probes);
}

void VulkanFieldBackend::write_light(const WorkingIrradiance& light,
                                     const WorkingIrradiance& last_irradiance_estimate) {
  vulkan::write<vec4>(*device_, light, field_.light());
  vulkan::write<vec4>(*device_, last_irradiance_estimate, field_.last_irradiance_estimate());
}

void VulkanFieldBackend::read_light(WorkingIrradiance& light,
                                    WorkingIrradiance& last_irradiance_estimate) const {
  vulkan::read<vec4>(*device_, field_.light(), light);
  vulkan::read<vec4>(*device_, field_.last_irradiance_estimate(), last_irradiance_estimate);
}

void VulkanFieldBackend::store_light(std::span<const int> probes, uint dither_seed) {
  DeviceProbes list;
  list.probes.assign(probes.begin(), probes.end());
  list.indices = host_buffer(*device_, probes, "probes to store");
  device_->run([&](Recorder& to) { field_.record_store_light(to, list, dither_seed); });
}

template <class T>
std::vector<T> VulkanFieldBackend::in_order_of(const DeviceProbes& list, std::span<const T> given,
                                               std::size_t each) const {
  std::vector<T> ordered(given.size());
  for (std::size_t named = 0; named < list.position.size(); ++named) {
    std::copy_n(&given[named * each], each, &ordered[list.position[named] * each]);
  }
  return ordered;
}

void VulkanFieldBackend::reserve_rays(std::size_t rays, std::size_t probes) {
  reserve<RayRecord>(*device_, rays, "probe rays", rays_);
  reserve<HitRecord>(*device_, rays, "probe hits", hits_);
  reserve<LitPointRecord>(*device_, rays, "points of surfels", points_);
  reserve<ShadedHitRecord>(*device_, rays, "shaded surfels", shaded_);
  reserve<vec3>(*device_, rays, "direct light of surfels", direct_);
  reserve<uint>(*device_, probes, "ray indices", first_indices_);
}

/// Reserves memory for the rays of a list, and counts them. Returns the number of passes to time.
std::uint32_t VulkanFieldBackend::prepare_rays(const DeviceProbes& list, DeviceTraced& traced) {
  std::vector<uint> first_indices;
  for (const int probe : list.probes) {
    first_indices.push_back(static_cast<uint>(first_ray_index(probe)));
  }
  std::size_t most_rays = 0;
  std::uint32_t groups = 0;
  for (const DeviceGroup& group : groups_of_rays(field_, list)) {
    const auto rays = static_cast<std::size_t>(group.count) * group.rays;
    traced.probe_rays += rays;
    most_rays = std::max(most_rays, rays);
    ++groups;
  }
  reserve_rays(most_rays, list.probes.size());
  vulkan::write<uint>(*device_, first_indices, first_indices_);
  return 2 * groups + kTimedPasses;
}

void VulkanFieldBackend::record_tracing(Recorder& to, const DeviceWorld& world,
                                        const DeviceProbes& list, bool seen) {
  const DeviceStage stage{world.scene(), world.tracer()};
  for (const DeviceGroup& group : groups_of_rays(field_, list)) {
    const auto rays = static_cast<std::uint32_t>(group.count * group.rays);
    to.begin_pass("trace");
    to.bind_textures(world.scene().textures());
    field_.record_rays(to, list, group, {rays_.address()});
    world.tracer().closest_hits(to, {{rays_.address()}, rays}, {hits_.address()});
    to.barrier();
    to.end_pass();
    to.begin_pass("shade");
    const RaySet& set = *field_.rays_of(list.probes[group.first]);
    shading_.shade_hits(to, stage, {{rays_.address()}, {hits_.address()}, rays},
                        {first_indices_.address() + group.first * sizeof(uint)},
                        static_cast<std::uint32_t>(group.rays), surfel_shading(settings_, set),
                        {{points_.address()}, {shaded_.address()}, {direct_.address()}});
    field_.record_surfels(to, list, group, {points_.address()}, {shaded_.address()},
                          {direct_.address()});
    to.end_pass();
    if (seen) field_.record_seen_distances(to, list, group, {hits_.address()});
  }
}

DeviceTraced VulkanFieldBackend::trace(const DeviceTracing& tracing) {
  std::vector<int> probes;
  for (const TraceGroup& group : tracing.groups) {
    field_.set_rays(group.probes, group.rays);
    probes.insert(probes.end(), group.probes.begin(), group.probes.end());
  }
  DeviceTraced traced;
  if (probes.empty()) return traced;
  const DeviceProbes list = field_.list(probes);
  const std::vector<float> blend_weights = in_order_of(list, tracing.blend_weights, 1);
  const Buffer blend_weight_buffer = host_buffer<float>(*device_, blend_weights, "blend weights");
  Buffer changes(*device_, probes.size() * sizeof(LightChange), vulkan::Memory::readback,
                 "changes of light");
  const std::uint32_t timed = prepare_rays(list, traced);
  field_.reserve_seen(list);
  field_.reserve_transport(list);
  solver_.reserve(list);
  const RayCounts counts(*device_);

  const float largest = *std::max_element(blend_weights.begin(), blend_weights.end());
  vulkan::Timestamps timestamps(*device_, timed);
  device_->run([&](Recorder& untimed) {
    Recorder to(*device_, untimed.commands(), &timestamps);
    record_tracing(to, *tracing.world.on_device(), list, /*seen=*/true);
    shading_.take_ray_count(to, counts.shadows);
    to.begin_pass("blend");
    field_.record_blend_distances(to, list, {blend_weight_buffer.address()}, tracing.dither_seed);
    to.end_pass();
    to.begin_pass("shade");
    field_.record_lookups(to, list, &tracing.world.on_device()->tracer());
    field_.take_ray_count(to, counts.lookups);
    to.end_pass();
    to.begin_pass("solve");
    if (tracing.max_bounces >= 0) {
      solver_.record_bounces(to, list, blend_weight_buffer, tracing.max_bounces);
    } else {
      solver_.record(to, list, blend_weight_buffer, largest, {}, tracing.solve);
    }
    field_.record_last_estimates(to, list, {solver_.solution().address()});
    field_.record_compare_light(to, list, {solver_.history().address()}, tracing.darkest,
                                {changes.address()});
    to.end_pass();
    to.begin_pass("blend");
    field_.record_store_light(to, list, tracing.dither_seed);
    to.end_pass();
  });
  assign_pass_times(timestamps.read(), traced);
  traced.shadow_rays = counts.sum();
  traced.solve = solver_.result();
  const std::span<const LightChange> found = changes.as<LightChange>();
  for (const std::size_t position : list.position) traced.changes.push_back(found[position]);
  return traced;
}

DeviceTraced VulkanFieldBackend::retrace(const World& world, std::span<const int> probes,
                                         uint dither_seed) {
  std::vector<int> traced_before, all;
  for (const int probe : probes) {
    if (field_.rays_of(probe)) traced_before.push_back(probe);
  }
  for (int probe = 0; probe < field_.probes(); ++probe) {
    if (field_.rays_of(probe)) all.push_back(probe);
  }
  DeviceTraced traced;
  if (traced_before.empty()) return traced;
  const DeviceProbes list = field_.list(traced_before), everyone = field_.list(all);
  const std::uint32_t timed = prepare_rays(list, traced);
  const RayCounts counts(*device_);
  vulkan::Timestamps timestamps(*device_, timed);
  device_->run([&](Recorder& untimed) {
    Recorder to(*device_, untimed.commands(), &timestamps);
    field_.record_distances_before(to, list);
    record_tracing(to, *world.on_device(), list, /*seen=*/false);
    shading_.take_ray_count(to, counts.shadows);
    to.begin_pass("blend");
    field_.record_move_distances(to, list, dither_seed);
    to.end_pass();
    to.begin_pass("shade");
    field_.record_lookups(to, everyone, &world.on_device()->tracer());
    field_.take_ray_count(to, counts.lookups);
    to.end_pass();
  });
  assign_pass_times(timestamps.read(), traced);
  traced.shadow_rays = counts.sum();
  return traced;
}

DeviceSolve VulkanFieldBackend::solve(std::span<const int> probes,
                                      std::span<const float> blend_weights,
                                      const WorkingIrradiance& history_ratio,
                                      const SolveSettings& settings, WorkingIrradiance* solution) {
  const auto texels = static_cast<std::size_t>(field_.tile_texels());
  if (solution != nullptr) solution->assign(probes.size() * texels, vec4(0.0f));
  if (probes.empty()) return {};
  const DeviceProbes list = field_.list(probes);
  const std::vector<float> ordered = in_order_of(list, blend_weights, 1);
  const Buffer blend_weight_buffer = host_buffer<float>(*device_, ordered, "blend weights");
  Buffer history_ratios;
  if (!history_ratio.empty()) {
    history_ratios =
        host_buffer<vec4>(*device_, in_order_of(list, std::span<const vec4>(history_ratio), texels),
                          "history ratios");
  }
  field_.reserve_transport(list);
  solver_.reserve(list);
  const float largest = *std::max_element(ordered.begin(), ordered.end());
  device_->run([&](Recorder& to) {
    solver_.record(to, list, blend_weight_buffer, largest,
                   {history_ratio.empty() ? 0 : history_ratios.address()}, settings);
  });
  if (solution != nullptr) {
    std::vector<vec4> found(probes.size() * texels);
    vulkan::read<vec4>(*device_, solver_.solution(), found);
    for (std::size_t named = 0; named < probes.size(); ++named) {
      std::copy_n(&found[list.position[named] * texels], texels, &(*solution)[named * texels]);
    }
  }
  return solver_.result();
}

void VulkanFieldBackend::receive(std::span<const int> probes, const WorkingIrradiance& fallback,
                                 WorkingIrradiance& received) {
  if (probes.empty()) return;
  const auto texels = static_cast<std::size_t>(field_.tile_texels());
  const DeviceProbes list = field_.list(probes);
  const Buffer before = host_buffer<vec4>(
      *device_, in_order_of(list, std::span<const vec4>(fallback), texels), "light before");
  const Buffer found(*device_, probes.size() * texels * sizeof(vec4), vulkan::Memory::readback,
                     "received light");
  field_.reserve_transport(list);
  device_->run([&](Recorder& to) {
    field_.record_transport(
        to, list, {{field_.light().address()}, {before.address()}, {}, {found.address()}});
  });
  for (std::size_t named = 0; named < probes.size(); ++named) {
    std::copy_n(&found.as<vec4>()[list.position[named] * texels], texels,
                &received[named * texels]);
  }
}

std::vector<double> VulkanFieldBackend::direct_light(std::span<const int> probes) {
  std::vector<double> light(probes.size(), 0.0);
  std::vector<int> traced;
  std::vector<std::size_t> named;
  for (std::size_t k = 0; k < probes.size(); ++k) {
    if (!field_.rays_of(probes[k])) continue;
    traced.push_back(probes[k]);
    named.push_back(k);
  }
  if (traced.empty()) return light;
  const auto texels = static_cast<std::size_t>(field_.tile_texels());
  const DeviceProbes list = field_.list(traced);
  const Buffer nothing(*device_, traced.size() * texels * sizeof(vec4), vulkan::Memory::upload,
                       "no light");
  const Buffer found(*device_, nothing.bytes(), vulkan::Memory::readback, "direct light");
  field_.reserve_transport(list);
  device_->run([&](Recorder& to) {
    field_.record_transport(
        to, list,
        {{field_.light().address()}, {nothing.address()}, {}, {found.address()}, kGatherDirect});
  });
  for (std::size_t k = 0; k < traced.size(); ++k) {
    const vec4* tile = &found.as<vec4>()[list.position[k] * texels];
    for (std::size_t t = 0; t < texels; ++t) light[named[k]] += luminance(vec3(tile[t]));
  }
  return light;
}

std::vector<float> VulkanFieldBackend::scatter_importance(std::span<const float> received,
                                                          float least) {
  std::vector<int> sending;
  for (int probe = 0; probe < field_.probes(); ++probe) {
    if (received[probe] > least && field_.rays_of(probe)) sending.push_back(probe);
  }
  std::vector<float> sent(received.size(), 0.0f);
  if (sending.empty()) return sent;
  const DeviceProbes list = field_.list(sending);
  const Buffer given = host_buffer(*device_, received, "importance");
  const Buffer sums(*device_, received.size_bytes(), vulkan::Memory::device, "importance sent");
  const Buffer taken(*device_, received.size_bytes(), vulkan::Memory::readback, "importance taken");
  // Sum fixed-point numbers, so that the order of additions does not matter. Probes send no more
  // importance in total than they received
  const double most = std::accumulate(received.begin(), received.end(), 0.0);
  const auto scale = static_cast<float>(kMaxScattered / most);
  device_->run([&](Recorder& to) {
    to.fill(sums, 0u);
    to.barrier();
    field_.record_scatter_importance(to, list, {given.address()}, {sums.address()}, scale);
    to.copy(sums, taken, received.size_bytes());
  });
  for (std::size_t i = 0; i < sent.size(); ++i) {
    sent[i] = static_cast<float>(taken.as<std::uint32_t>()[i]) / scale;
  }
  return sent;
}

}  // namespace lambent
