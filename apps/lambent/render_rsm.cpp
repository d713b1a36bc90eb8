// SPDX-License-Identifier: Apache-2.0
#include "lambent/render_rsm.h"

#include <CLI/CLI.hpp>
#include <map>

namespace lambent::cli {
namespace {

const std::map<std::string, RsmPattern> kPatterns = {{"whole", RsmPattern::whole},
                                                     {"disk", RsmPattern::disk}};
const std::map<std::string, RsmLayout> kLayouts = {{"restructured", RsmLayout::restructured},
                                                   {"sub-maps", RsmLayout::sub_maps},
                                                   {"full", RsmLayout::full}};

/// A copy of a scene in which directional, point and spot lights alone shine.
Scene without_other_light(Scene scene) {
  scene.environment = {};
  for (Material& material : scene.materials) {
    material.emission = glm::vec3(0.0f);
    if (!material.unlit) continue;
    // Unlit surfaces emit their colour and reflect nothing
    material.unlit = false;
    material.lambert = true;
    material.base_color = glm::vec4(glm::vec3(0.0f), material.base_color.a);
  }
  return scene;
}

}  // namespace

void add_rsm_options(CLI::App& command, RsmOptions& o) {
  const std::size_t others = command.get_options().size();
  RsmSettings& s = o.settings;
  command.add_option("--rsm-size", s.resolution, "Texels along an edge of each light's map")
      ->capture_default_str();
  command.add_option("--rsm-texels", s.texels, "Lights that each map becomes (0: all its texels)")
      ->capture_default_str();
  command.add_option("--sub-images", s.sub_images, "Along an edge of the picture")
      ->capture_default_str();
  command.add_option("--sub-maps", s.sub_maps, "Along an edge of the maps")->capture_default_str();
  command.add_option("--rsm-pattern", o.pattern, "whole or disk")
      ->check(CLI::IsMember(kPatterns))
      ->capture_default_str();
  command.add_option("--rsm-layout", o.layout, "restructured, sub-maps or full")
      ->check(CLI::IsMember(kLayouts))
      ->capture_default_str();
  command.add_option("--rsm-radius", s.disk_radius, "Of the disk, in edges of the map")
      ->capture_default_str();
  command.add_option("--rsm-softening", s.softening, "Spreads texels' light")
      ->capture_default_str();
  command.add_option("--sub-blur", s.sub_blur_radius, "Radius of the blur in sub-images")
      ->capture_default_str();
  command.add_flag("--irregular-blur", s.irregular_blur, "Repeat that blur with irregular taps");
  command.add_flag("--no-final-blur", o.no_final_blur, "Leave out the blur of the picture");
  command.add_flag("--no-shuffle", o.no_shuffle, "Deal texels to sub-maps in order");
  command.add_flag("--no-view-importance", o.no_view_importance,
                   "Choose lights by their power alone");
  command.add_option("--rsm-visibility", s.visibility_rays, "Shadow rays a pixel and light")
      ->capture_default_str();
  command.add_option("--rsm-downscale", s.downscale, "Gather at 1/N of width and height")
      ->capture_default_str();
  command.add_flag("--rsm-from-camera", s.from_camera, "One map, seen from the camera");
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
  if (const Expected<void> fine = check(settings); !fine) return tl::unexpected(fine.error());
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

FirstBounce::FirstBounce(const Scene& scene) : scene_(without_other_light(scene)), world_(scene_) {}

FieldSettings FirstBounce::settings(FieldSettings settings) {
  settings.max_bounces = 1;
  return settings;
}

}  // namespace lambent::cli
