// SPDX-License-Identifier: Apache-2.0
#include "field/vulkan/device_schedule.h"

#include <array>
#include <cassert>
#include <vector>

#include "field/schedule/schedule.h"
#include "shaders/schedule_choose_comp.h"
#include "shaders/schedule_list_comp.h"
#include "shaders/schedule_means_comp.h"
#include "shaders/schedule_priority_comp.h"
#include "shaders/update_variability_comp.h"
#include "vulkan/device_memory.h"

namespace lambent {

using vulkan::Buffer, vulkan::Memory;

namespace {

/// The state before the first update.
ScheduleState first_state(const FieldResources& field, float mean_light) {
  ScheduleState state{};
  state.live = static_cast<uint>(field.probes());
  state.mean_light = mean_light;
  return state;
}

}  // namespace

DeviceSchedule::DeviceSchedule(const FieldResources& field, std::span<const VolumeRole> roles,
                               int most_probes, int rays)
    : field_(field), chunks_(static_cast<int>(groups_of(field.probes(), kChunkProbes))) {
  assert(most_probes > 0 && most_probes % kBlockProbes == 0 && most_probes <= field.probes());
  const vulkan::Device& device = field.device();
  const std::array constants =
      tile_constants(field.settings(), field.volumes(), field.lookups_per_surfel());
  const auto make = [&](vulkan::Spirv spirv, const char* name) {
    return vulkan::Kernel(device, spirv, name, constants);
  };
  priority_ = make(shaders::schedule_priority_comp(), "schedule_priority");
  choose_ = make(shaders::schedule_choose_comp(), "schedule_choose");
  list_them_ = make(shaders::schedule_list_comp(), "schedule_list");
  update_variability_ = make(shaders::update_variability_comp(), "update_variability");
  means_ = make(shaders::schedule_means_comp(), "schedule_means");

  std::vector<int> levels;
  for (const VolumeRole& role : roles) levels.push_back(role.level);
  levels_ = vulkan::upload(device, levels, "levels of volumes");
  const ScheduleState state = first_state(field, /*mean_light=*/0.0f);
  state_ = vulkan::upload(device, std::span(&state, 1), "schedule");
  const std::vector<ProbeVariability> unknown(field.probes(), new_variability());
  variability_ = vulkan::upload(device, unknown, "variability of probes");
  std::vector<ListSize> sizes;
  for (uint shape = 0; shape < kListShapes; ++shape) {
    sizes.push_back(field.list_size(shape, rays));
  }
  sizes_ = vulkan::upload(device, sizes, "sizes of lists");
  bins_ = Buffer(device, sizeof(uint) * field.probes(), Memory::device, "bins of probes");
  chunk_records_ = Buffer(device, sizeof(ScheduleChunk) * chunks_, Memory::device, "chunks");
  changes_ = Buffer(device, sizeof(vec3) * most_probes, Memory::device, "changes of light");

  list_.probes.resize(most_probes);
  list_.most_rays = rays;
  list_.block_count = most_probes / kBlockProbes;
  list_.chosen = &state_;
  const std::vector<int> zeros(most_probes, 0);
  list_.indices = vulkan::upload(device, zeros, "chosen probes");
  list_.ray_sets = vulkan::upload(device, zeros, "their ray sets");
  list_.blocks =
      Buffer(device, sizeof(ProbeBlock) * list_.block_count, Memory::device, "their blocks");
}

void DeviceSchedule::start_from(std::span<const ProbeVariability> variability, float mean_light) {
  const ScheduleState state = first_state(field_, mean_light);
  vulkan::write(field_.device(), std::span(&state, 1), state_);
  vulkan::write(field_.device(), variability, variability_);
}

std::size_t DeviceSchedule::bytes() const {
  return bytes_of({&list_.indices, &list_.ray_sets, &list_.blocks, &state_, &variability_, &bins_,
                   &chunk_records_, &sizes_, &changes_});
}

void DeviceSchedule::record_choose(vulkan::Recorder& to, const ProbeStates& probes,
                                   std::uint32_t update, bool look) const {
  const int all = field_.probes();
  const ScheduleStateArray state = {state_.address()};
  const ChunkArray chunks = {chunk_records_.address()};
  const SchedulePriorityArguments priority = {{field_.grids().address()},
                                              {levels_.address()},
                                              probes,
                                              {variability_.address()},
                                              state,
                                              {bins_.address()},
                                              chunks,
                                              all,
                                              update + 1,
                                              longest_average(field_.settings()),
                                              look ? 1u : 0u};
  const ScheduleChooseArguments choose = {
      state, chunks, list_.block_array(), {sizes_.address()}, chunks_, list_.count()};
  const ScheduleListArguments list = {state, chunks, {bins_.address()}, list_.index_array(), all};
  to.run(priority_, priority, all);
  to.barrier();
  to.run(choose_, choose, kChunkProbes);
  to.barrier();
  to.run(list_them_, list, all);
  to.barrier();
}

void DeviceSchedule::record_update_variability(vulkan::Recorder& to, const DeviceProbes& list,
                                               FloatArray blend_weights, Vec4Array before,
                                               std::uint32_t update) const {
  const uint chosen = list.chosen != nullptr ? 1u : 0u;
  const ScheduleStateArray state = {state_.address()};
  const Vec3Array changes = {changes_.address()};
  const UpdateVariabilityArguments variability = {state,
                                                  {variability_.address()},
                                                  list.index_array(),
                                                  blend_weights,
                                                  changes,
                                                  list.count(),
                                                  chosen,
                                                  update + 1,
                                                  0u};
  const ScheduleMeansArguments means = {
      state, {chunk_records_.address()}, blend_weights, changes, chunks_, list.count(), chosen, 0u};
  field_.record_compare_light(to, list, before, changes);
  field_.run_over(to, update_variability_, variability, list, kOverLanes);
  to.barrier();
  to.run(means_, means, kGroupLanes);
  to.barrier();
}

}  // namespace lambent
