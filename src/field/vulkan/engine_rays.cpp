// SPDX-License-Identifier: Apache-2.0
// The rays of a recorded field's probes, which the device makes and an engine traces and shades.
#include <algorithm>
#include <cassert>

#include "field/placement/reset_arguments.h"
#include "field/schedule/schedule.h"
#include "field/vulkan/recorded_state.h"
#include "vulkan/recorder.h"

namespace lambent::vulkan {

RecordedField::State::EngineRays::EngineRays(State& field, VkAccelerationStructureKHR structure)
    : s_(field) {
  if (structure != VK_NULL_HANDLE) tracer_.emplace(*field.device, structure, field.ray_mask);
}

/// Uploads the grids of scrolled volumes, and resets the probes that have new places.
void RecordedField::State::EngineRays::scroll(Recorder& to) {
  const UpdateMemory& m = s_.memory();
  to.copy(m.grids, s_.field.grids(), m.grids.bytes());
  if (m.recycled_count > 0) {
    const ResetProbesArguments reset = {s_.probe_states(),
                                        {s_.schedule ? s_.schedule->variability().address() : 0},
                                        {m.recycled.address()},
                                        {s_.field.offsets().address()},
                                        {s_.field.distance().address()},
                                        {s_.field.light().address()},
                                        {s_.field.last_irradiance_estimate().address()},
                                        m.recycled_count,
                                        s_.field.distance_words(),
                                        s_.schedule ? 1u : 0u,
                                        0u};
    to.run(s_.kernels.reset_probes, reset,
           std::max(s_.field.distance_words(), s_.field.tile_texels()), m.recycled_count);
  }
  to.barrier();
}

/// Records the matrices of the update's ray sets.
void RecordedField::State::EngineRays::record_weights(Recorder& to) const {
  const UpdateMemory& m = s_.memory();
  const int ray_count = s_.settings.rays_per_probe;
  for (std::size_t set = 0; set < s_.batch.drawn_in.size(); ++set) {
    const RaySetRecord& record = m.sets.as<RaySetRecord>()[set];
    s_.field.record_weights(to, record.directions, ray_count, record.irradiance_weights,
                            record.distance_weights);
  }
}

void RecordedField::State::EngineRays::schedule(Recorder& to) {
  const DeviceProbes& list = s_.list();
  const RecordedRaysArguments arguments = {
      {s_.field.grids().address()},
      s_.probe_states(),
      {list.index_array(), {list.ray_sets.address()}, list.sets},
      {s_.rays.address()},
      s_.chosen(offsetof(ListState, probes)),
      s_.batch.count,
      s_.settings.rays_per_probe,
      s_.ray_mask,
      s_.batch.all ? 1u : 0u,
      s_.batch.on_device ? 1u : 0u,
      s_.placing_updates};
  if (s_.batch.history < 1.0f || s_.batch.place_again) {
    const FadeSamplesArguments fade = {{s_.standing.address()},
                                       s_.field.probes(),
                                       s_.batch.history,
                                       s_.batch.place_again ? 1u : 0u,
                                       0u};
    to.run(s_.kernels.fade_samples, fade, s_.field.probes());
    to.barrier();
  }
  if (s_.batch.on_device) {
    s_.schedule->record_choose(to, s_.probe_states(), s_.batch.update, s_.batch.all);
  }
  to.run(s_.kernels.rays, arguments, s_.settings.rays_per_probe, s_.batch.count);
  record_weights(to);
}

void RecordedField::State::EngineRays::trace(Recorder& to, int) {
  assert(tracer_);
  RayBatch probe_rays;
  probe_rays.rays = {s_.rays.address()};
  probe_rays.count = s_.ray_count();
  if (s_.batch.on_device) {
    probe_rays.indirect = &s_.schedule->state();
    probe_rays.indirect_offset = kOverLaunch * sizeof(GroupCounts);
  }
  tracer_->closest_hits(to, probe_rays, {s_.hits.address()});
}

/// Makes surfels from the engine's results, and computes the blend weights.
void RecordedField::State::EngineRays::shade(Recorder& to, int) {
  const DeviceProbes& probes = s_.list();
  const ProbeBatch& update_batch = s_.batch;
  const uint weight_of_history = update_batch.retraces           ? kHistoryRetraced
                                 : update_batch.discards_history ? kHistoryDiscarded
                                                                 : kHistoryGrows;
  const RecordedBlendWeightsArguments blend_weight = {
      s_.probe_states(),
      {s_.field.offsets().address()},
      probes.index_array(),
      {s_.blend_weights.address()},
      s_.chosen(offsetof(ListState, probes)),
      s_.chosen(offsetof(ListState, largest_blend_weight)),
      s_.batch.count,
      s_.batch.on_device ? 1u : 0u,
      longest_average(s_.settings),
      s_.batch.all ? 1u : 0u,
      weight_of_history,
      s_.placing_updates};
  const RecordedSurfelsArguments surfel = {probes.index_array(),     {s_.rays.address()},
                                           {s_.results.address()},   s_.field.surfels(),
                                           s_.batch.count,           s_.settings.rays_per_probe,
                                           s_.field.surfel_stride(), s_.settings.max_albedo};
  s_.field.run_over(to, s_.kernels.blend_weights, blend_weight, probes, kOverLanes);
  s_.field.run_over(to, s_.kernels.surfels, surfel, probes, kOverRays);
  to.barrier();
  // For rays that were traced again, move_distances() computes the distances
  if (!update_batch.retraces) s_.field.record_seen_surfels(to, probes);
}

void RecordedField::State::EngineRays::visibility(Recorder& to) {
  assert(tracer_);
  s_.field.record_visibility_around(to, *tracer_, s_.list());
}

void RecordedField::State::EngineRays::record(Recorder& to, const DeviceProbes& list,
                                              FloatArray weights, Vec4Array before) {
  // Without a schedule on the device, nothing depends on the variance of the probes' light
  if (s_.schedule)
    s_.schedule->record_update_variability(to, list, weights, before, s_.batch.update);
}

void RecordedField::State::EngineRays::placement(Recorder& to) {
  const MaintainArguments arguments = {
      {s_.field.grids().address()}, s_.probe_states(),      s_.list().index_array(),
      {s_.rays.address()},          {s_.results.address()}, s_.batch.count,
      s_.settings.rays_per_probe,   s_.placing_updates,     s_.batch.all ? 1u : 0u};
  s_.field.run_over(to, s_.kernels.maintain, arguments, s_.list(), kOverProbes);
}

}  // namespace lambent::vulkan
