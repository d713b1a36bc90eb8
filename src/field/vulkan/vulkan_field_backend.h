// SPDX-License-Identifier: Apache-2.0
// A field in the memory of our own world's device: passes are recorded, submitted and waited for.
#pragma once

#include <memory>
#include <vector>

#include "field/correction/device_training.h"
#include "field/field_backend.h"
#include "field/vulkan/device_solver.h"
#include "field/vulkan/field_resources.h"
#include "field/vulkan/world_rays.h"

namespace lambent {

class VulkanFieldBackend final : public FieldBackend, public DeviceLookups {
 public:
  VulkanFieldBackend(const World& world, ProbeData& data);

  bool suits(const World& world) const override { return is_on(world); }
  const DeviceLookups* on_device() const override { return this; }

  void fetch_light() override;
  void fetch_store() override;
  void fetch_corrections() override;
  void push_light() override;
  void push_solid_sides() override;
  void push_places(std::span<const int> moved) override;

  ProbeUpdateResult update_probes(ProbeUpdate update) override;
  InvalidationResult retrace(const World& world, std::span<const WorldChanges> changes,
                             std::span<const int> probes, std::span<const int> among,
                             uint dither_seed) override;
  std::uint64_t update_cell_visibility(const World& world, std::span<const int> cells) override;
  std::uint64_t find_lookups(const World& world, std::span<const int> moved,
                             std::span<const int> among) override;

  SolveResult solve(std::span<const int> probes, std::span<const float> blend_weights,
                    const WorkingIrradiance& history_ratio, const SolveSettings& settings) override;
  void receive(std::span<const int> probes, WorkingIrradiance& received) override;
  void store_light(std::span<const int> probes, uint dither_seed) override;

  void forget_corrections(std::span<const float> kept) override;

  std::vector<float> scatter_importance(std::span<const float> received, float least) override;
  void irradiance(std::span<const FieldQuery> queries, const World* world, CorrectionUse use,
                  std::span<vec3> result) const override;

  std::size_t surfel_bytes() const override { return field_.surfel_bytes(); }

  bool is_on(const World& world) const override;
  void record_lookups(vulkan::Recorder& recorder, const World* world, std::uint64_t queries,
                      std::uint32_t count, CorrectionUse use,
                      std::uint64_t irradiance) const override;

 private:
  /// Sorts values, `each` per probe, from the caller's order of probes into the list's order.
  template <class T>
  std::vector<T> in_order_of(const DeviceProbes& list, std::span<const T> given,
                             std::size_t each) const;
  std::vector<int> traced_among(std::span<const int> probes) const;
  void upload_light();

  ProbeData& data_;
  std::shared_ptr<vulkan::Device> device_;
  FieldResources field_;
  DeviceSolver solver_;
  HitShading shading_;
  WorldRayBuffers ray_buffers_;
  std::unique_ptr<DeviceTraining> training_;  // null: no update has learned corrections yet
  bool corrections_are_newer_ = false;        // the device has newer ones than ProbeData
  bool light_is_newer_ = false;  // the device has newer light and estimates than ProbeData
  bool store_is_newer_ = false;  // the device has newer tiles than ProbeData
};

}  // namespace lambent
