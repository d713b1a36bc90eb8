// SPDX-License-Identifier: Apache-2.0
// A room with one thing of every kind that shading tells apart.
#pragma once

#include <glm/gtc/matrix_transform.hpp>

#include "shared/random.h"
#include "support/hand_made.h"

namespace lambent::test {

/// A texture of random texels with its MIPs.
inline Texture noise_texture(int width, int height, bool srgb, std::uint32_t seed) {
  Texture texture;
  texture.srgb = srgb;
  TextureLevel level{width, height, {}};
  RandomStream random = make_random_stream(0u, 1u, seed);
  for (int i = 0; i < width * height * 4; ++i) {
    level.rgba.push_back(static_cast<std::uint8_t>(255.0f * next_uniform(random)));
  }
  texture.levels.push_back(std::move(level));
  build_mips(texture);
  return texture;
}

/// Texels of unit length about +Z, as normal maps have them.
inline Texture bump_texture(int size, std::uint32_t seed) {
  Texture texture = noise_texture(size, size, false, seed);
  for (std::size_t i = 2; i < texture.levels[0].rgba.size(); i += 4) {
    texture.levels[0].rgba[i] = static_cast<std::uint8_t>(192 + texture.levels[0].rgba[i] / 4);
  }
  build_mips(texture);
  return texture;
}

/// Textures of the scene below.
enum MaterialSceneTexture : int { kColors, kData, kBumps, kStripes, kTextureCount };

inline Scene material_scene() {
  Scene scene;
  scene.textures = {noise_texture(32, 16, true, 1), noise_texture(8, 8, false, 2),
                    bump_texture(16, 3), noise_texture(5, 3, true, 4)};
  const auto material = [&](auto change) {
    Material m;
    m.metallic = 0.3f;
    m.roughness = 0.6f;
    change(m);
    scene.materials.push_back(m);
    return static_cast<int>(scene.materials.size()) - 1;
  };
  const auto view = [](int texture, Wrap u, Wrap v) {
    TextureView result;
    result.texture = texture;
    result.wrap_u = u;
    result.wrap_v = v;
    return result;
  };
  const TextureView colors = view(kColors, Wrap::repeat, Wrap::repeat);

  // A room of textured, bumpy walls
  const int walls = material([&](Material& m) {
    m.base_color_texture = view(kColors, Wrap::mirrored_repeat, Wrap::clamp_to_edge);
    m.base_color_texture.uv_scale = {3.0f, 1.5f};
    m.base_color_texture.uv_rotation = 0.4f;
    m.base_color_texture.uv_offset = {0.1f, -0.3f};
    m.metallic_roughness_texture = view(kData, Wrap::repeat, Wrap::mirrored_repeat);
    m.normal_texture = view(kBumps, Wrap::repeat, Wrap::repeat);
    m.normal_scale = 0.7f;
    m.double_sided = true;
  });
  add_room(scene, 6.0f, walls);
  // Without its ceiling, so that the sky is seen
  scene.instances.erase(scene.instances.begin() + 1);

  // Balls: with tangents of their own and specular textures; mirrored and of second texture
  // coordinates, nearest texels and vertex colours
  const int coated = material([&](Material& m) {
    m.base_color_texture = colors;
    m.normal_texture = view(kBumps, Wrap::repeat, Wrap::repeat);
    m.specular_texture = view(kData, Wrap::clamp_to_edge, Wrap::repeat);
    m.specular_color_texture = colors;
    m.metallic = 0.0f;
    m.ior = 1.8f;
    m.clearcoat = 0.8f;
    m.clearcoat_texture = view(kData, Wrap::repeat, Wrap::repeat);
    m.clearcoat_roughness = 0.7f;
    m.clearcoat_roughness_texture = view(kData, Wrap::repeat, Wrap::clamp_to_edge);
    m.clearcoat_normal_texture = view(kBumps, Wrap::mirrored_repeat, Wrap::repeat);
    m.clearcoat_normal_scale = 0.5f;
    m.iridescence = 0.9f;
    m.iridescence_texture = view(kData, Wrap::mirrored_repeat, Wrap::clamp_to_edge);
    m.iridescence_ior = 1.6f;
    m.iridescence_thickness_min = 200.0f;
    m.iridescence_thickness_max = 500.0f;
    m.iridescence_thickness_texture = view(kData, Wrap::repeat, Wrap::repeat);
  });
  Mesh ball = sphere(0.8f, 10, coated);
  for (const glm::vec3& n : ball.normals) {
    const glm::vec3 t = glm::cross(glm::vec3(0.0f, 1.0f, 0.001f), n);
    ball.tangents.emplace_back(glm::normalize(t), -1.0f);
  }
  add(scene, ball, glm::translate(glm::mat4(1.0f), {-1.2f, -1.0f, 0.0f}));
  const int nearest = material([&](Material& m) {
    m.base_color_texture = view(kStripes, Wrap::repeat, Wrap::repeat);
    m.base_color_texture.nearest = true;
    m.base_color_texture.uv_set = 1;
    m.lambert = true;
  });
  Mesh painted = sphere(0.6f, 8, nearest);
  painted.uvs[1] = painted.uvs[0];
  for (const glm::vec3& n : painted.normals) painted.colors.emplace_back(0.5f + 0.5f * n, 1.0f);
  add(scene, painted,
      glm::scale(glm::translate(glm::mat4(1.0f), {1.2f, -1.0f, 0.5f}), {-1.0f, 1.4f, 0.7f}));

  // Screens: one with holes, one half see-through, both single-sided
  const int mask = material([&](Material& m) {
    m.base_color_texture = colors;
    m.alpha_mode = AlphaMode::mask;
    m.alpha_cutoff = 0.45f;
    m.sheen_color = {0.9f, 0.8f, 0.6f};
    m.sheen_color_texture = view(kStripes, Wrap::repeat, Wrap::repeat);
    m.sheen_roughness = 0.9f;
    m.sheen_roughness_texture = view(kData, Wrap::repeat, Wrap::repeat);
  });
  add(scene, quad({-2.0f, -0.5f, 1.5f}, {1.5f, 0.0f, 0.0f}, {0.0f, 1.5f, 0.0f}, mask));
  const int veil = material([&](Material& m) {
    m.base_color_texture = view(kStripes, Wrap::clamp_to_edge, Wrap::clamp_to_edge);
    m.base_color.a = 0.8f;
    m.alpha_mode = AlphaMode::blend;
  });
  add(scene, quad({0.5f, -0.5f, 1.5f}, {1.5f, 0.0f, 0.0f}, {0.0f, 1.5f, 0.0f}, veil));

  // What emits: textured, with holes, under a clearcoat; and an unlit one that receives no indirect
  // light
  const int lamp = material([&](Material& m) {
    m.emission = {6.0f, 5.0f, 3.0f};
    m.emission_texture = colors;
    m.base_color_texture = colors;
    m.alpha_mode = AlphaMode::mask;
    m.clearcoat = 1.0f;
    m.clearcoat_texture = view(kData, Wrap::repeat, Wrap::repeat);
  });
  add(scene, quad({-0.5f, 2.5f, -0.5f}, {1.0f, 0.0f, 0.0f}, {0.0f, 0.2f, 1.0f}, lamp));
  const int sign = material([&](Material& m) {
    m.unlit = true;
    m.base_color = {0.4f, 0.8f, 0.2f, 1.0f};
  });
  add(scene, quad({2.5f, -1.0f, -1.0f}, {0.0f, 0.0f, 1.0f}, {0.0f, 1.0f, 0.0f}, sign));
  scene.instances.back().receives_gi = false;

  scene.lights = {sun({2.0f, 1.8f, 1.5f}, {0.3f, -1.0f, 0.2f}),
                  point_light({3.0f, 1.0f, 1.0f}, {1.0f, 1.0f, -1.5f}),
                  point_light({1.0f, 4.0f, 4.0f}, {-1.0f, 2.0f, 1.0f})};
  scene.lights[1].range = 4.0f;
  scene.lights[2].type = Light::Type::spot;
  scene.lights[2].direction_ws = glm::normalize(glm::vec3(0.2f, -1.0f, 0.0f));
  scene.lights[2].inner_cone_angle = 0.3f;
  scene.environment.radiance = {0.8f, 0.9f, 1.0f};
  scene.environment.rotation = 0.5f;
  scene.environment.map = Image(8, 4, 3);
  RandomStream random = make_random_stream(0u, 2u, 9u);
  for (float& value : scene.environment.map.pixels) value = next_uniform(random);
  return scene;
}

}  // namespace lambent::test
