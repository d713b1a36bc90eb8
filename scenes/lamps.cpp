// SPDX-License-Identifier: Apache-2.0
// A street at night under a thousand lamps on cables, half of them spots, between houses with a
// thousand lanterns of a hundred emissive triangles each: a test of the cost and the noise of
// direct light from many sources.
#include <cmath>
#include <string>

#include "scenes/mesh_builder.h"
#include "scenes/parts.h"
#include "scenes/recipes.h"
#include "shared/constants.h"
#include "shared/random.h"

namespace lambent::scenes {
namespace {

constexpr float kLanternPitch = 2.0f;  // from cable to cable, and from lantern to lantern [m]
constexpr int kCables = 100;           // across the street
constexpr int kLampsOnCable = 10;
constexpr int kLanternRows = 5;      // on each side, one above the other
constexpr float kHalfStreet = 6.0f;  // from its middle to the houses [m]
constexpr float kKerb = 4.0f;        // from its middle to the pavement [m]
constexpr float kKerbHeight = 0.12f;
constexpr float kLength = kCables * kLanternPitch;  // [m]
constexpr float kCableHeight = 6.5f;                // at the houses [m]
constexpr float kSag = 1.2f;                        // of its middle [m]
constexpr float kRowHeight = 2.6f;                  // of a storey [m]
constexpr float kLantern = 0.12f;                   // radius [m]
constexpr float kLanternOff = 0.35f;                // from the wall to its middle [m]
// A hundred triangles: ten at either pole, twenty for each of four bands.
constexpr int kLanternSegments = 10, kLanternRings = 6;
constexpr float kPoint = 1.2f, kSpot = 5.0f;          // radiant intensity [W/sr]
constexpr float kSpotAngle = 0.7f;                    // outer cone [rad]
constexpr float kLanternFieldOfView = 1.0471975512f;  // 60 degrees [rad]

/// Houses of random width and height along one side, whose front is at `side * kHalfStreet`.
void add_houses(Scene& scene, int plaster, float side, RandomStream& random) {
  MeshBuilder builder;
  float z = 0.0f;
  while (z < kLength) {
    const float width = std::min(6.0f + 8.0f * next_uniform(random), kLength - z);
    const float height = 13.5f + 6.0f * next_uniform(random);
    const float depth = 8.0f;
    const float near = kHalfStreet, far = kHalfStreet + depth;
    builder.box({side > 0.0f ? near : -far, 0.0f, z},
                {side > 0.0f ? far : -near, height, z + width});
    // A bay juts out above the ground floor of every house
    const float bay = z + 0.3f * width;
    const float out = kHalfStreet - 0.25f;
    builder.box({side > 0.0f ? out : -near, 3.0f, bay},
                {side > 0.0f ? near : -out, 0.8f * height, bay + 0.3f * width});
    z += width;
  }
  add_object(scene, builder.take(side > 0.0f ? "houses_right" : "houses_left", plaster));
}

void add_lanterns(Scene& scene, float side, const int (&meshes)[3]) {
  for (int row = 0; row < kLanternRows; ++row) {
    for (int i = 0; i < kCables; ++i) {
      const glm::vec3 place(side * (kHalfStreet - kLanternOff),
                            2.4f + kRowHeight * static_cast<float>(row),
                            kLanternPitch * (static_cast<float>(i) + 0.5f));
      glm::mat4 world_from_object(1.0f);
      world_from_object[3] = glm::vec4(place, 1.0f);
      const std::string name = std::string(side > 0.0f ? "lantern_right_" : "lantern_left_") +
                               std::to_string(row) + "_" + std::to_string(i);
      add_instance(scene, name, meshes[(row + i) % 3], world_from_object);
    }
  }
}

void add_lamps(Scene& scene) {
  for (int cable = 0; cable < kCables; ++cable) {
    for (int i = 0; i < kLampsOnCable; ++i) {
      // A hanging cable is approximately a parabola
      const float s = (static_cast<float>(i) + 0.5f) / kLampsOnCable;
      const float sag = kSag * 4.0f * s * (1.0f - s);
      Light lamp;
      lamp.name = "lamp_" + std::to_string(cable) + "_" + std::to_string(i);
      lamp.position_ws = {kHalfStreet * (2.0f * s - 1.0f), kCableHeight - sag,
                          kLanternPitch * (static_cast<float>(cable) + 0.25f)};
      if ((cable + i) % 2 == 0) {
        lamp.intensity = kPoint * glm::vec3(1.0f, 0.7f, 0.4f);
      } else {
        lamp.type = Light::Type::spot;
        lamp.direction_ws = {0.0f, -1.0f, 0.0f};
        lamp.outer_cone_angle = kSpotAngle;
        lamp.inner_cone_angle = 0.6f * kSpotAngle;
        lamp.intensity =
            kSpot * (i % 3 == 0 ? glm::vec3(0.5f, 0.8f, 1.0f) : glm::vec3(1.0f, 0.85f, 0.6f));
      }
      scene.lights.push_back(std::move(lamp));
    }
  }
}

}  // namespace

AnimatedScene make_lamps() {
  Scene scene;
  const int plaster = add_lambert(scene, "plaster", {0.6f, 0.55f, 0.48f});
  const int asphalt = add_lambert(scene, "asphalt", {0.2f, 0.2f, 0.21f});
  const int stone = add_lambert(scene, "stone", {0.45f, 0.43f, 0.4f});
  const int crates = add_lambert(scene, "crates", {0.5f, 0.25f, 0.12f});
  MeshBuilder builder;
  builder.box({-kKerb, -0.2f, 0.0f}, {kKerb, 0.0f, kLength});
  add_object(scene, builder.take("street", asphalt));
  builder.box({-kHalfStreet, -0.2f, 0.0f}, {-kKerb, kKerbHeight, kLength});
  builder.box({kKerb, -0.2f, 0.0f}, {kHalfStreet, kKerbHeight, kLength});
  add_object(scene, builder.take("pavements", stone));
  RandomStream random = make_random_stream(1u, 0u, 0u);
  add_houses(scene, plaster, -1.0f, random);
  add_houses(scene, plaster, 1.0f, random);
  for (int i = 0; i < kCables; ++i) {
    const float x = kKerb + 1.1f * next_uniform(random);
    const float left = next_uniform(random) < 0.5f ? -1.0f : 1.0f;
    const float z = kLanternPitch * (static_cast<float>(i) + next_uniform(random) * 0.5f);
    const float size = 0.4f + 0.5f * next_uniform(random);
    const float middle = left * x;
    builder.box({middle - 0.5f * size, kKerbHeight, z},
                {middle + 0.5f * size, kKerbHeight + size, z + size});
  }
  add_object(scene, builder.take("crates", crates));

  const glm::vec3 colors[3] = {{9.0f, 5.0f, 2.0f}, {7.0f, 2.0f, 1.0f}, {3.0f, 5.0f, 7.0f}};
  int meshes[3];
  for (int i = 0; i < 3; ++i) {
    const std::string name = "lantern_" + std::to_string(i);
    const int material = add_lambert(scene, name, glm::vec3(0.2f), colors[i]);
    builder.faceted_sphere(glm::vec3(0.0f), kLantern, kLanternSegments, kLanternRings);
    meshes[i] = static_cast<int>(scene.meshes.size());
    scene.meshes.push_back(builder.take(name, material));
  }
  add_lanterns(scene, -1.0f, meshes);
  add_lanterns(scene, 1.0f, meshes);
  add_lamps(scene);
  add_camera(scene, "street", {1.5f, 1.7f, 60.0f}, {-1.0f, 3.2f, 90.0f}, kLanternFieldOfView,
             kAspect);
  add_camera(scene, "pavement", {5.3f, 1.5f, 100.2f}, {-6.0f, 1.2f, 106.0f}, kLanternFieldOfView,
             kAspect);
  return {std::move(scene), {}};
}

}  // namespace lambent::scenes
