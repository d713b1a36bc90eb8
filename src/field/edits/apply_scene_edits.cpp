// SPDX-License-Identifier: Apache-2.0
// The part of an update that applies edits of the world: exactly the probes whose light an edit
// changes get new light.
//
// Edits preserve the noise reduction of averaging. Let H be the light that a probe holds, and T E
// the estimate of its last rays from the light E of all probes at that time.
// Each texel has the history ratio g = H / (T E). After the edit, with the new transport T_new, the
// light solves
//   +---------------------------+
//   |  E_new = g (T_new E_new)  |
//   +---------------------------+
// Where nothing changed, the solution is H itself; where all light became k times as bright, it is
// k H (for k up to kMaxDirectGrowth); where all light was switched off, it is 0; and only the
// change itself has the noise of a single update. T E is stored when the light is solved for, so
// that g is right however long a probe stays stale.
//
// Sleeping probes light open air and hardly any surfel. They are brought up to date after the
// others have been solved for, some in each update.
#include <algorithm>
#include <iterator>
#include <limits>
#include <optional>

#include "core/pass_times.h"
#include "core/stopwatch.h"
#include "field/edits/history_ratio.h"
#include "field/edits/history_ratio_math.h"
#include "field/edits/invalidation.h"
#include "field/edits/moved_corrections.h"
#include "field/edits/stale_probes.h"
#include "field/field_state.h"
#include "field/passes.h"
#include "field/probes/tile_light.h"
#include "lambent/world.h"

namespace lambent {
namespace {

// An update brings one in this many of the stale sleeping probes up to date. Light in open air lags
// behind an edit by at most this many updates, and edits in every update cost little more. The
// number is odd: while edits go on, every second update traces new rays, of sleeping probes that
// are up to date, and those that are change from one such update to the next.
constexpr std::size_t kSleepingSlices = 7;

// While the world is edited in every update, corrections forget in one of this many updates: a
// fraction of the time in which they learn.
constexpr int kForgetInterval = 16;

// The share of an update's time for edits that the first slice after an edit may take. The slice
// tells what a probe takes, which differs from edit to edit.
constexpr double kFirstSliceShare = 0.25;

// Once this share of the time for edits is spent, no further slice begins.
constexpr double kTimeSpent = 0.9;

/// The oldest revision for which the world's log still has all later changes.
std::uint64_t oldest_known_revision(const World& world) {
  const std::uint64_t revision = world.revision();
  const std::uint64_t reach = std::min<std::uint64_t>(revision, World::kLogLength);
  return revision - reach;
}

/// Lowers the sample counts of probes whose light the pending edits changed. Returns, for each
/// probe of the field, the factor by which samples of corrections around it count less.
std::vector<float> reduce_history(const PendingEdits& pending, const WorkingIrradiance& light,
                                  int tile_texels, std::span<ProbeStatus> statuses,
                                  ProbeScheduler& scheduler) {
  const auto texels = static_cast<std::size_t>(tile_texels);
  std::vector<float> counts(statuses.size(), 1.0f);
  for (const int probe : pending.updated) {
    const TileLight held(&pending.before[probe * texels], texels),
        found(&light[probe * texels], texels);
    const float kept =
        reduce_samples(held, found, pending.probes.light[probe],
                       pending.probes.history_shares[probe], statuses[probe].samples);
    counts[probe] = kept * kept;
    scheduler.mark_changed(probe);
  }
  return counts;
}

}  // namespace

/// Brings one slice of the probes up to date. Scales their light by the ratio of direct light after
/// the edits to that before them, which gives the solve a good start.
EditedProbes IrradianceField::State::apply_edits_to_slice(
    const World& world, std::span<const WorldChanges> changes, std::span<const int> probes,
    std::span<const int> all, WorkingIrradiance& history_ratio, UpdateStatistics& statistics) {
  PassTimer watch(statistics.passes);
  const bool shapes_differ = std::any_of(changes.begin(), changes.end(),
                                         [](const WorldChanges& c) { return !c.moved.empty(); });
  if (shapes_differ) statistics.shadow_rays += update_cell_visibility(world, probes);
  InvalidationResult result = backend->retrace(world, changes, probes, all, dither_seed());
  statistics.probe_rays += result.probe_rays;
  statistics.shadow_rays += result.shadow_rays;
  statistics.probes_invalidated += static_cast<int>(probes.size());
  double counted = 0.0;
  for (const PassTime& pass : result.passes) {
    add_pass_time(statistics.passes, pass.name, pass.ms);
    counted += pass.ms;
  }

  double before = 0.0, after = 0.0;
  for (const EditedLight& light : result.light) {
    const ProbeAtEdit probe = probe_at_edit(light, /*held=*/0.0f);
    before += probe.direct_before;
    after += probe.direct_after;
  }
  edits.pending.direct_light += after;
  const float brighter = direct_growth(static_cast<float>(before), static_cast<float>(after));
  const auto texels = static_cast<std::size_t>(data.tile_texels());
  EditedProbes edited{reduce_history_ratios(probes, data, result.light, history_ratio),
                      std::move(result.light)};
  for (const int probe : probes) {
    statuses[probe].revision = world.revision();
    for (std::size_t t = 0; t < texels; ++t) data.light[probe * texels + t] *= brighter;
  }
  watch.finish(field_pass::kEdits, counted);
  return edited;
}

void IrradianceField::State::apply_edits_to_sleeping(const World& world, const EditBudget& budget,
                                                     std::span<const int> all,
                                                     UpdateStatistics& statistics) {
  PassTimer watch(statistics.passes);
  const std::uint64_t spent = statistics.probe_rays + statistics.shadow_rays;
  if (edits.stale_sleeping.empty() || spent >= budget.rays || budget.ms <= 0.0) return;
  const std::size_t most =
      std::min(edits.sleeping_per_slice, scheduling.edit_cost.probes_within(budget.ms));
  std::vector<int> probes =
      next_slice(edits.stale_sleeping, data.traces, statuses, {budget.rays - spent, most}).probes;
  edits.stale_sleeping.erase(
      edits.stale_sleeping.begin(),
      edits.stale_sleeping.begin() + static_cast<std::ptrdiff_t>(probes.size()));
  // Probes that became awake or vigilant meanwhile have been traced since
  std::erase_if(probes, [&](int probe) { return statuses[probe].revision == world.revision(); });
  if (probes.empty()) return;
  std::sort(probes.begin(), probes.end());
  std::uint64_t oldest = world.revision();
  for (const int probe : probes) oldest = std::min(oldest, statuses[probe].revision);
  const WorkingIrradiance before = light_of(data.light, probes, data.tile_texels());
  WorkingIrradiance history_ratio = history_ratio_of(probes, data);
  watch.finish(field_pass::kEdits);
  const EditedProbes edited = apply_edits_to_slice(world, *world.changes_since(oldest), probes, all,
                                                   history_ratio, statistics);
  watch.skip();

  // No surfel that matters reads sleeping probes, so that one iteration solves for their light
  SolveSettings once = solve_settings(settings);
  once.max_iterations = 1;
  const std::vector<float> blend_weights(probes.size(), 1.0f);
  const SolveResult solved = backend->solve(probes, blend_weights, history_ratio, once);
  statistics.probes_changed += store_edited_light(probes, before, solved, history_ratio);
  statistics.solve_iterations += solved.iterations;
  const auto texels = static_cast<std::size_t>(data.tile_texels());
  for (std::size_t k = 0; k < probes.size(); ++k) {
    const TileLight held(&before[k * texels], texels),
        found(&data.light[probes[k] * texels], texels);
    reduce_samples(held, found, edited.light[k], edited.history_shares[k],
                   statuses[probes[k]].samples);
    scheduling.scheduler.mark_changed(probes[k]);
  }
  watch.finish(field_pass::kSolve);
}

/// Stores the solution for probes whose light differs visibly from the light before. The others get
/// their old light back, bit by bit. Returns the number of probes that differ.
int IrradianceField::State::store_edited_light(std::span<const int> probes,
                                               const WorkingIrradiance& before,
                                               const SolveResult& solved,
                                               const WorkingIrradiance& history_ratio) {
  const auto texels = static_cast<std::size_t>(data.tile_texels());
  std::vector<int> touched;
  for (std::size_t k = 0; k < probes.size(); ++k) {
    const int probe = probes[k];
    vec4* now = &data.light[probe * texels];
    const TileLight held(&before[k * texels], texels), found(now, texels);
    if (relative_square(held, found) < kChangedFraction * kChangedFraction) {
      // The last estimate stays as well, so that several changes too small to be visible add up
      std::copy(held.begin(), held.end(), now);
      continue;
    }
    touched.push_back(probe);
    for (std::size_t t = 0; t < texels; ++t) {
      data.last_irradiance_estimate[probe * texels + t] =
          solved.solution[k * texels + t] / history_ratio[k * texels + t];
    }
  }
  backend->push_light();
  backend->store_light(touched, dither_seed());
  return static_cast<int>(touched.size());
}

/// Solves for the light of all probes to which the pending edits have been applied so far.
void IrradianceField::State::solve_edited(UpdateStatistics& statistics) {
  const int texels = data.tile_texels();
  const WorkingIrradiance before = light_of(edits.pending.before, edits.pending.updated, texels);
  const WorkingIrradiance history_ratio =
      light_of(edits.pending.history_ratio, edits.pending.updated, texels);
  const std::vector<float> blend_weights(edits.pending.updated.size(), 1.0f);
  const SolveResult solved =
      backend->solve(edits.pending.updated, blend_weights, history_ratio, solve_settings(settings));
  statistics.solve_iterations += solved.iterations;
  statistics.residual = solved.error;
  statistics.probes_changed =
      store_edited_light(edits.pending.updated, before, solved, history_ratio);
  WorkingIrradiance change = light_of(data.light, edits.pending.updated, texels);
  const double whole = norm(change);
  add_scaled(change, -1.0f, before, change);
  statistics.change = whole > 0.0 ? norm(change) / whole : 0.0;
}

/// Finds the probes whose surfels belong to an older revision. Those that cannot be brought up to
/// date start their average again.
StaleProbes IrradianceField::State::find_stale_probes(const World& world) {
  const std::uint64_t revision = world.revision();
  const std::uint64_t oldest = oldest_known_revision(world);
  StaleProbes stale;
  for (int probe = 0; probe < data.store.probes(); ++probe) {
    const ProbeStatus& status = statuses[probe];
    const bool traced = data.traces[probe].rays != nullptr;
    if (traced) stale.traced.push_back(probe);
    if (status.revision == revision) continue;
    // A revision later than the world's comes from another World object
    const bool is_in_log = status.revision >= oldest && status.revision < revision;
    if (traced && is_in_log && settings.max_bounces < 0) {
      const bool sleeps = status.state == ProbeState::sleeping;
      (sleeps ? stale.sleeping : stale.waiting).push_back(probe);
    } else {
      // The average cannot be preserved without surfels to compare, after more edits than the
      // world's log holds, and with an exact number of bounces
      reset_history(probe, revision, statuses, scheduling.scheduler);
    }
  }
  return stale;
}

/// Reduces the weight of averages and corrections whose light the pending edits changed.
void IrradianceField::State::reduce_history() {
  std::vector<float> counts = lambent::reduce_history(edits.pending, data.light, data.tile_texels(),
                                                      statuses, scheduling.scheduler);
  if (edits.to_forget.empty()) {
    edits.to_forget = std::move(counts);
    return;
  }
  for (std::size_t probe = 0; probe < counts.size(); ++probe) {
    edits.to_forget[probe] *= counts[probe];
  }
}

/// Reduces the weights of corrections that edits made wrong: at once after an edit, but only every
/// kForgetInterval updates while edits go on, since all corrections are then refined again.
void IrradianceField::State::forget_corrections(EditProgress progress) {
  const bool often = edits.forgot_at > 0 && updates - edits.forgot_at < kForgetInterval;
  if (edits.to_forget.empty() || (often && progress != EditProgress::none)) return;
  backend->forget_corrections(edits.to_forget);
  edits.to_forget.clear();
  edits.forgot_at = updates + 1;
}

/// Stores the light before the edits, while light and surfels still belong to the same world, and
/// forgets the corrections that lookups after the edits must not read.
void IrradianceField::State::begin_edits(const World& world, const EditBudget& budget,
                                         std::span<const int> traced) {
  const std::uint64_t revision = world.revision();
  if (!edits.pending.before.empty() && edits.pending.revision == revision) return;
  if (edits.pending.before.empty()) {
    refine_last_estimates(traced, *backend, data);
  } else {
    // The averages of probes that earlier edits changed are of the light before those edits
    reduce_history();
  }
  edits.pending.before = data.light;
  edits.pending.history_ratio.resize(data.light.size());
  edits.pending.probes.history_shares.resize(statuses.size());
  edits.pending.probes.light.resize(statuses.size());
  edits.pending.updated.clear();
  edits.pending.direct_light = 0.0;
  edits.pending.revision = revision;
  // Corrections are refined anew for that, which takes too long for updates that are held to a time
  if (is_bounded(budget)) return;
  if (const auto changes = world.changes_since(edits.applied_revision)) {
    const std::vector<float> kept = corrections_kept_by_moves(*changes, data.store);
    if (!kept.empty()) backend->forget_corrections(kept);
  }
}

/// Brings waiting probes up to date, slice by slice, until the budget is spent. It works in slices
/// because the rays and the time that a slice takes are known only afterwards. Returns the time
/// that all took [ms].
double IrradianceField::State::apply_edits_in_slices(const World& world, const EditBudget& budget,
                                                     StaleProbes& stale,
                                                     UpdateStatistics& statistics) {
  PassTimer watch(statistics.passes);
  const Stopwatch slices;
  const auto texels = static_cast<std::size_t>(data.tile_texels());
  std::vector<int> updated;
  std::uint64_t spent = 0;
  double spent_ms = 0.0;
  while (!stale.waiting.empty() && spent < budget.rays && spent_ms < kTimeSpent * budget.ms) {
    const bool first = edits.pending.updated.empty() && updated.empty();
    const double ms = first ? kFirstSliceShare * budget.ms : budget.ms - spent_ms;
    const StaleSlice slice =
        next_slice(stale.waiting, data.traces, statuses,
                   {budget.rays - spent, scheduling.edit_cost.probes_within(ms)});
    const std::vector<WorldChanges> changes = *world.changes_since(slice.oldest);
    WorkingIrradiance history_ratio = history_ratio_of(slice.probes, data);
    watch.finish(field_pass::kSolve);
    const EditedProbes edited =
        apply_edits_to_slice(world, changes, slice.probes, stale.traced, history_ratio, statistics);
    watch.skip();
    for (std::size_t k = 0; k < slice.probes.size(); ++k) {
      const auto probe = static_cast<std::size_t>(slice.probes[k]);
      std::copy_n(&history_ratio[k * texels], texels, &edits.pending.history_ratio[probe * texels]);
      edits.pending.probes.history_shares[probe] = edited.history_shares[k];
      edits.pending.probes.light[probe] = edited.light[k];
    }
    stale.waiting.erase(stale.waiting.begin(),
                        stale.waiting.begin() + static_cast<std::ptrdiff_t>(slice.probes.size()));
    updated.insert(updated.end(), slice.probes.begin(), slice.probes.end());
    spent = edit_work(statistics);
    const double now_ms = slices.ms();
    scheduling.edit_cost.learn_slice(slice.probes.size(), now_ms - spent_ms);
    spent_ms = now_ms;
  }
  std::sort(updated.begin(), updated.end());
  std::vector<int> merged;
  std::merge(edits.pending.updated.begin(), edits.pending.updated.end(), updated.begin(),
             updated.end(), std::back_inserter(merged));
  edits.pending.updated = std::move(merged);
  return slices.ms();
}

/// Removes the light of stale sleeping probes, when no other probe receives direct light any more.
/// Surfels that read them would return that light, which would decay slowly. The decay would enter
/// the history ratio, and light would be too bright when a lamp is switched on again.
void IrradianceField::State::darken_sleeping() {
  const auto texels = static_cast<std::size_t>(data.tile_texels());
  for (const int probe : edits.stale_sleeping) {
    std::fill_n(&data.light[probe * texels], texels, vec4(0.0f));
    std::fill_n(&data.last_irradiance_estimate[probe * texels], texels, vec4(0.0f));
  }
}

EditProgress IrradianceField::State::apply_scene_edits(const World& world, const EditBudget& budget,
                                                       const std::optional<vec3>& viewer_ws,
                                                       UpdateStatistics& statistics) {
  PassTimer watch(statistics.passes);
  const Stopwatch whole;
  EditBudget left = budget;
  const std::uint64_t revision = world.revision();
  if (edits.applied_revision == revision && edits.stale_sleeping.empty()) return EditProgress::none;
  if (edits.applied_revision > revision) {
    // The world is another object than before, and its log does not cover these probes
    for (const int probe : edits.stale_sleeping)
      reset_history(probe, revision, statuses, scheduling.scheduler);
    edits.stale_sleeping.clear();
  }
  backend->fetch_light();
  StaleProbes stale = find_stale_probes(world);
  if (edits.applied_revision != revision) {
    edits.sleeping_per_slice = (stale.sleeping.size() + kSleepingSlices - 1) / kSleepingSlices;
    std::stable_sort(stale.sleeping.begin(), stale.sleeping.end(),
                     [&](int a, int b) { return statuses[a].revision < statuses[b].revision; });
    edits.stale_sleeping = std::move(stale.sleeping);
  }
  const bool any = !stale.waiting.empty();
  if (any) {
    if (is_bounded(budget)) {
      order_stale_probes(revision, data.store, statuses, scheduling.importance, viewer_ws,
                         stale.waiting);
    }
    begin_edits(world, budget, stale.traced);
    watch.finish(field_pass::kEdits);
    const double slices_ms = apply_edits_in_slices(world, budget, stale, statistics);
    watch.skip();
    const bool dark = stale.waiting.empty() && edits.pending.direct_light == 0.0;
    if (dark) darken_sleeping();
    solve_edited(statistics);
    if (dark && !edits.stale_sleeping.empty()) {
      backend->store_light(edits.stale_sleeping, dither_seed());
    }
    watch.finish(field_pass::kSolve);
    scheduling.edit_cost.learn_other(whole.ms() - slices_ms);
    left.ms -= slices_ms;
    statistics.probes_stale = static_cast<int>(stale.waiting.size() + edits.stale_sleeping.size());
    if (!stale.waiting.empty()) return EditProgress::partial;
  }
  if (!edits.pending.before.empty()) reduce_history();
  edits.pending = {};
  edits.applied_revision = revision;
  apply_edits_to_sleeping(world, left, stale.traced, statistics);
  statistics.probes_stale = static_cast<int>(edits.stale_sleeping.size());
  return any ? EditProgress::complete : EditProgress::none;
}

}  // namespace lambent
