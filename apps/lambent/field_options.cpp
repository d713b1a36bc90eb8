// SPDX-License-Identifier: Apache-2.0
#include "lambent/field_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cassert>
#include <map>
#include <utility>

#include "lambent/parse.h"
#include "lambent/validators.h"
#include "lambent/words.h"

namespace lambent::cli {
namespace {

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

}  // namespace lambent::cli
