// SPDX-License-Identifier: Apache-2.0
#include "lambent/light_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "first_picture/daylight.h"
#include "lambent/input.h"
#include "lambent/parse.h"
#include "lambent/validators.h"
#include "lambent/world.h"
#include "scene/limits.h"

namespace lambent::cli {
namespace {

// Length of --sun below which its direction would be lost in rounding.
constexpr float kMinDirection = 1e-6f;

bool names_light(const LightOptions& options) {
  return !options.sun.empty() || !options.sky.empty() || !options.environment.empty();
}

bool are_within(const glm::vec3& color, float largest) {
  return glm::all(glm::greaterThanEqual(color, glm::vec3(0.0f))) &&
         glm::all(glm::lessThanEqual(color, glm::vec3(largest)));
}

Expected<void> add_sun(const LightOptions& options, Scene& scene) {
  if (options.sun.empty()) {
    if (!options.sun_irradiance.empty()) return fail("--sun-irradiance", "", "needs --sun");
    return {};
  }
  const auto direction = parse_vec3("--sun", options.sun);
  if (!direction) return tl::unexpected(direction.error());
  // In double, where squares of floats do not overflow
  const glm::dvec3 way(*direction);
  if (glm::length(way) < kMinDirection) return fail("--sun", "", "the direction has no length");
  glm::vec3 irradiance = kDaySunIrradiance;
  if (!options.sun_irradiance.empty()) {
    const auto given = parse_vec3("--sun-irradiance", options.sun_irradiance);
    if (!given) return tl::unexpected(given.error());
    irradiance = *given;
  }
  if (!are_within(irradiance, kMaxIrradiance)) {
    return fail("--sun-irradiance", "", "must be 0 to 1e10 W/m^2");
  }
  Light sun;
  sun.name = "sun";
  sun.type = Light::Type::directional;
  sun.direction_ws = glm::vec3(glm::normalize(way));
  sun.intensity = irradiance;
  scene.lights.push_back(sun);
  return {};
}

Expected<void> set_sky(const LightOptions& options, Scene& scene) {
  if (!options.sky.empty() && !options.environment.empty()) {
    return fail("--sky", "", "give either --sky or --environment");
  }
  if (!options.environment.empty()) {
    const auto fine = check_image_input(options.environment);
    if (!fine) return tl::unexpected(fine.error());
    Expected<Environment> environment = load_environment(options.environment);
    if (!environment) return tl::unexpected(environment.error());
    scene.environment = std::move(*environment);
  }
  if (options.sky.empty()) return {};
  const auto sky = parse_vec3("--sky", options.sky);
  if (!sky) return tl::unexpected(sky.error());
  if (!are_within(*sky, kMaxRadiance)) return fail("--sky", "", "must be 0 to 1e10 W/(m^2 sr)");
  scene.environment = {};
  scene.environment.radiance = *sky;
  return {};
}

FirstLight light_of_name(const std::string& name) {
  return name == "studio"  ? FirstLight::studio
         : name == "lamps" ? FirstLight::lamps
         : name == "sun"   ? FirstLight::sun
         : name == "sky"   ? FirstLight::sky
                           : FirstLight::scene;
}

// With suns, `--light sky` can set up a sky in proportion to them.
bool has_sun(const Scene& scene) {
  return std::any_of(scene.lights.begin(), scene.lights.end(), [](const Light& light) {
    return light.type == Light::Type::directional && light.intensity != glm::vec3(0.0f);
  });
}

std::string describe(FirstLight light, const Scene& scene, bool has_dome) {
  switch (light) {
    case FirstLight::studio:
      return "a studio";
    case FirstLight::sun:
      return "sun and sky";
    case FirstLight::sky:
      return "the scene's, under a sky in proportion to its suns";
    case FirstLight::lamps:
      return scene.lights.size() == 1 ? "a lamp" : std::to_string(scene.lights.size()) + " lamps";
    case FirstLight::scene:
      break;
  }
  if (has_dome) return "the scene's, with the dome around it as its sky";
  // glTF files have no sky: with only a sun, shadows and windows would be black
  const bool has_sky = scene.environment.radiance != glm::vec3(0.0f);
  return has_sun(scene) && !has_sky ? "the scene's, under a black sky (--sky lights it)"
                                    : "the scene's";
}

}  // namespace

void add_light_options(CLI::App& command, LightOptions& o) {
  command
      .add_option(
          "--light", o.light,
          "auto: the scene's, else what suits it. scene, sky (as much as its suns have), studio, "
          "sun (and sky), lamps, or none (but what surfaces emit)")
      ->check(one_of({"auto", "scene", "sky", "studio", "sun", "lamps", "none"}))
      ->capture_default_str()
      ->type_name("L");
  command.add_option("--sun", o.sun, "Add a sun whose light travels this way: --sun=0.3,-1,0.2")
      ->type_name("X,Y,Z");
  command.add_option("--sun-irradiance", o.sun_irradiance, "Of that sun [W/m^2] (20,18,15)")
      ->type_name("R,G,B");
  command.add_option("--sky", o.sky, "Constant sky [W/(m^2 sr)]")->type_name("R,G,B");
  command.add_option("--environment", o.environment, "Latitude-longitude sky, .hdr or .exr")
      ->type_name("FILE");
}

Expected<void> add_asked_light(const LightOptions& options, Scene& scene) {
  const bool replaces = light_of_name(options.light) != FirstLight::scene;
  if (replaces && names_light(options)) {
    return fail("--light", "",
                "'" + options.light +
                    "' brings its own lights: leave out --sun, --sky and "
                    "--environment, or take --light scene or none");
  }
  if (options.light == "sky" && !has_sun(scene)) {
    return fail(
        "--light", "",
        "'sky' is in proportion to the scene's suns, and it has none: take sun, which brings "
        "both");
  }
  if (options.light == "none") {
    scene.lights.clear();
    scene.environment = {};
  }
  if (const auto done = add_sun(options, scene); !done) return done;
  return set_sky(options, scene);
}

Expected<AddedLight> add_first_light(const LightOptions& options, const Camera& camera,
                                     const std::optional<Scene>& sky_dome, Scene& scene,
                                     World& world, std::optional<FirstLight> chosen) {
  const auto nothing_added = [](std::string text) {
    return AddedLight{FirstLight::scene, std::move(text)};
  };
  if (options.light == "none" && !names_light(options))
    return nothing_added("none but what surfaces emit");
  if (sky_dome && options.sky.empty() && options.environment.empty()) {
    const std::uint32_t revision = scene.environment.revision + 1;
    scene.environment = sky_of_dome(*sky_dome, glm::vec3(camera.world_from_view[3]));
    scene.environment.revision = revision;
    if (const auto changes = world.update(); !changes) return tl::unexpected(changes.error());
  }
  if (names_light(options)) return nothing_added("as asked");
  if (options.light != "auto") chosen = light_of_name(options.light);
  const FirstLight light = chosen ? *chosen : choose_first_light(world, camera);
  if (sky_dome && options.light == "auto" && add_sun_to_sky(world, camera, scene)) {
    if (const auto changes = world.update(); !changes) return tl::unexpected(changes.error());
    return AddedLight{FirstLight::sun,
                      "the dome around the scene as its sky, and a sun, as that shows a clear day "
                      "(--light scene leaves the sun out)"};
  }
  if (light == FirstLight::scene)
    return nothing_added(describe(light, scene, sky_dome.has_value()));
  set_first_light(light, world, camera, scene);
  if (const auto changes = world.update(); !changes) return tl::unexpected(changes.error());
  AddedLight added = {light, describe(light, scene, false)};
  if (options.light != "auto") return added;
  const bool emits = std::ranges::any_of(
      scene.materials, [](const Material& m) { return m.emission != glm::vec3(0.0f); });
  if (light == FirstLight::sky) {
    added.description += ", as it brings none (--light scene leaves it black)";
  } else if (emits) {
    added.description += ", as what surfaces emit lights little of the view (--light scene)";
  } else {
    added.description += ", as the scene brings none (--light, --sun and --sky choose)";
  }
  return added;
}

}  // namespace lambent::cli
