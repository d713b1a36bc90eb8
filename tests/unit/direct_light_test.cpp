// SPDX-License-Identifier: Apache-2.0
// Direct light of emissive surfaces near what they light.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "raytracing/shade_hits.h"
#include "shared/constants.h"
#include "support/hand_made.h"

namespace lambent::direct_light_test {
namespace {

constexpr float kRadiance = 12.0f;  // [W/(m^2 sr)]

struct Samples {
  double mean = 0.0, largest = 0.0;  // [W/m^2]
};

/// Samples of the irradiance of a ceiling `gap` above the middle of a square lamp with an edge of
/// 1 m. The lamp's middle is at `place`.
Samples irradiance_above_lamp(const glm::vec3& place, float gap) {
  Scene scene;
  scene.materials = {test::lambert(glm::vec3(0.5f)),
                     test::lambert(glm::vec3(0.0f), glm::vec3(kRadiance))};
  const glm::vec3 x(1.0f, 0.0f, 0.0f), z(0.0f, 0.0f, 1.0f);
  test::add(scene, test::quad(place - 0.5f * x - 0.5f * z, x, z, 1));
  const glm::vec3 above = place + glm::vec3(0.0f, gap, 0.0f);
  test::add(scene, test::quad(above - 2.0f * x - 2.0f * z, 4.0f * x, 4.0f * z, 0));
  const World world(scene);
  const glm::vec3 down(0.0f, -1.0f, 0.0f);
  std::vector<DirectLightQuery> queries;
  for (std::size_t i = 0; i < 20000; ++i) queries.push_back({{above, down, down}, i});
  std::vector<glm::vec3> irradiance(queries.size());
  ShadeHitsScratch scratch;
  direct_irradiance(world, queries, {}, scratch, irradiance);
  Samples samples;
  for (const glm::vec3& e : irradiance) {
    samples.mean += e.x / static_cast<double>(queries.size());
    samples.largest = std::max(samples.largest, static_cast<double>(e.x));
  }
  return samples;
}

/// The same in closed form: the form factor of a square seen from above its middle.
double expected_above_lamp(float gap) {
  const double a = 0.5 / gap, share = a / std::sqrt(1.0 + a * a);
  return kPi * kRadiance * 4.0 / kPi * share * std::atan(share);
}

TEST(DirectLight, OfALampCloseToASurfaceIsThatOfTheClosedForm) {
  // Shadow rays start off the surface, by the more the farther it is from the world's origin
  for (const glm::vec3& place :
       {glm::vec3(0.0f), glm::vec3(0.3f, 2.9f, -0.2f), glm::vec3(50.0f, 20.0f, -70.0f)}) {
    for (const float gap : {0.05f, 0.1f, 0.5f}) {
      const double expected = expected_above_lamp(gap);
      // Three standard errors
      EXPECT_NEAR(irradiance_above_lamp(place, gap).mean, expected, 0.005 * expected)
          << place.y << " m up, gap " << gap;
    }
  }
}

TEST(DirectLight, OfALampCloseToASurfaceIsBounded) {
  // Points drawn by power, seen 1 cm away, are worth up to 3,000 times the mean
  constexpr double kLargestOverMean = 2.0;
  for (const float gap : {0.001f, 0.01f, 0.1f, 1.0f}) {
    const Samples samples = irradiance_above_lamp(glm::vec3(0.0f, 2.9f, 0.0f), gap);
    EXPECT_LT(samples.largest, kLargestOverMean * samples.mean) << "gap " << gap;
  }
}

}  // namespace
}  // namespace lambent::direct_light_test
