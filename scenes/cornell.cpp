// SPDX-License-Identifier: Apache-2.0
// Based on: Cornell University Program of Computer Graphics, "Cornell Box Data",
// https://www.graphics.cornell.edu/online/box/data.html (geometry in millimetres, as published).
// Reflectances and emission are the measured spectra as linear Rec. 709; one unit here is 100 mm.
#include <array>
#include <cmath>
#include <cstdio>

#include "scenes/mesh_builder.h"
#include "scenes/parts.h"
#include "scenes/recipes.h"
#include "shared/constants.h"

namespace lambent::scenes {
namespace {

constexpr glm::vec3 kWhite{0.725f, 0.71f, 0.68f};
constexpr glm::vec3 kRed{0.63f, 0.065f, 0.05f};
constexpr glm::vec3 kGreen{0.14f, 0.45f, 0.091f};
constexpr glm::vec3 kLampReflectance{0.78f};
constexpr glm::vec3 kLampRadiance{17.0f, 12.0f, 4.0f};

/// Replaces the lamp: about its power, in a cone that lights the floor, both blocks and the bottom
/// of the walls, so that the upper half of the box has indirect light only.
constexpr glm::vec3 kSpotIntensity{60.0f, 52.0f, 40.0f};  // [W/sr]
constexpr float kSpotInnerCone = 0.52359878f;             // 30 degrees [rad]
constexpr float kSpotOuterCone = 0.69813170f;             // 40 degrees [rad]

/// The published vertical field of view: a 25 mm film at 35 mm focal length, 2 atan(12.5 / 35)
/// [rad].
constexpr float kCornellFieldOfView = 0.686047881f;

/// A published point [mm] in units of 100 mm. Divided, not multiplied, so that 552.8 becomes 5.528.
glm::vec3 mm(float x, float y, float z) {
  return glm::vec3(x, y, z) / 100.0f;
}

using Corners = std::array<glm::vec3, 4>;

Mesh quads(std::initializer_list<Corners> list, const char* name, int material) {
  MeshBuilder builder;
  for (const Corners& q : list) builder.quad(q[0], q[1], q[2], q[3]);
  return builder.take(name, material);
}

/// The spheres' reflectance and arrangement: two rows of three, without contact.
constexpr glm::vec3 kMetal{0.9f, 0.88f, 0.85f};
constexpr std::array kRoughnesses{0.0f, 0.1f, 0.2f, 0.4f, 0.6f, 0.8f};
constexpr float kCornellSphereRadius = 75.0f;  // [mm]
constexpr int kCornellSphereSegments = 96, kSphereSteps = 48;

/// The box without its blocks, with this radiance of the lamp.
Scene make_box(const glm::vec3& lamp_radiance) {
  Scene scene;
  const int white = add_lambert(scene, "white", kWhite);
  const int red = add_lambert(scene, "red", kRed);
  const int green = add_lambert(scene, "green", kGreen);
  const int lamp = add_lambert(scene, "light", kLampReflectance, lamp_radiance);

  add_object(
      scene,
      quads({Corners{mm(552.8f, 0, 0), mm(0, 0, 0), mm(0, 0, 559.2f), mm(549.6f, 0, 559.2f)}},
            "floor", white));
  // The ceiling has a hole for the lamp: four parts before, behind and to both sides of it.
  const float h = 548.8f;
  add_object(scene,
             quads({Corners{mm(556, h, 0), mm(556, h, 227), mm(0, h, 227), mm(0, h, 0)},
                    Corners{mm(556, h, 332), mm(556, h, 559.2f), mm(0, h, 559.2f), mm(0, h, 332)},
                    Corners{mm(556, h, 227), mm(556, h, 332), mm(343, h, 332), mm(343, h, 227)},
                    Corners{mm(213, h, 227), mm(213, h, 332), mm(0, h, 332), mm(0, h, 227)}},
                   "ceiling", white));
  add_object(scene, quads({Corners{mm(549.6f, 0, 559.2f), mm(0, 0, 559.2f), mm(0, h, 559.2f),
                                   mm(556, h, 559.2f)}},
                          "back", white));
  add_object(scene, quads({Corners{mm(0, 0, 559.2f), mm(0, 0, 0), mm(0, h, 0), mm(0, h, 559.2f)}},
                          "right_green", green));
  add_object(
      scene,
      quads({Corners{mm(552.8f, 0, 0), mm(549.6f, 0, 559.2f), mm(556, h, 559.2f), mm(556, h, 0)}},
            "left_red", red));
  add_object(scene,
             quads({Corners{mm(343, h, 227), mm(343, h, 332), mm(213, h, 332), mm(213, h, 227)}},
                   "light", lamp));
  add_camera(scene, "cornell", mm(278, 273, -800), mm(278, 273, 0), kCornellFieldOfView, 1.0f);
  return scene;
}

/// The blocks stand on the floor; their undersides were not measured and are not made.
void add_blocks(Scene& scene) {
  constexpr int white = 0;
  add_object(
      scene,
      quads({Corners{mm(130, 165, 65), mm(82, 165, 225), mm(240, 165, 272), mm(290, 165, 114)},
             Corners{mm(290, 0, 114), mm(290, 165, 114), mm(240, 165, 272), mm(240, 0, 272)},
             Corners{mm(130, 0, 65), mm(130, 165, 65), mm(290, 165, 114), mm(290, 0, 114)},
             Corners{mm(82, 0, 225), mm(82, 165, 225), mm(130, 165, 65), mm(130, 0, 65)},
             Corners{mm(240, 0, 272), mm(240, 165, 272), mm(82, 165, 225), mm(82, 0, 225)}},
            "short_block", white));
  add_object(
      scene,
      quads({Corners{mm(423, 330, 247), mm(265, 330, 296), mm(314, 330, 456), mm(472, 330, 406)},
             Corners{mm(423, 0, 247), mm(423, 330, 247), mm(472, 330, 406), mm(472, 0, 406)},
             Corners{mm(472, 0, 406), mm(472, 330, 406), mm(314, 330, 456), mm(314, 0, 456)},
             Corners{mm(314, 0, 456), mm(314, 330, 456), mm(265, 330, 296), mm(265, 0, 296)},
             Corners{mm(265, 0, 296), mm(265, 330, 296), mm(423, 330, 247), mm(423, 0, 247)}},
            "tall_block", white));
}

/// A metal sphere with smooth normals.
void add_sphere(Scene& scene, const glm::vec3& centre, float roughness) {
  std::array<char, 32> name;
  std::snprintf(name.data(), name.size(), "roughness_%.1f", roughness);
  Material metal;
  metal.name = name.data();
  metal.base_color = glm::vec4(kMetal, 1.0f);
  metal.metallic = 1.0f;
  metal.roughness = roughness;
  scene.materials.push_back(metal);
  const float radius = kCornellSphereRadius / 100.0f;
  std::vector<glm::vec2> profile;
  for (int i = 0; i <= kSphereSteps; ++i) {
    const float angle = kPi * static_cast<float>(i) / kSphereSteps;
    const bool pole = i == 0 || i == kSphereSteps;
    profile.emplace_back(pole ? 0.0f : radius * std::sin(angle), -radius * std::cos(angle));
  }
  MeshBuilder builder;
  builder.lathe(centre, profile, kCornellSphereSegments);
  add_object(scene, builder.take(metal.name, static_cast<int>(scene.materials.size()) - 1));
}

}  // namespace

AnimatedScene make_cornell() {
  Scene scene = make_box(kLampRadiance);
  add_blocks(scene);
  return {std::move(scene), {}};
}

AnimatedScene make_spheres() {
  Scene scene = make_box(kLampRadiance);
  for (int i = 0; i < static_cast<int>(kRoughnesses.size()); ++i) {
    // As the camera sees them, from the left to the right: +X is to the left
    const int column = i % 3;
    const bool upper = i < 3;
    const glm::vec3 centre =
        mm(448.0f - 170.0f * column, upper ? 345.0f : 80.0f, upper ? 330.0f : 200.0f);
    add_sphere(scene, centre, kRoughnesses[i]);
  }
  return {std::move(scene), {}};
}

AnimatedScene make_cornell_spot() {
  Scene scene = make_box(glm::vec3(0.0f));
  add_blocks(scene);
  Light spot;
  spot.name = "spot";
  spot.type = Light::Type::spot;
  spot.position_ws = mm(278, 547, 279.5f);
  spot.direction_ws = {0.0f, -1.0f, 0.0f};
  spot.intensity = kSpotIntensity;
  spot.inner_cone_angle = kSpotInnerCone;
  spot.outer_cone_angle = kSpotOuterCone;
  scene.lights.push_back(spot);
  return {std::move(scene), {}};
}

}  // namespace lambent::scenes
