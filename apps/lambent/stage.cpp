// SPDX-License-Identifier: Apache-2.0
#include "lambent/stage.h"

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <glm/gtc/constants.hpp>

#include "lambent/parse.h"
#include "lambent/world.h"
#include "raytracing/raytracer.h"
#include "scene/attributes.h"
#include "scene/limits.h"
#include "scenes/builtin.h"

namespace lambent::cli {
namespace {

// A clear afternoon for scenes that bring no light: the sun from above one shoulder, and a blue
// sky.
constexpr glm::vec3 kDefaultSunDirection{-0.5f, -1.0f, -0.35f};
constexpr glm::vec3 kDefaultSunIrradiance{20.0f, 18.0f, 15.0f};
constexpr glm::vec3 kDefaultSky{1.5f, 2.0f, 2.6f};
constexpr float kDefaultFov = 45.0f;  // vertical [degrees]
// Narrower and wider views show nothing that people would recognize [degrees].
constexpr float kSmallestFov = 1.0f, kLargestFov = 170.0f;

// Length of --sun below which its direction would drown in rounding.
constexpr float kMinDirection = 1e-6f;

bool has_light(const Scene& scene) {
  if (!scene.lights.empty() || scene.environment.radiance != glm::vec3(0.0f)) return true;
  for (const Instance& instance : scene.instances) {
    if (may_emit(scene.materials[scene.meshes[instance.mesh].material])) return true;
  }
  return false;
}

bool are_within(const glm::vec3& color, float largest) {
  return glm::all(glm::greaterThanEqual(color, glm::vec3(0.0f))) &&
         glm::all(glm::lessThanEqual(color, glm::vec3(largest)));
}

Light make_sun(const glm::vec3& direction, const glm::vec3& irradiance) {
  Light sun;
  sun.name = "sun";
  sun.type = Light::Type::directional;
  // In double, where no vector of floats is too long for its square
  sun.direction_ws = glm::vec3(glm::normalize(glm::dvec3(direction)));
  sun.intensity = irradiance;
  return sun;
}

Expected<void> add_sun(const StageOptions& options, Scene& scene) {
  if (options.sun.empty()) {
    if (!options.sun_irradiance.empty()) return fail("--sun-irradiance", "", "needs --sun");
    return {};
  }
  const auto direction = parse_vec3("--sun", options.sun);
  if (!direction) return tl::unexpected(direction.error());
  if (glm::length(glm::dvec3(*direction)) < kMinDirection)
    return fail("--sun", "", "the direction has no length");
  glm::vec3 irradiance = kDefaultSunIrradiance;
  if (!options.sun_irradiance.empty()) {
    const auto given = parse_vec3("--sun-irradiance", options.sun_irradiance);
    if (!given) return tl::unexpected(given.error());
    irradiance = *given;
  }
  if (!are_within(irradiance, kMaxIrradiance)) {
    return fail("--sun-irradiance", "", "must be 0 to 1e10 W/m^2");
  }
  scene.lights.push_back(make_sun(*direction, irradiance));
  return {};
}

Expected<void> set_sky(const StageOptions& options, Scene& scene) {
  if (!options.environment.empty()) {
    Expected<Environment> environment = load_environment(options.environment);
    if (!environment) return tl::unexpected(environment.error());
    scene.environment = std::move(*environment);
  }
  if (options.sky.empty()) return {};
  if (!options.environment.empty()) return fail("--sky", "", "give either --sky or --environment");
  const auto sky = parse_vec3("--sky", options.sky);
  if (!sky) return tl::unexpected(sky.error());
  if (!are_within(*sky, kMaxRadiance)) return fail("--sky", "", "must be 0 to 1e10 W/(m^2 sr)");
  scene.environment = {};
  scene.environment.radiance = *sky;
  return {};
}

/// Shows the whole scene from a little above, three quarters on.
Camera outside_camera(const Bounds& bounds, float vertical_fov) {
  const glm::vec3 center = 0.5f * (bounds.min + bounds.max);
  constexpr float kMinRadius = 1e-3f;                // of a scene of one point [m]
  const glm::vec3 three_quarters(0.6f, 0.4f, 1.0f);  // right, up and front of the object
  const float radius = std::max(0.5f * glm::length(bounds.max - bounds.min), kMinRadius);
  const float distance = radius / std::sin(0.5f * vertical_fov);
  return look_at(center + distance * glm::normalize(three_quarters), center, vertical_fov);
}

/// Stands near one end of a room, at eye height, and looks along its length.
Camera inside_camera(const World& world, const Bounds& bounds, float vertical_fov) {
  constexpr float kEyeHeight = 1.7f;      // [m]
  constexpr float kShareOfHeight = 0.4f;  // of low rooms, and of ones not in metres
  constexpr float kShareOfLength = 0.8f;  // of the way from the middle to the end
  const glm::vec3 center = 0.5f * (bounds.min + bounds.max);
  const glm::vec3 size = bounds.max - bounds.min;
  const glm::vec3 along =
      size.x >= size.z ? glm::vec3(1.0f, 0.0f, 0.0f) : glm::vec3(0.0f, 0.0f, 1.0f);

  const float drop = world.tracer().closest_hit({center, 0.0f, {0.0f, -1.0f, 0.0f}}).distance;
  glm::vec3 eye =
      center - glm::vec3(0.0f, drop - std::min(kEyeHeight, kShareOfHeight * size.y), 0.0f);
  const float room = world.tracer().closest_hit({eye, 0.0f, -along}).distance;
  eye -= along * kShareOfLength * std::min(room, glm::dot(along, size));
  return look_at(eye, eye + along, vertical_fov);
}

Camera fitted_camera(const World& world, float vertical_fov) {
  const Bounds bounds = world_bounds(world.scene());
  if (bounds.empty()) return look_at({0.0f, 0.0f, 1.0f}, glm::vec3(0.0f), vertical_fov);

  // A floor and four walls around the middle make a room; its ceiling may be open
  const glm::vec3 center = 0.5f * (bounds.min + bounds.max);
  for (const glm::vec3& way : {glm::vec3(1, 0, 0), glm::vec3(-1, 0, 0), glm::vec3(0, 0, 1),
                               glm::vec3(0, 0, -1), glm::vec3(0, -1, 0)}) {
    if (!world.tracer().occluded({center, 0.0f, way})) return outside_camera(bounds, vertical_fov);
  }
  return inside_camera(world, bounds, vertical_fov);
}

Expected<Camera> named_camera(const std::string& wanted, const Scene& scene) {
  for (const Camera& camera : scene.cameras) {
    if (camera.name == wanted) return camera;
  }
  std::size_t index = 0;
  const char* last = wanted.data() + wanted.size();
  const auto [stop, error] = std::from_chars(wanted.data(), last, index);
  if (error == std::errc() && stop == last && index < scene.cameras.size()) {
    return scene.cameras[index];
  }
  std::string known;
  for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
    known += (i == 0 ? "" : ", ") + std::to_string(i) + " " + scene.cameras[i].name;
  }
  return fail(
      "--camera", "",
      "no camera '" + wanted + "'; the scene has " + (known.empty() ? std::string("none") : known));
}

}  // namespace

void add_scene_options(CLI::App& command, StageOptions& o) {
  command.add_option("scene", o.scene, "A .gltf or .glb file, or the name of a built-in scene")
      ->required();
  command.add_option("--sun", o.sun, "Add a sun whose light travels along x,y,z");
  command.add_option("--sun-irradiance", o.sun_irradiance, "Of the sun, r,g,b [W/m^2]");
  command.add_option("--sky", o.sky, "Constant sky, r,g,b [W/(m^2 sr)]");
  command.add_option("--environment", o.environment, "Latitude-longitude sky, .hdr or .exr");
  command
      .add_option("--materials", o.materials, "gltf, or lambert: exact Lambert, nothing specular")
      ->check(CLI::IsMember({"gltf", "lambert"}))
      ->capture_default_str();
  command.add_flag("--no-normal-maps", o.no_normal_maps, "Ignore normal maps");
}

void add_stage_options(CLI::App& command, StageOptions& o) {
  add_scene_options(command, o);
  command.add_option("--camera", o.camera, "Camera of the scene, by index or name");
  command.add_option("--eye", o.eye, "Look from here, x,y,z [m]; needs --target");
  command.add_option("--target", o.target, "Look at this point, x,y,z [m]");
  command
      .add_option("--fov", o.fov_degrees, "Vertical field of view [degrees] (the camera's, or 45)")
      ->check(CLI::Range(kSmallestFov, kLargestFov));
}

Expected<Scene> open_stage(const StageOptions& options) {
  LoadOptions load;
  load.lambert = options.materials == "lambert";
  load.normal_maps = !options.no_normal_maps;
  Expected<Scene> scene = scenes::open_scene(options.scene, load);
  if (!scene) return scene;
  for (const std::string& warning : scene->source.warnings) {
    std::fprintf(stderr, "lambent: warning: %s\n", warning.c_str());
  }
  if (triangle_count(*scene) == 0) {
    return fail(options.scene, "", "the scene has no triangles: there is nothing to render");
  }
  if (const auto done = add_sun(options, *scene); !done) return tl::unexpected(done.error());
  if (const auto done = set_sky(options, *scene); !done) return tl::unexpected(done.error());

  const bool asked = !options.sun.empty() || !options.sky.empty() || !options.environment.empty();
  if (!asked && !has_light(*scene)) {
    std::fprintf(
        stderr,
        "lambent: the scene has no light; adding a sun and a sky (choose with --sun, --sky)\n");
    scene->lights.push_back(make_sun(kDefaultSunDirection, kDefaultSunIrradiance));
    scene->environment.radiance = kDefaultSky;
  }
  return scene;
}

Expected<Camera> choose_camera(const StageOptions& options, const World& world) {
  const Scene& scene = world.scene();
  const float fov_degrees = options.fov_degrees.value_or(kDefaultFov);
  // Written so that NaN fails
  if (!(fov_degrees >= kSmallestFov && fov_degrees <= kLargestFov)) {
    return fail("--fov", "", "must be 1 to 170 degrees");
  }
  const float vertical_fov = glm::radians(fov_degrees);
  if (options.eye.empty() != options.target.empty()) {
    return fail(options.eye.empty() ? "--target" : "--eye", "", "--eye and --target go together");
  }
  if (!options.eye.empty()) {
    if (!options.camera.empty()) return fail("--camera", "", "give either --camera or --eye");
    const auto eye = parse_place("--eye", options.eye);
    if (!eye) return tl::unexpected(eye.error());
    const auto target = parse_place("--target", options.target);
    if (!target) return tl::unexpected(target.error());
    if (*eye == *target) return fail("--target", "", "is where --eye is");
    return look_at(*eye, *target, vertical_fov);
  }
  if (options.camera.empty() && scene.cameras.empty()) return fitted_camera(world, vertical_fov);
  Expected<Camera> camera = options.camera.empty() ? Expected<Camera>(scene.cameras.front())
                                                   : named_camera(options.camera, scene);
  if (!camera || !options.fov_degrees) return camera;
  if (camera->orthographic) return fail("--fov", "", "an orthographic camera has none");
  camera->vertical_fov = vertical_fov;
  return camera;
}

}  // namespace lambent::cli
