// SPDX-License-Identifier: Apache-2.0
#include "lambent/scene_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/gtc/constants.hpp>

#include "lambent/console.h"
#include "lambent/first_picture.h"
#include "lambent/fog_option.h"
#include "lambent/input.h"
#include "lambent/parse.h"
#include "lambent/validators.h"
#include "lambent/words.h"
#include "lambent/world.h"
#include "scene/validate.h"

namespace lambent::cli {
namespace {

constexpr float kDefaultFov = 45.0f;  // vertical [degrees]
// Range of fields of view [degrees], beyond which nothing is recognisable.
constexpr float kSmallestFov = 1.0f, kLargestFov = 170.0f;
// Significant digits of the places of a view that was chosen: the first number where the eye is as
// far from the origin as from what it sees; floats have no more than the second.
constexpr int kDigitsOfView = 5, kMostDigits = 9;

Expected<Camera> named_camera(const std::string& wanted, const Scene& scene) {
  std::vector<std::string> names;
  for (const Camera& known : scene.cameras) names.push_back(known.name);
  if (const auto index = index_of(wanted, names)) return scene.cameras[*index];
  return fail("--camera", "", no_such("camera", wanted, names));
}

/// Index of the scene's first camera that sees any of its surfaces; -1: none does. Where something
/// moves, the first one, which may see something later.
int camera_that_shows(const World& world, float aspect) {
  const Scene& scene = world.scene();
  if (!scene.cameras.empty() && !scene.animations.empty()) return 0;
  for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
    if (sees_a_surface(world, scene.cameras[i], aspect)) return static_cast<int>(i);
  }
  return -1;
}

Expected<Camera> with_asked_fov(const SceneOptions& options, Camera camera) {
  if (!options.fov_degrees) return camera;
  if (camera.orthographic) return fail("--fov", "", "an orthographic camera has none");
  camera.vertical_fov = glm::radians(*options.fov_degrees);
  return camera;
}

}  // namespace

void add_material_options(CLI::App& command, SceneOptions& o) {
  command
      .add_option("--materials", o.materials, "gltf, or lambert: exact Lambert, nothing specular")
      ->check(one_of({"gltf", "lambert"}))
      ->capture_default_str()
      ->type_name("M");
  command.add_flag("--no-normal-maps", o.no_normal_maps, "Ignore normal maps");
}

void add_scene_options(CLI::App& command, SceneOptions& o) {
  command.add_option("SCENE", o.file, "A .gltf or .glb file, or the name of a built-in scene")
      ->required();
  command.option_defaults()->group("What is there, in which light");
  add_light_options(command, o.light);
  add_material_options(command, o);
}

void add_scene_and_view_options(CLI::App& command, SceneOptions& o) {
  add_scene_options(command, o);
  add_fog_option(command, o.fog);
  command.option_defaults()->group("Where to look from");
  command
      .add_option("--camera", o.camera,
                  "Camera of the scene, by index or name (its first that sees any of it, else one "
                  "that shows it)")
      ->type_name("C");
  command.add_option("--eye", o.eye, "Look from here [m]; needs --target")->type_name("X,Y,Z");
  command.add_option("--target", o.target, "Look at this point [m]")->type_name("X,Y,Z");
  command
      .add_option("--fov", o.fov_degrees,
                  "Vertical field of view [degrees], 1 to 170 (the camera's, or 45)")
      ->check(number(kSmallestFov, kLargestFov))
      ->type_name("DEG");
}

Expected<OpenedScene> open_lit_scene(const SceneOptions& options) {
  LoadOptions load;
  load.lambert = options.materials == "lambert";
  load.normal_maps = !options.no_normal_maps;
  Expected<Scene> loaded = open_scene_input(options.file, load);
  if (!loaded) return tl::unexpected(loaded.error());
  OpenedScene opened{std::move(*loaded), std::nullopt};
  Scene& scene = opened.scene;
  for (const std::string& warning : scene.source.warnings) {
    warn(warning);
  }
  if (triangle_count(scene) == 0) {
    return fail(options.file, "", "the scene has no triangles: there is nothing to render");
  }
  if (const auto done = add_asked_light(options.light, scene); !done) {
    return tl::unexpected(done.error());
  }
  const bool keeps_dome = options.keep_sky_dome || options.light.light == "none";
  if (!keeps_dome) opened.sky_dome = take_sky_dome(scene);
  if (options.no_fog) scene.fog.clear();
  if (options.fog.empty()) return opened;
  Expected<FogVolume> fog = parse_fog(options.fog, world_bounds(scene));
  if (!fog) return tl::unexpected(fog.error());
  scene.fog.push_back(std::move(*fog));
  if (const auto fine = validate_fog(scene); !fine) return tl::unexpected(fine.error());
  return opened;
}

Expected<Camera> camera_of_scene(const SceneOptions& options, const Scene& scene) {
  Expected<Camera> camera = options.camera.empty() ? Expected<Camera>(scene.cameras.front())
                                                   : named_camera(options.camera, scene);
  if (!camera) return camera;
  return with_asked_fov(options, std::move(*camera));
}

Expected<View> choose_view(const SceneOptions& options, const World& world, float aspect,
                           const Poses& poses) {
  const Scene& scene = world.scene();
  // Written so that NaN fails
  const float fov_degrees = options.fov_degrees.value_or(kDefaultFov);
  if (!(fov_degrees >= kSmallestFov && fov_degrees <= kLargestFov)) {
    return fail("--fov", "", "must be 1 to 170 degrees");
  }
  if (options.eye.empty() != options.target.empty()) {
    return fail(options.eye.empty() ? "--target" : "--eye", "", "--eye and --target go together");
  }
  std::optional<float> vertical_fov;
  if (options.fov_degrees) vertical_fov = glm::radians(*options.fov_degrees);
  if (!options.eye.empty()) {
    if (!options.camera.empty()) return fail("--camera", "", "give either --camera or --eye");
    const auto eye = parse_place("--eye", options.eye);
    if (!eye) return tl::unexpected(eye.error());
    const auto target = parse_place("--target", options.target);
    if (!target) return tl::unexpected(target.error());
    if (*eye == *target) return fail("--target", "", "is where --eye is");
    return View{look_at(*eye, *target, vertical_fov.value_or(glm::radians(kDefaultFov))),
                View::From::options};
  }
  const int showing = options.camera.empty() ? camera_that_shows(world, aspect) : -1;
  if (options.camera.empty() && showing < 0) {
    if (!scene.cameras.empty()) {
      warn(
          "No camera of the scene sees any of its surfaces, and another view was chosen "
          "(--camera 0 keeps the first).");
    }
    const Expected<FirstView> view = first_view(world, {vertical_fov, aspect}, poses);
    if (!view) return tl::unexpected(view.error());
    return View{view->camera, view->inside ? View::From::inside : View::From::outside,
                view->distance};
  }
  const Expected<Camera> camera = showing < 0 ? camera_of_scene(options, scene)
                                              : with_asked_fov(options, scene.cameras[showing]);
  if (!camera) return tl::unexpected(camera.error());
  return View{*camera, View::From::scene};
}

std::string describe(const View& view) {
  if (view.from == View::From::options) return "as asked";
  if (view.from == View::From::scene) {
    return view.camera.name.empty() ? "the scene's" : "the scene's '" + view.camera.name + "'";
  }
  const glm::vec3 eye(view.camera.world_from_view[3]);
  // The target is on what is shown, so that views around it begin from there. As far as the eye is
  // from the origin beside that, more digits are needed for the same direction
  const glm::vec3 target = eye - view.distance * glm::vec3(view.camera.world_from_view[2]);
  const float larger = std::max(glm::length(eye) / view.distance, 1.0f);
  const int digits =
      std::min(kDigitsOfView + static_cast<int>(std::ceil(std::log10(larger))), kMostDigits);
  char text[256];
  std::snprintf(text, sizeof text, "%s, as --eye=%.*g,%.*g,%.*g --target=%.*g,%.*g,%.*g --fov %.3g",
                view.from == View::From::inside ? "inside the scene" : "the whole object", digits,
                eye.x, digits, eye.y, digits, eye.z, digits, target.x, digits, target.y, digits,
                target.z, glm::degrees(view.camera.vertical_fov));
  return text;
}

}  // namespace lambent::cli
