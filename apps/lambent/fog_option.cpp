// SPDX-License-Identifier: Apache-2.0
#include "lambent/fog_option.h"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "lambent/parse.h"
#include "scene/validate.h"

namespace lambent::cli {
namespace {

constexpr const char* kOption = "--fog";

// Each edge of the box is at least this share of the longest, since the box of a flat scene would
// contain no fog.
constexpr float kLeastEdge = 0.1f;

}  // namespace

void add_fog_option(CLI::App& command, std::string& fog) {
  command
      .add_option(kOption, fog,
                  "Fill the scene with fog: extinction [1/m]; share that is scattered (0.9), mean "
                  "cosine of that (0), height over which it thins to 1/e [m] (0: nowhere)")
      ->type_name("D[,A,G,H]");
}

Expected<FogVolume> parse_fog(const std::string& text, const Bounds& scene) {
  const auto numbers = parse_numbers(kOption, text, 1, 4, "a density [1/m], or D,A,G,H");
  if (!numbers) return tl::unexpected(numbers.error());
  const auto number = [&](std::size_t i, float otherwise) {
    return i < numbers->size() ? (*numbers)[i] : otherwise;
  };
  FogVolume fog;
  fog.name = "fog";
  fog.density = (*numbers)[0];
  fog.albedo = glm::vec3(number(1, fog.albedo.x));
  fog.anisotropy = number(2, fog.anisotropy);
  fog.scale_height = number(3, fog.scale_height);
  const glm::vec3 size = scene.max - scene.min;
  fog.size = glm::max(size, glm::vec3(kLeastEdge * std::max({size.x, size.y, size.z})));
  fog.centre = 0.5f * (scene.min + scene.max);
  fog.centre.y = scene.min.y + 0.5f * fog.size.y;
  if (const char* flaw = flaw_of(fog)) return fail(kOption, "", flaw);
  return fog;
}

}  // namespace lambent::cli
