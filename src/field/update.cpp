// SPDX-License-Identifier: Apache-2.0
// Based on: McGuire et al., "Probe-based dynamic global illumination", US 2021/0012562; Majercik et
// al., "Dynamic Diffuse Global Illumination with Ray-Traced Irradiance Fields", JCGT 8(2), 2019.
// The order of an update of the irradiance field.
#include <algorithm>
#include <numeric>

#include "core/parallel.h"
#include "core/stopwatch.h"
#include "field/field_state.h"
#include "field/probes/tile_light.h"
#include "field/schedule/importance.h"
#include "field/transport/distances.h"
#include "lambent/world.h"

namespace lambent {
namespace {

constexpr std::size_t kProbesPerTask = 64;

}  // namespace

std::vector<int> IrradianceField::State::traced_probes() const {
  std::vector<int> traced;
  for (int probe = 0; probe < store.probes(); ++probe) {
    if (traces[probe].rays != nullptr) traced.push_back(probe);
  }
  return traced;
}

SolveResult IrradianceField::State::solve(std::span<const int> probes,
                                          std::span<const float> blend_weights,
                                          const WorkingIrradiance& history_ratio,
                                          const SolveSettings& by) {
  if (!device) return solve_bounces(transport(probes), blend_weights, history_ratio, by, light);
  if (!host_light_is_stale) device->write_light(light, last_irradiance_estimate);
  SolveResult result;
  const DeviceSolve solved =
      device->solve(probes, blend_weights, history_ratio, by, &result.solution);
  device->read_light(light, last_irradiance_estimate);
  host_light_is_stale = false;
  result.iterations = solved.iterations;
  result.error = solved.error;
  result.change = solved.change;
  return result;
}

uint IrradianceField::State::dither_seed() const {
  return store_dither_seed(static_cast<uint>(updates), settings.seed);
}

void IrradianceField::State::store_light(std::span<const int> probes) {
  if (device) {
    device->store_light(probes, dither_seed());
    host_store_is_stale = true;
    return;
  }
  const auto texels = static_cast<std::size_t>(tile_texels());
  const uint dither = dither_seed();
  parallel_chunks(probes.size(), kProbesPerTask, [&](std::size_t begin, std::size_t end) {
    std::vector<vec3> interior(texels);
    for (std::size_t k = begin; k < end; ++k) {
      for (std::size_t t = 0; t < texels; ++t) interior[t] = vec3(light[probes[k] * texels + t]);
      store.store_irradiance(probes[k], interior, dither);
    }
  });
}

/// Computes how much the groups' rays will count: all history of n updates' worth of rays and w new
/// ones blend with the weight w / (n + w), where n is limited by the hysteresis.
TracedProbes IrradianceField::State::blend_weights_of(std::span<const TraceGroup> groups) const {
  const float longest = longest_average(settings);
  TracedProbes traced;
  for (const TraceGroup& group : groups) {
    const float weight =
        static_cast<float>(group.rays->rays()) / static_cast<float>(settings.rays_per_probe);
    for (const int probe : group.probes) {
      const float held = min(statuses[probe].samples, max(longest - weight, 0.0f));
      traced.blend_weights.push_back(weight / (held + weight));
    }
    traced.probes.insert(traced.probes.end(), group.probes.begin(), group.probes.end());
    traced.weights.insert(traced.weights.end(), group.probes.size(), weight);
  }
  return traced;
}

/// Blends the distances of the groups' hits into the store. The blend weights are one per probe,
/// group after group.
void IrradianceField::State::blend_in_distances(const Scene& scene,
                                                std::span<const TraceGroup> groups,
                                                std::span<const float> blend_weights) {
  for (const TraceGroup& group : groups) {
    const DistanceBlend blend(settings, group.rays->directions);
    blend_distances(scene, blend, group, blend_weights.first(group.probes.size()), dither_seed(),
                    store);
    blend_weights = blend_weights.subspan(group.probes.size());
  }
}

float IrradianceField::State::darkest() const {
  return kDarkShare * mean_light;
}

/// Compares the light of some probes to their `history`.
std::vector<LightChange> IrradianceField::State::light_changes(
    std::span<const int> probes, const WorkingIrradiance& history) const {
  const auto texels = static_cast<std::size_t>(tile_texels());
  std::vector<LightChange> changes;
  for (std::size_t k = 0; k < probes.size(); ++k) {
    const TileLight held(&light[probes[k] * texels], texels), before(&history[k * texels], texels);
    changes.push_back(
        {relative_square(held, before, darkest()), mean_luminance(before), mean_luminance(held)});
  }
  return changes;
}

/// Learns the noise of the traced probes from how much their light changed, counts their samples,
/// and notes that they were traced in this update and at the world's revision.
void IrradianceField::State::update_variability(const World& world, const TracedProbes& traced,
                                                std::span<const LightChange> changes) {
  const float longest = longest_average(settings);
  double light_sum = 0.0;
  for (std::size_t k = 0; k < traced.probes.size(); ++k) {
    const int probe = traced.probes[k];
    ProbeStatus& status = statuses[probe];
    const LightChange& change = changes[k];
    light_sum += change.now;
    learn_noise(estimate_relative_square(change.relative_square, change.before,
                                         traced.blend_weights[k], mean_light),
                traced.weights[k], status);
    status.samples = min(status.samples, longest);
    status.served = static_cast<std::uint32_t>(updates) + 1;
    status.state = state_once_traced(status.state);
    status.revision = world.revision();
    scheduler.mark_changed(probe);
  }
  if (traced.probes.empty()) return;
  const auto count = static_cast<float>(traced.probes.size());
  const float now = static_cast<float>(light_sum) / count;
  const ProbeCounts& states = scheduler.states();
  const int live = store.probes() - states.off - states.sleeping;
  mean_light = learned_light(mean_light, now, count, static_cast<float>(live));
}

void IrradianceField::State::trace(const World& world, std::vector<TraceGroup> groups,
                                   UpdateStatistics& statistics) {
  for (const TraceGroup& group : groups) {
    for (const int probe : group.probes) {
      // A probe that woke before it was brought up to date holds an average of the light before the
      // edit
      if (statuses[probe].revision != world.revision()) reset_history(probe, world.revision());
    }
  }
  if (device) return trace_on_device(world, groups, statistics);
  Stopwatch watch;
  for (TraceGroup& group : groups) {
    trace_probe_rays(world.tracer(), store, group);
    statistics.probe_rays += group.hits.size();
  }
  statistics.trace_ms += watch.lap();

  const TracedProbes traced = blend_weights_of(groups);
  blend_in_distances(world.scene(), groups, traced.blend_weights);
  statistics.blend_ms += watch.lap();

  for (const TraceGroup& group : groups) {
    statistics.shadow_rays += shade_surfels(world, store, group, settings, traces);
  }
  statistics.shadow_rays += update_cell_visibility(world, traced.probes);
  statistics.shadow_rays += find_surfel_lookups(store, visibility(world), traced.probes, traces);
  statistics.shade_ms += watch.lap();

  // Solve for all bounces, starting from the light that the probes hold
  const TransportOperator to_these = transport(traced.probes);
  const WorkingIrradiance history = light_of(light, traced.probes, tile_texels());
  const SolveResult solved =
      settings.max_bounces >= 0
          ? solve_counted_bounces(to_these, traced.blend_weights, settings.max_bounces, light)
          : solve_bounces(to_these, traced.blend_weights, {}, solve_settings(), light);
  store_last_estimates(traced.probes, solved.solution);
  statistics.solve_iterations += solved.iterations;
  statistics.residual = solved.error;
  statistics.change = solved.change;
  statistics.probes_traced += static_cast<int>(traced.probes.size());
  statistics.solve_ms += watch.lap();

  update_variability(world, traced, light_changes(traced.probes, history));
  store_light(traced.probes);
  statistics.blend_ms += watch.lap();
}

void IrradianceField::State::solve_warm_up(UpdateStatistics& statistics) {
  Stopwatch watch;
  const std::vector<int> traced = traced_probes();
  const std::vector<float> blend_weights(traced.size(), 1.0f);
  const SolveResult solved = solve(traced, blend_weights, {}, solve_settings());
  statistics.solve_iterations += solved.iterations;
  statistics.residual = solved.error;
  statistics.change = solved.change;
  store_last_estimates(traced, solved.solution);
  if (device) device->write_light(light, last_irradiance_estimate);
  store_light(traced);
  statistics.solve_ms += watch.lap();
}

UpdateStatistics IrradianceField::update(const World& world, const UpdateRequest& request) {
  State& s = *state_;
  UpdateStatistics statistics;
  Stopwatch watch;
  s.move_to(world, statistics);
  std::uint64_t budget = request.ray_budget;
  if (request.time_budget_ms > 0.0) {
    const std::uint64_t learned = s.ray_cost.rays_within(request.time_budget_ms);
    budget = budget == 0 ? learned : std::min(budget, learned);
  }
  // An exact number of bounces is carried through all probes at once
  if (s.settings.max_bounces >= 0) budget = 0;

  std::optional<vec3> viewer_ws = request.viewer_ws;
  if (viewer_ws && !is_finite(*viewer_ws)) viewer_ws.reset();
  if (viewer_ws) statistics.probes_recycled = s.scroll_volumes(world, *viewer_ws, statistics);
  if (s.updates == 0) {
    std::vector<int> all(s.statuses.size());
    std::iota(all.begin(), all.end(), 0);
    s.place_probes(world, all);
    s.placed_revision = world.revision();
  } else {
    s.relocate_edited(world, statistics);
  }
  s.classify(world);
  statistics.place_ms = watch.lap();

  s.importance.clear();
  if (budget > 0 && !request.seen.empty()) {
    s.fetch_store();
    s.importance = s.device
                       ? probe_importance(s.store, request.seen,
                                          [&](std::span<const float> received, float least) {
                                            return s.device->scatter_importance(received, least);
                                          })
                       : probe_importance(s.store, request.seen, s.traces);
  }
  const EditProgress progress = s.apply_scene_edits(world, budget, viewer_ws, statistics);
  const std::uint64_t spent = statistics.probe_rays + statistics.shadow_rays;
  // Tracing is put off while stale probes are left: new surfels could no longer be compared with
  // those from before the edits
  const bool trace =
      progress != EditProgress::partial &&
      (budget == 0 ? progress == EditProgress::none || s.applied_edits_last : spent < budget);
  s.applied_edits_last = progress != EditProgress::none && !trace;
  if (trace) {
    const auto update = static_cast<uint>(s.updates);
    s.scheduler.refresh(s.store, s.statuses);
    const Schedule schedule =
        budget == 0
            ? schedule_all(s.store, s.roles, s.statuses, s.settings, update)
            : s.scheduler.choose(s.store, budget - spent, update + 1, viewer_ws, s.importance);
    s.trace(world, group_by_rays(schedule, s.settings, update), statistics);
  }
  s.scheduler.refresh(s.store, s.statuses);
  if (s.warming_up && s.scheduler.unserved() == 0) {
    // Probes that were traced while others held no light yet have received a part of the bounces
    // only
    if (s.updates > 0 && s.settings.max_bounces < 0) s.solve_warm_up(statistics);
    s.warming_up = false;
  }
  ++s.updates;
  statistics.states = s.scheduler.states();
  // Learn the cost of a probe ray, with its shadow rays and everything else included
  if (trace && progress == EditProgress::none) {
    s.ray_cost.learn(statistics.probe_rays, statistics.place_ms + watch.lap());
  }
  return statistics;
}

}  // namespace lambent
