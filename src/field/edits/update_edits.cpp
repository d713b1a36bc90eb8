// SPDX-License-Identifier: Apache-2.0
// The part of an update that follows edits of the world: exactly what they touch gets new light.
//
// What averaging knew better than the rays of one update is kept: with H the light that a probe
// holds and T E what its last rays told of the light E that there was, each texel is corrected by
// the gain g = H / (T E). After the edit the light solves
//   +---------------------------+
//   |  E_new = g (T_new E_new)  |
//   +---------------------------+
// Where nothing changed that is H itself; where all light became k times as bright, k H; where it
// went out, 0; and nowhere has it more noise than the change itself. T E is remembered when the
// light is solved for, so that g holds however long a probe has waited to follow.
//
// Sleeping probes light open air alone: surfels of others do not read them. They follow after the
// others have been solved for, some in each update.
#include <algorithm>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>

#include "core/parallel.h"
#include "core/stopwatch.h"
#include "field/edits/follow.h"
#include "field/field_state.h"
#include "field/probes/tile_light.h"
#include "lambent/world.h"

namespace lambent {
namespace {

// Light that edits changed by less than this share of a probe's is not worth losing history for:
// half of what can be seen.
constexpr float kTouchedShare = 0.005f;

// Holding a probe's surfels against edits costs about as much as tracing so many rays, even where
// nothing need be traced.
constexpr std::uint64_t kRaysPerProbeFollowed = 8;

// An update brings one in so many of the sleeping probes up to date, so that open air lags behind
// an edit by no more updates than that, and edits in every update cost little more.
constexpr std::size_t kSleeperSlices = 8;

// Edits after which a probe that has not followed goes before all that have.
constexpr std::uint64_t kFarBehind = 16;

constexpr std::size_t kProbesPerTask = 64;

/// Luminance that a probe's rays bring back of direct light and the sky, added up.
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

/// The oldest revision of the world after which it still knows what changed.
std::uint64_t oldest_known_revision(const World& world) {
  const std::uint64_t revision = world.revision();
  const std::uint64_t reach = std::min<std::uint64_t>(revision, World::kLogLength);
  return revision - reach;
}

/// Some of the probes that know an older world.
struct Slice {
  std::vector<int> probes;
  std::uint64_t oldest = 0;  ///< Revision that any of them knows.
};

/// The first waiting probes, with at most so many surfels but at least one probe.
Slice next_slice(std::span<const int> waiting, std::span<const ProbeTrace> traces,
                 std::span<const ProbeRecord> records, std::uint64_t most_surfels) {
  Slice slice;
  slice.oldest = records[waiting.front()].revision;
  std::uint64_t surfels = 0;
  for (const int probe : waiting) {
    // One that moved to a new place has forgotten its rays
    if (traces[probe].rays) surfels += static_cast<std::uint64_t>(traces[probe].rays->rays());
    if (surfels > most_surfels && !slice.probes.empty()) break;
    slice.probes.push_back(probe);
    slice.oldest = std::min(slice.oldest, records[probe].revision);
  }
  return slice;
}

}  // namespace

std::vector<double> IrradianceField::State::direct_light(std::span<const int> probes) {
  return device ? device->direct_light(probes) : direct_light_of(traces, probes);
}

/// Brings surfels and distances up to date with the world. On a device rays are cheap and finding
/// out which may differ is not: all are traced again.
FollowedEdits IrradianceField::State::follow_surfels(const World& world,
                                                     std::span<const WorldChanges> changes,
                                                     std::span<const int> probes,
                                                     std::span<const int> all) {
  if (!device) {
    return follow_edits(world, changes, settings, probes, all, visibility(world), store, traces,
                        salt());
  }
  const DeviceTraced traced = device->retrace(world, probes, salt());
  store_behind = true;
  return {traced.probe_rays, traced.shadow_rays, {}};
}

/// Follows the edits with one slice of the probes. Their light becomes as much brighter as direct
/// light did, which is where the solution starts from.
void IrradianceField::State::follow_slice(const World& world, std::span<const WorldChanges> changes,
                                          std::span<const int> probes, std::span<const int> all,
                                          UpdateStatistics& statistics) {
  const std::vector<double> direct_before = direct_light(probes);
  const bool shapes_differ = std::any_of(changes.begin(), changes.end(),
                                         [](const WorldChanges& c) { return !c.moved.empty(); });
  if (shapes_differ) statistics.shadow_rays += look_across_cells(world, probes);
  const FollowedEdits followed = follow_surfels(world, changes, probes, all);
  statistics.probe_rays += followed.probe_rays;
  statistics.shadow_rays += followed.shadow_rays;
  statistics.probes_followed += static_cast<int>(probes.size());

  const std::vector<double> direct_after = direct_light(probes);
  const double before = std::accumulate(direct_before.begin(), direct_before.end(), 0.0);
  const double after = std::accumulate(direct_after.begin(), direct_after.end(), 0.0);
  const auto brighter = static_cast<float>(before > 0.0 ? after / before : 1.0);
  const int texels = tile_texels();
  for (const int probe : probes) {
    records[probe].revision = world.revision();
    for (int t = 0; t < texels; ++t) {
      light[static_cast<std::size_t>(probe) * texels + t] *= brighter;
    }
  }
}

void IrradianceField::State::follow_sleepers(const World& world, std::uint64_t ray_budget,
                                             std::span<const int> all,
                                             UpdateStatistics& statistics) {
  Stopwatch watch;
  const std::uint64_t spent = statistics.probe_rays + statistics.shadow_rays;
  if (ray_budget != 0 && spent >= ray_budget) return;
  std::size_t count = std::min(sleepers_a_slice, late_sleepers.size());
  if (ray_budget != 0 && count > 0) {
    count = std::min(count,
                     next_slice(late_sleepers, traces, records, ray_budget - spent).probes.size());
  }
  std::vector<int> probes(late_sleepers.begin(),
                          late_sleepers.begin() + static_cast<std::ptrdiff_t>(count));
  late_sleepers.erase(late_sleepers.begin(),
                      late_sleepers.begin() + static_cast<std::ptrdiff_t>(probes.size()));
  // Those that woke meanwhile have been traced
  std::erase_if(probes, [&](int probe) { return records[probe].revision == world.revision(); });
  if (probes.empty()) return;
  std::sort(probes.begin(), probes.end());
  std::uint64_t oldest = world.revision();
  for (const int probe : probes) oldest = std::min(oldest, records[probe].revision);
  const WorkingIrradiance before = light_of(light, probes, tile_texels());
  const WorkingIrradiance gain = gain_of(probes);
  follow_slice(world, *world.changes_since(oldest), probes, all, statistics);
  statistics.follow_ms += watch.lap();

  // No surfel that matters reads them: to send the light of the others to them once is enough
  RelightSettings once = relight_settings();
  once.max_iterations = 1;
  const std::vector<float> shares(probes.size(), 1.0f);
  const RelightResult solved = solve(probes, shares, gain, once);
  statistics.probes_touched += settle_edits(probes, before, solved, gain);
  statistics.relights += solved.iterations;
  statistics.relight_ms += watch.lap();
}

/// Stores what was solved for where it differs from the light before; the others keep theirs to the
/// bit. Returns how many differ.
int IrradianceField::State::settle_edits(std::span<const int> probes,
                                         const WorkingIrradiance& before,
                                         const RelightResult& solved,
                                         const WorkingIrradiance& gain) {
  const auto texels = static_cast<std::size_t>(tile_texels());
  std::vector<int> touched;
  for (std::size_t k = 0; k < probes.size(); ++k) {
    const int probe = probes[k];
    vec4* now = &light[probe * texels];
    const TileLight held(&before[k * texels], texels), found(now, texels);
    if (relative_square(found, held) < kTouchedShare * kTouchedShare) {
      // What the rays told stays, too: changes too small to be seen add up
      std::copy(held.begin(), held.end(), now);
      continue;
    }
    touched.push_back(probe);
    for (std::size_t t = 0; t < texels; ++t) {
      told[probe * texels + t] = solved.solution[k * texels + t] / gain[k * texels + t];
    }
  }
  if (device) device->write_light(light, told);
  store_light(touched);
  return static_cast<int>(touched.size());
}

/// Solves for the light of all that have followed the edits so far.
void IrradianceField::State::solve_edits(UpdateStatistics& statistics) {
  const int texels = tile_texels();
  const WorkingIrradiance before = light_of(edits.before, edits.followed, texels);
  const WorkingIrradiance gain = light_of(edits.gain, edits.followed, texels);
  const std::vector<float> shares(edits.followed.size(), 1.0f);
  const RelightResult solved = solve(edits.followed, shares, gain, relight_settings());
  statistics.relights += solved.iterations;
  statistics.residual = solved.error;
  statistics.probes_touched = settle_edits(edits.followed, before, solved, gain);
  WorkingIrradiance change = light_of(light, edits.followed, texels);
  const double whole = norm(change);
  add_scaled(change, -1.0f, before, change);
  statistics.change = whole > 0.0 ? norm(change) / whole : 0.0;
}

/// Finds the probes that know an older world. Those that cannot follow start their average anew.
Behind IrradianceField::State::find_behind(const World& world) {
  const std::uint64_t revision = world.revision();
  const std::uint64_t oldest = oldest_known_revision(world);
  Behind behind;
  for (int probe = 0; probe < store.probes(); ++probe) {
    const ProbeRecord& record = records[probe];
    const bool traced = traces[probe].rays != nullptr;
    if (traced) behind.traced.push_back(probe);
    if (record.revision == revision) continue;
    // A later revision than the world's is of another object of the class
    const bool told_of = record.revision >= oldest && record.revision < revision;
    if (traced && told_of && settings.max_bounces < 0) {
      const bool sleeps = record.state == ProbeState::sleeping;
      (sleeps ? behind.sleepers : behind.waiting).push_back(probe);
    } else {
      // Without surfels to hold against edits, after more of them than the world remembers, or
      // where bounces are counted, what was averaged is of the past
      forget_light(probe, revision);
    }
  }
  return behind;
}

/// Takes from the averages of the probes that followed the open edits what they are no longer
/// worth.
void IrradianceField::State::lose_samples() {
  const auto texels = static_cast<std::size_t>(tile_texels());
  for (const int probe : edits.followed) {
    const TileLight held(&edits.before[probe * texels], texels),
        found(&light[probe * texels], texels);
    if (relative_square(found, held) < kTouchedShare * kTouchedShare) continue;
    // The less, the more the light changed
    const float kept = likeness(found, held);
    records[probe].samples = max(records[probe].samples * kept * kept, 1.0f);
    agenda.changed(probe);
  }
}

/// Remembers the light before the edits, while light and rays are of one world.
void IrradianceField::State::open_edits(std::uint64_t revision, std::span<const int> traced) {
  if (!edits.before.empty() && edits.revision == revision) return;
  if (edits.before.empty()) {
    tell_exactly(traced);
  } else {
    // Those that followed the edits before this one hold averages of another light
    lose_samples();
  }
  edits.before = light;
  edits.gain.resize(light.size());
  edits.followed.clear();
  edits.revision = revision;
}

/// Follows in slices until the budget is spent: how many rays a slice takes is known afterwards.
/// Takes those that followed out of `behind.waiting`.
void IrradianceField::State::follow_in_slices(const World& world, std::uint64_t ray_budget,
                                              Behind& behind, UpdateStatistics& statistics) {
  Stopwatch watch;
  const auto texels = static_cast<std::size_t>(tile_texels());
  const std::uint64_t most =
      ray_budget == 0 ? std::numeric_limits<std::uint64_t>::max() : ray_budget;
  std::vector<int> followed;
  std::uint64_t spent = 0;
  while (!behind.waiting.empty() && spent < most) {
    const Slice slice = next_slice(behind.waiting, traces, records, most - spent);
    const std::vector<WorldChanges> changes = *world.changes_since(slice.oldest);
    const WorkingIrradiance gain = gain_of(slice.probes);
    for (std::size_t k = 0; k < slice.probes.size(); ++k) {
      std::copy_n(&gain[k * texels], texels, &edits.gain[slice.probes[k] * texels]);
    }
    statistics.relight_ms += watch.lap();
    follow_slice(world, changes, slice.probes, behind.traced, statistics);
    statistics.follow_ms += watch.lap();
    behind.waiting.erase(behind.waiting.begin(),
                         behind.waiting.begin() + static_cast<std::ptrdiff_t>(slice.probes.size()));
    followed.insert(followed.end(), slice.probes.begin(), slice.probes.end());
    spent =
        statistics.probe_rays + statistics.shadow_rays + kRaysPerProbeFollowed * followed.size();
  }
  std::sort(followed.begin(), followed.end());
  std::vector<int> merged;
  std::merge(edits.followed.begin(), edits.followed.end(), followed.begin(), followed.end(),
             std::back_inserter(merged));
  edits.followed = std::move(merged);
}

Followed IrradianceField::State::follow(const World& world, std::uint64_t ray_budget,
                                        const std::optional<vec3>& viewer_ws,
                                        UpdateStatistics& statistics) {
  Stopwatch watch;
  const std::uint64_t revision = world.revision();
  if (followed_revision == revision && late_sleepers.empty()) return Followed::nothing;
  if (followed_revision > revision) {
    // Of another object of the class: what these probes know cannot be told from what it knows
    for (const int probe : late_sleepers) forget_light(probe, revision);
    late_sleepers.clear();
  }
  fetch_light();
  Behind behind = find_behind(world);
  if (followed_revision != revision) {
    sleepers_a_slice = (behind.sleepers.size() + kSleeperSlices - 1) / kSleeperSlices;
    std::stable_sort(behind.sleepers.begin(), behind.sleepers.end(),
                     [&](int a, int b) { return records[a].revision < records[b].revision; });
    late_sleepers = std::move(behind.sleepers);
  }
  const bool any = !behind.waiting.empty();
  if (any) {
    put_in_order(behind.waiting, ray_budget, viewer_ws, revision);
    open_edits(revision, behind.traced);
    statistics.follow_ms += watch.lap();
    follow_in_slices(world, ray_budget, behind, statistics);
    watch.lap();
    solve_edits(statistics);
    statistics.relight_ms += watch.lap();
    if (!behind.waiting.empty()) return Followed::some;
  }
  if (!edits.before.empty()) lose_samples();
  edits = {};
  followed_revision = revision;
  follow_sleepers(world, ray_budget, behind.traced, statistics);
  return any ? Followed::all : Followed::nothing;
}

/// Under a budget, probes far behind come first, so that edits without end leave none behind; then
/// those that matter to what is seen, or near ones.
void IrradianceField::State::put_in_order(std::vector<int>& waiting, std::uint64_t ray_budget,
                                          const std::optional<vec3>& viewer_ws,
                                          std::uint64_t revision) const {
  if (ray_budget == 0) return;
  std::vector<float> rank(records.size(), 0.0f);
  for (const int probe : waiting) {
    if (revision - records[probe].revision > kFarBehind) {
      rank[probe] = -std::numeric_limits<float>::max();
    } else if (!importance.empty()) {
      rank[probe] = -importance[probe];
    } else if (viewer_ws) {
      rank[probe] = glm::distance(store.probe_position_ws(probe), *viewer_ws);
    }
  }
  std::stable_sort(waiting.begin(), waiting.end(), [&](int a, int b) { return rank[a] < rank[b]; });
}

/// Has a probe start its average anew.
void IrradianceField::State::forget_light(int probe, std::uint64_t revision) {
  records[probe].samples = 0.0f;
  records[probe].revision = revision;
  agenda.changed(probe);
}

}  // namespace lambent
