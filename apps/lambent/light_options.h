// SPDX-License-Identifier: Apache-2.0
// The options of a scene's light, and their application.
#pragma once

#include <optional>
#include <string>

#include "lambent/error.h"
#include "lambent/first_picture.h"
#include "lambent/scene.h"

namespace CLI {
class App;
}

namespace lambent {
class World;
}

namespace lambent::cli {

struct LightOptions {
  std::string light = "auto";
  std::string sun, sun_irradiance;
  std::string sky, environment;
};

void add_light_options(CLI::App& command, LightOptions& options);

/// Adds the sun and sets the sky of the options; removes the scene's own lights and sky where they
/// request it.
Expected<void> add_asked_light(const LightOptions& options, Scene& scene);

/// What lights a scene.
struct AddedLight {
  FirstLight kind;          ///< FirstLight::scene where the program added no light of its own.
  std::string description;  ///< For people.
};

/// Adds the light that the options leave to the program, as the camera's view needs it, and updates
/// the world. `scene` is the world's scene. `sky_dome`, which take_sky_dome took from it, becomes
/// its sky where the options request no other. `chosen`: what suits more than this view, a
/// sequence's; none: what suits this view is chosen.
Expected<AddedLight> add_first_light(const LightOptions& options, const Camera& camera,
                                     const std::optional<Scene>& sky_dome, Scene& scene,
                                     World& world, std::optional<FirstLight> chosen = {});

}  // namespace lambent::cli
