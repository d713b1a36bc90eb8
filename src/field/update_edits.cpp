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
#include <optional>

#include "core/stopwatch.h"
#include "field/field_state.h"
#include "field/follow.h"
#include "field/tile_light.h"
#include "lambent/world.h"

namespace lambent {
namespace {

// Light that edits changed by less than this share of a probe's is not worth losing history for: a
// quarter of what can be seen.
constexpr float kTouchedShare = 0.0025f;

// Surfels are cheap to follow: about so many for the time of tracing one.
constexpr std::uint64_t kFollowedPerRay = 4;

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

}  // namespace

bool IrradianceField::State::follow(const World& world, std::uint64_t ray_budget,
                                    UpdateStatistics& statistics) {
  // Find the probes that know an older world
  Stopwatch watch;
  const std::uint64_t revision = world.revision();
  const std::uint64_t most_surfels = kFollowedPerRay * ray_budget;
  std::uint64_t oldest = revision, surfels = 0;
  std::vector<int> all, probes;
  bool waiting = false;
  for (int probe = 0; probe < store.probes(); ++probe) {
    if (!traces[probe].rays) continue;
    all.push_back(probe);
    if (records[probe].revision == revision) continue;
    if (ray_budget != 0 && surfels >= most_surfels) {
      waiting = true;
      continue;
    }
    surfels += traces[probe].surfels.size();
    oldest = std::min(oldest, records[probe].revision);
    probes.push_back(probe);
  }
  if (probes.empty()) return false;
  const std::optional<std::vector<WorldChanges>> changes = world.changes_since(oldest);
  if (!changes || settings.max_bounces >= 0) {
    // The log no longer says what changed, or bounces cannot be followed one by one: all may be new
    for (const int probe : all) {
      records[probe].samples = 0.0f;
      records[probe].revision = revision;
    }
    edits = {};
    return false;
  }

  // Compute by how much averaging corrects what the last rays told. Probes go on being corrected
  // so: where nothing changes, the solution is the light that they hold
  const int texels = tile_texels();
  if (edits.before.empty() || edits.revision != revision) {
    edits.before = light;
    edits.gain.resize(light.size());
    edits.followed.clear();
    edits.revision = revision;
  }
  const WorkingIrradiance held = light_of(light, probes, texels);
  WorkingIrradiance told(held.size());
  transport(probes).apply(edits.before, held, told);
  for (std::size_t k = 0; k < probes.size(); ++k) {
    for (int t = 0; t < texels; ++t) {
      edits.gain[static_cast<std::size_t>(probes[k]) * texels + t] =
          gain_between(told[k * texels + t], held[k * texels + t]);
    }
  }
  const WorkingIrradiance direct_before = direct_of(transport(probes), held);
  statistics.relight_ms += watch.lap();

  const FollowedEdits followed =
      follow_edits(world, *changes, settings, probes, all, store, traces, salt());
  statistics.probe_rays += followed.probe_rays;
  statistics.shadow_rays += followed.shadow_rays;
  statistics.probes_followed += static_cast<int>(probes.size());
  for (const int probe : probes) records[probe].revision = revision;
  statistics.follow_ms += watch.lap();

  // Start from the light that was there, as much brighter as direct light became
  const WorkingIrradiance direct_after = direct_of(transport(probes), held);
  const double direct_power = inner_product(direct_before, direct_before);
  if (direct_power > 0.0) {
    const auto brighter =
        static_cast<float>(inner_product(direct_before, direct_after) / direct_power);
    for (const int probe : probes) {
      for (int t = 0; t < texels; ++t) {
        light[static_cast<std::size_t>(probe) * texels + t] *= brighter;
      }
    }
  }

  // Solve for the light of all that have been followed so far
  std::vector<int> merged;
  std::merge(edits.followed.begin(), edits.followed.end(), probes.begin(), probes.end(),
             std::back_inserter(merged));
  edits.followed = std::move(merged);
  const WorkingIrradiance history = light_of(edits.before, edits.followed, texels);
  const WorkingIrradiance gain = light_of(edits.gain, edits.followed, texels);
  const std::vector<float> shares(edits.followed.size(), 1.0f);
  const RelightResult solved =
      relight(transport(edits.followed), shares, gain, relight_settings(), light);
  statistics.relights += solved.iterations;
  statistics.residual = solved.error;

  // Probes whose light stayed keep it to the bit; averages of another light are worth the less the
  // more it changed
  std::vector<int> touched;
  for (std::size_t k = 0; k < edits.followed.size(); ++k) {
    const int probe = edits.followed[k];
    vec4* now = &light[static_cast<std::size_t>(probe) * texels];
    const TileLight before(&history[k * texels], texels), after(now, texels);
    if (relative_square(after, before) < kTouchedShare * kTouchedShare) {
      std::copy(before.begin(), before.end(), now);
      continue;
    }
    touched.push_back(probe);
    const float kept = likeness(after, before);
    if (!waiting) records[probe].samples = max(records[probe].samples * kept * kept, 1.0f);
  }
  WorkingIrradiance change = light_of(light, edits.followed, texels);
  const double whole = norm(change);
  add_scaled(change, -1.0f, history, change);
  statistics.change = whole > 0.0 ? norm(change) / whole : 0.0;
  statistics.probes_touched = static_cast<int>(touched.size());
  statistics.relight_ms += watch.lap();
  store_light(touched);
  if (!waiting) edits = {};
  statistics.blend_ms += watch.lap();
  return true;
}

}  // namespace lambent
