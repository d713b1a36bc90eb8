// SPDX-License-Identifier: Apache-2.0
// Scene, view and light: the options that all rendering subcommands share.
#pragma once

#include <optional>
#include <string>

#include "lambent/error.h"
#include "lambent/first_picture.h"
#include "lambent/light_options.h"
#include "lambent/scene.h"

namespace CLI {
class App;
}

namespace lambent {
class World;
}

namespace lambent::cli {

struct SceneOptions {
  std::string file;
  std::string camera;
  std::string eye, target;
  std::optional<float> fov_degrees;  // none: the camera's own
  LightOptions light;
  std::string materials = "gltf";
  bool no_normal_maps = false;
  std::string fog;      // empty: the scene's own
  bool no_fog = false;  // omit the scene's own
  // A dome stays a mesh: in a glTF file that is shared, a sky has no place
  bool keep_sky_dome = false;
};

/// Adds the options of what is read of the materials.
void add_material_options(CLI::App& command, SceneOptions& options);
/// Adds the options of scene and light, without those of the view.
void add_scene_options(CLI::App& command, SceneOptions& options);
/// Adds the options of scene, light and view.
void add_scene_and_view_options(CLI::App& command, SceneOptions& options);

/// A scene, without the dome that it brings as its sky (take_sky_dome in lambent/first_picture.h).
struct OpenedScene {
  Scene scene;
  std::optional<Scene> sky_dome;
};

/// Opens the scene, with the lights of the options. Prints the loader's warnings on stderr.
Expected<OpenedScene> open_lit_scene(const SceneOptions& options);

/// The camera of a picture, and how it was chosen.
struct View {
  enum class From { options, scene, inside, outside };
  Camera camera;
  From from = From::scene;
  float distance = 1.0f;  ///< To what it shows, where the program chose it [m].
};

/// The camera that the options ask for, else the scene's first that sees any of its surfaces, else
/// one that shows the scene (lambent/first_picture.h), with a warning where the scene has cameras.
/// `aspect` is the picture's width over its height. A view that the program chooses from outside
/// shows the whole object in all of the `poses`.
Expected<View> choose_view(const SceneOptions& options, const World& world, float aspect,
                           const Poses& poses = {});

/// The camera of the scene that the options name, else its first, of which there must be one.
Expected<Camera> camera_of_scene(const SceneOptions& options, const Scene& scene);

/// Describes how the view was chosen; if by the program, also the options that reproduce it.
std::string describe(const View& view);

}  // namespace lambent::cli
