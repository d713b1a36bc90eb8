// SPDX-License-Identifier: Apache-2.0
// The part of an update that follows edits of the world: exactly what they touch gets new light.
//
// What averaging knew better than the rays of one update is kept: with H the light that a probe
// holds and T_old the transport through its surfels before the edit, each texel is corrected by the
// gain g = H / (T_old H). After the edit the light solves
//   +--------------------+
//   |  E = g (T_new E)   |
//   +--------------------+
// Where nothing changed that is H itself, to the bit; where all light became k times as bright, k
// H; where it went out, 0; and nowhere has it more noise than the change itself.
#include <algorithm>
#include <iterator>
#include <limits>
#include <optional>

#include "core/stopwatch.h"
#include "field/field_state.h"
#include "field/follow.h"
#include "field/tile_light.h"
#include "lambent/world.h"

namespace lambent {
namespace {

// Light that edits changed by less than this share of a probe's is not worth losing history for:
// half of what can be seen.
constexpr float kTouchedShare = 0.005f;

// Holding a probe's surfels against edits costs about as much as tracing so many rays, even where
// nothing need be traced.
constexpr std::uint64_t kRaysPerProbeFollowed = 8;

// What one update's rays tell of a probe is not off by more than this factor, or they met nothing
// worth correcting.
constexpr float kMaxGain = 2.0f;

/// What `told` must be multiplied by to give `held`, within bounds.
vec4 gain_between(const vec4& told, const vec4& held) {
  vec4 gain(1.0f);
  for (int c = 0; c < 3; ++c) {
    if (told[c] > kTiniestLight) gain[c] = clamp(held[c] / told[c], 1.0f / kMaxGain, kMaxGain);
  }
  return gain;
}

/// What the probes receive of direct light and the sky.
WorkingIrradiance direct_of(const TransportOperator& transport, const WorkingIrradiance& held) {
  WorkingIrradiance received(held.size());
  transport.apply_direct(held, received);
  return received;
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
    surfels += traces[probe].surfels.size();
    if (surfels > most_surfels && !slice.probes.empty()) break;
    slice.probes.push_back(probe);
    slice.oldest = std::min(slice.oldest, records[probe].revision);
  }
  return slice;
}

}  // namespace

/// Computes by how much averaging corrects what the probes' last rays told of the light before the
/// edits.
void IrradianceField::State::keep_gain(std::span<const int> probes) {
  const int texels = tile_texels();
  const WorkingIrradiance held = light_of(light, probes, texels);
  WorkingIrradiance told(held.size());
  transport(probes).apply(edits.before, held, told);
  for (std::size_t k = 0; k < probes.size(); ++k) {
    for (int t = 0; t < texels; ++t) {
      edits.gain[static_cast<std::size_t>(probes[k]) * texels + t] =
          gain_between(told[k * texels + t], held[k * texels + t]);
    }
  }
}

/// Follows the edits with one slice of the probes. Their light becomes as much brighter as direct
/// light did, which is where the solution starts from.
void IrradianceField::State::follow_slice(const World& world, std::span<const WorldChanges> changes,
                                          std::span<const int> probes, std::span<const int> all,
                                          UpdateStatistics& statistics) {
  const int texels = tile_texels();
  const WorkingIrradiance held = light_of(light, probes, texels);
  const WorkingIrradiance direct_before = direct_of(transport(probes), held);
  const bool shapes_differ = std::any_of(changes.begin(), changes.end(),
                                         [](const WorldChanges& c) { return !c.moved.empty(); });
  if (settings.visibility == Visibility::hybrid && shapes_differ) {
    statistics.shadow_rays += sights.look(world.tracer(), store, probes);
  }
  const FollowedEdits followed =
      follow_edits(world, changes, settings, probes, all, visibility(world), store, traces, salt());
  statistics.probe_rays += followed.probe_rays;
  statistics.shadow_rays += followed.shadow_rays;
  statistics.probes_followed += static_cast<int>(probes.size());

  const WorkingIrradiance direct_after = direct_of(transport(probes), held);
  const double power = inner_product(direct_before, direct_before);
  const float brighter =
      power > 0.0 ? static_cast<float>(inner_product(direct_before, direct_after) / power) : 1.0f;
  for (const int probe : probes) {
    records[probe].revision = edits.revision;
    for (int t = 0; t < texels; ++t) {
      light[static_cast<std::size_t>(probe) * texels + t] *= brighter;
    }
  }
}

/// Solves for the light of all that have followed the edits so far.
void IrradianceField::State::solve_edits(bool done, UpdateStatistics& statistics) {
  const int texels = tile_texels();
  const WorkingIrradiance before = light_of(edits.before, edits.followed, texels);
  const std::vector<float> shares(edits.followed.size(), 1.0f);
  const RelightResult solved =
      relight(transport(edits.followed), shares, light_of(edits.gain, edits.followed, texels),
              relight_settings(), light);
  statistics.relights += solved.iterations;
  statistics.residual = solved.error;

  // Probes whose light stayed keep it to the bit; averages of another light are worth the less the
  // more it changed
  std::vector<int> touched;
  for (std::size_t k = 0; k < edits.followed.size(); ++k) {
    const int probe = edits.followed[k];
    vec4* now = &light[static_cast<std::size_t>(probe) * texels];
    const TileLight held(&before[k * texels], texels), found(now, texels);
    if (relative_square(found, held) < kTouchedShare * kTouchedShare) {
      std::copy(held.begin(), held.end(), now);
      continue;
    }
    touched.push_back(probe);
    const float kept = likeness(found, held);
    if (done) records[probe].samples = max(records[probe].samples * kept * kept, 1.0f);
  }
  WorkingIrradiance change = light_of(light, edits.followed, texels);
  const double whole = norm(change);
  add_scaled(change, -1.0f, before, change);
  statistics.change = whole > 0.0 ? norm(change) / whole : 0.0;
  statistics.probes_touched = static_cast<int>(touched.size());
  store_light(touched);
}

Followed IrradianceField::State::follow(const World& world, std::uint64_t ray_budget,
                                        const std::optional<vec3>& viewer_ws,
                                        UpdateStatistics& statistics) {
  // Find the probes that know an older world
  Stopwatch watch;
  const std::uint64_t revision = world.revision();
  const std::uint64_t oldest = oldest_known_revision(world);
  std::vector<int> all, waiting;
  for (int probe = 0; probe < store.probes(); ++probe) {
    ProbeRecord& record = records[probe];
    const bool traced = traces[probe].rays != nullptr;
    if (traced) all.push_back(probe);
    if (record.revision == revision) continue;
    // A later revision than the world's is of another object of the class
    const bool told = record.revision >= oldest && record.revision < revision;
    if (traced && told && settings.max_bounces < 0) {
      waiting.push_back(probe);
    } else {
      // Without surfels to hold against edits, after more of them than the world remembers, or
      // where bounces are counted, what was averaged is of the past
      forget_light(probe, revision);
    }
  }
  if (waiting.empty()) return Followed::nothing;
  if (ray_budget != 0 && viewer_ws) {
    std::stable_sort(waiting.begin(), waiting.end(), [&](int a, int b) {
      return glm::distance(store.probe_position_ws(a), *viewer_ws) <
             glm::distance(store.probe_position_ws(b), *viewer_ws);
    });
  }
  if (edits.before.empty() || edits.revision != revision) {
    edits.before = light;
    edits.gain.resize(light.size());
    edits.followed.clear();
    edits.revision = revision;
  }

  // Follow in slices until the budget is spent: how many rays a slice takes is known afterwards
  std::vector<int> followed;
  const std::uint64_t most =
      ray_budget == 0 ? std::numeric_limits<std::uint64_t>::max() : ray_budget;
  std::uint64_t spent = 0;
  while (!waiting.empty() && spent < most) {
    const Slice slice = next_slice(waiting, traces, records, most - spent);
    const std::vector<WorldChanges> changes = *world.changes_since(slice.oldest);
    keep_gain(slice.probes);
    statistics.relight_ms += watch.lap();
    follow_slice(world, changes, slice.probes, all, statistics);
    statistics.follow_ms += watch.lap();
    waiting.erase(waiting.begin(),
                  waiting.begin() + static_cast<std::ptrdiff_t>(slice.probes.size()));
    followed.insert(followed.end(), slice.probes.begin(), slice.probes.end());
    spent =
        statistics.probe_rays + statistics.shadow_rays + kRaysPerProbeFollowed * followed.size();
  }
  std::sort(followed.begin(), followed.end());
  std::vector<int> merged;
  std::merge(edits.followed.begin(), edits.followed.end(), followed.begin(), followed.end(),
             std::back_inserter(merged));
  edits.followed = std::move(merged);
  solve_edits(waiting.empty(), statistics);
  statistics.relight_ms += watch.lap();
  if (!waiting.empty()) return Followed::some;
  edits = {};
  return Followed::all;
}

/// Has a probe start its average anew.
void IrradianceField::State::forget_light(int probe, std::uint64_t revision) {
  records[probe].samples = 0.0f;
  records[probe].revision = revision;
}

}  // namespace lambent
