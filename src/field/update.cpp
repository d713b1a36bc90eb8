// SPDX-License-Identifier: Apache-2.0
// Based on: McGuire et al., "Probe-based dynamic global illumination", US 2021/0012562; Majercik et
// al., "Dynamic Diffuse Global Illumination with Ray-Traced Irradiance Fields", JCGT 8(2), 2019.
// The order of an update of the irradiance field, written once for all executors.
#include <algorithm>
#include <numeric>
#include <utility>

#include "core/pass_times.h"
#include "field/field_state.h"
#include "field/passes.h"
#include "field/schedule/importance.h"
#include "lambent/world.h"

namespace lambent {
namespace {

/// Runs one pass under its name.
template <class Pass>
void run(FieldPasses& passes, const char* name, Pass pass) {
  passes.begin(name);
  pass();
  passes.end();
}

/// Traces and shades all rays, as many at a time as memory holds.
void find_surfels(FieldPasses& passes) {
  for (int batch = 0; batch < passes.batches(); ++batch) {
    run(passes, field_pass::kTrace, [&] { passes.trace(batch); });
    run(passes, field_pass::kShade, [&] { passes.shade(batch); });
  }
}

/// From surfels to stored light.
void light_probes(FieldPasses& passes) {
  run(passes, field_pass::kBlendDistances, [&] { passes.blend_distances(); });
  if (passes.settings().visibility == Visibility::hybrid) {
    run(passes, field_pass::kVisibility, [&] { passes.visibility(); });
  }
  run(passes, field_pass::kLookups, [&] { passes.lookups(); });
  run(passes, field_pass::kSolve, [&] { passes.solve(); });
  run(passes, field_pass::kVariability, [&] { passes.variability(); });
  run(passes, field_pass::kStore, [&] { passes.store(); });
}

}  // namespace

void update_probes(FieldPasses& passes) {
  find_surfels(passes);
  light_probes(passes);
}

void choose_rays(FieldPasses& passes) {
  run(passes, field_pass::kSchedule, [&] { passes.schedule(); });
}

void find_hits(FieldPasses& passes) {
  run(passes, field_pass::kTrace, [&] { passes.trace(0); });
}

void follow_hits(FieldPasses& passes) {
  run(passes, field_pass::kShade, [&] { passes.shade(0); });
  light_probes(passes);
}

void maintain_probes(FieldPasses& passes) {
  run(passes, field_pass::kPlacement, [&] { passes.placement(); });
}

double UpdateStatistics::ms(std::string_view pass) const {
  const auto known = std::find_if(passes.begin(), passes.end(),
                                  [&](const PassTime& time) { return time.name == pass; });
  return known == passes.end() ? 0.0 : known->ms;
}

uint IrradianceField::State::salt() const {
  return store_salt(static_cast<uint>(updates), settings.seed);
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
  const int live = memory.store.probes() - states.off - states.sleeping;
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
  const TracedProbes traced = shares_of(groups);
  for (const TraceGroup& group : groups) {
    for (const int probe : group.probes) memory.traces[probe].rays = group.rays;
  }
  for (const int probe : traced.probes) told_roughly[probe] = 1;
  const ProbeUpdateResult found =
      backend->update_probes({world, std::move(groups), traced.probes, traced.shares,
                              relight_settings(settings), kDarkShare * mean_light, salt()});
  statistics.probe_rays += found.probe_rays;
  statistics.shadow_rays += found.shadow_rays;
  statistics.relights += found.iterations;
  statistics.residual = found.error;
  statistics.change = found.change;
  statistics.probes_traced += static_cast<int>(traced.probes.size());
  for (const PassTime& pass : found.passes) add_pass_time(statistics.passes, pass.name, pass.ms);
  book(world, traced, found.changes);
}

void IrradianceField::State::solve_start(UpdateStatistics& statistics) {
  PassTimer timer(statistics.passes);
  const std::vector<int> traced = memory.traced_probes();
  const std::vector<float> shares(traced.size(), 1.0f);
  const RelightResult solved = backend->solve(traced, shares, {}, relight_settings(settings));
  statistics.relights += solved.iterations;
  statistics.residual = solved.error;
  statistics.change = solved.change;
  remember_told(traced, solved.solution);
  backend->push_light();
  timer.finish(field_pass::kSolve);
  backend->store_light(traced, salt());
  timer.finish(field_pass::kStore);
}

void IrradianceField::State::move_to(const World& world, UpdateStatistics& statistics) {
  if (backend->suits(world)) return;
  backend->fetch_light();
  backend->fetch_store();
  // Surfels stay behind: probes that have been traced are traced anew, and what they averaged of
  // another world than this cannot be corrected
  for (std::size_t probe = 0; probe < records.size(); ++probe) {
    if (memory.traces[probe].rays == nullptr) continue;
    memory.traces[probe] = {};
    if (records[probe].revision != world.revision()) records[probe].samples = 0.0f;
    records[probe].revision = world.revision();
  }
  agenda.changed_all();
  edits = {};
  late_sleepers.clear();
  backend = make_field_backend(world, memory);
  // Nothing has been placed before the first update
  if (updates == 0) return;
  statistics.shadow_rays += look_across_cells(world, all_probes());
}

std::vector<int> IrradianceField::State::all_probes() const {
  std::vector<int> all(records.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

/// Has volumes follow the viewer, and places and classifies probes.
void IrradianceField::State::place_all(const World& world, const std::optional<vec3>& viewer_ws,
                                       UpdateStatistics& statistics) {
  if (viewer_ws) statistics.probes_recycled = follow_viewer(world, *viewer_ws, statistics);
  if (updates == 0) {
    place(world, all_probes());
    placed_revision = world.revision();
  } else {
    place_edited(world, statistics);
  }
  classify(world);
}

/// The rays that an update may trace; 0: no bound.
std::uint64_t IrradianceField::State::ray_budget(const UpdateRequest& request) const {
  // An exact number of bounces is carried through all probes at once
  if (settings.max_bounces >= 0) return 0;
  if (!(request.time_budget_ms > 0.0)) return request.ray_budget;
  const std::uint64_t learned = ray_cost.rays_within(request.time_budget_ms);
  return request.ray_budget == 0 ? learned : std::min(request.ray_budget, learned);
}

/// The probes that an update traces, with their rays.
std::vector<TraceGroup> IrradianceField::State::schedule(std::uint64_t budget,
                                                         const std::optional<vec3>& viewer_ws) {
  const auto update = static_cast<uint>(updates);
  agenda.note(memory.store, records);
  const Schedule schedule =
      budget == 0 ? schedule_all(memory.store, roles, records, settings, update)
                  : agenda.within(memory.store, budget, update + 1, viewer_ws, importance);
  return group_by_rays(schedule, settings, update);
}

UpdateStatistics IrradianceField::update(const World& world, const UpdateRequest& request) {
  State& s = *state_;
  UpdateStatistics statistics;
  Stopwatch whole;
  PassTimer timer(statistics.passes);
  const std::uint64_t budget = s.ray_budget(request);
  std::optional<vec3> viewer_ws = request.viewer_ws;
  if (viewer_ws && !is_finite(*viewer_ws)) viewer_ws.reset();

  s.move_to(world, statistics);
  s.place_all(world, viewer_ws, statistics);
  timer.finish(field_pass::kPlacement);

  s.importance.clear();
  if (budget > 0 && !request.seen.empty()) {
    s.backend->fetch_store();
    s.importance = probe_importance(s.memory.store, request.seen,
                                    [&](std::span<const float> received, float least) {
                                      return s.backend->send_back(received, least);
                                    });
    timer.finish(field_pass::kSchedule);
  }

  const Followed followed = s.follow(world, budget, viewer_ws, statistics);
  timer.skip();
  const std::uint64_t spent = statistics.probe_rays + statistics.shadow_rays;
  // Probes that wait to be held against edits would lose sight of them were they traced before
  const bool trace =
      followed != Followed::some &&
      (budget == 0 ? followed == Followed::nothing || s.followed_last : spent < budget);
  s.followed_last = followed != Followed::nothing && !trace;
  if (trace) {
    std::vector<TraceGroup> groups = s.schedule(budget == 0 ? 0 : budget - spent, viewer_ws);
    timer.finish(field_pass::kSchedule);
    s.trace(world, std::move(groups), statistics);
  }

  s.agenda.note(s.memory.store, s.records);
  if (s.starting && s.agenda.unserved() == 0) {
    // Probes that were traced while others knew no light have only seen a part of its bounces
    if (s.updates > 0 && s.settings.max_bounces < 0) s.solve_start(statistics);
    s.starting = false;
  }
  ++s.updates;
  statistics.states = s.agenda.states();
  // What tracing a probe ray costs, its shadow rays and all else included
  if (trace && followed == Followed::nothing) {
    s.ray_cost.learn(statistics.probe_rays, whole.lap());
  }
  return statistics;
}

}  // namespace lambent
