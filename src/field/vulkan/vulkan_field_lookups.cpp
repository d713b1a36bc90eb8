// SPDX-License-Identifier: Apache-2.0
// Lookups of a field on Vulkan, with the visibility rays that they need.
#include <algorithm>
#include <cassert>

#include "field/lookup/visibility_math.h"
#include "field/vulkan/vulkan_field_backend.h"
#include "vulkan/device_memory.h"
#include "vulkan/recorder.h"

namespace lambent {
namespace {

using vulkan::Buffer;
using vulkan::Recorder;

// The most queries of the host that are in memory at a time: enough to fill any device, in 48 MB.
constexpr std::size_t kQueriesAtATime = 1 << 20;

}  // namespace

std::uint64_t VulkanFieldBackend::update_cell_visibility(const World& world,
                                                         std::span<const int> cells) {
  const DeviceWorld& there = *world.on_device();
  const Buffer lowest = host_buffer(*device_, cells, "cells to look at");
  device_->run([&](Recorder& to) {
    to.bind_textures(there.scene().textures());
    field_.record_cell_visibility(to, there.tracer(), {lowest.address()},
                                  static_cast<int>(cells.size()));
  });
  return cells.size() * kCellPairs;
}

std::uint64_t VulkanFieldBackend::find_lookups(const World& world, std::span<const int> probes) {
  std::vector<int> traced;
  for (const int probe : probes) {
    if (field_.rays_of(probe)) traced.push_back(probe);
  }
  if (traced.empty()) return 0;
  const DeviceProbes list = field_.list(traced);
  const Buffer rays(*device_, sizeof(uint), vulkan::Memory::readback, "rays of lookups");
  device_->run([&](Recorder& to) {
    to.bind_textures(world.on_device()->scene().textures());
    field_.record_lookups(to, list, &world.on_device()->tracer());
    field_.take_ray_count(to, rays);
  });
  return rays.as<uint>().front();
}

void VulkanFieldBackend::irradiance(std::span<const FieldQuery> queries, const World* world,
                                    std::span<vec3> result) const {
  for (std::size_t first = 0; first < queries.size(); first += kQueriesAtATime) {
    const std::size_t count = std::min(kQueriesAtATime, queries.size() - first);
    const Buffer asked = host_buffer(*device_, queries.subspan(first, count), "queries");
    const Buffer answers(*device_, count * sizeof(vec3), vulkan::Memory::readback, "answers");
    device_->run([&](Recorder& to) {
      record_lookups(to, world, asked.address(), static_cast<std::uint32_t>(count),
                     answers.address());
    });
    std::copy_n(answers.as<vec3>().begin(), count, result.begin() + first);
  }
}

void VulkanFieldBackend::record_lookups(Recorder& recorder, const World* world,
                                        std::uint64_t queries, std::uint32_t count,
                                        std::uint64_t irradiance) const {
  const DeviceTracer* tracer = nullptr;
  if (world != nullptr && is_on(*world)) {
    recorder.bind_textures(world->on_device()->scene().textures());
    tracer = &world->on_device()->tracer();
  }
  field_.record_lookup(recorder, {queries}, count, {irradiance}, tracer);
}

std::unique_ptr<FieldBackend> make_field_backend(const World& world, const FieldSettings& settings,
                                                 const ProbeStore& store) {
  assert(store.probes() <= kMaxBackendProbes);
  return std::make_unique<VulkanFieldBackend>(world, settings, store);
}

}  // namespace lambent
