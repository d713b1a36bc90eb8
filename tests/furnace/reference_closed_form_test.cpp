// SPDX-License-Identifier: Apache-2.0
// The reference against radiance that is known in closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "reference/path_tracer.h"
#include "shared/constants.h"
#include "support/hand_made.h"

namespace lambent::reference_closed_form_test {
namespace {

using test::add;
using test::add_room;
using test::lambert;
using test::point_light;
using test::quad;
using test::sun;

constexpr std::uint32_t kSeed = 7;
// An estimate may stray this many of its standard errors: 1 in 15,000 if it is right, and tests are
// deterministic.
constexpr float kSigmas = 4.0f;

void expect_near(const Estimate& estimate, float expected, float relative_tolerance) {
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(estimate.mean[k] / expected, 1.0f, relative_tolerance);
    EXPECT_LT(std::abs(estimate.mean[k] - expected),
              kSigmas * estimate.standard_error[k] + 1e-4f * expected);
  }
}

Estimate irradiance(const World& world, const SurfacePoint& point, int samples,
                    LightKind which = LightKind::all) {
  return reference_irradiance(world, {&point, 1}, samples, kSeed, which)[0];
}

TEST(ReferenceFurnace, ClosedRoomHoldsTheRadianceOfTheGeometricSeries) {
  for (const float albedo : {0.2f, 0.5f, 0.9f}) {
    Scene scene;
    scene.materials = {lambert(glm::vec3(albedo), glm::vec3(1.0f))};
    add_room(scene, 2.0f, 0);
    const World world(scene);
    const Ray ray{
        {0.1f, 0.2f, 0.3f}, 0.0f, glm::normalize(glm::vec3(0.3f, -0.5f, 1.0f)), kInfiniteDistance};
    expect_near(reference_radiance(world, ray, 1 << 14, kSeed), 1.0f / (1.0f - albedo), 0.005f);
  }
}

TEST(ReferenceFurnace, EverySplitOfTheImageAddsUpInAClosedRoom) {
  Scene scene;
  scene.materials = {lambert(glm::vec3(0.5f), glm::vec3(1.0f))};
  add_room(scene, 2.0f, 0);
  const World world(scene);
  const Camera camera = look_at({0.0f, 0.0f, 0.5f}, {0.2f, 0.1f, -1.0f}, 1.0f);
  ReferenceSettings settings;
  settings.width = settings.height = 16;
  settings.samples = 256;
  const ReferenceResult result = render_reference(world, camera, settings);
  const auto mean = [&](const char* layer) {
    const Image& image = *result.image.find(layer);
    double sum = 0.0;
    for (const float value : image.pixels) sum += value;
    return sum / static_cast<double>(image.pixels.size());
  };
  // Emitted 1; of the light pi that arrives directly half is reflected; the rest of the series is
  // indirect
  EXPECT_NEAR(mean("emission"), 1.0, 1e-6);
  EXPECT_NEAR(mean("direct"), 0.5, 0.0025);
  EXPECT_NEAR(mean("indirect"), 0.5, 0.0025);
  EXPECT_NEAR(mean("irradiance"), kPi, 0.016);
  EXPECT_EQ(mean("glossy"), 0.0);
  EXPECT_NEAR(mean("albedo"), 0.5, 1e-6);
  EXPECT_NEAR(mean(""), 2.0, 0.01);
}

TEST(ReferenceFurnace, ConvexObjectUnderAConstantSkyShowsItsAlbedo) {
  Scene scene;
  scene.materials = {lambert(glm::vec3(0.2f, 0.5f, 0.8f))};
  add(scene, test::sphere(1.0f, 64, 0));
  scene.environment.radiance = glm::vec3(2.0f);
  const World world(scene);
  const Ray ray{
      {0.0f, 0.0f, 5.0f}, 0.0f, glm::normalize(glm::vec3(0.1f, 0.05f, -1.0f)), kInfiniteDistance};
  const Estimate estimate = reference_radiance(world, ray, 4096, kSeed);
  EXPECT_NEAR(estimate.mean.x, 0.4f, 0.002f);
  EXPECT_NEAR(estimate.mean.y, 1.0f, 0.005f);
  EXPECT_NEAR(estimate.mean.z, 1.6f, 0.008f);
}

TEST(ReferenceClosedForm, DirectionalLightIsExact) {
  Scene scene;
  scene.materials = {lambert(glm::vec3(0.5f))};
  add(scene, quad({-1.0f, 0.0f, -1.0f}, {0.0f, 0.0f, 2.0f}, {2.0f, 0.0f, 0.0f}, 0));
  scene.lights = {sun(glm::vec3(10.0f), {0.0f, -0.8f, 0.6f})};
  const World world(scene);
  const Ray ray{{0.1f, 2.0f, 0.2f}, 0.0f, {0.0f, -1.0f, 0.0f}, kInfiniteDistance};
  EXPECT_NEAR(reference_radiance(world, ray, 4, kSeed).mean.x, 0.5f * kInvPi * 8.0f, 1e-5f);
}

TEST(ReferenceClosedForm, PointLightFollowsTheInverseSquare) {
  Scene scene;
  scene.materials = {lambert(glm::vec3(0.5f))};
  scene.lights = {point_light(glm::vec3(30.0f), {0.0f, 3.0f, 0.0f})};
  const World world(scene);
  const SurfacePoint point{{4.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}};
  EXPECT_NEAR(irradiance(world, point, 4).mean.x, 30.0f / 25.0f * 0.6f, 1e-5f);
}

TEST(ReferenceClosedForm, PointLightOnASurfaceOfItsLampLightsTheRoom) {
  // Around places with other rounding of coordinates: both sides of the cap are lit
  for (const float height : {3.0f, 3.3f, 2.77f}) {
    Scene scene;
    scene.materials = {lambert(glm::vec3(0.5f))};
    add(scene, quad({-0.1f, height, -0.1f}, {0.0f, 0.0f, 0.2f}, {0.2f, 0.0f, 0.0f}, 0));
    scene.lights = {point_light(glm::vec3(30.0f), {0.0f, height, 0.0f})};
    const World world(scene);
    const float distance = std::hypot(4.0f, height);
    const float expected = 30.0f * height / (distance * distance * distance);
    const SurfacePoint below{{4.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}};
    EXPECT_NEAR(irradiance(world, below, 4).mean.x, expected, 1e-4f) << height;
    const SurfacePoint above{{4.0f, 2.0f * height, 0.0f}, {0.0f, -1.0f, 0.0f}};
    EXPECT_NEAR(irradiance(world, above, 4).mean.x, expected, 1e-4f) << height;
  }
}

TEST(ReferenceClosedForm, SpotLightFadesBetweenItsCones) {
  Scene scene;
  scene.materials = {lambert(glm::vec3(0.5f))};
  Light light = point_light(glm::vec3(30.0f), {0.0f, 2.0f, 0.0f});
  light.type = Light::Type::spot;
  light.direction_ws = {0.0f, -1.0f, 0.0f};
  light.inner_cone_angle = 0.2f;
  light.outer_cone_angle = 0.5f;
  scene.lights = {light};
  const World world(scene);
  for (const float angle : {0.0f, 0.1f, 0.3f, 0.45f, 0.6f}) {
    const SurfacePoint point{{2.0f * std::tan(angle), 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}};
    const float cosine = std::cos(angle);
    const float fade =
        std::clamp((cosine - std::cos(0.5f)) / (std::cos(0.2f) - std::cos(0.5f)), 0.0f, 1.0f);
    const float distance = 2.0f / cosine;
    const float expected = 30.0f * fade * fade * cosine / (distance * distance);
    EXPECT_NEAR(irradiance(world, point, 4).mean.x, expected, 1e-4f) << angle;
  }
}

TEST(ReferenceClosedForm, ManyLightsAddUp) {
  Scene scene;
  scene.materials = {lambert(glm::vec3(0.5f))};
  float expected = 0.0f;
  for (int i = 0; i < 20; ++i) {
    const float height = 1.0f + 0.25f * static_cast<float>(i);
    scene.lights.push_back(point_light(glm::vec3(3.0f), {0.0f, height, 0.0f}));
    expected += 3.0f / (height * height);
  }
  const World world(scene);
  const Estimate estimate = irradiance(world, {{0.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}}, 64);
  // Drawn in proportion to what they send, unoccluded lights leave no noise
  EXPECT_NEAR(estimate.mean.x / expected, 1.0f, 1e-5f);
}

// Mean over the unit square of the floor of the irradiance from another of radiance 1 is pi times
// the form factor.
Estimate form_factor(const World& world, reference::Strategy strategy) {
  constexpr int kGrid = 128;
  std::vector<SurfacePoint> points;
  for (int y = 0; y < kGrid; ++y) {
    for (int x = 0; x < kGrid; ++x) {
      const glm::vec2 u((static_cast<float>(x) + 0.5f) / kGrid,
                        (static_cast<float>(y) + 0.5f) / kGrid);
      points.push_back({{u.x, 0.0f, u.y}, {0.0f, 1.0f, 0.0f}});
    }
  }
  const std::vector<Estimate> estimates =
      reference_irradiance(world, points, 64, kSeed, LightKind::all, strategy);
  glm::dvec3 sum(0.0), variance(0.0);
  for (const Estimate& e : estimates) {
    sum += e.mean;
    variance += e.standard_error * e.standard_error;
  }
  const double count = kPi * kGrid * kGrid;
  return {sum / count, glm::sqrt(variance) / count};
}

Scene one_emitter(const glm::vec3& corner, const glm::vec3& a, const glm::vec3& b) {
  Scene scene;
  scene.materials = {lambert(glm::vec3(0.0f), glm::vec3(1.0f))};
  add(scene, quad(corner, a, b, 0));
  return scene;
}

constexpr float kParallelSquares = 0.1998249f;
constexpr float kPerpendicularSquares = 0.2000438f;

Scene ceiling_square() {
  return one_emitter({0.0f, 1.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 1.0f});
}
Scene wall_square() {
  return one_emitter({0.0f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f});
}

TEST(ReferenceFormFactor, OfParallelUnitSquaresIsWithinTwoPerMille) {
  const Scene scene = ceiling_square();
  const World world(scene);
  const Estimate f = form_factor(world, reference::Strategy::combined);
  EXPECT_NEAR(f.mean.x / kParallelSquares, 1.0f, 0.002f);
}

TEST(ReferenceFormFactor, OfPerpendicularUnitSquaresIsWithinTwoPerMille) {
  const Scene scene = wall_square();
  const World world(scene);
  const Estimate f = form_factor(world, reference::Strategy::combined);
  EXPECT_NEAR(f.mean.x / kPerpendicularSquares, 1.0f, 0.002f);
}

TEST(ReferenceFormFactor, IsTheSameForEveryStrategy) {
  const Scene scene = ceiling_square();
  const World world(scene);
  for (const auto strategy : {reference::Strategy::scatter, reference::Strategy::light}) {
    const Estimate f = form_factor(world, strategy);
    EXPECT_LT(std::abs(f.mean.x - kParallelSquares), kSigmas * f.standard_error.x);
    EXPECT_LT(f.standard_error.x, 0.005f * kParallelSquares);
  }
}

// Lambert 1760: irradiance from a polygon of radiance 1 that lies above the horizon.
double polygon_irradiance(const glm::dvec3& point, const glm::dvec3& normal,
                          const std::vector<glm::dvec3>& corners) {
  double sum = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec3 a = glm::normalize(corners[i] - point);
    const glm::dvec3 b = glm::normalize(corners[(i + 1) % corners.size()] - point);
    const glm::dvec3 axis = glm::cross(a, b);
    const double length = glm::length(axis);
    sum += std::atan2(length, glm::dot(a, b)) * glm::dot(normal, axis / length);
  }
  return std::abs(sum) / 2.0;
}

TEST(ReferenceClosedForm, PolygonLightFollowsLambertsFormula) {
  const Scene scene = one_emitter({2.13f, 5.488f, 2.27f}, {1.3f, 0.0f, 0.0f}, {0.0f, 0.0f, 1.05f});
  const World world(scene);
  const std::vector<glm::dvec3> corners = {
      {2.13, 5.488, 2.27}, {3.43, 5.488, 2.27}, {3.43, 5.488, 3.32}, {2.13, 5.488, 3.32}};
  // On the walls around the lamp, from well below it to where it is seen at a grazing angle
  for (const float height : {1.0f, 4.0f, 5.2f, 5.4f}) {
    const SurfacePoint points[2] = {{{0.03f, height, 5.59f}, {0.0f, 0.0f, -1.0f}},
                                    {{0.0f, height, 1.7f}, {1.0f, 0.0f, 0.0f}}};
    for (const SurfacePoint& point : points) {
      const double expected = polygon_irradiance(point.position_ws, point.normal_ws, corners);
      EXPECT_NEAR(irradiance(world, point, 1 << 12).mean.x / expected, 1.0, 0.005) << height;
    }
  }
}

TEST(ReferenceClosedForm, CubeLitFromItsCentreMatchesSolvedRadiosity) {
  Scene scene;
  scene.materials = {lambert(glm::vec3(2.0f / 3.0f))};
  add_room(scene, 10.0f, 0);
  scene.lights = {point_light(glm::vec3(50000.0f), {0.0f, 0.0f, 0.0f})};
  const World world(scene);
  struct Row {
    float x, y, radiance;
  };
  for (const Row& row : {Row{0, 0, 892.80f}, Row{2, 0, 806.05f}, Row{4, 0, 656.90f},
                         Row{2, 2, 741.61f}, Row{4, 2, 619.72f}, Row{4, 4, 533.65f}}) {
    const Estimate e = irradiance(world, {{row.x, row.y, -5.0f}, {0.0f, 0.0f, 1.0f}}, 1 << 14);
    EXPECT_NEAR(e.mean.x * (2.0f / 3.0f) * kInvPi / row.radiance, 1.0f, 0.005f)
        << row.x << "," << row.y;
  }
}

}  // namespace
}  // namespace lambent::reference_closed_form_test
