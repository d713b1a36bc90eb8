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

RelightResult IrradianceField::State::solve(std::span<const int> probes,
                                            std::span<const float> shares,
                                            const WorkingIrradiance& gain,
                                            const RelightSettings& by) {
  if (!device) return relight(transport(probes), shares, gain, by, light);
  if (!light_behind) device->write_light(light, told);
  RelightResult result;
  const DeviceSolve solved = device->solve(probes, shares, gain, by, &result.solution);
  device->read_light(light, told);
  light_behind = false;
  result.iterations = solved.iterations;
  result.error = solved.error;
  result.change = solved.change;
  return result;
}

uint IrradianceField::State::salt() const {
  return store_salt(static_cast<uint>(updates), settings.seed);
}

void IrradianceField::State::store_light(std::span<const int> probes) {
  if (device) {
    device->store_light(probes, salt());
    store_behind = true;
    return;
  }
  const auto texels = static_cast<std::size_t>(tile_texels());
  const uint dither = salt();
  parallel_chunks(probes.size(), kProbesPerTask, [&](std::size_t begin, std::size_t end) {
    std::vector<vec3> interior(texels);
    for (std::size_t k = begin; k < end; ++k) {
      for (std::size_t t = 0; t < texels; ++t) interior[t] = vec3(light[probes[k] * texels + t]);
      store.store_irradiance(probes[k], interior, dither);
    }
  });
}

/// What the groups' rays will count for.
TracedProbes IrradianceField::State::shares_of(std::span<const TraceGroup> groups) const {
  const float longest = longest_average(settings);
  TracedProbes traced;
  for (const TraceGroup& group : groups) {
    const float weight =
        static_cast<float>(group.rays->rays()) / static_cast<float>(settings.rays_per_probe);
    for (const int probe : group.probes) {
      const float held = min(records[probe].samples, max(longest - weight, 0.0f));
      traced.shares.push_back(weight / (held + weight));
    }
    traced.probes.insert(traced.probes.end(), group.probes.begin(), group.probes.end());
    traced.weights.insert(traced.weights.end(), group.probes.size(), weight);
  }
  return traced;
}

/// Blends the distances that the groups' rays met into the store. `shares` are of all groups'
/// probes.
void IrradianceField::State::blend_in_distances(const Scene& scene,
                                                std::span<const TraceGroup> groups,
                                                std::span<const float> shares) {
  for (const TraceGroup& group : groups) {
    const DistanceBlend blend(settings, group.rays->directions);
    blend_distances(scene, blend, group, shares.first(group.probes.size()), salt(), store);
    shares = shares.subspan(group.probes.size());
  }
}

float IrradianceField::State::darkest() const {
  return kDarkShare * mean_light;
}

/// By how much the probes' light differs from what it was.
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

/// Books what the probes' light says of their noise, and that they were served.
void IrradianceField::State::book(const World& world, const TracedProbes& traced,
                                  std::span<const LightChange> changes) {
  const float longest = longest_average(settings);
  double light_sum = 0.0;
  for (std::size_t k = 0; k < traced.probes.size(); ++k) {
    const int probe = traced.probes[k];
    ProbeRecord& record = records[probe];
    const LightChange& change = changes[k];
    light_sum += change.now;
    learn_noise(told_square(change.relative_square, change.before, traced.shares[k], mean_light),
                traced.weights[k], record);
    record.samples = min(record.samples, longest);
    record.served = static_cast<std::uint32_t>(updates) + 1;
    record.state = state_once_traced(record.state);
    record.revision = world.revision();
    agenda.changed(probe);
  }
  if (traced.probes.empty()) return;
  const auto count = static_cast<float>(traced.probes.size());
  const float now = static_cast<float>(light_sum) / count;
  const ProbeCounts& states = agenda.states();
  const int live = store.probes() - states.off - states.sleeping;
  mean_light = learned_light(mean_light, now, count, static_cast<float>(live));
}

void IrradianceField::State::trace(const World& world, std::vector<TraceGroup> groups,
                                   UpdateStatistics& statistics) {
  for (const TraceGroup& group : groups) {
    for (const int probe : group.probes) {
      // What woke before it followed an edit holds the average of another light
      if (records[probe].revision != world.revision()) forget_light(probe, world.revision());
    }
  }
  if (device) return trace_on_device(world, groups, statistics);
  Stopwatch watch;
  for (TraceGroup& group : groups) {
    trace_probe_rays(world.tracer(), store, group);
    statistics.probe_rays += group.hits.size();
  }
  statistics.trace_ms += watch.lap();

  const TracedProbes traced = shares_of(groups);
  blend_in_distances(world.scene(), groups, traced.shares);
  statistics.blend_ms += watch.lap();

  for (const TraceGroup& group : groups) {
    statistics.shadow_rays += shade_surfels(world, store, group, settings, traces);
  }
  statistics.shadow_rays += look_across_cells(world, traced.probes);
  statistics.shadow_rays += find_surfel_lookups(store, visibility(world), traced.probes, traces);
  statistics.shade_ms += watch.lap();

  // Solve for all bounces, starting from the light that is there
  const TransportOperator to_these = transport(traced.probes);
  const WorkingIrradiance history = light_of(light, traced.probes, tile_texels());
  const RelightResult solved =
      settings.max_bounces >= 0
          ? relight_bounces(to_these, traced.shares, settings.max_bounces, light)
          : relight(to_these, traced.shares, {}, relight_settings(), light);
  remember_told(traced.probes, solved.solution);
  statistics.relights += solved.iterations;
  statistics.residual = solved.error;
  statistics.change = solved.change;
  statistics.probes_traced += static_cast<int>(traced.probes.size());
  statistics.relight_ms += watch.lap();

  book(world, traced, light_changes(traced.probes, history));
  store_light(traced.probes);
  statistics.blend_ms += watch.lap();
}

void IrradianceField::State::solve_start(UpdateStatistics& statistics) {
  Stopwatch watch;
  const std::vector<int> traced = traced_probes();
  const std::vector<float> shares(traced.size(), 1.0f);
  const RelightResult solved = solve(traced, shares, {}, relight_settings());
  statistics.relights += solved.iterations;
  statistics.residual = solved.error;
  statistics.change = solved.change;
  remember_told(traced, solved.solution);
  if (device) device->write_light(light, told);
  store_light(traced);
  statistics.relight_ms += watch.lap();
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
  if (viewer_ws) statistics.probes_recycled = s.follow_viewer(world, *viewer_ws, statistics);
  if (s.updates == 0) {
    std::vector<int> all(s.records.size());
    std::iota(all.begin(), all.end(), 0);
    s.place(world, all);
    s.placed_revision = world.revision();
  } else {
    s.place_edited(world, statistics);
  }
  s.classify(world);
  statistics.place_ms = watch.lap();

  s.importance.clear();
  if (budget > 0 && !request.seen.empty()) {
    s.fetch_store();
    s.importance = s.device ? probe_importance(s.store, request.seen,
                                               [&](std::span<const float> received, float least) {
                                                 return s.device->send_back(received, least);
                                               })
                            : probe_importance(s.store, request.seen, s.traces);
  }
  const Followed followed = s.follow(world, budget, viewer_ws, statistics);
  const std::uint64_t spent = statistics.probe_rays + statistics.shadow_rays;
  // Probes that wait to be held against edits would lose sight of them were they traced before
  const bool trace =
      followed != Followed::some &&
      (budget == 0 ? followed == Followed::nothing || s.followed_last : spent < budget);
  s.followed_last = followed != Followed::nothing && !trace;
  if (trace) {
    const auto update = static_cast<uint>(s.updates);
    s.agenda.note(s.store, s.records);
    const Schedule schedule =
        budget == 0 ? schedule_all(s.store, s.roles, s.records, s.settings, update)
                    : s.agenda.within(s.store, budget - spent, update + 1, viewer_ws, s.importance);
    s.trace(world, group_by_rays(schedule, s.settings, update), statistics);
  }
  s.agenda.note(s.store, s.records);
  if (s.starting && s.agenda.unserved() == 0) {
    // Probes that were traced while others knew no light have only seen a part of its bounces
    if (s.updates > 0 && s.settings.max_bounces < 0) s.solve_start(statistics);
    s.starting = false;
  }
  ++s.updates;
  statistics.states = s.agenda.states();
  // What tracing a probe ray costs, its shadow rays and all else included
  if (trace && followed == Followed::nothing) {
    s.ray_cost.learn(statistics.probe_rays, statistics.place_ms + watch.lap());
  }
  return statistics;
}

}  // namespace lambent
