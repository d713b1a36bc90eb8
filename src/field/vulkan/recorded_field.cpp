// SPDX-License-Identifier: Apache-2.0
// The public functions of a field whose passes an engine records, in parts between the engine's own
// commands.
#include <algorithm>

#include "field/probes/volumes.h"
#include "field/vulkan/recorded_state.h"
#include "vulkan/recorder.h"

namespace lambent::vulkan {
namespace {

constexpr int kMaxFramesInFlight = 16;
constexpr int kMaxPlacingUpdates = 64;

BufferRange range_of(const Buffer& buffer) {
  return {buffer.handle(), buffer.offset(), buffer.bytes(), buffer.address()};
}

Expected<void> check_recorded(const FieldSettings& s, const RecordedFieldSettings& r) {
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
  const ProbeStore shape(grids_of(*volumes), settings);
  const bool all_at_once = recorded.probes_per_update == 0 && recorded.rays_per_update == 0;
  if (all_at_once && shape.probes() > kMaxBatchProbes) {
    return fail(
        "", "probes per update",
        "must be given where there are more than 65535: here " + std::to_string(shape.probes()));
  }
  if (recorded.rays_per_update > 0 && shape.probes() < kBlockProbes) {
    return fail("", "rays per update", "must be 0 where there are fewer than eight probes");
  }
  return RecordedField(
      std::make_unique<State>(std::move(device), settings, recorded, *volumes, shape));
}

RecordedField::RecordedField(std::unique_ptr<State> state) : state_(std::move(state)) {}
RecordedField::~RecordedField() = default;
RecordedField::RecordedField(RecordedField&&) noexcept = default;
RecordedField& RecordedField::operator=(RecordedField&&) noexcept = default;

Expected<PlannedUpdate> RecordedField::plan(const UpdatePlan& update) {
  State& s = *state_;
  if (!(update.history >= 0.0f && update.history <= 1.0f)) {
    return fail("", "history", "must be 0 to 1");
  }
  ScrolledVolumes scrolling = s.scroll(update.viewer_ws);
  s.batch = s.plan.next(update, scrolling.recycled);
  UpdateMemory& memory = s.memory();
  s.times = memory.take_times();
  memory.write(s.batch, s.settings);
  if (s.settings.cascades > 0) memory.write(scrolling);
  s.grids = std::move(scrolling.grids);
  return PlannedUpdate{static_cast<std::uint32_t>(s.batch.count),
                       static_cast<std::uint32_t>(s.settings.rays_per_probe),
                       s.ray_count(),
                       s.batch.places,
                       s.batch.on_device,
                       s.batch.retraces};
}

void RecordedField::State::record_part(EngineRays& source, VkCommandBuffer commands,
                                       void (*part)(FieldPasses&)) {
  Recorder to(*device, commands, memory().next_timer());
  to.barrier();
  UpdateVulkan update{field,
                      solver,
                      source,
                      source,
                      list(),
                      blend_weights,
                      batch.largest_blend_weight,
                      store_dither_seed(batch.update, settings.seed)};
  if (batch.retraces) update.history = history.get();
  FieldPassesVulkan passes(to, update);
  part(passes);
  to.barrier();
}

void RecordedField::record_rays(VkCommandBuffer commands) const {
  State::EngineRays source(*state_);
  state_->record_part(source, commands, choose_rays);
}

void RecordedField::record_trace(VkCommandBuffer commands,
                                 VkAccelerationStructureKHR structure) const {
  State::EngineRays source(*state_, structure);
  state_->record_part(source, commands, find_hits);
}

Expected<void> RecordedField::record_update(VkCommandBuffer commands,
                                            VkAccelerationStructureKHR structure) {
  if (state_->settings.visibility != Visibility::moments && structure == VK_NULL_HANDLE) {
    return fail("", "structure",
                "is needed where probes are seen by rays (FieldSettings::visibility)");
  }
  State::EngineRays source(*state_, structure);
  const bool retraces = state_->batch.retraces;
  state_->record_part(source, commands, retraces ? follow_retraced_hits : follow_hits);
  return {};
}

void RecordedField::record_maintain(VkCommandBuffer commands) const {
  State::EngineRays source(*state_);
  state_->record_part(source, commands, maintain_probes);
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
const std::vector<PassTime>& RecordedField::pass_times() const {
  return state_->times;
}
std::size_t RecordedField::bytes() const {
  return state_->bytes();
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
