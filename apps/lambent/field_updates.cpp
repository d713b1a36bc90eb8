// SPDX-License-Identifier: Apache-2.0
#include "lambent/field_updates.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

namespace lambent::cli {
namespace {

// Passes that statistics always list, whether or not they ran; names of UpdateStatistics::passes.
constexpr const char* kPasses[] = {"placement",  "edits",   "schedule",    "trace",
                                   "shade",      "lookups", "solve",       "blend_distances",
                                   "visibility", "store",   "variability", "corrections"};

// Light counts as settled when an update changes the field by less than this share of it,
constexpr double kSettledChange = 0.002;
// or after this many updates.
constexpr int kMaxSettleUpdates = 256;

// Light counts as calm when its standard error is below this share of it: noise around probes is
// then hard to see on a plain wall. That is for as many probes as a scene's grid has by default.
// What gathering rays meet is lit by more of them where there are more, and averages their errors,
// so that these may be larger by the square root of their number, up to kMaxCalmError, which is
// below what users are told of.
constexpr double kCalmError = 0.025;
constexpr double kMaxCalmError = 0.04;
// Fields that do not become calm end after this many updates,
constexpr int kMaxCalmUpdates = 80;
// or once probes have traced this many rays: 14 updates of all probes of a grid of the default
// size. What few of a probe's rays find, gathering rays find by themselves, and they meet more
// probes where there are more. Pictures without a gather show the noise of the probes, which four
// times as many rays halve.
constexpr std::uint64_t kMaxCalmRays = 8'000'000;
constexpr std::uint64_t kMaxCalmRaysUngathered = 4 * kMaxCalmRays;
// The first updates trace as many rays as the settings say, later ones this share of them, from
// the probes with the most noise near the viewer. docs/performance.md tells what that saves, and
// what two full updates in place of three cost.
constexpr int kFullUpdates = 3;
constexpr double kLaterRayShare = 0.5;

using AfterUpdate = std::function<void(const FieldProgress&)>;

/// How far a field is updated: until its light changes little, or has little noise, within limits.
struct UpdateLimits {
  int least;  ///< Number of updates, including earlier ones, before which no other condition holds.
  int most;   ///< Number of updates, including earlier ones.
  double change = 0.0;  ///< Relative change of the light by an update; 0: no condition.
  double error = 0.0;   ///< Relative standard error of the light; 0: no condition.
  /// Number of probe rays after which the field ends as it is; 0: no condition.
  std::uint64_t max_rays = 0;
  /// Number of updates after which the others trace kLaterRayShare of the rays; 0: none do.
  int full_updates = 0;
};

/// The share of the updates that have been made, 0 to 1, if the light does not become calm before.
double share_done(const UpdateLimits& limits, int updates, std::uint64_t rays) {
  const double of_most = static_cast<double>(updates) / limits.most;
  if (limits.max_rays == 0) return of_most;
  const double of_least = static_cast<double>(updates) / limits.least;
  const double of_rays = static_cast<double>(rays) / static_cast<double>(limits.max_rays);
  return std::max(of_most, std::min({1.0, of_least, of_rays}));
}

/// Updates a field that has had `before` updates already, which are included in the counts.
FieldProgress run_updates(const World& world, int before, const UpdateLimits& limits,
                          const UpdateRequest& request, IrradianceField& field,
                          const ProgressFn& progress, const AfterUpdate& after,
                          nlohmann::ordered_json& stats) {
  FieldProgress reached;
  reached.updates = before;
  UpdateStatistics last, sum;
  std::map<std::string, double> pass_ms;
  for (const char* pass : kPasses) pass_ms[pass] = 0.0;
  const auto calm = [&] {
    return reached.updates > before && reached.updates >= limits.least &&
           (reached.change < limits.change ||
            (limits.error > 0.0 && field.standard_error() < limits.error));
  };
  const auto rays_spent = [&] {
    return limits.max_rays > 0 && reached.updates >= limits.least &&
           sum.probe_rays >= limits.max_rays;
  };
  const auto done = [&] { return reached.updates >= limits.most || calm() || rays_spent(); };
  UpdateRequest next = request;
  while (!done()) {
    last = field.update(world, next);
    ++reached.updates;
    if (limits.full_updates > 0 && reached.updates == limits.full_updates) {
      const double rays = kLaterRayShare * static_cast<double>(last.probe_rays);
      next.ray_budget =
          std::max(static_cast<std::uint64_t>(rays), std::uint64_t{1});  // 0: no bound
    }
    reached.change = last.change;
    reached.settled = last.change < kSettledChange;
    for (const PassTime& pass : last.passes) pass_ms[pass.name] += pass.ms;
    sum.probe_rays += last.probe_rays;
    sum.shadow_rays += last.shadow_rays;
    sum.correction_rays += last.correction_rays;
    sum.probes_traced += last.probes_traced;
    sum.probes_invalidated += last.probes_invalidated;
    sum.probes_changed += last.probes_changed;
    sum.probes_recycled += last.probes_recycled;
    if (progress) progress("field", share_done(limits, reached.updates, sum.probe_rays));
    if (after && !done()) after(reached);
  }
  const FieldGrid& grid = field.grids().front();
  stats["updates"] = reached.updates;
  stats["probes"] = field.probes();
  stats["volumes"] = field.grids().size();
  stats["probe_spacing_x_m"] = grid.spacing.x;
  stats["probe_spacing_y_m"] = grid.spacing.y;
  stats["probe_spacing_z_m"] = grid.spacing.z;
  stats["rays_per_probe"] = field.settings().rays_per_probe;
  stats["field_bytes"] = field.store_bytes();
  stats["bytes_per_probe"] = static_cast<double>(field.store_bytes()) / field.probes();
  stats["surfel_bytes"] = field.surfel_bytes();
  stats["probe_rays"] = sum.probe_rays;
  stats["surfel_shadow_rays"] = sum.shadow_rays;
  stats["correction_rays"] = sum.correction_rays;
  stats["probes_traced"] = sum.probes_traced;
  stats["probes_invalidated"] = sum.probes_invalidated;
  stats["probes_changed"] = sum.probes_changed;
  stats["probes_recycled"] = sum.probes_recycled;
  stats["probes_stale"] = last.probes_stale;
  stats["probes_off"] = last.states.off;
  stats["probes_sleeping"] = last.states.sleeping;
  stats["probes_newly_awake"] = last.states.newly_awake;
  stats["probes_awake"] = last.states.awake;
  stats["probes_newly_vigilant"] = last.states.newly_vigilant;
  stats["probes_vigilant"] = last.states.vigilant;
  stats["solve_iterations_last_update"] = last.solve_iterations;
  stats["solve_residual"] = last.residual;
  stats["field_change_last_update"] = last.change;
  stats["field_standard_error"] = field.standard_error();
  for (const auto& [pass, ms] : pass_ms) stats[pass + "_ms"] = ms;
  return reached;
}

}  // namespace

FieldProgress update_field(const World& world, int updates, const UpdateRequest& request,
                           IrradianceField& field, const ProgressFn& progress,
                           nlohmann::ordered_json& stats) {
  return run_updates(world, 0, {updates, updates}, request, field, progress, {}, stats);
}

FieldProgress calm_field(const World& world, int least, bool gathers, const UpdateRequest& request,
                         IrradianceField& field, const ProgressFn& progress,
                         nlohmann::ordered_json& stats) {
  const double ratio = static_cast<double>(field.probes()) / FieldSettings{}.probe_budget;
  const UpdateLimits limits{
      .least = least,
      .most = std::max(least, kMaxCalmUpdates),
      .error = std::min(kCalmError * std::sqrt(std::max(ratio, 1.0)), kMaxCalmError),
      .max_rays = gathers ? kMaxCalmRays : kMaxCalmRaysUngathered,
      .full_updates = kFullUpdates};
  return run_updates(world, 0, limits, request, field, progress, {}, stats);
}

FieldProgress settle_field(const World& world, const UpdateRequest& request, IrradianceField& field,
                           const ProgressFn& progress, nlohmann::ordered_json& stats) {
  const UpdateLimits limits{1, kMaxSettleUpdates, kSettledChange};
  return run_updates(world, 0, limits, request, field, progress, {}, stats);
}

FieldProgress bake_field(const World& world, const UpdateRequest& request, const BakeLoop& loop,
                         IrradianceField& field, nlohmann::ordered_json& stats) {
  const UpdateLimits limits = loop.updates == 0 ? UpdateLimits{1, kMaxSettleUpdates, kSettledChange}
                                                : UpdateLimits{loop.updates, loop.updates};
  return run_updates(world, field.updates(), limits, request, field, loop.progress,
                     loop.after_update, stats);
}

}  // namespace lambent::cli
