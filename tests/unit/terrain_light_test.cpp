// SPDX-License-Identifier: Apache-2.0
// The light of first pictures of terrains on which nothing stands.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "lambent/first_picture.h"
#include "lambent/world.h"
#include "support/box_scenes.h"
#include "support/hand_made.h"

namespace lambent::terrain_light_test {
namespace {

// Number of squares along each edge of a tile.
constexpr int kSquares = 48;

/// A round tile of a quarry, 2 wide and 0.3 high, scaled; with an underside 0.1 below, where it is
/// that of a thing.
Scene quarry(float scale, bool has_underside = false) {
  Mesh mesh;
  const auto place = [](int i) { return 2.0f * static_cast<float>(i) / kSquares - 1.0f; };
  for (const float below : {0.0f, 0.1f}) {
    for (int z = 0; z <= kSquares; ++z) {
      for (int x = 0; x <= kSquares; ++x) {
        // Terraces that rise to all sides
        const float radius = std::hypot(place(x), place(z));
        const float height = 0.1f * std::floor(3.9f * std::min(radius, 1.0f));
        mesh.positions.push_back(scale * glm::vec3(place(x), height - below, place(z)));
        mesh.normals.emplace_back(0.0f, below > 0.0f ? -1.0f : 1.0f, 0.0f);
      }
    }
  }
  constexpr unsigned kRow = kSquares + 1, kSheet = kRow * kRow;
  for (int z = 0; z < kSquares; ++z) {
    for (int x = 0; x < kSquares; ++x) {
      if (std::hypot(place(x) + 1.0f / kSquares, place(z) + 1.0f / kSquares) > 1.0f) continue;
      const unsigned a = static_cast<unsigned>(z) * kRow + static_cast<unsigned>(x);
      const unsigned b = a + 1, c = a + kRow, d = c + 1;
      mesh.triangles.insert(mesh.triangles.end(), {{a, c, d}, {a, d, b}});
      if (!has_underside) continue;
      mesh.triangles.insert(mesh.triangles.end(), {{a + kSheet, d + kSheet, c + kSheet},
                                                   {a + kSheet, b + kSheet, d + kSheet}});
    }
  }
  return test::scene_of({std::move(mesh)});
}

FirstLight light_of(const Scene& scene) {
  const World world(scene);
  const FirstView view = first_view(world).value();
  EXPECT_FALSE(view.inside);
  return choose_first_light(world, view.camera);
}

TEST(FirstLight, IsTheSunsOnATileOfATerrain) {
  EXPECT_EQ(light_of(quarry(90.0f)), FirstLight::sun);
  EXPECT_EQ(light_of(quarry(9000.0f)), FirstLight::sun) << "in centimetres";
  Scene unlit = quarry(90.0f);
  unlit.materials[0].unlit = true;
  EXPECT_EQ(light_of(unlit), FirstLight::sun) << "its sky is seen around it";
}

TEST(FirstLight, IsAStudioForAReliefAndADish) {
  EXPECT_EQ(light_of(quarry(0.1f)), FirstLight::studio) << "a relief of 20 cm";
  EXPECT_EQ(light_of(quarry(100.0f, true)), FirstLight::studio)
      << "a dish of 20 cm, in millimetres";
}

}  // namespace
}  // namespace lambent::terrain_light_test
