// SPDX-License-Identifier: Apache-2.0
// lambent info: prints the contents of a scene.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <glm/gtc/constants.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "lambent/commands.h"
#include "lambent/help.h"
#include "lambent/input.h"
#include "lambent/scene.h"
#include "lambent/words.h"
#include "lambent/world.h"
#include "raytracing/solid_sides/find_solid_sides.h"
#include "scene/attributes.h"

namespace lambent::cli {
namespace {

constexpr double kBytesPerMebibyte = 1048576.0;

struct Totals {
  std::size_t vertices = 0;
  std::size_t mesh_triangles = 0;
  std::size_t triangles = 0;
  std::size_t emissive_triangles = 0;
  std::size_t texture_bytes = 0;
};

std::size_t bytes_of(const Texture& texture) {
  std::size_t bytes = 0;
  for (const TextureLevel& level : texture.levels) bytes += level.rgba.size();
  return bytes;
}

Totals total(const Scene& scene) {
  Totals totals;
  for (const Mesh& mesh : scene.meshes) {
    totals.vertices += mesh.positions.size();
    totals.mesh_triangles += mesh.triangles.size();
  }
  totals.triangles = triangle_count(scene);
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    if (may_emit(scene.materials[mesh.material]))
      totals.emissive_triangles += mesh.triangles.size();
  }
  for (const Texture& texture : scene.textures) totals.texture_bytes += bytes_of(texture);
  return totals;
}

std::string join(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : ", ") + printable(part);
  return text.empty() ? "none" : text;
}

#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
void row(const char* label, const char* format, ...) {
  std::printf("%-14s ", label);
  va_list arguments;
  va_start(arguments, format);
  std::vprintf(format, arguments);
  va_end(arguments);
  std::printf("\n");
}

std::string text_of(const glm::vec3& v) {
  char text[96];
  std::snprintf(text, sizeof text, "%.4g %.4g %.4g", v.x, v.y, v.z);
  return text;
}

const char* name_of(Light::Type type) {
  switch (type) {
    case Light::Type::directional:
      return "directional";
    case Light::Type::point:
      return "point";
    case Light::Type::spot:
      return "spot";
  }
  return "";
}

// A material's features beyond plain factors.
std::vector<std::string> features_of(const Material& m) {
  std::vector<std::string> features;
  const auto add = [&features](bool present, const char* name) {
    if (present) features.emplace_back(name);
  };
  add(m.base_color_texture.texture >= 0, "base color map");
  add(m.metallic_roughness_texture.texture >= 0, "metallic-roughness map");
  add(m.normal_texture.texture >= 0, "normal map");
  add(m.emission_texture.texture >= 0, "emission map");
  add(m.specular_texture.texture >= 0, "specular map");
  add(m.specular_color_texture.texture >= 0, "specular color map");
  add(m.transmission_texture.texture >= 0, "transmission map");
  add(m.clearcoat > 0.0f, "clearcoat");
  add(m.clearcoat_texture.texture >= 0, "clearcoat map");
  add(m.clearcoat_roughness_texture.texture >= 0, "clearcoat roughness map");
  add(m.clearcoat_normal_texture.texture >= 0, "clearcoat normal map");
  add(m.sheen_color != glm::vec3(0.0f), "sheen");
  add(m.sheen_color_texture.texture >= 0, "sheen color map");
  add(m.sheen_roughness_texture.texture >= 0, "sheen roughness map");
  add(may_emit(m) && !m.unlit, "emissive");
  add(m.alpha_mode == AlphaMode::mask, "alpha mask");
  add(m.alpha_mode == AlphaMode::blend, "alpha blend");
  add(is_transmissive(m) && !m.bounds_volume, "thin glass");
  add(is_transmissive(m) && m.bounds_volume, "refracting volume");
  add(m.double_sided, "double-sided");
  add(m.unlit, "unlit");
  add(m.lambert, "lambert");
  return features;
}

void print_materials(const Scene& scene) {
  const Material plain;  // only differences from the default material are listed
  row("materials", "%zu", scene.materials.size());
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    const Material& m = scene.materials[i];
    std::printf("  %3zu  %-24s color %s, metallic %.3g, roughness %.3g", i,
                printable(m.name).c_str(), text_of(m.base_color).c_str(), m.metallic, m.roughness);
    if (m.emission != glm::vec3(0.0f)) {
      std::printf(", emission %s W/(m2 sr)", text_of(m.emission).c_str());
    }
    if (m.ior != plain.ior) std::printf(", ior %.4g", m.ior);
    if (m.specular != plain.specular || m.specular_color != plain.specular_color) {
      std::printf(", specular %.3g times %s", m.specular, text_of(m.specular_color).c_str());
    }
    const auto features = features_of(m);
    if (!features.empty()) std::printf("; %s", join(features).c_str());
    std::printf("\n");
  }
}

void print_textures(const Scene& scene, const Totals& totals) {
  row("textures", "%zu, %.1f MiB with MIPs", scene.textures.size(),
      static_cast<double>(totals.texture_bytes) / kBytesPerMebibyte);
  for (std::size_t i = 0; i < scene.textures.size(); ++i) {
    const Texture& t = scene.textures[i];
    std::printf("  %3zu  %5d x %-5d %-6s %6.1f MiB  %s\n", i, t.levels[0].width, t.levels[0].height,
                t.srgb ? "sRGB" : "linear", static_cast<double>(bytes_of(t)) / kBytesPerMebibyte,
                printable(t.name).c_str());
  }
}

void print_lights(const Scene& scene, const Totals& totals) {
  row("lights", "%zu, and %zu emissive triangles", scene.lights.size(), totals.emissive_triangles);
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    const bool directional = light.type == Light::Type::directional;
    std::printf("  %3zu  %-24s %s %s %s", i, printable(light.name).c_str(), name_of(light.type),
                text_of(light.intensity).c_str(), directional ? "W/m2" : "W/sr");
    if (!directional) std::printf(", at %s m", text_of(light.position_ws).c_str());
    if (light.type != Light::Type::point) {
      std::printf(", travels %s", text_of(light.direction_ws).c_str());
    }
    if (light.type == Light::Type::spot) {
      std::printf(", cone %.1f to %.1f deg", glm::degrees(light.inner_cone_angle),
                  glm::degrees(light.outer_cone_angle));
    }
    if (light.range > 0.0f) std::printf(", range %.4g m", light.range);
    std::printf("\n");
  }
}

void print_cameras(const Scene& scene) {
  row("cameras", "%zu", scene.cameras.size());
  for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
    const Camera& camera = scene.cameras[i];
    std::printf("  %3zu  %-24s at %s m, ", i, printable(camera.name).c_str(),
                text_of(glm::vec3(camera.world_from_view[3])).c_str());
    if (camera.orthographic) {
      std::printf("orthographic, %.4g m high\n", camera.vertical_extent);
    } else {
      std::printf("vertical fov %.1f deg\n", glm::degrees(camera.vertical_fov));
    }
  }
}

/// Instances with a flag other than the default, by flag.
struct FlagCounts {
  std::size_t dynamic = 0, without_casting_gi = 0, without_receiving_gi = 0, ignored_by_probes = 0;
};

FlagCounts count_flags(const Scene& scene) {
  FlagCounts counts;
  for (const Instance& instance : scene.instances) {
    counts.dynamic += instance.dynamic;
    counts.without_casting_gi += !instance.casts_gi;
    counts.without_receiving_gi += !instance.receives_gi;
    counts.ignored_by_probes += instance.ignored_by_probes;
  }
  return counts;
}

void print_flags(const Scene& scene) {
  const FlagCounts counts = count_flags(scene);
  const auto line = [](std::size_t count, const char* what) {
    if (count > 0) std::printf("  %zu %s\n", count, what);
  };
  line(counts.dynamic, "move");
  line(counts.without_casting_gi, "cast no GI");
  line(counts.without_receiving_gi, "receive no GI");
  line(counts.ignored_by_probes, "are ignored by probes");
}

void print_animations(const Scene& scene) {
  row("animations", "%zu", scene.animations.size());
  for (std::size_t i = 0; i < scene.animations.size(); ++i) {
    const Animation& animation = scene.animations[i];
    std::printf("  %3zu  %-24s %.4g s, %zu channels\n", i, printable(animation.name).c_str(),
                duration(animation), animation.channels.size());
  }
}

/// The meshes whose triangles face away from open space.
std::vector<MiswoundMesh> find_miswound(const Scene& scene) {
  if (scene.instances.empty()) return {};
  const World world(scene);
  return miswound_meshes(scene, find_solid_sides(world, {}));
}

void print_winding(const Scene& scene) {
  const std::vector<MiswoundMesh> miswound = find_miswound(scene);
  row("winding", "%zu meshes face solid matter, in whole or in part", miswound.size());
  for (const MiswoundMesh& found : miswound) {
    const Mesh& mesh = scene.meshes[found.mesh];
    std::printf("  %3d  %-24s %zu of %zu triangles\n", found.mesh, printable(mesh.name).c_str(),
                found.triangles, mesh.triangles.size());
  }
}

void print_human(const Scene& scene, const std::string& name) {
  const Totals totals = total(scene);
  const SceneSource& source = scene.source;
  row("scene", "%s", name.c_str());
  if (!source.generator.empty()) row("generator", "%s", printable(source.generator).c_str());
  row("extensions", "%s", join(source.extensions).c_str());
  row("meshes", "%zu (%zu triangles, %zu vertices)", scene.meshes.size(), totals.mesh_triangles,
      totals.vertices);
  row("instances", "%zu (%zu triangles)", scene.instances.size(), totals.triangles);
  print_flags(scene);
  print_materials(scene);
  print_textures(scene, totals);
  print_lights(scene, totals);
  print_cameras(scene);
  print_animations(scene);
  const Bounds bounds = world_bounds(scene);
  if (bounds.empty()) {
    row("bounds", "empty");
  } else {
    row("bounds", "%s to %s m", text_of(bounds.min).c_str(), text_of(bounds.max).c_str());
  }
  const glm::dvec3& origin = source.origin;
  if (origin != glm::dvec3(0.0)) {
    row("origin", "%.10g %.10g %.10g m in the file's coordinates", origin.x, origin.y, origin.z);
  }
  const Image& map = scene.environment.map;
  if (map.empty()) {
    row("environment", "%s W/(m2 sr)", text_of(scene.environment.radiance).c_str());
  } else {
    row("environment", "map of %d x %d, times %s", map.width, map.height,
        text_of(scene.environment.radiance).c_str());
  }
  print_winding(scene);
  row("file", "%d nodes, %d scenes, %d animations, %d skins, %d morph targets", source.nodes,
      source.scenes, source.animations, source.skins, source.morph_targets);
  row("warnings", "%zu", source.warnings.size());
  for (const std::string& warning : source.warnings) {
    std::printf("  %s\n", printable(warning).c_str());
  }
}

nlohmann::ordered_json list_of(const glm::vec3& v) {
  return {v.x, v.y, v.z};
}

// One flat object; lists of objects become parallel lists of their properties.
nlohmann::ordered_json json_of(const Scene& scene, const std::string& name) {
  const Totals totals = total(scene);
  const SceneSource& source = scene.source;
  nlohmann::ordered_json json;
  json["scene"] = name;
  json["generator"] = source.generator;
  json["extensions"] = source.extensions;
  json["meshes"] = scene.meshes.size();
  json["mesh_triangles"] = totals.mesh_triangles;
  json["vertices"] = totals.vertices;
  json["instances"] = scene.instances.size();
  json["triangles"] = totals.triangles;
  json["emissive_triangles"] = totals.emissive_triangles;
  json["materials"] = scene.materials.size();
  json["textures"] = scene.textures.size();
  json["texture_bytes"] = totals.texture_bytes;
  constexpr const char* kLists[] = {
      "light_names",      "light_types",  "light_intensities",  "light_positions_m",
      "light_directions", "camera_names", "camera_positions_m", "camera_vertical_fovs_rad"};
  json["lights"] = scene.lights.size();
  json["cameras"] = scene.cameras.size();
  for (const char* list : kLists) json[list] = nlohmann::ordered_json::array();
  for (const Light& light : scene.lights) {
    json["light_names"].push_back(light.name);
    json["light_types"].push_back(name_of(light.type));
    json["light_intensities"].push_back(list_of(light.intensity));
    json["light_positions_m"].push_back(list_of(light.position_ws));
    json["light_directions"].push_back(list_of(light.direction_ws));
  }
  for (const Camera& camera : scene.cameras) {
    json["camera_names"].push_back(camera.name);
    json["camera_positions_m"].push_back(list_of(glm::vec3(camera.world_from_view[3])));
    json["camera_vertical_fovs_rad"].push_back(camera.orthographic ? 0.0f : camera.vertical_fov);
  }
  const Bounds bounds = world_bounds(scene);
  json["bounds_min_m"] = bounds.empty() ? nlohmann::ordered_json() : list_of(bounds.min);
  json["bounds_max_m"] = bounds.empty() ? nlohmann::ordered_json() : list_of(bounds.max);
  json["origin_in_file_m"] = {source.origin.x, source.origin.y, source.origin.z};
  json["environment_radiance"] = list_of(scene.environment.radiance);
  json["environment_width_px"] = scene.environment.map.width;
  json["environment_height_px"] = scene.environment.map.height;
  json["nodes"] = source.nodes;
  json["scenes"] = source.scenes;
  json["animations"] = source.animations;
  json["skins"] = source.skins;
  json["morph_targets"] = source.morph_targets;
  const FlagCounts flags = count_flags(scene);
  json["instances_dynamic"] = flags.dynamic;
  json["instances_without_casting_gi"] = flags.without_casting_gi;
  json["instances_without_receiving_gi"] = flags.without_receiving_gi;
  json["instances_ignored_by_probes"] = flags.ignored_by_probes;
  for (const char* list : {"animation_names", "animation_durations_s", "animation_channels"}) {
    json[list] = nlohmann::ordered_json::array();
  }
  for (const Animation& animation : scene.animations) {
    json["animation_names"].push_back(animation.name);
    json["animation_durations_s"].push_back(duration(animation));
    json["animation_channels"].push_back(animation.channels.size());
  }
  for (const char* list : {"miswound_mesh_names", "miswound_mesh_triangles"}) {
    json[list] = nlohmann::ordered_json::array();
  }
  for (const MiswoundMesh& found : find_miswound(scene)) {
    json["miswound_mesh_names"].push_back(scene.meshes[found.mesh].name);
    json["miswound_mesh_triangles"].push_back(found.triangles);
  }
  json["warnings"] = source.warnings;
  return json;
}

struct InfoOptions {
  std::string scene;
  bool json = false;
};

Expected<void> info(const InfoOptions& options) {
  const Expected<Scene> scene = open_scene_input(options.scene);
  if (!scene) return tl::unexpected(scene.error());
  if (options.json) {
    // Names are UTF-8, but a path need not be
    const auto replace = nlohmann::ordered_json::error_handler_t::replace;
    std::printf("%s\n", json_of(*scene, options.scene).dump(2, ' ', false, replace).c_str());
  } else {
    print_human(*scene, options.scene);
  }
  return {};
}

}  // namespace

void add_info(CLI::App& app, Run& run) {
  auto options = std::make_shared<InfoOptions>();
  CLI::App* command = app.add_subcommand("info", "Print what was understood of a scene");
  command->group(kSceneGroup);
  command->add_option("SCENE", options->scene, "A .gltf or .glb file, or a built-in scene")
      ->required();
  command->add_flag("--json", options->json, "Print one flat JSON object");
  command->callback([options, &run] { run = [options] { return info(*options); }; });
}

}  // namespace lambent::cli
