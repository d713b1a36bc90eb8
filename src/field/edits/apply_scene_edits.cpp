// SPDX-License-Identifier: Apache-2.0
// The part of an update that applies edits of the world: exactly the probes whose light an edit
// changes get new light.
//
// What averaging has gained over the rays of a single update is kept. Let H be the light that a
// probe holds, and T E the estimate of its last rays from the light E of all probes at that time.
// Each texel has the history ratio g = H / (T E). After the edit, with the new transport T_new, the
// light solves
//   +---------------------------+
//   |  E_new = g (T_new E_new)  |
//   +---------------------------+
// Where nothing changed, the solution is H itself; where all light became k times as bright, it is
// k H; where the light went out, it is 0; and nowhere is there more noise than in the change
// itself. T E is stored when the light is solved for, so that g is right however long a probe stays
// stale.
//
// Sleeping probes light open air only, and no surfel reads them. They are brought up to date after
// the others have been solved for, some in each update.
#include <algorithm>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>

#include "core/parallel.h"
#include "core/stopwatch.h"
#include "field/edits/invalidation.h"
#include "field/field_state.h"
#include "field/probes/tile_light.h"
#include "lambent/world.h"

namespace lambent {
namespace {

// A probe whose light an edit changes by less than this fraction keeps its old light and its
// history. It is half of the smallest visible difference.
constexpr float kChangedFraction = 0.005f;

// Testing a probe's surfels against edits costs about as much as tracing this many rays, even where
// nothing has to be traced.
constexpr std::uint64_t kRaysPerInvalidation = 8;

// An update brings one in this many of the stale sleeping probes up to date. Open air lags behind
// an edit by at most as many updates, and a scene that is edited in every update costs little more.
constexpr std::size_t kSleepingSlices = 8;

// A probe that lags behind the world by more revisions than this is brought up to date before all
// others.
constexpr std::uint64_t kOverdueRevisions = 16;

constexpr std::size_t kProbesPerTask = 64;

/// The luminance of the direct and sky light that a probe's rays bring back, summed over the rays.
double direct_light_of(const ProbeTrace& trace) {
  double sum = 0.0;
  for (const Surfel& surfel : trace.surfels) {
    if (surfel.kind == SurfelKind::back_face) continue;
    const vec3 share = surfel.kind == SurfelKind::sky ? vec3(1.0f) : surfel.albedo_over_pi;
    sum += luminance(share * surfel.light);
  }
  return sum;
}

std::vector<double> direct_light_of(std::span<const ProbeTrace> traces,
                                    std::span<const int> probes) {
  std::vector<double> light(probes.size());
  parallel_chunks(probes.size(), kProbesPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) light[k] = direct_light_of(traces[probes[k]]);
  });
  return light;
}

/// The oldest revision for which the world's log still tells all later changes.
std::uint64_t oldest_known_revision(const World& world) {
  const std::uint64_t revision = world.revision();
  const std::uint64_t reach = std::min<std::uint64_t>(revision, World::kLogLength);
  return revision - reach;
}

/// Some stale probes that are brought up to date together.
struct Slice {
  std::vector<int> probes;
  std::uint64_t oldest = 0;  ///< The oldest revision that any of them is up to date with.
};

/// Takes the first waiting probes: at least one, and no more than have `most_surfels` in all.
Slice next_slice(std::span<const int> waiting, std::span<const ProbeTrace> traces,
                 std::span<const ProbeStatus> statuses, std::uint64_t most_surfels) {
  Slice slice;
  slice.oldest = statuses[waiting.front()].revision;
  std::uint64_t surfels = 0;
  for (const int probe : waiting) {
    // A probe that was relocated has no surfels
    if (traces[probe].rays) surfels += static_cast<std::uint64_t>(traces[probe].rays->rays());
    if (surfels > most_surfels && !slice.probes.empty()) break;
    slice.probes.push_back(probe);
    slice.oldest = std::min(slice.oldest, statuses[probe].revision);
  }
  return slice;
}

}  // namespace

std::vector<double> IrradianceField::State::direct_light(std::span<const int> probes) {
  return device ? device->direct_light(probes) : direct_light_of(traces, probes);
}

/// Brings surfels and distances up to date with the world. On a device, tracing all rays again is
/// cheaper than finding out which of them may have changed.
InvalidationResult IrradianceField::State::update_stale_surfels(
    const World& world, std::span<const WorldChanges> changes, std::span<const int> probes,
    std::span<const int> all) {
  if (!device) {
    return invalidate_surfels(world, changes, settings, probes, all, visibility(world), store,
                              traces, dither_seed());
  }
  const DeviceTraced traced = device->retrace(world, probes, dither_seed());
  host_store_is_stale = true;
  return {traced.probe_rays, traced.shadow_rays, {}};
}

/// Brings one slice of the probes up to date. Scales their light by the ratio in which direct light
/// became brighter, which gives the solve a good start.
void IrradianceField::State::apply_edits_to_slice(const World& world,
                                                  std::span<const WorldChanges> changes,
                                                  std::span<const int> probes,
                                                  std::span<const int> all,
                                                  UpdateStatistics& statistics) {
  const std::vector<double> direct_before = direct_light(probes);
  const bool shapes_differ = std::any_of(changes.begin(), changes.end(),
                                         [](const WorldChanges& c) { return !c.moved.empty(); });
  if (shapes_differ) statistics.shadow_rays += update_cell_visibility(world, probes);
  const InvalidationResult result = update_stale_surfels(world, changes, probes, all);
  statistics.probe_rays += result.probe_rays;
  statistics.shadow_rays += result.shadow_rays;
  statistics.probes_invalidated += static_cast<int>(probes.size());

  const std::vector<double> direct_after = direct_light(probes);
  const double before = std::accumulate(direct_before.begin(), direct_before.end(), 0.0);
  const double after = std::accumulate(direct_after.begin(), direct_after.end(), 0.0);
  const auto brighter = static_cast<float>(before > 0.0 ? after / before : 1.0);
  const int texels = tile_texels();
  for (const int probe : probes) {
    statuses[probe].revision = world.revision();
    for (int t = 0; t < texels; ++t) {
      light[static_cast<std::size_t>(probe) * texels + t] *= brighter;
    }
  }
}

void IrradianceField::State::apply_edits_to_sleeping(const World& world, std::uint64_t ray_budget,
                                                     std::span<const int> all,
                                                     UpdateStatistics& statistics) {
  Stopwatch watch;
  const std::uint64_t spent = statistics.probe_rays + statistics.shadow_rays;
  if (ray_budget != 0 && spent >= ray_budget) return;
  std::size_t count = std::min(sleeping_per_slice, stale_sleeping.size());
  if (ray_budget != 0 && count > 0) {
    count = std::min(
        count, next_slice(stale_sleeping, traces, statuses, ray_budget - spent).probes.size());
  }
  std::vector<int> probes(stale_sleeping.begin(),
                          stale_sleeping.begin() + static_cast<std::ptrdiff_t>(count));
  stale_sleeping.erase(stale_sleeping.begin(),
                       stale_sleeping.begin() + static_cast<std::ptrdiff_t>(probes.size()));
  // Probes that woke up meanwhile have been traced since
  std::erase_if(probes, [&](int probe) { return statuses[probe].revision == world.revision(); });
  if (probes.empty()) return;
  std::sort(probes.begin(), probes.end());
  std::uint64_t oldest = world.revision();
  for (const int probe : probes) oldest = std::min(oldest, statuses[probe].revision);
  const WorkingIrradiance before = light_of(light, probes, tile_texels());
  const WorkingIrradiance history_ratio = history_ratio_of(probes);
  apply_edits_to_slice(world, *world.changes_since(oldest), probes, all, statistics);
  statistics.edits_ms += watch.lap();

  // No surfel that matters reads sleeping probes, so that one iteration solves for their light
  SolveSettings once = solve_settings();
  once.max_iterations = 1;
  const std::vector<float> blend_weights(probes.size(), 1.0f);
  const SolveResult solved = solve(probes, blend_weights, history_ratio, once);
  statistics.probes_changed += store_edited_light(probes, before, solved, history_ratio);
  statistics.solve_iterations += solved.iterations;
  statistics.solve_ms += watch.lap();
}

/// Stores the solution for probes whose light differs visibly from the light before. The others get
/// their old light back, bit by bit. Returns the number of probes that differ.
int IrradianceField::State::store_edited_light(std::span<const int> probes,
                                               const WorkingIrradiance& before,
                                               const SolveResult& solved,
                                               const WorkingIrradiance& history_ratio) {
  const auto texels = static_cast<std::size_t>(tile_texels());
  std::vector<int> touched;
  for (std::size_t k = 0; k < probes.size(); ++k) {
    const int probe = probes[k];
    vec4* now = &light[probe * texels];
    const TileLight held(&before[k * texels], texels), found(now, texels);
    if (relative_square(found, held) < kChangedFraction * kChangedFraction) {
      // The last estimate stays as well, so that several changes too small to be seen add up
      std::copy(held.begin(), held.end(), now);
      continue;
    }
    touched.push_back(probe);
    for (std::size_t t = 0; t < texels; ++t) {
      last_irradiance_estimate[probe * texels + t] =
          solved.solution[k * texels + t] / history_ratio[k * texels + t];
    }
  }
  if (device) device->write_light(light, last_irradiance_estimate);
  store_light(touched);
  return static_cast<int>(touched.size());
}

/// Solves for the light of all probes that the pending edits have reached so far.
void IrradianceField::State::solve_edited(UpdateStatistics& statistics) {
  const int texels = tile_texels();
  const WorkingIrradiance before = light_of(pending_edits.before, pending_edits.updated, texels);
  const WorkingIrradiance history_ratio =
      light_of(pending_edits.history_ratio, pending_edits.updated, texels);
  const std::vector<float> blend_weights(pending_edits.updated.size(), 1.0f);
  const SolveResult solved =
      solve(pending_edits.updated, blend_weights, history_ratio, solve_settings());
  statistics.solve_iterations += solved.iterations;
  statistics.residual = solved.error;
  statistics.probes_changed =
      store_edited_light(pending_edits.updated, before, solved, history_ratio);
  WorkingIrradiance change = light_of(light, pending_edits.updated, texels);
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
  for (int probe = 0; probe < store.probes(); ++probe) {
    const ProbeStatus& status = statuses[probe];
    const bool traced = traces[probe].rays != nullptr;
    if (traced) stale.traced.push_back(probe);
    if (status.revision == revision) continue;
    // A revision later than the world's comes from another World object
    const bool is_in_log = status.revision >= oldest && status.revision < revision;
    if (traced && is_in_log && settings.max_bounces < 0) {
      const bool sleeps = status.state == ProbeState::sleeping;
      (sleeps ? stale.sleeping : stale.waiting).push_back(probe);
    } else {
      // The average is lost without surfels to compare, after more edits than the world's log
      // holds, and where bounces are counted
      reset_history(probe, revision);
    }
  }
  return stale;
}

/// Lowers the sample counts of probes whose light the pending edits changed.
void IrradianceField::State::reduce_history() {
  const auto texels = static_cast<std::size_t>(tile_texels());
  for (const int probe : pending_edits.updated) {
    const TileLight held(&pending_edits.before[probe * texels], texels),
        found(&light[probe * texels], texels);
    if (relative_square(found, held) < kChangedFraction * kChangedFraction) continue;
    // The more the distribution of the light changed, the fewer samples the average is worth
    const float kept = likeness(found, held);
    statuses[probe].samples = max(statuses[probe].samples * kept * kept, 1.0f);
    scheduler.mark_changed(probe);
  }
}

/// Keeps the light before the edits, while light and surfels still belong to the same world.
void IrradianceField::State::begin_edits(std::uint64_t revision, std::span<const int> traced) {
  if (!pending_edits.before.empty() && pending_edits.revision == revision) return;
  if (pending_edits.before.empty()) {
    refine_last_estimates(traced);
  } else {
    // The averages of probes that earlier edits changed are of the light before those edits
    reduce_history();
  }
  pending_edits.before = light;
  pending_edits.history_ratio.resize(light.size());
  pending_edits.updated.clear();
  pending_edits.revision = revision;
}

/// Brings waiting probes up to date, slice by slice, until the budget is spent. It works in slices
/// because the number of rays that a slice takes is known only afterwards.
void IrradianceField::State::apply_edits_in_slices(const World& world, std::uint64_t ray_budget,
                                                   StaleProbes& stale,
                                                   UpdateStatistics& statistics) {
  Stopwatch watch;
  const auto texels = static_cast<std::size_t>(tile_texels());
  const std::uint64_t most =
      ray_budget == 0 ? std::numeric_limits<std::uint64_t>::max() : ray_budget;
  std::vector<int> updated;
  std::uint64_t spent = 0;
  while (!stale.waiting.empty() && spent < most) {
    const Slice slice = next_slice(stale.waiting, traces, statuses, most - spent);
    const std::vector<WorldChanges> changes = *world.changes_since(slice.oldest);
    const WorkingIrradiance history_ratio = history_ratio_of(slice.probes);
    for (std::size_t k = 0; k < slice.probes.size(); ++k) {
      std::copy_n(&history_ratio[k * texels], texels,
                  &pending_edits.history_ratio[slice.probes[k] * texels]);
    }
    statistics.solve_ms += watch.lap();
    apply_edits_to_slice(world, changes, slice.probes, stale.traced, statistics);
    statistics.edits_ms += watch.lap();
    stale.waiting.erase(stale.waiting.begin(),
                        stale.waiting.begin() + static_cast<std::ptrdiff_t>(slice.probes.size()));
    updated.insert(updated.end(), slice.probes.begin(), slice.probes.end());
    spent = statistics.probe_rays + statistics.shadow_rays + kRaysPerInvalidation * updated.size();
  }
  std::sort(updated.begin(), updated.end());
  std::vector<int> merged;
  std::merge(pending_edits.updated.begin(), pending_edits.updated.end(), updated.begin(),
             updated.end(), std::back_inserter(merged));
  pending_edits.updated = std::move(merged);
}

EditProgress IrradianceField::State::apply_scene_edits(const World& world, std::uint64_t ray_budget,
                                                       const std::optional<vec3>& viewer_ws,
                                                       UpdateStatistics& statistics) {
  Stopwatch watch;
  const std::uint64_t revision = world.revision();
  if (applied_revision == revision && stale_sleeping.empty()) return EditProgress::none;
  if (applied_revision > revision) {
    // The world is another object than before, and its log says nothing about these probes
    for (const int probe : stale_sleeping) reset_history(probe, revision);
    stale_sleeping.clear();
  }
  fetch_light();
  StaleProbes stale = find_stale_probes(world);
  if (applied_revision != revision) {
    sleeping_per_slice = (stale.sleeping.size() + kSleepingSlices - 1) / kSleepingSlices;
    std::stable_sort(stale.sleeping.begin(), stale.sleeping.end(),
                     [&](int a, int b) { return statuses[a].revision < statuses[b].revision; });
    stale_sleeping = std::move(stale.sleeping);
  }
  const bool any = !stale.waiting.empty();
  if (any) {
    order_stale_probes(stale.waiting, ray_budget, viewer_ws, revision);
    begin_edits(revision, stale.traced);
    statistics.edits_ms += watch.lap();
    apply_edits_in_slices(world, ray_budget, stale, statistics);
    watch.lap();
    solve_edited(statistics);
    statistics.solve_ms += watch.lap();
    if (!stale.waiting.empty()) return EditProgress::partial;
  }
  if (!pending_edits.before.empty()) reduce_history();
  pending_edits = {};
  applied_revision = revision;
  apply_edits_to_sleeping(world, ray_budget, stale.traced, statistics);
  return any ? EditProgress::complete : EditProgress::none;
}

/// Under a budget, overdue probes come first, so that a world that is edited without end leaves
/// none stale for ever. Then come probes by their importance, or by their distance from the viewer.
void IrradianceField::State::order_stale_probes(std::vector<int>& waiting, std::uint64_t ray_budget,
                                                const std::optional<vec3>& viewer_ws,
                                                std::uint64_t revision) const {
  if (ray_budget == 0) return;
  std::vector<float> rank(statuses.size(), 0.0f);
  for (const int probe : waiting) {
    if (revision - statuses[probe].revision > kOverdueRevisions) {
      rank[probe] = -std::numeric_limits<float>::max();
    } else if (!importance.empty()) {
      rank[probe] = -importance[probe];
    } else if (viewer_ws) {
      rank[probe] = glm::distance(store.probe_position_ws(probe), *viewer_ws);
    }
  }
  std::stable_sort(waiting.begin(), waiting.end(), [&](int a, int b) { return rank[a] < rank[b]; });
}

/// Lets a probe start its average again.
void IrradianceField::State::reset_history(int probe, std::uint64_t revision) {
  statuses[probe].samples = 0.0f;
  statuses[probe].revision = revision;
  scheduler.mark_changed(probe);
}

}  // namespace lambent
