// SPDX-License-Identifier: Apache-2.0
// The passes of a recorded field, in the order of an update.
#include <algorithm>
#include <cassert>

#include "field/probes/volumes.h"
#include "field/schedule/schedule.h"
#include "field/vulkan/recorded_state.h"
#include "raytracing/trace_arguments.h"
#include "vulkan/recorder.h"

namespace lambent::vulkan {
namespace {

constexpr int kMaxFramesInFlight = 16;
constexpr int kMaxPlacingUpdates = 64;

BufferRange range_of(const Buffer& buffer) {
  return {buffer.handle(), buffer.offset(), buffer.bytes(), buffer.address()};
}

/// Records a pass into an engine's command buffer, with a barrier before and after it.
template <class Record>
void record_pass(const Device& device, VkCommandBuffer commands, const char* name, Record record) {
  Recorder to(device, commands);
  to.begin_pass(name);
  to.barrier();
  record(to);
  to.barrier();
  to.end_pass();
}

Expected<void> check_recorded(const FieldSettings& s, const RecordedFieldSettings& r) {
  if (s.cascades != 0) return fail("", "cascades", "recorded fields do not follow the viewer");
  if (s.visibility != Visibility::moments) {
    return fail("", "visibility", "recorded fields trace no rays for it");
  }
  if (s.max_bounces >= 0 && (r.probes_per_update != 0 || r.rays_per_update != 0)) {
    return fail("", "bounces", "can be counted only where all probes are traced at once");
  }
  if (r.frames_in_flight < 1 || r.frames_in_flight > kMaxFramesInFlight) {
    return fail("", "frames in flight", "must be 1 to 16");
  }
  if (r.probes_per_update < 0 || r.probes_per_update > kMaxBatchProbes) {
    return fail("", "probes per update", "must be 0 to 65535");
  }
  if (r.rays_per_update != 0) {
    if (r.probes_per_update != 0) return fail("", "rays per update", "or probes, not both");
    if (r.rays_per_update < kBlockProbes * s.rays_per_probe) {
      return fail("", "rays per update", "must be those of eight probes at least, or 0");
    }
  }
  const int placing = r.placing_updates;
  if (placing != 0 && (placing < 2 || placing > kMaxPlacingUpdates)) {
    return fail("", "placing updates", "must be 2 to 64, or 0");
  }
  return {};
}

}  // namespace

Expected<RecordedField> RecordedField::make(std::shared_ptr<Device> device,
                                            const FieldSettings& settings, const Bounds& bounds,
                                            const RecordedFieldSettings& recorded) {
  if (const auto fine = check_settings(settings); !fine) return tl::unexpected(fine.error());
  if (const auto fine = check_recorded(settings, recorded); !fine) {
    return tl::unexpected(fine.error());
  }
  const Expected<std::vector<Volume>> volumes = plan_volumes(settings, bounds);
  if (!volumes) return tl::unexpected(volumes.error());
  std::vector<ProbeGrid> grids;
  for (const Volume& volume : *volumes) grids.push_back(volume.grid);
  const ProbeStore shape(grids, settings);
  const bool all_at_once = recorded.probes_per_update == 0 && recorded.rays_per_update == 0;
  if (all_at_once && shape.probes() > kMaxBatchProbes) {
    return fail(
        "", "probes per update",
        "must be given where there are more than 65535: here " + std::to_string(shape.probes()));
  }
  if (recorded.rays_per_update > 0 && shape.probes() < kBlockProbes) {
    return fail("", "rays per update", "must be 0 where there are fewer than eight probes");
  }
  return RecordedField(std::make_unique<State>(std::move(device), settings, recorded, shape));
}

RecordedField::RecordedField(std::unique_ptr<State> state) : state_(std::move(state)) {}
RecordedField::~RecordedField() = default;
RecordedField::RecordedField(RecordedField&&) noexcept = default;
RecordedField& RecordedField::operator=(RecordedField&&) noexcept = default;

PlannedUpdate RecordedField::plan(const UpdatePlan& update) {
  State& s = *state_;
  assert(update.history >= 0.0f && update.history <= 1.0f);
  s.batch = s.plan.next(update);
  s.memory().write(s.batch, s.settings);
  return {static_cast<std::uint32_t>(s.batch.count),
          static_cast<std::uint32_t>(s.settings.rays_per_probe), s.ray_count(),
          s.batch.place != kPlaceLeave, s.batch.on_device};
}

void RecordedField::record_rays(VkCommandBuffer commands) const {
  State& s = *state_;
  const RecordedRaysArguments arguments = {{s.field.grids().address()},
                                           s.probe_states(),
                                           s.list().index_array(),
                                           {s.memory().directions.address()},
                                           {s.rays.address()},
                                           s.chosen(offsetof(ListState, probes)),
                                           s.batch.count,
                                           s.settings.rays_per_probe,
                                           s.ray_mask,
                                           s.batch.all ? 1u : 0u,
                                           s.batch.on_device ? 1u : 0u,
                                           0u};
  record_pass(*s.device, commands, "rays", [&](Recorder& to) {
    if (s.batch.history < 1.0f) {
      const FadeSamplesArguments fade = {{s.standing.address()}, s.field.probes(), s.batch.history};
      to.run(s.kernels.fade_samples, fade, s.field.probes());
      to.barrier();
    }
    if (s.batch.on_device) {
      s.schedule->record_choose(to, s.probe_states(), s.batch.update, s.batch.all);
    }
    to.run(s.kernels.rays, arguments, s.settings.rays_per_probe, s.batch.count);
  });
}

void RecordedField::record_trace(VkCommandBuffer commands,
                                 VkAccelerationStructureKHR structure) const {
  const State& s = *state_;
  VkAccelerationStructureDeviceAddressInfoKHR info{};
  info.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_DEVICE_ADDRESS_INFO_KHR;
  info.accelerationStructure = structure;
  const VkDeviceAddress address =
      s.device->fn().vkGetAccelerationStructureDeviceAddressKHR(s.device->handle(), &info);
  const std::uint32_t count = s.ray_count();
  const EngineClosestArguments arguments = {
      uvec2(static_cast<uint>(address), static_cast<uint>(address >> 32)),
      {s.rays.address()},
      {s.hits.address()},
      count,
      0u};
  record_pass(*s.device, commands, "trace", [&](Recorder& to) {
    if (s.batch.on_device) {
      to.trace_indirect(s.tracer.closest, arguments, s.schedule->state(),
                        kOverLaunch * sizeof(GroupCounts));
      return;
    }
    to.trace(s.tracer.closest, arguments, count);
  });
}

/// Turns the engine's results into surfels and computes the blend weights and the ray weights.
void RecordedField::State::record_results(Recorder& to) {
  const UpdateMemory& m = memory();
  const DeviceProbes& now = list();
  const RecordedBlendWeightsArguments blend_weight = {
      probe_states(),
      {field.offsets().address()},
      now.index_array(),
      {blend_weights.address()},
      chosen(offsetof(ListState, probes)),
      chosen(offsetof(ListState, largest_blend_weight)),
      batch.count,
      batch.on_device ? 1u : 0u,
      longest_average(settings),
      batch.all ? 1u : 0u,
      batch.discards_history ? 1u : 0u};
  const RecordedSurfelsArguments surfel = {
      now.index_array(), {rays.address()},        {results.address()},   field.surfels(),
      batch.count,       settings.rays_per_probe, field.surfel_stride(), settings.max_albedo};
  field.run_over(to, kernels.blend_weights, blend_weight, now, kOverLanes);
  field.run_over(to, kernels.surfels, surfel, now, kOverRays);
  field.record_weights(to, {m.directions.address()}, settings.rays_per_probe,
                       {irradiance_weights.address()}, {distance_weights.address()});
}

void RecordedField::record_update(VkCommandBuffer commands) {
  State& s = *state_;
  const DeviceProbes& list = s.list();
  const uint dither_seed = store_dither_seed(s.batch.update, s.settings.seed);
  const auto pass = [&](const char* name, const auto& record) {
    record_pass(*s.device, commands, name, record);
  };
  pass("shade", [&](Recorder& to) { s.record_results(to); });
  pass("blend", [&](Recorder& to) {
    s.field.record_seen_surfels(to, list);
    s.field.record_blend_distances(to, list, {s.blend_weights.address()}, dither_seed);
  });
  pass("shade", [&](Recorder& to) { s.field.record_lookups(to, list); });
  pass("solve", [&](Recorder& to) {
    if (s.settings.max_bounces >= 0) {
      s.solver.record_bounces(to, list, s.blend_weights, s.settings.max_bounces);
      return;
    }
    const SolveSettings settings = {s.settings.max_albedo, s.settings.solve_tolerance,
                                    s.settings.max_solve_iterations};
    s.solver.record(to, list, s.blend_weights, s.batch.largest_blend_weight, {}, settings);
  });
  if (s.schedule) {
    pass("schedule", [&](Recorder& to) {
      s.schedule->record_update_variability(to, list, {s.blend_weights.address()},
                                            {s.solver.history().address()}, s.batch.update);
    });
  }
  pass("blend", [&](Recorder& to) { s.field.record_store_light(to, list, dither_seed); });
}

void RecordedField::record_maintain(VkCommandBuffer commands) const {
  State& s = *state_;
  const MaintainArguments arguments = {
      {s.field.grids().address()}, s.probe_states(),      s.list().index_array(),
      {s.rays.address()},          {s.results.address()}, s.batch.count,
      s.settings.rays_per_probe,   s.batch.place,         s.batch.all ? 1u : 0u};
  record_pass(*s.device, commands, "maintain", [&](Recorder& to) {
    s.field.run_over(to, s.kernels.maintain, arguments, s.list(), kOverProbes);
  });
}

BufferRange RecordedField::rays() const {
  return range_of(state_->rays);
}
BufferRange RecordedField::hits() const {
  return range_of(state_->hits);
}
BufferRange RecordedField::results() const {
  return range_of(state_->results);
}
BufferRange RecordedField::ray_launch() const {
  const State& s = *state_;
  if (!s.batch.on_device) return {};
  const Buffer& state = s.schedule->state();
  const VkDeviceSize first = kOverLaunch * sizeof(GroupCounts);
  return {state.handle(), state.offset() + first, sizeof(GroupCounts), state.address() + first};
}
BufferRange RecordedField::states() const {
  return range_of(state_->states);
}
LookupBuffers RecordedField::lookup_buffers() const {
  const FieldResources& field = state_->field;
  return {range_of(field.grids()), range_of(field.offsets()), range_of(field.irradiance()),
          range_of(field.distance()), range_of(state_->record)};
}
VkDescriptorSetLayout RecordedField::lookup_set_layout() const {
  return state_->lookup_set.layout();
}
VkDescriptorSet RecordedField::lookup_set() const {
  return state_->lookup_set.set();
}
const FieldSettings& RecordedField::settings() const {
  return state_->settings;
}
int RecordedField::probes() const {
  return state_->field.probes();
}
std::uint32_t RecordedField::updates() const {
  return state_->plan.updates();
}

}  // namespace lambent::vulkan
