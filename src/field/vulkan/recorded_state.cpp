// SPDX-License-Identifier: Apache-2.0
// Construction of a recorded field's kernels and memory.
#include "field/vulkan/recorded_state.h"

#include <algorithm>
#include <array>

#include "core/pass_times.h"
#include "field/lookup/field_record.h"
#include "field/transport/blend.h"
#include "shaders/fade_samples_comp.h"
#include "shaders/maintain_probes_comp.h"
#include "shaders/recorded_blend_weights_comp.h"
#include "shaders/recorded_rays_comp.h"
#include "shaders/recorded_surfels_comp.h"
#include "shaders/reset_probes_comp.h"
#include "vulkan/device_memory.h"
#include "vulkan/recorder.h"

namespace lambent::vulkan {
namespace {

static_assert(kVisibilityMoments == static_cast<uint>(Visibility::moments) &&
              kVisibilityHybrid == static_cast<uint>(Visibility::hybrid) &&
              kVisibilityExact == static_cast<uint>(Visibility::exact));

// The most parts in which an engine records an update, and the most passes of a part.
constexpr int kUpdateParts = 4;
constexpr std::uint32_t kMaxPartPasses = 16;

template <class T>
Buffer device_buffer(const Device& device, std::size_t count, const char* name) {
  return {device, count * sizeof(T), Memory::device, name};
}

/// The cascade level of each probe.
std::vector<std::uint8_t> levels_of(const ProbeStore& shape, std::span<const VolumeRole> roles) {
  std::vector<std::uint8_t> levels;
  for (int volume = 0; volume < shape.volumes(); ++volume) {
    levels.insert(levels.end(), probe_count(shape.grid(volume)),
                  static_cast<std::uint8_t>(roles[volume].level));
  }
  return levels;
}

/// A list of the largest possible length, for which memory is reserved.
DeviceProbes largest_list(const BatchPlan& plan, const FieldSettings& settings) {
  DeviceProbes list;
  list.probes.resize(plan.most_probes());
  list.most_rays = settings.rays_per_probe;
  return list;
}

}  // namespace

RecordedKernels::RecordedKernels(const Device& device, const FieldSettings& settings, int volumes) {
  const std::array constants = tile_constants(settings, volumes, /*lookups=*/1);
  const auto make = [&](Spirv spirv, const char* name) {
    return Kernel(device, spirv, name, constants);
  };
  rays = make(shaders::recorded_rays_comp(), "recorded_rays");
  fade_samples = make(shaders::fade_samples_comp(), "fade_samples");
  blend_weights = make(shaders::recorded_blend_weights_comp(), "recorded_blend_weights");
  surfels = make(shaders::recorded_surfels_comp(), "recorded_surfels");
  maintain = make(shaders::maintain_probes_comp(), "maintain_probes");
  reset_probes = make(shaders::reset_probes_comp(), "reset_probes");
}

LookupSet::LookupSet(const Device& device, const FieldResources& field) : device_(device) {
  const Functions& f = device.fn();
  const std::array<const Buffer*, 4> buffers = {&field.grids(), &field.offsets(),
                                                &field.irradiance(), &field.distance()};
  std::array<VkDescriptorSetLayoutBinding, 4> bindings{};
  for (std::uint32_t i = 0; i < bindings.size(); ++i) {
    bindings[i] = {i, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_ALL, nullptr};
  }
  VkDescriptorSetLayoutCreateInfo layout{};
  layout.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
  layout.bindingCount = static_cast<std::uint32_t>(bindings.size());
  layout.pBindings = bindings.data();
  check(f.vkCreateDescriptorSetLayout(device.handle(), &layout, nullptr, &layout_),
        "vkCreateDescriptorSetLayout");
  const VkDescriptorPoolSize size = {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, layout.bindingCount};
  VkDescriptorPoolCreateInfo pool{};
  pool.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
  pool.maxSets = 1;
  pool.poolSizeCount = 1;
  pool.pPoolSizes = &size;
  check(f.vkCreateDescriptorPool(device.handle(), &pool, nullptr, &pool_),
        "vkCreateDescriptorPool");
  VkDescriptorSetAllocateInfo set{};
  set.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
  set.descriptorPool = pool_;
  set.descriptorSetCount = 1;
  set.pSetLayouts = &layout_;
  check(f.vkAllocateDescriptorSets(device.handle(), &set, &set_), "vkAllocateDescriptorSets");
  std::array<VkDescriptorBufferInfo, 4> infos{};
  std::array<VkWriteDescriptorSet, 4> writes{};
  for (std::uint32_t i = 0; i < writes.size(); ++i) {
    infos[i] = {buffers[i]->handle(), buffers[i]->offset(), buffers[i]->bytes()};
    writes[i].sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
    writes[i].dstSet = set_;
    writes[i].dstBinding = i;
    writes[i].descriptorCount = 1;
    writes[i].descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    writes[i].pBufferInfo = &infos[i];
  }
  f.vkUpdateDescriptorSets(device.handle(), static_cast<std::uint32_t>(writes.size()),
                           writes.data(), 0, nullptr);
}

LookupSet::~LookupSet() {
  device_.fn().vkDestroyDescriptorPool(device_.handle(), pool_, nullptr);
  device_.fn().vkDestroyDescriptorSetLayout(device_.handle(), layout_, nullptr);
}

UpdateMemory::UpdateMemory(const FieldResources& field, const BatchPlan& plan, int rays,
                           bool follows_viewer, FloatArray irradiance_weights,
                           FloatArray distance_weights) {
  const Device& device = field.device();
  const auto probes = static_cast<std::size_t>(plan.most_probes());
  const auto most_sets = static_cast<std::size_t>(plan.most_ray_sets());
  list.indices = Buffer(device, probes * sizeof(int), Memory::upload, "probes");
  list.ray_sets = Buffer(device, probes * sizeof(int), Memory::upload, "their ray sets");
  // The last block of a ray set may have fewer probes
  list.blocks =
      Buffer(device, (groups_of(plan.most_probes(), kBlockProbes) + most_sets) * sizeof(ProbeBlock),
             Memory::upload, "blocks of probes");
  list.most_rays = rays;
  directions =
      Buffer(device, most_sets * rays * sizeof(vec3), Memory::upload, "directions of rays");
  sets = Buffer(device, most_sets * sizeof(RaySetRecord), Memory::upload, "ray sets");
  for (std::size_t set = 0; set < most_sets; ++set) {
    sets.as<RaySetRecord>()[set] = {
        directions_of(static_cast<int>(set), rays),
        {irradiance_weights.address + set * field.irradiance_weight_bytes(rays)},
        {distance_weights.address + set * field.distance_weight_bytes(rays)},
        rays,
        0u};
  }
  list.sets = {sets.address()};
  if (follows_viewer) {
    grids = Buffer(device, field.grids().bytes(), Memory::upload, "scrolled grids");
    recycled = Buffer(device, field.probes() * sizeof(int), Memory::upload, "recycled probes");
  }
  for (int part = 0; part < kUpdateParts; ++part) {
    timers.push_back(std::make_unique<Timestamps>(device, kMaxPartPasses));
  }
}

std::vector<PassTime> UpdateMemory::take_times() {
  std::vector<PassTime> times;
  for (std::size_t part = 0; part < parts; ++part) {
    for (const DevicePassTime& pass : timers[part]->read_if_finished()) {
      add_pass_time(times, pass.name, pass.ms);
    }
  }
  parts = 0;
  return times;
}

void UpdateMemory::write(const ProbeBatch& batch, const FieldSettings& settings) {
  for (std::size_t set = 0; set < batch.drawn_in.size(); ++set) {
    const std::vector<vec3> drawn =
        probe_ray_directions(settings.rays_per_probe, batch.drawn_in[set], settings.seed);
    std::copy(drawn.begin(), drawn.end(),
              directions.as<vec3>().begin() + static_cast<std::ptrdiff_t>(set * drawn.size()));
    sets.as<RaySetRecord>()[set].update = batch.drawn_in[set];
  }
  list.probes = batch.probes;
  std::copy(list.probes.begin(), list.probes.end(), list.indices.as<int>().begin());
  std::copy(batch.ray_sets.begin(), batch.ray_sets.end(), list.ray_sets.as<int>().begin());
  const std::span<ProbeBlock> blocks = list.blocks.as<ProbeBlock>();
  list.block_count = 0;
  for (int k = 0; k < list.count(); ++k) {
    ProbeBlock* last = list.block_count > 0 ? &blocks[list.block_count - 1] : nullptr;
    const int set = batch.ray_sets[k];
    if (last == nullptr || last->ray_set != set || last->count == kBlockProbes) {
      last = &blocks[list.block_count++];
      *last = {k, 0, set};
    }
    ++last->count;
  }
}

void UpdateMemory::write(const ScrolledVolumes& scrolling) {
  std::copy(scrolling.grids.begin(), scrolling.grids.end(), grids.as<ProbeGrid>().begin());
  std::copy(scrolling.recycled.begin(), scrolling.recycled.end(), recycled.as<int>().begin());
  recycled_count = static_cast<int>(scrolling.recycled.size());
}

RecordedField::State::State(std::shared_ptr<Device> on, const FieldSettings& of,
                            const RecordedFieldSettings& recorded, std::span<const Volume> volumes,
                            const ProbeStore& shape)
    : device(std::move(on)),
      settings(of),
      ray_mask(recorded.ray_mask),
      placing_updates(of.relocation ? static_cast<uint>(recorded.placing_updates) : 0u),
      roles(roles_of(volumes)),
      grids(shape.grids().begin(), shape.grids().end()),
      plan(of, recorded, levels_of(shape, roles)),
      field(*device, of, shape),
      solver(field),
      kernels(*device, of, shape.volumes()),
      lookup_set(*device, field) {
  // Recording makes nothing
  device->kept<EngineClosest>();
  if (of.visibility != Visibility::moments) device->kept<EngineOcclusion>();
  if (of.visibility == Visibility::hybrid) field.reserve_visibility_around();
  const auto all = static_cast<std::size_t>(shape.probes());
  const auto probes = static_cast<std::size_t>(plan.most_probes());
  const std::size_t ray_room = probes * of.rays_per_probe;
  standing = device_buffer<RecordedProbe>(*device, all, "standing of probes");
  states = device_buffer<uint>(*device, all, "states of probes");
  rays = device_buffer<RayRecord>(*device, ray_room, "rays of probes");
  hits = device_buffer<HitRecord>(*device, ray_room, "hits of probes' rays");
  results = device_buffer<RayResult>(*device, ray_room, "results of probes' rays");
  blend_weights = device_buffer<float>(*device, probes, "blend weights");
  const auto most_sets = static_cast<std::size_t>(plan.most_ray_sets());
  irradiance_weights = device_buffer<std::byte>(
      *device, most_sets * field.irradiance_weight_bytes(of.rays_per_probe), "weights of rays");
  distance_weights = device_buffer<std::byte>(
      *device, most_sets * field.distance_weight_bytes(of.rays_per_probe), "weights of rays");
  record = device_buffer<FieldRecord>(*device, 1, "field");
  write_record();
  device->run([&](Recorder& to) {
    to.fill(standing, 0u);
    to.fill(states, kProbeOn);
  });
  const DeviceProbes largest = largest_list(plan, of);
  field.reserve_surfels(of.rays_per_probe);
  field.reserve_seen(largest);
  solver.reserve(largest);
  if (plan.follows_edits()) {
    history = std::make_unique<DeviceHistory>(field, solver, probe_states(), largest);
  }
  if (recorded.rays_per_update > 0) {
    schedule =
        std::make_unique<DeviceSchedule>(field, roles, plan.most_probes(), of.rays_per_probe);
  }
  for (int i = 0; i < recorded.frames_in_flight; ++i) {
    ring.emplace_back(field, plan, of.rays_per_probe, of.cascades > 0,
                      FloatArray{irradiance_weights.address()},
                      FloatArray{distance_weights.address()});
  }
}

std::size_t UpdateMemory::bytes() const {
  return bytes_of(
      {&list.indices, &list.ray_sets, &list.blocks, &directions, &sets, &grids, &recycled});
}

void RecordedField::State::write_record() const {
  const FieldRecord lookup = {field.store(), field.corrections().arrays(CorrectionUse::smooth),
                              field.cell_visibility(), field.volumes(),
                              static_cast<uint>(settings.visibility)};
  vulkan::write(*device, std::span(&lookup, 1), record);
}

std::size_t RecordedField::State::bytes() const {
  std::size_t bytes = field.bytes() + solver.bytes() +
                      bytes_of({&standing, &states, &record, &rays, &hits, &results, &blend_weights,
                                &irradiance_weights, &distance_weights});
  if (schedule) bytes += schedule->bytes();
  if (history) bytes += history->bytes();
  for (const UpdateMemory& memory : ring) bytes += memory.bytes();
  return bytes;
}

ScrolledVolumes RecordedField::State::scroll(const std::optional<vec3>& viewer_ws) const {
  if (settings.cascades == 0 || !viewer_ws || !is_finite(*viewer_ws)) return {grids, {}};
  return scroll_volumes(grids, roles, *viewer_ws, /*at_once=*/plan.updates() == 0);
}

}  // namespace lambent::vulkan
