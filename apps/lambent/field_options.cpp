// SPDX-License-Identifier: Apache-2.0
#include "lambent/field_options.h"

#include <CLI/CLI.hpp>
#include <map>
#include <nlohmann/json.hpp>

#include "lambent/parse.h"

namespace lambent::cli {
namespace {

// Light is called settled when an update changes the field by less than this share of it ...
constexpr double kSettledChange = 0.002;
// ... or after so many updates.
constexpr int kMaxSettleUpdates = 256;

const std::map<std::string, IrradianceFormat> kIrradianceFormats = {
    {"rgb9e5", IrradianceFormat::rgb9e5},
    {"r11g11b10f", IrradianceFormat::r11g11b10f},
    {"float32", IrradianceFormat::float32}};
const std::map<std::string, DistanceFormat> kDistanceFormats = {{"rg16f", DistanceFormat::rg16f},
                                                                {"rg32f", DistanceFormat::rg32f}};

const std::map<std::string, Visibility> kVisibilities = {
    {"moments", Visibility::moments}, {"hybrid", Visibility::hybrid}, {"exact", Visibility::exact}};

FieldProgress run_updates(const World& world, int most, bool until_settled,
                          const UpdateRequest& request, IrradianceField& field,
                          const ProgressFn& progress, nlohmann::ordered_json& stats) {
  FieldProgress reached;
  UpdateStatistics last, sum;
  while (reached.updates < most && !(until_settled && reached.settled)) {
    last = field.update(world, request);
    ++reached.updates;
    reached.settled = last.change < kSettledChange;
    sum.place_ms += last.place_ms;
    sum.edits_ms += last.edits_ms;
    sum.trace_ms += last.trace_ms;
    sum.shade_ms += last.shade_ms;
    sum.solve_ms += last.solve_ms;
    sum.blend_ms += last.blend_ms;
    sum.probe_rays += last.probe_rays;
    sum.shadow_rays += last.shadow_rays;
    sum.probes_traced += last.probes_traced;
    sum.probes_invalidated += last.probes_invalidated;
    sum.probes_changed += last.probes_changed;
    sum.probes_recycled += last.probes_recycled;
    if (progress) progress("field", static_cast<double>(reached.updates) / most);
  }
  reached.change = last.change;
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
  stats["place_ms"] = sum.place_ms;
  stats["edits_ms"] = sum.edits_ms;
  stats["trace_ms"] = sum.trace_ms;
  stats["shade_ms"] = sum.shade_ms;
  stats["solve_ms"] = sum.solve_ms;
  stats["blend_ms"] = sum.blend_ms;
  return reached;
}

}  // namespace

void add_field_options(CLI::App& command, FieldOptions& o) {
  o.of_shape.push_back(command.add_option("--probes", o.probes, "Probes along each axis, XxYxZ"));
  o.of_shape.push_back(
      command
          .add_option("--probe-spacing", o.settings.probe_spacing, "Distance between probes [m]")
          ->check([](const std::string& text) {
            float spacing = 0.0f;
            const bool fine = CLI::detail::lexical_cast(text, spacing) && spacing > 0.0f;
            return fine ? std::string() : "'" + text + "' is not a number above 0";
          }));
  o.of_shape.push_back(
      command.add_option("--bounds", o.bounds, "Box of the probes, x0,y0,z0,x1,y1,z1 [m]"));
  o.of_shape.push_back(command
                           .add_option("--cascades", o.settings.cascades,
                                       "Nested volumes around the camera, in place of one box")
                           ->check(CLI::Range(0, 16)));
  o.of_shape.push_back(
      command
          .add_option("--volume", o.volumes,
                      "Another volume: a box, then any of :spacing=M :probes=XxYxZ :turn=DEGREES "
                      ":priority=N")
          ->allow_extra_args(false)
          ->take_all());
  command.add_option("--rays", o.settings.rays_per_probe, "Rays a probe and update")
      ->check(CLI::Range(16, 4096))
      ->capture_default_str();
  command
      .add_option("--hysteresis", o.settings.hysteresis, "Share of the old light an update keeps")
      ->check(CLI::Range(0.0f, 0.999f))
      ->capture_default_str();
  o.of_shape.push_back(
      command
          .add_option("--irradiance-format", o.irradiance_format, "rgb9e5, r11g11b10f or float32")
          ->check(CLI::IsMember(kIrradianceFormats))
          ->capture_default_str());
  o.of_shape.push_back(command.add_option("--distance-format", o.distance_format, "rg16f or rg32f")
                           ->check(CLI::IsMember(kDistanceFormats))
                           ->capture_default_str());
  o.of_shape.push_back(
      command
          .add_option("--irradiance-texels", o.settings.irradiance_texels, "Of a tile's edge, even")
          ->check(CLI::Range(2, 16))
          ->capture_default_str());
  o.of_shape.push_back(
      command.add_option("--distance-texels", o.settings.distance_texels, "Of a tile's edge")
          ->check(CLI::Range(4, 32))
          ->capture_default_str());
  o.of_shape.push_back(
      command.add_flag("!--no-relocation", o.settings.relocation, "Keep the probes on the grid"));
  command.add_option("--visibility", o.settings.visibility, "Of probes: moments, hybrid or exact")
      ->transform(CLI::CheckedTransformer(kVisibilities))
      ->default_str("moments");
}

Expected<FieldSettings> field_settings(const FieldOptions& options, const Scene& scene,
                                       std::uint32_t seed, int bounces) {
  FieldSettings settings = options.settings;
  settings.seed = seed;
  settings.max_bounces = bounces;
  settings.irradiance_format = kIrradianceFormats.at(options.irradiance_format);
  settings.distance_format = kDistanceFormats.at(options.distance_format);
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

FieldProgress update_field(const World& world, int updates, const UpdateRequest& request,
                           IrradianceField& field, const ProgressFn& progress,
                           nlohmann::ordered_json& stats) {
  return run_updates(world, updates, false, request, field, progress, stats);
}

FieldProgress settle_field(const World& world, const UpdateRequest& request, IrradianceField& field,
                           const ProgressFn& progress, nlohmann::ordered_json& stats) {
  return run_updates(world, kMaxSettleUpdates, true, request, field, progress, stats);
}

}  // namespace lambent::cli
