// SPDX-License-Identifier: Apache-2.0
// The atrium's columns, balustrades, fountain and trees.
#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "scenes/atrium.h"
#include "scenes/parts.h"
#include "shared/constants.h"
#include "shared/random.h"
#include "shared/sampling.h"

namespace lambent::scenes::atrium {
namespace {

using B = MeshBuilder;
using Profile = std::vector<glm::vec2>;

constexpr glm::vec3 kOrigin{0.0f};

/// Appends a half-round from one point of a profile to another of the same radius, bulging
/// outwards.
void torus(Profile& profile, float radius, float from, float to, int steps) {
  const float half = 0.5f * (to - from);
  for (int i = 0; i <= steps; ++i) {
    const float angle = kPi * (static_cast<float>(i) / steps - 0.5f);
    profile.emplace_back(radius + half * std::cos(angle), from + half * (1.0f + std::sin(angle)));
  }
}

glm::mat4 moved(float x, float y, float z) {
  return glm::translate(glm::mat4(1.0f), {x, y, z});
}

/// A column shaft that swells: Vignola's entasis as a gentle power, `flutes` grooves that fade at
/// both ends.
struct Shaft {
  float foot, top, radius;
  int flutes, points_a_flute, rows;
};

void shaft(MeshBuilder& builder, const Shaft& shape) {
  constexpr float kTaper = 0.15f, kTaperPower = 1.8f;
  constexpr float kFluteDepth = 0.085f;  // of the radius
  constexpr float kPlainShare = 0.045f;  // of the height, at both ends
  const int columns = shape.flutes > 0 ? shape.flutes * shape.points_a_flute : shape.points_a_flute;
  builder.surface(columns, shape.rows, true, [&](float s, float t) {
    // The first and the last row are round; the flutes run between the rows next to them.
    const bool end = t <= 0.0f || t >= 1.0f;
    const float height = end ? t
                             : glm::mix(kPlainShare, 1.0f - kPlainShare,
                                        (t * shape.rows - 1.0f) / (shape.rows - 2.0f));
    const float groove = end ? 0.0f : std::sqrt(std::abs(std::sin(kPi * s * shape.flutes)));
    const float swell = 1.0f - kTaper * std::pow(height, kTaperPower);
    const float radius = shape.radius * swell * (1.0f - kFluteDepth * groove);
    const float angle = -kTwoPi * s;
    return B::SurfacePoint{{radius * std::cos(angle), glm::mix(shape.foot, shape.top, height),
                            radius * std::sin(angle)},
                           {s * kTwoPi * shape.radius, -height * (shape.top - shape.foot)}};
  });
}

/// A bell with eight leaves in relief that curl over at the top.
void leafy_capital(MeshBuilder& builder, float foot, float top, float radius) {
  constexpr int kLeaves = 8, kPointsALeaf = 4, kRows = 7;
  builder.surface(kLeaves * kPointsALeaf, kRows, true, [&](float s, float t) {
    const float bell = 1.0f + 0.38f * t * t;
    const float leaf = 0.5f + 0.5f * std::cos(kTwoPi * s * kLeaves);
    const float curl = 0.20f * leaf * std::sin(kPi * std::min(1.0f, 1.12f * t));
    const float r = radius * (bell + curl);
    const float angle = -kTwoPi * s;
    return B::SurfacePoint{{r * std::cos(angle), glm::mix(foot, top, t), r * std::sin(angle)},
                           {s * kTwoPi * radius, -t * (top - foot)}};
  });
}

void lower_column(MeshBuilder& builder) {
  constexpr float kRadius = 0.235f;
  const float y = kAisleFloor;
  builder.box({-0.33f, y, -0.33f}, {0.33f, y + 0.12f, 0.33f}, B::kAllFaces & ~B::kBottom);
  // Attic base: torus, scotia, torus, fillet
  Profile base{{0.28f, y + 0.12f}};
  torus(base, 0.275f, y + 0.121f, y + 0.205f, 4);
  base.insert(base.end(), {{0.262f, y + 0.212f}, {0.248f, y + 0.235f}, {0.258f, y + 0.258f}});
  torus(base, 0.25f, y + 0.262f, y + 0.312f, 3);
  base.insert(base.end(), {{kRadius + 0.006f, y + 0.318f}, {kRadius + 0.006f, y + 0.335f}});
  builder.lathe(kOrigin, base, 20);
  const float neck = kLowerSpring - 0.44f;
  shaft(builder, {y + 0.33f, neck, kRadius, 16, 4, 9});
  Profile ring;
  torus(ring, 0.195f, neck - 0.005f, neck + 0.04f, 3);
  builder.lathe(kOrigin, ring, 20);
  leafy_capital(builder, neck + 0.03f, kLowerSpring - 0.11f, 0.2f);
  builder.box({-0.31f, kLowerSpring - 0.115f, -0.31f}, {0.31f, kLowerSpring + 0.012f, 0.31f});
}

void upper_column(MeshBuilder& builder) {
  constexpr float kRadius = 0.15f;
  const float y = kGalleryFloor;
  builder.box({-0.21f, y, -0.21f}, {0.21f, y + 0.1f, 0.21f}, B::kAllFaces & ~B::kBottom);
  Profile base{{0.18f, y + 0.1f}};
  torus(base, 0.17f, y + 0.101f, y + 0.16f, 3);
  base.insert(base.end(), {{kRadius + 0.005f, y + 0.17f}, {kRadius + 0.005f, y + 0.19f}});
  builder.lathe(kOrigin, base, 16);
  const float neck = kUpperSpring - 0.3f;
  shaft(builder, {y + 0.18f, neck, kRadius, 0, 16, 6});
  const Profile echinus{{0.128f, neck - 0.01f}, {0.15f, neck},         {0.15f, neck + 0.03f},
                        {0.13f, neck + 0.035f}, {0.13f, neck + 0.1f},  {0.16f, neck + 0.15f},
                        {0.21f, neck + 0.2f},   {0.24f, neck + 0.215f}};
  builder.lathe(kOrigin, echinus, 16);
  builder.box({-0.27f, kUpperSpring - 0.09f, -0.27f}, {0.27f, kUpperSpring + 0.012f, 0.27f});
}

}  // namespace

void add_columns(Scene& scene, const Palette& palette) {
  MeshBuilder builder;
  lower_column(builder);
  const int lower = add_mesh(scene, builder, "lower_column", palette.limestone);
  upper_column(builder);
  const int upper = add_mesh(scene, builder, "upper_column", palette.limestone);
  for (const glm::vec3& foot : column_feet()) {
    add_instance(scene, "lower_column", lower, moved(foot.x, 0.0f, foot.z));
    add_instance(scene, "upper_column", upper, moved(foot.x, 0.0f, foot.z));
  }
}

void add_balustrades(Scene& scene, const Palette& palette) {
  constexpr int kBalusters = 7;
  constexpr float kClear = 1.33f;  // half the length of a rail between plinths [m]
  const float y = kGalleryFloor;
  MeshBuilder builder;
  const unsigned sides = B::kAllFaces & ~(B::kLeft | B::kRight);
  builder.box({-kClear, y, -0.09f}, {kClear, y + 0.1f, 0.09f}, sides & ~B::kBottom);
  builder.box({-kClear, y + 0.78f, -0.07f}, {kClear, y + 0.83f, 0.07f}, sides & ~B::kTop);
  builder.box({-kClear, y + 0.83f, -0.11f}, {kClear, y + 0.92f, 0.11f}, sides);
  const Profile baluster{{0.055f, y + 0.1f},  {0.055f, y + 0.14f}, {0.03f, y + 0.17f},
                         {0.062f, y + 0.28f}, {0.066f, y + 0.33f}, {0.03f, y + 0.56f},
                         {0.028f, y + 0.62f}, {0.05f, y + 0.73f},  {0.05f, y + 0.78f}};
  for (int i = 0; i < kBalusters; ++i) {
    const float x = kClear * (2.0f * (i + 0.5f) / kBalusters - 1.0f);
    builder.lathe({x, 0.0f, 0.0f}, baluster, 8);
  }
  const int mesh = add_mesh(scene, builder, "balustrade", palette.limestone);
  for (const glm::vec3& middle : bay_middles()) {
    add_instance(scene, "balustrade", mesh, facing_court(middle));
  }
  // Plinths that take the rails' ends at the columns
  for (const glm::vec3& foot : column_feet()) {
    builder.set_transform(moved(foot.x, 0.0f, foot.z));
    builder.box({-0.19f, y + 0.1f, -0.19f}, {0.19f, y + 0.95f, 0.19f}, B::kAllFaces & ~B::kBottom);
  }
  add(scene, builder, "rail_plinths", palette.limestone);
}

void add_fountain(Scene& scene, const Palette& palette) {
  MeshBuilder builder;
  // An octagonal basin: moulding, rim and inner wall as one profile around an eight-cornered path
  constexpr float kRadius = 1.35f;
  std::array<glm::vec3, 8> octagon;
  for (int i = 0; i < 8; ++i) {
    const float angle = kTwoPi * (static_cast<float>(i) + 0.5f) / 8.0f;
    octagon[i] = {kRadius * std::cos(angle), 0.0f, -kRadius * std::sin(angle)};
  }
  const std::array<glm::vec2, 11> wall{
      glm::vec2(0.12f, 0.0f),  glm::vec2(0.12f, 0.07f), glm::vec2(0.03f, 0.11f),
      glm::vec2(0.0f, 0.14f),  glm::vec2(0.0f, 0.36f),  glm::vec2(0.05f, 0.41f),
      glm::vec2(0.07f, 0.44f), glm::vec2(0.07f, 0.5f),  glm::vec2(-0.3f, 0.5f),
      glm::vec2(-0.3f, 0.44f), glm::vec2(-0.24f, 0.2f)};
  builder.moulding(wall, octagon, true);
  // The stem with its two bowls, up the outside and down the inside of each
  Profile stem{{0.34f, 0.2f}, {0.34f, 0.5f}, {0.24f, 0.54f}, {0.16f, 0.7f}, {0.14f, 0.86f}};
  torus(stem, 0.14f, 0.86f, 0.92f, 3);
  stem.insert(stem.end(), {{0.16f, 0.95f},
                           {0.36f, 1.0f},
                           {0.55f, 1.08f},
                           {0.66f, 1.18f},
                           {0.70f, 1.2f},
                           {0.70f, 1.24f},
                           {0.64f, 1.24f},
                           {0.6f, 1.19f},
                           {0.12f, 1.1f},
                           {0.09f, 1.3f},
                           {0.08f, 1.5f}});
  torus(stem, 0.08f, 1.5f, 1.55f, 3);
  stem.insert(stem.end(), {{0.1f, 1.57f},
                           {0.24f, 1.62f},
                           {0.32f, 1.7f},
                           {0.34f, 1.73f},
                           {0.3f, 1.73f},
                           {0.05f, 1.66f},
                           {0.045f, 1.8f},
                           {0.07f, 1.86f},
                           {0.06f, 1.93f},
                           {0.0f, 1.98f}});
  builder.lathe(kOrigin, stem, 32);
  add(scene, builder, "fountain", palette.limestone);

  const auto pool = [&](float radius, float y, int sides, float turn) {
    builder.surface(sides, 1, true, [&](float s, float t) {
      const float angle = -kTwoPi * (s + turn);
      const float r = radius * (1.0f - t);
      const glm::vec3 p(r * std::cos(angle), y, r * std::sin(angle));
      return B::SurfacePoint{p, {p.x, p.z}};
    });
  };
  pool(1.2f, 0.42f, 8, 0.5f / 8.0f);
  pool(0.61f, 1.205f, 32, 0.0f);
  pool(0.28f, 1.715f, 32, 0.0f);
  add(scene, builder, "water", palette.water);
}

void add_trees(Scene& scene, const Palette& palette) {
  constexpr int kLeaves = 420, kFruits = 9;
  constexpr float kCrown = 0.62f, kCrownHeight = 2.05f;
  const Profile pot{{0.24f, 0.0f}, {0.25f, 0.03f}, {0.32f, 0.3f},  {0.35f, 0.5f}, {0.39f, 0.52f},
                    {0.39f, 0.6f}, {0.345f, 0.6f}, {0.33f, 0.53f}, {0.0f, 0.53f}};
  MeshBuilder builder;
  builder.lathe(kOrigin, pot, 24);
  const int pot_mesh = add_mesh(scene, builder, "pot", palette.terracotta);
  const Profile trunk{{0.05f, 0.52f}, {0.038f, 0.7f}, {0.033f, 1.2f}, {0.025f, 1.9f}, {0.0f, 2.0f}};
  builder.lathe(kOrigin, trunk, 8);
  const int trunk_mesh = add_mesh(scene, builder, "trunk", palette.wood);

  // Leaves fill a ball, most of them near its surface and turned outwards.
  RandomStream random = make_random_stream(0, 0, 7);
  const auto in_crown = [&](float inner) {
    const vec3 direction = sample_uniform_sphere(next_uniform2(random));
    return direction * kCrown * glm::mix(inner, 1.0f, std::sqrt(next_uniform(random)));
  };
  for (int i = 0; i < kLeaves; ++i) {
    const vec3 place = in_crown(0.45f);
    const vec3 scatter = sample_uniform_sphere(next_uniform2(random));
    const Frame frame = make_frame(glm::normalize(glm::normalize(place) + 0.9f * scatter));
    const float turn = kTwoPi * next_uniform(random);
    const vec3 along = std::cos(turn) * frame.tangent + std::sin(turn) * frame.bitangent;
    const vec3 across = glm::cross(frame.normal, along);
    const vec3 centre = vec3(0.0f, kCrownHeight, 0.0f) + place;
    const float length = glm::mix(0.06f, 0.1f, next_uniform(random)), width = 0.38f * length;
    builder.quad(centre - along * length, centre + across * width, centre + along * length,
                 centre - across * width);
  }
  const int leaf_mesh = add_mesh(scene, builder, "leaves", palette.leaf);
  for (int i = 0; i < kFruits; ++i) {
    const vec3 centre = vec3(0.0f, kCrownHeight, 0.0f) + in_crown(0.9f);
    constexpr float kFruit = 0.042f;
    const Profile round{{0.0f, -kFruit},
                        {0.7f * kFruit, -0.7f * kFruit},
                        {kFruit, 0.0f},
                        {0.7f * kFruit, 0.7f * kFruit},
                        {0.0f, kFruit}};
    builder.lathe(centre, round, 8);
  }
  const int fruit_mesh = add_mesh(scene, builder, "oranges", palette.orange);

  constexpr float kFromStep = 1.15f;
  int turn = 0;
  for (const float x : {-kCourtX + kFromStep, kCourtX - kFromStep}) {
    for (const float z : {-kCourtZ + kFromStep, kCourtZ - kFromStep}) {
      const glm::mat4 place =
          glm::rotate(moved(x, 0.0f, z), 1.3f * static_cast<float>(++turn), {0.0f, 1.0f, 0.0f});
      add_instance(scene, "pot", pot_mesh, place);
      add_instance(scene, "trunk", trunk_mesh, place);
      add_instance(scene, "leaves", leaf_mesh, place);
      add_instance(scene, "oranges", fruit_mesh, place);
    }
  }
}

}  // namespace lambent::scenes::atrium
