// SPDX-License-Identifier: Apache-2.0
// In which light a scene is rendered: the options, and what becomes of them.
#pragma once

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

/// Adds the sun and sets the sky that the options name; takes the scene's own lights and sky away
/// where they say so.
Expected<void> add_asked_light(const LightOptions& options, Scene& scene);

/// Adds the light that the options leave to the program, as the camera's view needs it, and has the
/// world follow. `scene` is the world's. Returns what lights the scene, in words.
Expected<std::string> add_first_light(const LightOptions& options, const Camera& camera,
                                      Scene& scene, World& world);

}  // namespace lambent::cli
