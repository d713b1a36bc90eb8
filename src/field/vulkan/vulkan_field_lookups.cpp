// SPDX-License-Identifier: Apache-2.0
// Lookups of a field on Vulkan, with the visibility rays that they need.
#include <algorithm>
#include <cassert>

#include "field/lookup/visibility_math.h"
#include "field/vulkan/vulkan_field_backend.h"
#include "raytracing/world_access.h"
#include "vulkan/device_memory.h"
#include "vulkan/recorder.h"

namespace lambent {
namespace {

using vulkan::Buffer;
using vulkan::Recorder;

// The most queries of the host that are in memory at a time: enough to keep any device busy, in
// 48 MB.
constexpr std::size_t kQueriesAtATime = 1 << 20;

}  // namespace

std::uint64_t VulkanFieldBackend::update_cell_visibility(const World& world,
                                                         std::span<const int> cells) {
  const DeviceWorld& there = *device_world_of(world);
  const Buffer lowest = host_buffer(*device_, cells, "cells to look at");
  device_->run([&](Recorder& to) {
    to.bind_textures(there.scene().textures());
    field_.record_cell_visibility(to, there.tracer(), {lowest.address()},
                                  static_cast<int>(cells.size()));
  });
  return cells.size() * kCellPairs;
}

/// Finds all lookups again, which is cheaper than finding the surfels that read a moved probe.
std::uint64_t VulkanFieldBackend::find_lookups(const World& world, std::span<const int>,
                                               std::span<const int> among) {
  const std::vector<int> traced = traced_among(among);
  if (traced.empty()) return 0;
  const DeviceProbes list = field_.list(traced);
  const Buffer rays(*device_, sizeof(uint), vulkan::Memory::readback, "rays of lookups");
  device_->run([&](Recorder& to) {
    to.bind_textures(device_world_of(world)->scene().textures());
    field_.record_lookups(to, list, &device_world_of(world)->tracer());
    field_.take_ray_count(to, rays);
  });
  return rays.as<uint>().front();
}

void VulkanFieldBackend::irradiance(std::span<const FieldQuery> queries, const World* world,
                                    CorrectionUse use, std::span<vec3> result) const {
  for (std::size_t first = 0; first < queries.size(); first += kQueriesAtATime) {
    const std::size_t count = std::min(kQueriesAtATime, queries.size() - first);
    const Buffer asked = host_buffer(*device_, queries.subspan(first, count), "queries");
    const Buffer answers(*device_, count * sizeof(vec3), vulkan::Memory::readback, "answers");
    device_->run([&](Recorder& to) {
      record_lookups(to, world, asked.address(), static_cast<std::uint32_t>(count), use,
                     answers.address());
    });
    std::copy_n(answers.as<vec3>().begin(), count, result.begin() + first);
  }
}

void VulkanFieldBackend::record_lookups(Recorder& recorder, const World* world,
                                        std::uint64_t queries, std::uint32_t count,
                                        CorrectionUse use, std::uint64_t irradiance) const {
  const DeviceTracer* tracer = nullptr;
  if (world != nullptr && is_on(*world)) {
    recorder.bind_textures(device_world_of(*world)->scene().textures());
    tracer = &device_world_of(*world)->tracer();
  }
  field_.record_lookup(recorder, {queries}, count, {irradiance}, tracer,
                       field_.corrections().arrays(use));
}

std::unique_ptr<FieldBackend> make_field_backend_vulkan(const World& world, ProbeData& data) {
  assert(lives_on_device(world, data.store.probes()));
  return std::make_unique<VulkanFieldBackend>(world, data);
}

}  // namespace lambent
