// SPDX-License-Identifier: Apache-2.0
#include "field/vulkan/world_rays.h"

#include <algorithm>

#include "field/lookup/visibility_math.h"
#include "vulkan/device_memory.h"

namespace lambent {
namespace {

using vulkan::Buffer;
using vulkan::Recorder;

// The most rays that are in memory at a time: enough to keep any device busy, in about 40 MB.
constexpr int kMaxBatchRays = 1 << 18;

/// Splits a list into batches that trace the same ray set, each small enough for kMaxBatchRays.
std::vector<DeviceGroup> batches_of(const FieldResources& field, const DeviceProbes& list) {
  std::vector<DeviceGroup> batches;
  for (int first = 0; first < list.count();) {
    const auto rays = field.rays_of(list.probes[first]);
    const int most = std::max(kMaxBatchRays / rays->rays(), 1);
    int end = first + 1;
    while (end < list.count() && end - first < most && field.rays_of(list.probes[end]) == rays) {
      ++end;
    }
    batches.push_back({first, end - first, rays->rays()});
    first = end;
  }
  return batches;
}

std::size_t rays_of(const DeviceGroup& batch) {
  return static_cast<std::size_t>(batch.count) * batch.rays;
}

}  // namespace

WorldRaysVulkan::WorldRaysVulkan(FieldResources& field, HitShading& shading,
                                 WorldRayBuffers& buffers, const DeviceWorld& world,
                                 const DeviceProbes& list, std::span<const int> cells, bool sees,
                                 DeviceTraining* training)
    : field_(field),
      shading_(shading),
      buffers_(buffers),
      world_(world),
      list_(list),
      sees_(sees),
      training_(training),
      batches_(batches_of(field, list)),
      cell_count_(static_cast<int>(cells.size())),
      shadow_rays_(field.device(), sizeof(uint), vulkan::Memory::readback, "shadow rays"),
      lookup_rays_(field.device(), sizeof(uint), vulkan::Memory::readback, "rays of lookups") {
  const vulkan::Device& device = field.device();
  if (!cells.empty()) cells_ = host_buffer(device, cells, "cells to look across");
  std::size_t most_rays = 0;
  for (const DeviceGroup& batch : batches_) most_rays = std::max(most_rays, rays_of(batch));
  reserve<RayRecord>(device, most_rays, "probe rays", buffers.rays);
  reserve<HitRecord>(device, most_rays, "probe hits", buffers.hits);
  reserve<LitPointRecord>(device, most_rays, "points of surfels", buffers.points);
  reserve<ShadedHitRecord>(device, most_rays, "shaded surfels", buffers.shaded);
  reserve<vec3>(device, most_rays, "direct light of surfels", buffers.direct);
  reserve<uint>(device, list.probes.size(), "ray indices", buffers.first_indices);
  std::vector<uint> first_indices;
  for (const int probe : list.probes) {
    first_indices.push_back(static_cast<uint>(first_ray_index(probe)));
  }
  vulkan::write<uint>(device, first_indices, buffers.first_indices);
}

void WorldRaysVulkan::trace(Recorder& to, int batch) {
  const DeviceGroup& group = batches_[batch];
  const auto rays = static_cast<std::uint32_t>(rays_of(group));
  to.bind_textures(world_.scene().textures());
  field_.record_rays(to, list_, group, {buffers_.rays.address()});
  world_.tracer().closest_hits(to, {{buffers_.rays.address()}, rays}, {buffers_.hits.address()});
  to.barrier();
}

void WorldRaysVulkan::shade(Recorder& to, int batch) {
  const DeviceGroup& group = batches_[batch];
  const auto rays = static_cast<std::uint32_t>(rays_of(group));
  const RaySet& set = *field_.rays_of(list_.probes[group.first]);
  shading_.shade_hits(
      to,
      {world_.scene(),
       world_.tracer(),
       {{buffers_.solid_first_words.address()}, {buffers_.solid_words.address()}}},
      {{buffers_.rays.address()}, {buffers_.hits.address()}, rays},
      {buffers_.first_indices.address() + group.first * sizeof(uint)},
      static_cast<std::uint32_t>(group.rays), surfel_shading(field_.settings(), set, nullptr),
      {{buffers_.points.address()}, {buffers_.shaded.address()}, {buffers_.direct.address()}});
  field_.record_surfels(to, list_, group, {buffers_.points.address()}, {buffers_.shaded.address()},
                        {buffers_.direct.address()});
  if (sees_) field_.record_seen_distances(to, list_, group, {buffers_.hits.address()});
}

void WorldRaysVulkan::visibility(Recorder& to) {
  field_.record_cell_visibility(to, world_.tracer(), {cells_.address()}, cell_count_);
}

void WorldRaysVulkan::record_counts(Recorder& to) const {
  to.barrier();
  shading_.take_ray_count(to, shadow_rays_);
  field_.take_ray_count(to, lookup_rays_);
}

std::uint64_t WorldRaysVulkan::probe_rays() const {
  std::uint64_t rays = 0;
  for (const DeviceGroup& batch : batches_) rays += rays_of(batch);
  return rays;
}

std::uint64_t WorldRaysVulkan::other_rays() const {
  return std::uint64_t{shadow_rays_.as<uint>().front()} + lookup_rays_.as<uint>().front() +
         static_cast<std::uint64_t>(cell_count_) * kCellPairs;
}

}  // namespace lambent
