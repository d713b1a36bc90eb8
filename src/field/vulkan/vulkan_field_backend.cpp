// SPDX-License-Identifier: Apache-2.0
#include "field/vulkan/vulkan_field_backend.h"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <utility>

#include "field/passes.h"
#include "raytracing/world_access.h"
#include "shared/color.h"
#include "vulkan/device_memory.h"
#include "vulkan/recorder.h"

namespace lambent {
namespace {

using vulkan::Buffer;
using vulkan::Recorder;

// The sum of all importance, in fixed-point numbers. The rest of the range up to 2^32 is more than
// the sum of all errors of rounding terms to the nearest number.
constexpr double kMaxScattered = 2147483648.0;

// The most passes of an update besides those of its batches, and the number of passes of a batch.
constexpr std::uint32_t kTimedPasses = 16;
constexpr std::uint32_t kBatchPasses = 2;

std::uint32_t timed_passes(const WorldRaysVulkan& rays) {
  return kTimedPasses + kBatchPasses * static_cast<std::uint32_t>(rays.batches());
}

std::vector<PassTime> pass_times(const vulkan::Timestamps& timestamps) {
  std::vector<PassTime> times;
  for (const vulkan::DevicePassTime& pass : timestamps.read())
    times.push_back({pass.name, pass.ms});
  return times;
}

/// Reads the changes of light back for the host, which schedules.
class ChangesForHost final : public VariabilityVulkan {
 public:
  ChangesForHost(const FieldResources& field, std::size_t probes)
      : found(field.device(), probes * sizeof(LightChange), vulkan::Memory::readback,
              "changes of light"),
        field_(field) {}

  void record(Recorder& to, const DeviceProbes& list, FloatArray, Vec4Array before) override {
    field_.record_compare_light(to, list, before, {found.address()});
  }

  const Buffer found;

 private:
  const FieldResources& field_;
};

/// Ignores the changes of light, for passes that do not change light.
class Unchanged final : public VariabilityVulkan {
 public:
  void record(Recorder&, const DeviceProbes&, FloatArray, Vec4Array) override {
    assert(!"no light was solved for");
  }
};

}  // namespace

VulkanFieldBackend::VulkanFieldBackend(const World& world, ProbeData& data)
    : data_(data),
      device_(device_world_of(world)->shared_device()),
      field_(*device_, data.settings, data.store),
      solver_(field_),
      shading_(*device_) {
  push_light();
  push_solid_sides();
  field_.corrections().write(data.correction);
}

bool VulkanFieldBackend::is_on(const World& world) const {
  return device_world_of(world) != nullptr && &device_world_of(world)->device() == device_.get();
}

void VulkanFieldBackend::fetch_light() {
  if (!light_is_newer_) return;
  vulkan::read<vec4>(*device_, field_.light(), data_.light);
  vulkan::read<vec4>(*device_, field_.last_irradiance_estimate(), data_.last_irradiance_estimate);
  light_is_newer_ = false;
}

void VulkanFieldBackend::fetch_store() {
  if (!store_is_newer_) return;
  field_.read_store(data_.store);
  store_is_newer_ = false;
}

void VulkanFieldBackend::fetch_corrections() {
  if (!corrections_are_newer_) return;
  data_.correction = field_.corrections().read();
  corrections_are_newer_ = false;
}

void VulkanFieldBackend::forget_corrections(std::span<const float> kept) {
  if (field_.corrections().empty()) return;
  const Buffer given = host_buffer(*device_, kept, "corrections kept");
  device_->run([&](Recorder& to) {
    field_.corrections().record_forget(to, {field_.grids().address()}, {given.address()});
  });
  corrections_are_newer_ = true;
}

void VulkanFieldBackend::push_light() {
  vulkan::write<vec4>(*device_, data_.light, field_.light());
  vulkan::write<vec4>(*device_, data_.last_irradiance_estimate, field_.last_irradiance_estimate());
  light_is_newer_ = false;
}

void VulkanFieldBackend::push_solid_sides() {
  if (data_.solid_sides.words.empty()) return;
  ray_buffers_.solid_first_words = host_buffer(
      *device_, std::span(std::as_const(data_.solid_sides.first_word)), "solid sides of instances");
  ray_buffers_.solid_words =
      host_buffer(*device_, std::span(std::as_const(data_.solid_sides.words)), "solid sides");
}

/// Uploads the host's light, unless the device's is newer.
void VulkanFieldBackend::upload_light() {
  if (!light_is_newer_) push_light();
}

void VulkanFieldBackend::push_places(std::span<const int> moved) {
  field_.set_places(data_.store);
  field_.set_rays(moved, nullptr);
  field_.write_distances(data_.store, moved);
}

void VulkanFieldBackend::store_light(std::span<const int> probes, uint dither_seed) {
  DeviceProbes list;
  list.probes.assign(probes.begin(), probes.end());
  list.indices = host_buffer(*device_, probes, "probes to store");
  device_->run([&](Recorder& to) { field_.record_store_light(to, list, dither_seed); });
  store_is_newer_ = true;
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

/// Returns those of the probes that have been traced.
std::vector<int> VulkanFieldBackend::traced_among(std::span<const int> probes) const {
  std::vector<int> traced;
  for (const int probe : probes) {
    if (field_.rays_of(probe)) traced.push_back(probe);
  }
  return traced;
}

ProbeUpdateResult VulkanFieldBackend::update_probes(ProbeUpdate update) {
  ProbeUpdateResult result;
  if (update.probes.empty()) return result;
  upload_light();
  for (const TraceGroup& group : update.groups) field_.set_rays(group.probes, group.rays);
  const DeviceProbes list = field_.list(update.probes);
  const std::vector<float> blend_weights = in_order_of<float>(list, update.blend_weights, 1);
  const Buffer blend_weight_buffer = host_buffer<float>(*device_, blend_weights, "blend weights");
  const bool hybrid = data_.settings.visibility == Visibility::hybrid;
  const std::vector<int> cells =
      hybrid ? cells_around(data_.store, update.probes) : std::vector<int>();
  if (update.learns) {
    if (!training_) training_ = std::make_unique<DeviceTraining>(field_);
    training_->begin(training_surfels(data_, update.probes, update.number), update.number);
    corrections_are_newer_ = true;
  }
  WorldRaysVulkan rays(field_, shading_, ray_buffers_, *device_world_of(update.world), list, cells,
                       /*sees=*/true, update.learns ? training_.get() : nullptr);
  ChangesForHost changes(field_, update.probes.size());
  field_.reserve_seen(list);
  field_.reserve_transport(list);
  solver_.reserve(list);

  vulkan::Timestamps timestamps(*device_, timed_passes(rays));
  device_->run([&](Recorder& untimed) {
    Recorder to(*device_, untimed.commands(), &timestamps);
    const float largest = *std::max_element(blend_weights.begin(), blend_weights.end());
    FieldPassesVulkan passes(to, {field_, solver_, rays, changes, list, blend_weight_buffer,
                                  largest, update.dither_seed});
    lambent::update_probes(passes);
    rays.record_counts(to);
  });
  light_is_newer_ = store_is_newer_ = true;
  result.passes = pass_times(timestamps);
  result.probe_rays = rays.probe_rays();
  result.shadow_rays = rays.other_rays();
  if (update.learns) result.correction_rays = training_->rays();
  const DeviceSolve solved = solver_.result();
  result.iterations = solved.iterations;
  result.error = solved.error;
  result.change = solved.change;
  const std::span<const LightChange> found = changes.found.as<LightChange>();
  for (const std::size_t position : list.position) result.changes.push_back(found[position]);
  return result;
}

/// Traces all rays again: on a device this is cheaper than finding those that edits may affect.
InvalidationResult VulkanFieldBackend::retrace(const World& world, std::span<const WorldChanges>,
                                               std::span<const int> probes,
                                               std::span<const int> among, uint dither_seed) {
  InvalidationResult result;
  result.light.resize(probes.size());
  const std::vector<int> traced = traced_among(probes);
  if (traced.empty()) return result;
  const DeviceProbes list = field_.list(traced), everyone = field_.list(traced_among(among));
  WorldRaysVulkan rays(field_, shading_, ray_buffers_, *device_world_of(world), list, {},
                       /*sees=*/false, /*training=*/nullptr);
  const Buffer light(*device_, traced.size() * sizeof(EditedLight), vulkan::Memory::readback,
                     "edited light");
  Unchanged unchanged;
  const Buffer no_weights;
  UpdateVulkan update{field_, solver_, rays, unchanged, list, no_weights};
  update.dither_seed = dither_seed;
  update.readers = &everyone;
  vulkan::Timestamps timestamps(*device_, timed_passes(rays));
  device_->run([&](Recorder& untimed) {
    Recorder to(*device_, untimed.commands(), &timestamps);
    FieldPassesVulkan passes(to, update);
    retrace_probes(passes);
    field_.record_edited_light(to, list, {light.address()});
    rays.record_counts(to);
  });
  store_is_newer_ = true;
  result.probe_rays = rays.probe_rays();
  result.shadow_rays = rays.other_rays();
  result.passes = pass_times(timestamps);
  std::size_t named = 0;
  for (std::size_t k = 0; k < probes.size(); ++k) {
    if (!field_.rays_of(probes[k])) continue;
    result.light[k] = light.as<EditedLight>()[list.position[named++]];
  }
  return result;
}

SolveResult VulkanFieldBackend::solve(std::span<const int> probes,
                                      std::span<const float> blend_weights,
                                      const WorkingIrradiance& history_ratio,
                                      const SolveSettings& settings) {
  const auto texels = static_cast<std::size_t>(field_.tile_texels());
  SolveResult result;
  result.solution.assign(probes.size() * texels, vec4(0.0f));
  if (probes.empty()) return result;
  upload_light();
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
  std::vector<vec4> found(probes.size() * texels);
  vulkan::read<vec4>(*device_, solver_.solution(), found);
  for (std::size_t named = 0; named < probes.size(); ++named) {
    std::copy_n(&found[list.position[named] * texels], texels, &result.solution[named * texels]);
  }
  light_is_newer_ = true;
  fetch_light();
  const DeviceSolve solved = solver_.result();
  result.iterations = solved.iterations;
  result.error = solved.error;
  result.change = solved.change;
  return result;
}

void VulkanFieldBackend::receive(std::span<const int> probes, WorkingIrradiance& received) {
  if (probes.empty()) return;
  const auto texels = static_cast<std::size_t>(field_.tile_texels());
  const DeviceProbes list = field_.list(probes);
  const Buffer before = host_buffer<vec4>(
      *device_, in_order_of(list, std::span<const vec4>(received), texels), "light before");
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
