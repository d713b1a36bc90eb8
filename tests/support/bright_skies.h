// SPDX-License-Identifier: Apache-2.0
// Skies with small parts that are much brighter than the rest.
#pragma once

#include <utility>

#include "lambent/scene.h"
#include "support/field_scenes.h"
#include "support/hand_made.h"

namespace lambent::test {

/// Red, green and blue fields on a dim sky; the green ones are its bright part.
inline Environment checkered_sky() {
  Environment sky;
  sky.radiance = {1.0f, 0.5f, 2.0f};
  sky.map = Image(360, 180, 3);
  for (int y = 0; y < 180; ++y) {
    for (int x = 0; x < 360; ++x) {
      for (int k = 0; k < 3; ++k) {
        sky.map.at(x, y)[k] = (x / 20 + y / 30) % 4 == k ? 8.0f : 0.25f;
      }
    }
  }
  return sky;
}

/// A dim sky with a sun of almost 3 degrees, which sends as much light as all the rest.
inline Environment sunny_sky() {
  Environment sky;
  sky.radiance = glm::vec3(1.0f);
  sky.map = Image(256, 128, 3);
  for (float& value : sky.map.pixels) value = 0.5f;
  for (int y = 40; y < 42; ++y) {
    for (int x = 150; x < 152; ++x) {
      for (int k = 0; k < 3; ++k) sky.map.at(x, y)[k] = 4000.0f;
    }
  }
  sky.rotation = 0.7f;
  return sky;
}

/// A ball of metal, with a clearcoat or without, under a sun that is part of the sky.
inline Stage ball_under_the_sun(float roughness, float clearcoat) {
  Scene scene;
  scene.materials.resize(1);
  scene.materials[0].metallic = 1.0f;
  scene.materials[0].roughness = roughness;
  scene.materials[0].clearcoat = clearcoat;
  scene.materials[0].clearcoat_roughness = 0.25f;
  add(scene, sphere(1.0f, 48, 0));
  scene.environment = sunny_sky();
  scene.cameras.push_back(look_at({0.0f, 0.3f, 4.0f}, {0.0f, 0.0f, 0.0f}, 0.6f));
  return Stage(std::move(scene));
}

/// A field for it, which convex metal hardly reads.
inline IrradianceField field_of_ball(const Stage& stage) {
  FieldSettings few;
  few.probe_count = glm::ivec3(3);
  few.rays_per_probe = 64;
  return make_field(stage, few, 2);
}

}  // namespace lambent::test
