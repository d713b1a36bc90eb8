// SPDX-License-Identifier: Apache-2.0
#include "lambent/render_rsm.h"

#include <CLI/CLI.hpp>
#include <limits>
#include <map>
#include <utility>

#include "lambent/validators.h"

namespace lambent::cli {
namespace {

const std::map<std::string, RsmPattern> kPatterns = {{"whole", RsmPattern::whole},
                                                     {"disk", RsmPattern::disk}};
const std::map<std::string, RsmLayout> kLayouts = {{"restructured", RsmLayout::restructured},
                                                   {"sub-maps", RsmLayout::sub_maps},
                                                   {"full", RsmLayout::full}};

// Any finite float: the library checks the ranges.
constexpr double kAnyNumber = std::numeric_limits<float>::max();

/// The options that correspond to settings of the library. plane_tolerance has no option.
constexpr std::pair<const char*, const char*> kOptionsOfRsmSettings[] = {
    {"resolution", "--rsm-size"},      {"texels", "--rsm-texels"},
    {"sub_maps", "--sub-maps"},        {"sub_images", "--sub-images"},
    {"disk_radius", "--rsm-radius"},   {"softening", "--rsm-softening"},
    {"sub_blur_radius", "--sub-blur"}, {"visibility_rays", "--rsm-visibility"},
    {"downscale", "--rsm-downscale"},  {"direct_lights", "--rsm-direct-lights"}};

/// Converts an error of the library to one about the option that the user typed.
Error in_options(Error error) {
  for (const auto& [setting, option] : kOptionsOfRsmSettings) {
    if (error.place != setting) continue;
    error.place = option;
    break;
  }
  return error;
}

/// Fails on options that are valid individually, but not together, as the library's check does, but
/// with the names of options.
Expected<void> check_together(const RsmSettings& s) {
  if (s.sub_maps > 0 && s.sub_images % s.sub_maps != 0) {
    return fail("--sub-images", "",
                std::to_string(s.sub_images) + " is not a multiple of --sub-maps " +
                    std::to_string(s.sub_maps) + ": some light would reach no pixel");
  }
  if (s.merge_maps && s.texels == 0) {
    return fail("--rsm-merge-maps", "", "does not go with --rsm-texels 0");
  }
  if (s.direct && s.from_camera) {
    return fail("--rsm-direct", "", "does not go with --rsm-from-camera: no light has a map");
  }
  if (s.direct_lights > 0 && !s.direct) {
    return fail("--rsm-direct-lights", "", "goes with --rsm-direct alone");
  }
  if (s.pattern != RsmPattern::disk) return {};
  if (s.merge_maps) return fail("--rsm-merge-maps", "", "goes with --rsm-pattern whole alone");
  if (s.texels == 0) return fail("--rsm-texels", "", "0 does not go with --rsm-pattern disk");
  if (s.visibility_rays > 0) {
    return fail("--rsm-visibility", "", "goes with --rsm-pattern whole alone");
  }
  return {};
}

/// A copy of a scene with directional, point and spot lights as the only light.
Scene without_other_light(Scene scene) {
  scene.environment = {};
  for (Material& material : scene.materials) {
    material.emission = glm::vec3(0.0f);
    if (!material.unlit) continue;
    // Unlit surfaces emit, so make them black
    material.unlit = false;
    material.lambert = true;
    material.base_color = glm::vec4(glm::vec3(0.0f), material.base_color.a);
  }
  return scene;
}

}  // namespace

void add_rsm_options(CLI::App& command, RsmOptions& o) {
  command.option_defaults()->group("Reflective shadow maps, for --method rsm and rsm+field");
  const std::size_t others = command.get_options().size();
  RsmSettings& s = o.settings;
  // The library checks ranges; here a value must only be a number
  const auto count = [&command](const char* name, int& value, const char* what) {
    command.add_option(name, value, what)
        ->check(whole_number())
        ->capture_default_str()
        ->type_name("N");
  };
  const auto length = [&command](const char* name, float& value, const char* what) {
    return command.add_option(name, value, what)
        ->check(number(-kAnyNumber, kAnyNumber))
        ->capture_default_str()
        ->type_name("R");
  };
  count("--rsm-size", s.resolution, "Texels along an edge of each light's map, 1 to 4096");
  count("--rsm-texels", s.texels, "Lights that each map becomes, 1 to 65536; 0: all its texels");
  count("--sub-images", s.sub_images, "Along an edge of the picture, 1 to 16");
  count("--sub-maps", s.sub_maps, "Along an edge of the maps, 1 to 16");
  command.add_option("--rsm-pattern", o.pattern, "whole or disk")
      ->check(one_of({"whole", "disk"}))
      ->capture_default_str()
      ->type_name("P");
  command.add_option("--rsm-layout", o.layout, "restructured, sub-maps or full")
      ->check(one_of({"restructured", "sub-maps", "full"}))
      ->capture_default_str()
      ->type_name("L");
  o.radius =
      length("--rsm-radius", s.disk_radius, "Of the disk, in edges of the map, above 0 to 2");
  length("--rsm-softening", s.softening, "Times a texel's area that its light is spread over");
  count("--sub-blur", s.sub_blur_radius, "Radius of the blur in sub-images, 0 to 4");
  command.add_flag("--irregular-blur", s.irregular_blur, "Repeat that blur with irregular taps");
  command.add_flag("--no-final-blur", o.no_final_blur, "Leave out the blur of the picture");
  command.add_flag("--no-shuffle", o.no_shuffle, "Deal texels to sub-maps in order");
  command.add_flag("--no-view-importance", o.no_view_importance,
                   "Choose lights by their power alone");
  count("--rsm-visibility", s.visibility_rays, "Shadow rays a pixel and light, 0 to 64");
  count("--rsm-downscale", s.downscale, "Gather at 1/N of width and height, 1 to 16");
  command.add_flag("--rsm-from-camera", s.from_camera, "One map, seen from the camera");
  command.add_flag("--rsm-merge-maps", s.merge_maps,
                   "Share --rsm-texels among the maps of all lights");
  command.add_flag("--rsm-direct", s.direct, "Ask lights in the sub-images, once a pixel");
  count("--rsm-direct-lights", s.direct_lights,
        "Lights that a pixel then asks, up to 65536; 0: all");
  const std::vector<CLI::Option*> all = command.get_options();
  o.options.assign(all.begin() + static_cast<std::ptrdiff_t>(others), all.end());
}

bool uses_rsm(const std::string& method) {
  return method == "rsm" || method == "rsm+field";
}

Expected<RsmSettings> rsm_settings(const RsmOptions& options, const std::string& method,
                                   std::uint32_t seed) {
  if (!uses_rsm(method)) {
    for (const CLI::Option* option : options.options) {
      if (option->count() == 0) continue;
      return fail(option->get_name(), "", "goes with --method rsm and rsm+field alone");
    }
  }
  if (options.radius->count() > 0 && kPatterns.at(options.pattern) != RsmPattern::disk) {
    return fail("--rsm-radius", "", "goes with --rsm-pattern disk alone");
  }
  RsmSettings settings = options.settings;
  settings.pattern = kPatterns.at(options.pattern);
  settings.layout = kLayouts.at(options.layout);
  settings.final_blur = !options.no_final_blur;
  settings.shuffle = !options.no_shuffle;
  settings.view_importance = !options.no_view_importance;
  settings.seed = seed;
  if (settings.from_camera && method == "rsm+field") {
    return fail("--rsm-from-camera", "",
                "goes with --method rsm alone: its light is not of lights without extent alone");
  }
  if (const auto fine = check_together(settings); !fine) return tl::unexpected(fine.error());
  if (const auto fine = check(settings); !fine) return tl::unexpected(in_options(fine.error()));
  return settings;
}

Expected<void> check_rsm_use(const RsmOptions& options, const std::string& method, int bounces,
                             int gather_rays, bool converge) {
  constexpr std::uint32_t kAnySeed = 1;
  const auto settings = rsm_settings(options, method, kAnySeed);
  if (!settings) return tl::unexpected(settings.error());
  if (!uses_rsm(method)) return {};
  if (gather_rays > 0) return fail("--gather", "", "goes with --method field alone");
  if (converge) return fail("--converge", "", "goes with --method field alone");
  if (method == "rsm" && bounces >= 0 && bounces != 1) {
    return fail("--bounces", "", "--method rsm has one");
  }
  if (method == "rsm+field" && bounces == 0) {
    return fail("--bounces", "", "--method rsm+field has at least one");
  }
  return {};
}

std::string slow_gather(const RsmSettings& settings, std::size_t lights) {
  // As many as for sixteen lights by default
  constexpr std::size_t kMany = 16384;
  const auto texels = static_cast<std::size_t>(settings.texels);
  if (settings.from_camera || settings.merge_maps || lights * texels <= kMany) return {};
  const std::string each = std::to_string(texels);
  return "the maps of " + std::to_string(lights) + " lights have " +
         std::to_string(lights * texels) + " texels to gather, " + each +
         " each; --rsm-merge-maps has " + each +
         " for all, and a smaller --rsm-size is faster, too";
}

FirstBounce::FirstBounce(const Scene& scene) : scene_(without_other_light(scene)), world_(scene_) {}

FieldSettings FirstBounce::settings(FieldSettings settings) {
  settings.max_bounces = 1;
  return settings;
}

}  // namespace lambent::cli
