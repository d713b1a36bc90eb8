// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "lambent/scene.h"
#include "scene/limits.h"

namespace lambent {

Expected<Environment> load_environment(const std::string& path) {
  Expected<LayeredImage> image = read_image(path);
  if (!image) return tl::unexpected(std::move(image).error());
  if (image->layers.empty()) return fail(path, "", "the image has no channels");
  // Take the unnamed layer of an EXR with several layers, or the first one where there is none
  Layer* layer = &image->layers.front();
  for (Layer& candidate : image->layers) {
    if (candidate.name.empty()) layer = &candidate;
  }
  const Image& source = layer->image;
  if (source.empty()) return fail(path, "", "the image has no pixels");
  if (source.channels < 1) return fail(path, "", "the image has no channels");

  Environment environment;
  environment.radiance = glm::vec3(1.0f);
  environment.map = Image(source.width, source.height, 3);
  for (int y = 0; y < source.height; ++y) {
    for (int x = 0; x < source.width; ++x) {
      const float* in = source.at(x, y);
      float* out = environment.map.at(x, y);
      for (int k = 0; k < 3; ++k) {
        const float value = source.channels >= 3 ? in[k] : in[0];
        if (!std::isfinite(value)) {
          return fail(path, "pixel (" + std::to_string(x) + ", " + std::to_string(y) + ")",
                      "the radiance is not a finite number");
        }
        if (value > kMaxRadiance) {
          return fail(path, "pixel (" + std::to_string(x) + ", " + std::to_string(y) + ")",
                      "the radiance is above 1e10 W/(m^2 sr)");
        }
        // Published maps have small negative values from resampling filters
        out[k] = value > 0.0f ? value : 0.0f;
      }
    }
  }
  return environment;
}

}  // namespace lambent
