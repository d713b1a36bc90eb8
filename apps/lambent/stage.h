// SPDX-License-Identifier: Apache-2.0
// What is rendered, from where and in which light: the options that every rendering subcommand
// shares.
#pragma once

#include <optional>
#include <string>

#include "lambent/error.h"
#include "lambent/scene.h"

namespace CLI {
class App;
}

namespace lambent {
class World;
}

namespace lambent::cli {

struct StageOptions {
  std::string scene;
  std::string camera;
  std::string eye, target;
  std::optional<float> fov_degrees;  // none: the camera's own
  std::string sun, sun_irradiance;
  std::string sky, environment;
  std::string materials = "gltf";
  bool no_normal_maps = false;
};

/// What is there and in which light, without from where.
void add_scene_options(CLI::App& command, StageOptions& options);
/// All of it.
void add_stage_options(CLI::App& command, StageOptions& options);

/// The scene with the lights that the options ask for. Tells on stderr of the loader's warnings,
/// and where a scene without any light was given some.
Expected<Scene> open_stage(const StageOptions& options);

/// The camera that the options ask for, else the scene's first, else one that shows the scene: from
/// inside where the scene is a room, from outside where it is an object.
Expected<Camera> choose_camera(const StageOptions& options, const World& world);

}  // namespace lambent::cli
