// SPDX-License-Identifier: Apache-2.0
#include "scenes/builtin.h"

namespace lambent::scenes {
namespace {

/// Applies load_scene's options to a scene made in memory.
void apply(const LoadOptions& options, Scene& scene) {
  for (Material& material : scene.materials) {
    material.lambert = material.lambert || options.lambert;
    if (!options.normal_maps) material.normal_texture = {};
  }
}

}  // namespace

Expected<Scene> open_scene(const std::string& path_or_name, const LoadOptions& options) {
  if (!is_name(path_or_name)) return load_scene(path_or_name, options);
  Expected<Scene> scene = make(path_or_name);
  if (scene) apply(options, *scene);
  return scene;
}

}  // namespace lambent::scenes
