// SPDX-License-Identifier: Apache-2.0
#include "lambent/field_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "lambent/parse.h"
#include "lambent/validators.h"
#include "lambent/words.h"

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
// below what users are told of. Updates beyond kMaxCalmUpdates improve it by less than they cost.
constexpr double kCalmError = 0.025;
constexpr double kMaxCalmError = 0.04;
constexpr int kMaxCalmUpdates = 80;
// Light that would still be noisy (kNoisyField) after the last of them gets no more than this many:
// where few rays find most of the light, gathering rays meet it themselves. In five such scenes, 80
// updates brought `indirect` at most 1 % nearer to the reference (FLIP), for twice the time.
constexpr int kMaxNoisyUpdates = 32;
// Once all bounces have reached all probes, an update has this share of a full one's rays, which go
// to the noisiest probes: a bathroom lit by a patch of sun reaches 3 % of error in 4.4 s, with full
// updates in 7.6 s, and with quarters of them in 5.6 s.
constexpr double kCalmRays = 0.5;

const std::map<std::string, IrradianceFormat> kIrradianceFormats = {
    {"rgb9e5", IrradianceFormat::rgb9e5},
    {"r11g11b10f", IrradianceFormat::r11g11b10f},
    {"float32", IrradianceFormat::float32}};
const std::map<std::string, DistanceFormat> kDistanceFormats = {{"rg16f", DistanceFormat::rg16f},
                                                                {"rg32f", DistanceFormat::rg32f}};

// Largest distance between probes [m]; its square is finite in a float.
constexpr double kMaxSpacing = 1e15;
constexpr int kMaxCascades = 16;

const std::map<std::string, Visibility> kVisibilities = {
    {"moments", Visibility::moments}, {"hybrid", Visibility::hybrid}, {"exact", Visibility::exact}};

/// The options that correspond to settings of the library. Other settings have no option.
constexpr std::pair<const char*, const char*> kOptionsOfFieldSettings[] = {
    {"rays", "--rays"},
    {"hysteresis", "--hysteresis"},
    {"irradiance texels", "--irradiance-texels"},
    {"distance texels", "--distance-texels"},
    {"bounces", "--bounces"},
    {"cascades", "--cascades"},
    {"probe spacing", "--probe-spacing"},
    {"probes", "--probes"},
    {"volume", "--bounds"},
    {"volumes", "--volume"}};

template <class Value>
std::vector<std::string> names_of(const std::map<std::string, Value>& values) {
  std::vector<std::string> names;
  names.reserve(values.size());
  for (const auto& [name, value] : values) names.push_back(name);
  return names;
}

using AfterUpdate = std::function<void(const FieldProgress&)>;

/// Conditions for the end of updates: the light changes little, or has little noise, within limits.
struct UpdateLimits {
  int least;
  int most;
  double change = 0.0;  // relative change of the light by an update; 0: no condition
  double error = 0.0;   // relative standard error of the light; 0: no condition
  double rays = 1.0;    // share of a full update's rays, after the first `least` updates
};

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
  // Standard errors fall with the square root of the number of updates
  const auto stays_noisy = [&] {
    return limits.error > 0.0 && reached.updates == std::max(limits.least, kMaxNoisyUpdates) &&
           field.standard_error() * std::sqrt(static_cast<double>(reached.updates) / limits.most) >
               kNoisyField;
  };
  const auto done = [&] { return reached.updates >= limits.most || calm() || stays_noisy(); };
  UpdateRequest next = request;
  while (!done()) {
    last = field.update(world, next);
    ++reached.updates;
    if (limits.rays < 1.0 && reached.updates == limits.least) {
      next.ray_budget =
          static_cast<std::uint64_t>(limits.rays * static_cast<double>(last.probe_rays));
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
    if (progress) progress("field", static_cast<double>(reached.updates) / limits.most);
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

void add_field_options(CLI::App& command, FieldOptions& o) {
  command.option_defaults()->group("The field");
  const auto of_shape = [&o](CLI::Option* option) {
    o.of_shape.push_back(option);
    return option;
  };
  of_shape(command.add_option("--probes", o.probes, "Probes along each axis, each 2 to 4096"))
      ->type_name("XxYxZ");
  of_shape(command.add_option("--probe-spacing", o.settings.probe_spacing,
                              "Or the distance between them [m] (about 4,096 probes)"))
      ->check(number_above_zero(kMaxSpacing))
      ->type_name("M");
  of_shape(command.add_option("--bounds", o.bounds,
                              "Box of the probes [m] (the scene's open space, a little inside)"))
      ->type_name("X0,Y0,Z0,X1,Y1,Z1");
  of_shape(command.add_option("--cascades", o.settings.cascades,
                              "Nested volumes around the camera in place of one box, 1 to 16"))
      ->check(whole_number(0, kMaxCascades))
      ->type_name("N");
  of_shape(command.add_option("--volume", o.volumes,
                              "Another volume: a box as of --bounds, then any of :spacing=M "
                              ":probes=XxYxZ :turn=DEGREES :priority=N"))
      ->allow_extra_args(false)
      ->take_all()
      ->type_name("BOX[:KEY=VALUE]...");
  command.add_option("--rays", o.settings.rays_per_probe, "Rays a probe and update, 16 to 4096")
      ->check(whole_number(16, 4096))
      ->capture_default_str()
      ->type_name("N");
  command
      .add_option("--hysteresis", o.settings.hysteresis,
                  "Share of the old light that an update keeps, 0 to 0.999")
      ->check(number(0.0, 0.999))
      ->capture_default_str()
      ->type_name("H");
  of_shape(command.add_option("--irradiance-format", o.irradiance_format,
                              list_text(names_of(kIrradianceFormats))))
      ->check(one_of(names_of(kIrradianceFormats)))
      ->capture_default_str()
      ->type_name("F");
  of_shape(command.add_option("--distance-format", o.distance_format, "rg16f or rg32f"))
      ->check(one_of(names_of(kDistanceFormats)))
      ->capture_default_str()
      ->type_name("F");
  of_shape(command.add_option("--irradiance-texels", o.settings.irradiance_texels,
                              "Along a tile's edge, 2 to 16, even"))
      ->check(whole_number(2, 16))
      ->capture_default_str()
      ->type_name("N");
  of_shape(command.add_option("--distance-texels", o.settings.distance_texels,
                              "Along a tile's edge, 4 to 32"))
      ->check(whole_number(4, 32))
      ->capture_default_str()
      ->type_name("N");
  command.add_flag("!--no-corrections", o.settings.corrections,
                   "Do not learn how far lookups are off");
  of_shape(
      command.add_flag("!--no-relocation", o.settings.relocation, "Keep the probes on the grid"));
  command
      .add_option("--visibility", o.visibility,
                  "Which probes a lookup sees: moments, hybrid or exact (moments; of pictures of "
                  "--quality high hybrid)")
      ->check(one_of(names_of(kVisibilities)))
      ->type_name("V");
}

std::string name_of(IrradianceFormat format) {
  const auto named = std::find_if(kIrradianceFormats.begin(), kIrradianceFormats.end(),
                                  [&](const auto& entry) { return entry.second == format; });
  assert(named != kIrradianceFormats.end());
  return named->first;
}

Expected<FieldSettings> field_settings(const FieldOptions& options, const Scene& scene,
                                       std::uint32_t seed, int bounces) {
  FieldSettings settings = options.settings;
  settings.seed = seed;
  settings.max_bounces = bounces;
  settings.irradiance_format = kIrradianceFormats.at(options.irradiance_format);
  settings.distance_format = kDistanceFormats.at(options.distance_format);
  if (!options.visibility.empty()) settings.visibility = kVisibilities.at(options.visibility);
  if (!options.probes.empty()) {
    if (settings.probe_spacing > 0.0f && settings.cascades == 0) {
      return fail("--probes", "", "give either --probes or --probe-spacing");
    }
    const auto counts = parse_counts("--probes", options.probes);
    if (!counts) return tl::unexpected(counts.error());
    settings.probe_count = *counts;
  }
  if (!options.bounds.empty()) {
    if (settings.cascades > 0) {
      return fail("--bounds", "", "cascades follow the camera: give either");
    }
    const auto box = parse_box("--bounds", options.bounds);
    if (!box) return tl::unexpected(box.error());
    settings.volume = *box;
  }
  settings.volumes = scene.volumes;
  for (const std::string& text : options.volumes) {
    const auto volume = parse_volume("--volume", text);
    if (!volume) return tl::unexpected(volume.error());
    settings.volumes.push_back(*volume);
  }
  return settings;
}

Error in_options(Error error, const FieldOptions& options) {
  for (const auto& [setting, option] : kOptionsOfFieldSettings) {
    if (error.place != setting) continue;
    error.place = option;
    return error;
  }
  // Volumes are named by the option's text, or by the scene's author
  for (const std::string& typed : options.volumes) {
    if (error.place == "volume '" + typed + "'") error.place = "--volume " + typed;
  }
  return error;
}

FieldProgress update_field(const World& world, int updates, const UpdateRequest& request,
                           IrradianceField& field, const ProgressFn& progress,
                           nlohmann::ordered_json& stats) {
  return run_updates(world, 0, {updates, updates}, request, field, progress, {}, stats);
}

FieldProgress calm_field(const World& world, int least, const UpdateRequest& request,
                         IrradianceField& field, const ProgressFn& progress,
                         nlohmann::ordered_json& stats) {
  const double ratio = static_cast<double>(field.probes()) / FieldSettings{}.probe_budget;
  const double calm_error = std::min(kCalmError * std::sqrt(std::max(ratio, 1.0)), kMaxCalmError);
  const UpdateLimits limits{least, std::max(least, kMaxCalmUpdates), 0.0, calm_error, kCalmRays};
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
