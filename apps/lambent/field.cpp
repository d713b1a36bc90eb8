// SPDX-License-Identifier: Apache-2.0
// lambent field: prints the contents of a field's file, for people and for other programs.
#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "field/file/field_file.h"
#include "lambent/command_files.h"
#include "lambent/commands.h"
#include "lambent/console.h"
#include "lambent/field_options.h"
#include "lambent/help.h"
#include "lambent/image.h"
#include "lambent/input.h"
#include "lambent/output.h"
#include "lambent/validators.h"
#include "lambent/words.h"

namespace lambent::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kDistanceFormatNames[] = {"rg16f", "rg32f"};
constexpr const char* kIrradianceEnding = ".irradiance.exr";
constexpr const char* kDistanceEnding = ".distance.exr";
constexpr std::array kStates = {"off",   "sleeping",       "newly_awake",
                                "awake", "newly_vigilant", "vigilant"};

/// Summary of a volume's probes.
struct Summary {
  std::array<int, kStates.size()> states{};
  double samples = 0.0;        // mean per probe
  glm::dvec3 irradiance{0.0};  // mean over probes and directions [W/m^2]
  int relocated = 0;           // off the grid
};

Summary summarize(const FieldVolume& volume) {
  Summary summary;
  const ProbeStore store = volume.store();
  const int n = volume.irradiance_texels;
  for (int probe = 0; probe < store.probes(); ++probe) {
    const ProbeStatus& record = volume.records[probe];
    ++summary.states[static_cast<std::size_t>(record.state)];
    summary.samples += record.samples;
    if (volume.offsets[probe] != 0) ++summary.relocated;
    for (int t = 0; t < n * n; ++t) {
      summary.irradiance += glm::dvec3(store.irradiance_texel(probe, ivec2(t % n, t / n) + 1));
    }
  }
  summary.samples /= store.probes();
  summary.irradiance /= static_cast<double>(store.probes()) * n * n;
  return summary;
}

Json array_of(const glm::vec3& v) {
  return Json::array({v.x, v.y, v.z});
}

Json json_of(const FieldFile& field) {
  Json json;
  json["version"] = kFieldFileVersion;
  json["updates"] = field.updates;
  json["scene_triangles"] = field.scene.triangles;
  json["scene_vertices"] = field.scene.vertices;
  json["scene_instances"] = field.scene.instances;
  json["volumes"] = field.volumes.size();
  for (const FieldVolume& volume : field.volumes) {
    const Summary summary = summarize(volume);
    const ProbeGrid& grid = volume.grid;
    json["probes"].push_back(probe_count(grid));
    json["probe_counts"].push_back(Json::array({grid.count.x, grid.count.y, grid.count.z}));
    json["origins_m"].push_back(array_of(grid.origin_ws));
    json["spacings_m"].push_back(array_of(grid.spacing));
    json["axes"].push_back(
        Json::array({array_of(grid.axes[0]), array_of(grid.axes[1]), array_of(grid.axes[2])}));
    json["scroll_volumes"].push_back(volume.role.follows_viewer);
    json["irradiance_formats"].push_back(name_of(volume.irradiance_format));
    json["distance_formats"].push_back(
        kDistanceFormatNames[static_cast<int>(volume.distance_format)]);
    json["irradiance_texels"].push_back(volume.irradiance_texels);
    json["distance_texels"].push_back(volume.distance_texels);
    json["mean_samples"].push_back(summary.samples);
    json["mean_irradiances"].push_back(array_of(summary.irradiance));
    json["probes_relocated"].push_back(summary.relocated);
    for (std::size_t s = 0; s < kStates.size(); ++s) {
      json[std::string("probes_") + kStates[s]].push_back(summary.states[s]);
    }
  }
  return json;
}

void print_volume(const FieldVolume& volume) {
  const Summary summary = summarize(volume);
  const ProbeGrid& grid = volume.grid;
  const vec3 far = probe_position(grid, grid.count - 1);
  std::printf("probes       %d: %d x %d x %d, %g x %g x %g m apart, %d moved off the grid\n",
              probe_count(grid), grid.count.x, grid.count.y, grid.count.z, grid.spacing.x,
              grid.spacing.y, grid.spacing.z, summary.relocated);
  std::printf("place        %g %g %g to %g %g %g m\n", grid.origin_ws.x, grid.origin_ws.y,
              grid.origin_ws.z, far.x, far.y, far.z);
  if (volume.role.follows_viewer) std::printf("role         follows the viewer\n");
  std::printf("irradiance   %d x %d texels, %s; %.4g %.4g %.4g W/m^2 on average\n",
              volume.irradiance_texels, volume.irradiance_texels,
              name_of(volume.irradiance_format).c_str(), summary.irradiance.x, summary.irradiance.y,
              summary.irradiance.z);
  std::printf("distances    %d x %d texels, %s\n", volume.distance_texels, volume.distance_texels,
              kDistanceFormatNames[static_cast<int>(volume.distance_format)]);
  std::printf("samples      %.4g updates a probe on average\n", summary.samples);
  std::printf("states      ");
  const char* separator = " ";
  for (std::size_t s = 0; s < kStates.size(); ++s) {
    if (summary.states[s] == 0) continue;
    std::printf("%s%d %s", separator, summary.states[s], kStates[s]);
    separator = ", ";
  }
  std::printf("\n");
}

Expected<void> info(const std::string& path, bool as_json) {
  if (const auto fine = check_field_input(path); !fine) return fine;
  const Expected<FieldFile> field = read_field_file(path);
  if (!field) return tl::unexpected(field.error());
  if (as_json) {
    std::printf("%s\n", json_of(*field).dump(2).c_str());
    return {};
  }
  std::printf("updates      %u\n", field->updates);
  std::printf("scene        %llu triangles in %u instances\n",
              static_cast<unsigned long long>(field->scene.triangles), field->scene.instances);
  for (const FieldVolume& volume : field->volumes) print_volume(volume);
  return {};
}

/// Calls texel(x, y, probe, texel of the tile) for each pixel of an atlas of tiles with gutter:
/// count.x of them in a row, in the order of the probes.
template <class Texel>
void for_atlas(const FieldVolume& volume, int texels, Texel texel) {
  const int width = texels + 2;
  for (int probe = 0; probe < probe_count(volume.grid); ++probe) {
    const ivec2 corner = ivec2(probe % volume.grid.count.x, probe / volume.grid.count.x) * width;
    for (int t = 0; t < width * width; ++t) {
      const ivec2 within(t % width, t / width);
      texel(corner.x + within.x, corner.y + within.y, probe, within);
    }
  }
}

/// An image as large as a volume's atlas.
LayeredImage blank_atlas(const FieldVolume& volume, int texels) {
  const ivec3 count = volume.grid.count;
  return {count.x * (texels + 2), count.y * count.z * (texels + 2), {}};
}

Expected<void> export_volume(const FieldVolume& volume, const std::string& prefix) {
  const ProbeStore store = volume.store();
  LayeredImage irradiance = blank_atlas(volume, volume.irradiance_texels);
  Image& light = irradiance.require("", 3);
  for_atlas(volume, volume.irradiance_texels, [&](int x, int y, int probe, ivec2 texel) {
    const vec3 value = store.irradiance_texel(probe, texel);
    for (int c = 0; c < 3; ++c) light.at(x, y)[c] = value[c];
  });
  if (auto done = write_exr(prefix + kIrradianceEnding, irradiance); !done) return done;
  tell_written(prefix + kIrradianceEnding, pixels_text(irradiance.width, irradiance.height));

  LayeredImage distance = blank_atlas(volume, volume.distance_texels);
  distance.require("", 1);
  Image& squares = distance.require("mean_square", 1);
  Image& means = *distance.find("");
  for_atlas(volume, volume.distance_texels, [&](int x, int y, int probe, ivec2 texel) {
    const vec2 moments = store.moments_texel(probe, texel);
    *means.at(x, y) = moments.x;
    *squares.at(x, y) = moments.y;
  });
  if (auto done = write_exr(prefix + kDistanceEnding, distance); !done) return done;
  tell_written(prefix + kDistanceEnding, pixels_text(distance.width, distance.height));
  return {};
}

Expected<void> export_atlases(const std::string& path, const std::string& prefix) {
  if (const auto fine = check_place(prefix + kIrradianceEnding); !fine) return fine;
  if (const auto fine = check_field_input(path); !fine) return fine;
  const Expected<FieldFile> field = read_field_file(path);
  if (!field) return tl::unexpected(field.error());
  const auto prefix_of = [&](std::size_t i) {
    return field->volumes.size() == 1 ? prefix : prefix + "." + std::to_string(i);
  };
  CommandFiles files;
  files.reads(path, "the field");
  for (std::size_t i = 0; i < field->volumes.size(); ++i) {
    files.writes(prefix_of(i) + kIrradianceEnding, "-o");
    files.writes(prefix_of(i) + kDistanceEnding, "-o");
  }
  if (const auto distinct = files.check(); !distinct) return distinct;
  for (std::size_t i = 0; i < field->volumes.size(); ++i) {
    if (auto made = make_folders(prefix_of(i) + kIrradianceEnding); !made) return made;
    if (auto done = export_volume(field->volumes[i], prefix_of(i)); !done) return done;
  }
  return {};
}

}  // namespace

void add_field(CLI::App& app, Run& run) {
  CLI::App* command = app.add_subcommand("field", "Look into a field file, or export it");
  command->group(kFieldGroup);
  command->require_subcommand(1);

  struct Options {
    std::string file, prefix;
    bool json = false;
  };
  const auto o = std::make_shared<Options>();
  CLI::App* print = command->add_subcommand("info", "Print what a field file holds");
  print->add_option("FILE", o->file, "Field file, of lambent bake")->required();
  print->add_flag("--json", o->json, "One flat JSON object");
  print->callback([o, &run] { run = [o] { return info(o->file, o->json); }; });

  CLI::App* atlases = command->add_subcommand("export", "Write the atlases of a field as .exr");
  atlases->add_option("FILE", o->file, "Field file, of lambent bake")->required();
  atlases
      ->add_option("-o,--output", o->prefix,
                   "Write this and .irradiance.exr, and this and .distance.exr")
      ->required()
      ->check(file_name())
      ->type_name("PREFIX");
  atlases->callback([o, &run] { run = [o] { return export_atlases(o->file, o->prefix); }; });
}

}  // namespace lambent::cli
