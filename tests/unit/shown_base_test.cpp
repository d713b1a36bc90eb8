// SPDX-License-Identifier: Apache-2.0
// Which hits of a mirror's paths are the surface that it shows.
#include <gtest/gtest.h>

#include "glossy/path_math.h"

namespace lambent {
namespace {

const vec3 kUp(0.0f, 1.0f, 0.0f);

Reflectance coat_of(float alpha) {
  Reflectance surface = lambert_reflectance(vec3(0.0f));
  surface.alpha = alpha;
  surface.f0 = vec3(0.9f);
  surface.f90 = 1.0f;
  return surface;
}

CoatPath from_mirror(float alpha) {
  return begin_path(1.0f, alpha, kStageOwnMirror, 0.0f);
}

/// The path that a sharp mirror's ray becomes where a coat reflects it.
CoatPath reflected_by(const Reflectance& coat) {
  CoatPath path = from_mirror(0.0001f);
  extend_by_reflection(coat, {1.0f, 0.0f}, kUp, kUp, glm::normalize(vec3(0.3f, 1.0f, 0.2f)), 0.0f,
                       vec2(0.4f, 0.6f), path);
  return path;
}

bool shows_a_wall(const CoatPath& path) {
  return is_in_own_mirror(path, no_transmission(), lambert_reflectance(vec3(0.7f)));
}

TEST(ShownBase, IsOfTheFirstSurfaceWithABase) {
  EXPECT_TRUE(shows_a_wall(from_mirror(0.0001f)));
  EXPECT_FALSE(is_in_own_mirror(from_mirror(0.0001f), no_transmission(), coat_of(0.0001f)));
  EXPECT_TRUE(shows_a_wall(reflected_by(coat_of(0.0001f)))) << "in a further mirror";
  Reflectance polished = coat_of(0.0001f);
  polished.diffuse = vec3(0.5f);
  EXPECT_FALSE(shows_a_wall(reflected_by(polished))) << "the polished floor has them";
}

TEST(ShownBase, IsNotOfWideLobes) {
  EXPECT_FALSE(shows_a_wall(reflected_by(coat_of(0.04f))));
  EXPECT_FALSE(shows_a_wall(from_mirror(0.009f)));
}

}  // namespace
}  // namespace lambent
