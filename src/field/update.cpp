// SPDX-License-Identifier: Apache-2.0
// Based on: McGuire et al., "Probe-based dynamic global illumination", US 2021/0012562; Majercik et
// al., "Dynamic Diffuse Global Illumination with Ray-Traced Irradiance Fields", JCGT 8(2), 2019.
// The order of an update of the irradiance field, written once for all executors.
#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "core/pass_times.h"
#include "field/edits/history_ratio.h"
#include "field/edits/scene_edits.h"
#include "field/field_state.h"
#include "field/passes.h"
#include "field/schedule/importance.h"
#include "lambent/world.h"

namespace lambent {
namespace {

// The cost of rays is learned from updates that trace at least this share of what they may.
constexpr double kUsedShare = 0.5;

/// Runs one pass under its name.
template <class Pass>
void run(FieldPasses& passes, const char* name, Pass pass) {
  passes.begin(name);
  pass();
  passes.end();
}

/// Traces and shades all rays, batch after batch.
void find_surfels(FieldPasses& passes) {
  for (int batch = 0; batch < passes.batches(); ++batch) {
    run(passes, field_pass::kTrace, [&] { passes.trace(batch); });
    run(passes, field_pass::kShade, [&] { passes.shade(batch); });
  }
}

/// Runs all passes from the solve to stored light.
void solve_light(FieldPasses& passes) {
  run(passes, field_pass::kSolve, [&] { passes.solve(); });
  run(passes, field_pass::kVariability, [&] { passes.variability(); });
  run(passes, field_pass::kStore, [&] { passes.store(); });
}

/// Finds which probes see each other, where lookups ask.
void look_across_cells(FieldPasses& passes) {
  if (passes.settings().visibility != Visibility::hybrid) return;
  run(passes, field_pass::kVisibility, [&] { passes.visibility(); });
}

/// Runs all passes from surfels to stored light.
void light_probes(FieldPasses& passes) {
  run(passes, field_pass::kBlendDistances, [&] { passes.blend_distances(); });
  look_across_cells(passes);
  if (passes.learns()) {
    run(passes, field_pass::kCorrections, [&] { passes.corrections(); });
  }
  run(passes, field_pass::kLookups, [&] { passes.lookups(); });
  solve_light(passes);
}

/// The time of the passes that take longer the more rays an update traces [ms].
double ms_of_rays(const UpdateStatistics& statistics) {
  double ms = 0.0;
  for (const char* pass : {field_pass::kTrace, field_pass::kShade, field_pass::kBlendDistances,
                           field_pass::kCorrections, field_pass::kLookups}) {
    ms += statistics.ms(pass);
  }
  return ms;
}

}  // namespace

void update_probes(FieldPasses& passes) {
  find_surfels(passes);
  light_probes(passes);
}

void retrace_probes(FieldPasses& passes) {
  run(passes, field_pass::kEdits, [&] { passes.keep_history(); });
  find_surfels(passes);
  run(passes, field_pass::kBlendDistances, [&] { passes.move_distances(); });
  run(passes, field_pass::kLookups, [&] { passes.lookups(); });
}

void choose_rays(FieldPasses& passes) {
  if (passes.settings().cascades > 0) run(passes, field_pass::kPlacement, [&] { passes.scroll(); });
  run(passes, field_pass::kSchedule, [&] { passes.schedule(); });
}

void find_hits(FieldPasses& passes) {
  run(passes, field_pass::kTrace, [&] { passes.trace(0); });
}

void follow_hits(FieldPasses& passes) {
  run(passes, field_pass::kShade, [&] { passes.shade(0); });
  light_probes(passes);
}

void follow_retraced_hits(FieldPasses& passes) {
  run(passes, field_pass::kEdits, [&] { passes.keep_history(); });
  run(passes, field_pass::kShade, [&] { passes.shade(0); });
  run(passes, field_pass::kBlendDistances, [&] { passes.move_distances(); });
  look_across_cells(passes);
  run(passes, field_pass::kLookups, [&] { passes.lookups(); });
  solve_light(passes);
}

void maintain_probes(FieldPasses& passes) {
  run(passes, field_pass::kPlacement, [&] { passes.placement(); });
}

double UpdateStatistics::ms(std::string_view pass) const {
  const auto known = std::find_if(passes.begin(), passes.end(),
                                  [&](const PassTime& time) { return time.name == pass; });
  return known == passes.end() ? 0.0 : known->ms;
}

uint IrradianceField::State::dither_seed() const {
  return store_dither_seed(static_cast<uint>(updates), settings.seed);
}

bool IrradianceField::State::follows_viewer() const {
  return std::any_of(volumes.roles.begin(), volumes.roles.end(),
                     [](const VolumeRole& role) { return role.follows_viewer; });
}

/// Whether an update learns corrections of lookups. With an exact number of bounces it does not,
/// since gathers include light of all bounces. With volumes that follow the viewer it does not
/// either: light would jump where a volume with corrections borders on one that has just scrolled.
bool IrradianceField::State::learns_corrections(std::span<const TraceGroup> groups) const {
  if (!settings.corrections || settings.max_bounces >= 0 || follows_viewer()) return false;
  // Gathered light can be compared only with light of the same world
  std::size_t lit = 0, all = 0;
  for (const TraceGroup& group : groups) {
    all += group.probes.size();
    for (const int probe : group.probes) lit += statuses[probe].samples > 0.0f ? 1 : 0;
  }
  return 2 * lit > all;
}

void IrradianceField::State::trace(const World& world, std::vector<TraceGroup> groups,
                                   UpdateStatistics& statistics) {
  for (const TraceGroup& group : groups) {
    for (const int probe : group.probes) {
      // A probe that became awake before the edits were applied to it holds an average of the light
      // before them
      if (statuses[probe].revision != world.revision()) {
        reset_history(probe, world.revision(), statuses, scheduling.scheduler);
      }
    }
  }
  std::vector<TraceGroup> in_turn = split_turns(groups, statuses);
  const ProbeUpdateResult found =
      trace_groups(world, std::move(groups), /*in_turn=*/false, statistics);
  statistics.solve_iterations += found.iterations;
  statistics.residual = found.error;
  statistics.change = found.change;
  // Hardly any surfel reads the probes that take turns, so that their light is solved for after
  // that of all others: surfaces are lit almost as without, and the statistics tell of them
  if (!in_turn.empty()) trace_groups(world, std::move(in_turn), /*in_turn=*/true, statistics);
}

ProbeUpdateResult IrradianceField::State::trace_groups(const World& world,
                                                       std::vector<TraceGroup> groups, bool in_turn,
                                                       UpdateStatistics& statistics) {
  const bool learns = !in_turn && learns_corrections(groups);
  SolveSettings solve = solve_settings(settings);
  if (in_turn) solve.max_iterations = 1;
  const TracedProbes traced = blend_weights_of(groups, settings, statuses);
  for (const TraceGroup& group : groups) {
    for (const int probe : group.probes) data.traces[probe].rays = group.rays;
  }
  for (const int probe : traced.probes) data.last_estimate_is_coarse[probe] = 1;
  ProbeUpdateResult found = backend->update_probes(
      {world, std::move(groups), traced.probes, traced.blend_weights, solve,
       static_cast<uint>(updates), learns, /*divides=*/!in_turn, dither_seed()});
  statistics.probe_rays += found.probe_rays;
  statistics.shadow_rays += found.shadow_rays;
  statistics.correction_rays += found.correction_rays;
  statistics.probes_traced += static_cast<int>(traced.probes.size());
  for (const PassTime& pass : found.passes) add_pass_time(statistics.passes, pass.name, pass.ms);
  update_variability(traced, found.changes,
                     {static_cast<std::uint32_t>(updates) + 1, world.revision()}, settings,
                     statuses, scheduling);
  return found;
}

void IrradianceField::State::solve_warm_up(UpdateStatistics& statistics) {
  PassTimer timer(statistics.passes);
  const std::vector<int> traced = data.traced_probes();
  const std::vector<float> blend_weights(traced.size(), 1.0f);
  const SolveResult solved = backend->solve(traced, blend_weights, {}, solve_settings(settings));
  statistics.solve_iterations += solved.iterations;
  statistics.residual = solved.error;
  statistics.change = solved.change;
  store_last_estimates(traced, solved.solution, data);
  backend->push_light();
  timer.finish(field_pass::kSolve);
  backend->store_light(traced, dither_seed());
  timer.finish(field_pass::kStore);
}

void IrradianceField::State::move_to(const World& world, UpdateStatistics& statistics) {
  if (backend->suits(world)) return;
  backend->fetch_light();
  backend->fetch_store();
  backend->fetch_corrections();
  // Surfels are not transferred. Probes that had some are traced again; averages of an older
  // revision of the world cannot be corrected without surfels and start again
  for (std::size_t probe = 0; probe < statuses.size(); ++probe) {
    if (data.traces[probe].rays == nullptr) continue;
    data.traces[probe] = {};
    if (statuses[probe].revision != world.revision()) statuses[probe].samples = 0.0f;
    statuses[probe].revision = world.revision();
  }
  scheduling.scheduler.mark_all_changed();
  edits.pending = {};
  edits.stale_sleeping.clear();
  backend = make_field_backend(world, data);
  // Before the first update no probe has been placed yet
  if (updates == 0) return;
  statistics.shadow_rays += update_cell_visibility(world, all_probes());
}

std::vector<int> IrradianceField::State::all_probes() const {
  std::vector<int> all(statuses.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

/// Scrolls volumes with the viewer, and places and classifies probes. Returns whether it placed
/// some, or found what is solid.
bool IrradianceField::State::place_all(const World& world, const std::optional<vec3>& viewer_ws,
                                       UpdateStatistics& statistics) {
  bool placed = find_solid_sides(world);
  if (viewer_ws) statistics.probes_recycled = scroll_volumes(world, *viewer_ws, statistics);
  if (updates == 0) {
    place_probes(world, all_probes());
    placement.placed_revision = world.revision();
    placement.open_before.reset();
    placed = true;
  } else {
    placed |= relocate_edited(world, statistics);
  }
  // An exact number of bounces is carried through all probes at once
  if (settings.max_bounces < 0) {
    classify(world, data.store, placement, statuses, scheduling.scheduler);
  }
  return placed;
}

/// Whether an update has a budget. An exact number of bounces is carried through all probes at
/// once, whatever the budget.
bool IrradianceField::State::has_budget(const UpdateRequest& request) const {
  return settings.max_bounces < 0 && (request.ray_budget > 0 || request.time_budget_ms > 0.0);
}

/// Computes what edits may take of an update that has taken `spent_ms` so far.
EditBudget IrradianceField::State::edit_budget(const UpdateRequest& request,
                                               double spent_ms) const {
  EditBudget budget = kUnboundedEdits;
  if (!has_budget(request)) return budget;
  if (request.ray_budget > 0) budget.rays = request.ray_budget;
  if (request.time_budget_ms > 0.0) {
    budget.ms = scheduling.edit_cost.time_left(request.time_budget_ms, spent_ms);
  }
  return budget;
}

/// Computes how many rays are left of a budget when the update has taken `spent` rays and
/// `spent_ms`, with edits or without.
std::uint64_t IrradianceField::State::budget_after_edits(const UpdateRequest& request,
                                                         std::uint64_t spent, double spent_ms,
                                                         bool edited) const {
  std::uint64_t left = std::numeric_limits<std::uint64_t>::max();
  if (request.ray_budget != 0) left = request.ray_budget - std::min(request.ray_budget, spent);
  const double budget_ms = request.time_budget_ms;
  if (!(budget_ms > 0.0)) return left;
  // Edits may take all of the time
  const double left_ms = edited ? budget_ms - spent_ms : budget_ms;
  if (!(left_ms > 0.0)) return 0;
  return std::min(left, scheduling.ray_cost.rays_within(left_ms, edited ? 0.0 : spent_ms));
}

/// Chooses the probes that an update traces and draws their rays.
std::vector<TraceGroup> IrradianceField::State::schedule(std::uint64_t budget,
                                                         const std::optional<vec3>& viewer_ws) {
  const auto update = static_cast<uint>(updates);
  scheduling.scheduler.refresh(data.store, statuses);
  std::vector<int> stale = edits.stale_sleeping;
  std::sort(stale.begin(), stale.end());
  const Schedule schedule =
      budget == 0 ? schedule_all(data.store, volumes.roles, statuses, settings, update, stale)
                  : scheduling.scheduler.choose(data.store, budget, update + 1, viewer_ws,
                                                scheduling.importance, stale);
  return group_by_rays(schedule, settings, update);
}

/// Computes the importance of each probe to the points that the camera sees.
void IrradianceField::State::weigh_importance(std::span<const FieldQuery> seen) {
  backend->fetch_store();
  scheduling.importance =
      probe_importance(data.store, seen, [&](std::span<const float> received, float least) {
        return backend->scatter_importance(received, least);
      });
}

/// Solves once more as soon as all probes have been traced.
void IrradianceField::State::end_warm_up(UpdateStatistics& statistics) {
  if (!scheduling.warming_up || scheduling.scheduler.never_traced() > 0) return;
  // Probes that were traced while others held no light yet have received only part of the bounces
  if (updates > 0 && settings.max_bounces < 0) solve_warm_up(statistics);
  scheduling.warming_up = false;
}

UpdateStatistics IrradianceField::update(const World& world, const UpdateRequest& request) {
  State& s = *state_;
  UpdateStatistics statistics;
  Stopwatch whole;
  PassTimer timer(statistics.passes);
  const bool bounded = s.has_budget(request);
  std::optional<vec3> viewer_ws = request.viewer_ws;
  if (viewer_ws && !is_finite(*viewer_ws)) viewer_ws.reset();

  s.move_to(world, statistics);
  // A budget does not include the time that placing probes takes
  if (s.place_all(world, viewer_ws, statistics)) whole.lap();
  timer.finish(field_pass::kPlacement);

  s.scheduling.importance.clear();
  if (bounded && !request.seen.empty()) {
    s.weigh_importance(request.seen);
    timer.finish(field_pass::kSchedule);
  }

  const EditProgress progress =
      s.apply_scene_edits(world, s.edit_budget(request, whole.ms()), viewer_ws, statistics);
  timer.skip();
  const std::uint64_t edit_rays = statistics.probe_rays;
  s.forget_corrections(progress);
  const std::uint64_t left = bounded
                                 ? s.budget_after_edits(request, edit_rays + statistics.shadow_rays,
                                                        whole.ms(), progress != EditProgress::none)
                                 : 0;
  // New rays are not traced while stale probes are left: new surfels could no longer be compared
  // with those from before the edits
  const bool trace = progress != EditProgress::partial &&
                     (bounded ? left > 0 : progress == EditProgress::none || s.edits.applied_last);
  s.edits.applied_last = progress != EditProgress::none && !trace;
  whole.lap();
  const double earlier_ms = ms_of_rays(statistics);
  if (trace) {
    std::vector<TraceGroup> groups = s.schedule(left, viewer_ws);
    timer.finish(field_pass::kSchedule);
    s.trace(world, std::move(groups), statistics);
  }

  s.scheduling.scheduler.refresh(s.data.store, s.statuses);
  s.end_warm_up(statistics);
  ++s.updates;
  statistics.states = s.scheduling.scheduler.states();
  // Fewer rays than the budget allows say little of the cost of many, unless they exceed its time
  const std::uint64_t new_rays = statistics.probe_rays - edit_rays;
  const double took_ms = whole.ms();
  const bool uses_budget = static_cast<double>(new_rays) >= kUsedShare * static_cast<double>(left);
  const bool too_long = request.time_budget_ms > 0.0 && took_ms > request.time_budget_ms;
  if (trace && (uses_budget || too_long)) {
    const double rays_ms = ms_of_rays(statistics) - earlier_ms;
    s.scheduling.ray_cost.learn(new_rays, rays_ms, took_ms - rays_ms);
  }
  return statistics;
}

}  // namespace lambent
