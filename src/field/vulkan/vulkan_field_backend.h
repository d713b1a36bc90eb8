// SPDX-License-Identifier: Apache-2.0
// The FieldBackend on Vulkan. It records the passes of FieldResources and DeviceSolver in the order
// of an update, into one command buffer, and waits for it.
#pragma once

#include <memory>
#include <vector>

#include "field/field_backend.h"
#include "field/vulkan/device_solver.h"
#include "field/vulkan/field_resources.h"
#include "raytracing/vulkan/device_world.h"
#include "raytracing/vulkan/hit_shading.h"

namespace lambent {

class VulkanFieldBackend final : public FieldBackend {
 public:
  VulkanFieldBackend(const World& world, const FieldSettings& settings, const ProbeStore& store);

  bool is_on(const World& world) const override;
  void set_places(const ProbeStore& store) override { field_.set_places(store); }
  void set_distances(const ProbeStore& store, std::span<const int> probes) override;
  void write_store(const ProbeStore& store) override { field_.write_store(store); }
  void read_store(ProbeStore& store) const override { field_.read_store(store); }
  void write_light(const WorkingIrradiance& light,
                   const WorkingIrradiance& last_irradiance_estimate) override;
  void read_light(WorkingIrradiance& light,
                  WorkingIrradiance& last_irradiance_estimate) const override;
  void store_light(std::span<const int> probes, uint dither_seed) override;

  DeviceTraced trace(const DeviceTracing& tracing) override;
  DeviceTraced retrace(const World& world, std::span<const int> probes, uint dither_seed) override;
  std::uint64_t update_cell_visibility(const World& world, std::span<const int> cells) override;
  std::uint64_t find_lookups(const World& world, std::span<const int> probes) override;
  void drop_surfels(std::span<const int> probes) override { field_.set_rays(probes, nullptr); }

  DeviceSolve solve(std::span<const int> probes, std::span<const float> blend_weights,
                    const WorkingIrradiance& history_ratio, const SolveSettings& settings,
                    WorkingIrradiance* solution) override;
  void receive(std::span<const int> probes, const WorkingIrradiance& fallback,
               WorkingIrradiance& received) override;
  std::vector<double> direct_light(std::span<const int> probes) override;

  std::vector<float> scatter_importance(std::span<const float> received, float least) override;
  void irradiance(std::span<const FieldQuery> queries, const World* world,
                  std::span<vec3> result) const override;
  void record_lookups(vulkan::Recorder& recorder, const World* world, std::uint64_t queries,
                      std::uint32_t count, std::uint64_t irradiance) const override;

  std::size_t surfel_bytes() const override { return field_.surfel_bytes(); }

 private:
  /// Sorts values, `each` per probe, from the caller's order of probes into the list's order.
  template <class T>
  std::vector<T> in_order_of(const DeviceProbes& list, std::span<const T> given,
                             std::size_t each) const;
  /// Records the tracing and shading of a list's rays, group after group. With `seen`, it also
  /// records the distances that they count as.
  void record_tracing(vulkan::Recorder& to, const DeviceWorld& world, const DeviceProbes& list,
                      bool seen);
  void reserve_rays(std::size_t rays, std::size_t probes);
  std::uint32_t prepare_rays(const DeviceProbes& list, DeviceTraced& traced);

  std::shared_ptr<vulkan::Device> device_;
  FieldSettings settings_;
  FieldResources field_;
  DeviceSolver solver_;
  HitShading shading_;
  // These hold the rays of one group at a time
  vulkan::Buffer rays_, hits_, points_, shaded_, direct_, first_indices_;
};

}  // namespace lambent
