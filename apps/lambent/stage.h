// SPDX-License-Identifier: Apache-2.0
// What is rendered, from where and in which light: the options that every rendering subcommand
// shares.
#pragma once

#include <optional>
#include <string>

#include "lambent/error.h"
#include "lambent/scene.h"
#include "lambent/stage_light.h"

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
  LightOptions light;
  std::string materials = "gltf";
  bool no_normal_maps = false;
  std::string fog;      // empty: the scene's own
  bool no_fog = false;  // the scene's own is left out
};

/// What is there and in which light, without from where.
void add_scene_options(CLI::App& command, StageOptions& options);
/// All of it.
void add_stage_options(CLI::App& command, StageOptions& options);

/// The scene with the lights that the options name. Tells on stderr of the loader's warnings.
Expected<Scene> open_stage(const StageOptions& options);

/// From where a scene is seen, and who says so.
struct View {
  enum class From { options, scene, inside, outside };
  Camera camera;
  From from = From::scene;
};

/// The camera that the options ask for, else the scene's first that sees any of its surfaces, else
/// one that shows the scene (lambent/first_picture.h), with a warning where the scene has cameras.
/// `aspect` is the picture's width over its height.
Expected<View> choose_view(const StageOptions& options, const World& world, float aspect);

/// The camera of the scene that the options name, else its first, of which there must be one.
Expected<Camera> camera_of_scene(const StageOptions& options, const Scene& scene);

/// Who chose the view, in words; of one that we chose also the options that give it again.
std::string describe(const View& view);

}  // namespace lambent::cli
