// SPDX-License-Identifier: Apache-2.0
// Light of all bounces in fog: from irradiance back to radiance, scattered.
#include <gtest/gtest.h>

#include "fog/ambient.h"

namespace lambent::fog_ambient_test {
namespace {

float second_legendre(float cosine) {
  return 0.5f * (3.0f * cosine * cosine - 1.0f);
}

// Radiance 3 + c + 2 P2(c) by the cosine c to an axis has irradiance 3 pi + 2 pi / 3 c + pi / 2
// P2(c), and fog takes the bands 1, g and g^2 times.
TEST(FogAmbient, ScattersTheBandsOfRadiance) {
  const vec3 axis = normalize(vec3(0.3f, -0.5f, 0.8f));
  for (const vec3& direction :
       {axis, -axis, normalize(vec3(1.0f, 0.2f, -0.4f)), vec3(0.0f, 1.0f, 0.0f)}) {
    AmbientIrradiance ambient = {vec3(0.0f), vec3(0.0f), vec3(0.0f), 1.0f};
    const Frame frame = make_frame(direction);
    for (int i = 0; i < kAmbientDirections; ++i) {
      const float cosine = dot(ambient_direction(frame, i), axis);
      const float irradiance = kPi * (3.0f + 2.0f / 3.0f * cosine + 0.5f * second_legendre(cosine));
      // In two halves, as probes answer
      for (int half = 0; half < 2; ++half) add_ambient(ambient, i, vec3(irradiance), 0.5f);
    }
    const float along = dot(direction, axis);
    for (const float g : {0.0f, 0.6f, -0.3f, 0.9f}) {
      const float truth = 3.0f + g * along + g * g * 2.0f * second_legendre(along);
      EXPECT_NEAR(ambient_source(ambient, g).x, truth, 1e-4f) << g;
    }
  }
}

TEST(FogAmbient, IsNeverNegative) {
  AmbientIrradiance ambient = {vec3(1.0f), vec3(-5.0f), vec3(0.0f), 1.0f};
  EXPECT_EQ(ambient_source(ambient, 0.9f), vec3(0.0f));
}

}  // namespace
}  // namespace lambent::fog_ambient_test
