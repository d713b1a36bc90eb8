// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "lambent/rsm.h"
#include "rsm/maps/projection.h"
#include "rsm/pattern.h"
#include "rsm/texel_light.h"
#include "shared/sampling.h"
#include "support/field_scenes.h"
#include "support/hand_made.h"
#include "support/made_view.h"

namespace lambent::rsm_gather_test {
namespace {

using test::Stage;

/// Points of a wall, some of which see nothing.
struct WallView : test::MadeView {
  WallView(int w, int h, float spacing = 0.1f) : MadeView(w, h) {
    for (int y = 0; y < h; ++y) {
      for (int x = 0; x < w; ++x) {
        const bool seen = (x * 7 + y * 3) % 11 != 0;
        add(spacing * vec3(x, y, 0), seen ? vec3(0.0f, 0.0f, 1.0f) : vec3(0.0f),
            seen ? 2.0f : 0.0f);
      }
    }
  }
};

/// A map of one texel that faces the wall of WallView from a metre away.
ReflectiveShadowMap single_texel() {
  ReflectiveShadowMap map;
  map.resolution = 1;
  map.texels.resize(1);
  map.texels[0].position_ws = vec3(0.4f, 0.3f, 1.0f);
  map.texels[0].normal_ws = normalize(vec3(0.2f, -0.1f, -1.0f));
  map.texels[0].area = 1e-6f;
  map.texels[0].softening = kSofteningPerArea * 1e-6f;
  map.texels[0].flux = vec3(3.0f, 2.0f, 1.0f);
  return map;
}

RsmIrradiance gather(std::span<const ReflectiveShadowMap> maps, const RsmView& view,
                     const RsmSettings& settings) {
  static const Scene empty;
  static const World world(empty);
  RsmIrradiance result;
  EXPECT_TRUE(RsmGatherer().gather(world, maps, view, settings, result));
  return result;
}

TEST(RsmGather, OfASingleTexelIsTheClosedForm) {
  const ReflectiveShadowMap map = single_texel();
  const WallView wall(9, 7);
  for (const RsmLayout layout : {RsmLayout::full, RsmLayout::restructured}) {
    RsmSettings settings = plain_gather();
    settings.layout = layout;
    settings.texels = 1;
    const RsmIrradiance light = gather({&map, 1}, wall.view(), settings);
    for (std::size_t i = 0; i < wall.positions.size(); ++i) {
      // E = flux / pi * cos * cos / d^2
      const vec3 way = map.texels[0].position_ws - wall.positions[i];
      const float d2 = dot(way, way), d = std::sqrt(d2);
      const float expected =
          wall.normals[i] == vec3(0.0f)
              ? 0.0f
              : 3.0f * kInvPi * (way.z / d) * (-dot(map.texels[0].normal_ws, way) / d) / d2;
      EXPECT_NEAR(light.irradiance[i].x, expected, 1e-5f * expected);
      EXPECT_NEAR(light.irradiance[i].z, expected / 3.0f, 1e-5f * expected);
    }
  }
}

/// A map of a lit patch of floor before the wall, of many texels.
ReflectiveShadowMap floor_map(int resolution) {
  ReflectiveShadowMap map;
  map.resolution = resolution;
  const float edge = 2.0f / static_cast<float>(resolution);
  for (int y = 0; y < resolution; ++y) {
    for (int x = 0; x < resolution; ++x) {
      RsmTexel texel;
      texel.position_ws = vec3((static_cast<float>(x) + 0.5f) * edge - 0.2f, -0.05f,
                               (static_cast<float>(y) + 0.5f) * edge);
      texel.normal_ws = vec3(0.0f, 1.0f, 0.0f);
      texel.area = edge * edge;
      texel.softening = kSofteningPerArea * texel.area;
      texel.flux = vec3(1.0f, 0.8f, 0.5f) * texel.area;
      map.texels.push_back(texel);
    }
  }
  return map;
}

TEST(RsmGather, IsTheSameToTheBitInEveryLayout) {
  const ReflectiveShadowMap map = floor_map(45);
  for (const ivec2 size : {ivec2(1, 1), ivec2(37, 23), ivec2(64, 16)}) {
    const WallView wall(size.x, size.y);
    for (const int n : {3, 4}) {
      for (const RsmPattern pattern : {RsmPattern::whole, RsmPattern::disk}) {
        RsmSettings settings;
        settings.sub_maps = settings.sub_images = n;
        settings.texels = 100;
        settings.pattern = pattern;
        settings.sub_blur_radius = 2;
        settings.irregular_blur = true;
        const auto restructured = gather({&map, 1}, wall.view(), settings).irradiance;
        settings.layout = RsmLayout::sub_maps;
        EXPECT_EQ(gather({&map, 1}, wall.view(), settings).irradiance, restructured) << n;
        settings.layout = RsmLayout::full;
        EXPECT_EQ(gather({&map, 1}, wall.view(), settings).irradiance, restructured) << n;
      }
    }
  }
}

TEST(RsmGather, ComesNearTheExhaustiveOneWithFewTexelsAPixel) {
  const ReflectiveShadowMap map = floor_map(128);
  WallView wall(64, 48, 0.02f);
  for (vec3& normal : wall.normals) normal = vec3(0.0f, 0.0f, 1.0f);
  for (float& depth : wall.depths) depth = 2.0f;
  RsmSettings all = plain_gather();
  all.texels = 0;
  const auto truth = gather({&map, 1}, wall.view(), all).irradiance;
  const auto light = gather({&map, 1}, wall.view(), {}).irradiance;
  double error = 0.0, sum = 0.0, mean = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    error += std::pow(light[i].x - truth[i].x, 2.0);
    sum += truth[i].x;
    mean += light[i].x;
  }
  const double count = static_cast<double>(truth.size());
  EXPECT_LT(std::sqrt(error / count) / (sum / count), 0.05);
  EXPECT_NEAR(mean / sum, 1.0, 0.01);
}

TEST(RsmGeometry, BoundsLightWithoutLosingAnyBetweenFacingPlanes) {
  // A texel at height h over an infinite plane that it faces sends all of its light there
  for (const float softening : {0.01f, 1.0f, 25.0f}) {
    double sum = 0.0;
    constexpr int kSteps = 200000;
    constexpr float kFarthest = 2000.0f;
    for (int i = 0; i < kSteps; ++i) {
      // Radii in proportion to the square of the step, so that the middle is sampled densely
      const double a = kFarthest * std::pow(i / double{kSteps}, 2.0);
      const double b = kFarthest * std::pow((i + 1) / double{kSteps}, 2.0);
      const auto r = static_cast<float>(0.5 * (a + b));
      sum += kPi * (b * b - a * a) *
             bounded_geometry_term(vec3(r, 0.0f, 0.0f), vec3(0.0f, 1.0f, 0.0f),
                                   vec3(0.0f, 1.0f, 0.0f), vec3(0.0f, -1.0f, 0.0f), softening);
    }
    EXPECT_NEAR(sum, 1.0, 2e-3) << softening;
  }
}

TEST(RsmGeometry, LosesNoLightOnAverageInACorner) {
  // Floor and wall share an edge; texels at distance a light the wall at height y, and half of each
  // texel's light belongs on the wall. Along the edge the terms are summed with a step of ds
  constexpr double kExtent = 60.0, kStep = 0.2, kSoftening = 1.0;
  const vec3 up(0.0f, 1.0f, 0.0f), out(1.0f, 0.0f, 0.0f);
  double bounded = 0.0, unbounded = 0.0;
  for (double a = 0.5 * kStep; a < kExtent; a += kStep) {
    for (double y = 0.5 * kStep; y < kExtent; y += kStep) {
      // Integrals along the edge in closed form: of 1 / (D^2 + z^2 + e)^2, pi / (2 (D^2 + e)^1.5)
      const double d2 = a * a + y * y;
      const vec3 point(0.0f, static_cast<float>(y), 0.0f), texel(static_cast<float>(a), 0.0f, 0.0f);
      const double term = bounded_geometry_term(point, out, texel, up, kSoftening);
      bounded +=
          term * std::pow(d2 + kSoftening, 2.0) * kPi / (2.0 * std::pow(d2 + kSoftening, 1.5));
      unbounded += geometry_term(point, out, texel, up) * d2 * d2 * kPi / (2.0 * std::pow(d2, 1.5));
    }
  }
  // What is far from the corner differs by e / d^2 and is cut off by the extent
  EXPECT_NEAR(bounded / unbounded, 1.0, 0.005);
}

TEST(RsmGeometry, IsThePublishedTermFarAway) {
  const vec3 point(0.1f, 0.2f, 0.3f), n = normalize(vec3(0.1f, 0.2f, 1.0f));
  const vec3 texel(3.0f, -1.0f, 9.0f), m = normalize(vec3(-0.3f, 0.1f, -1.0f));
  const float exact = geometry_term(point, n, texel, m);
  EXPECT_GT(exact, 0.0f);
  EXPECT_NEAR(bounded_geometry_term(point, n, texel, m, 1e-4f) / exact, 1.0f, 1e-4f);
}

TEST(RsmPattern, WeighsADiskByItsArea) {
  double sum = 0.0;
  for (uint i = 0; i < 500; ++i) {
    const DiskSample sample = disk_sample(i, 500, 20.0f);
    EXPECT_LE(length(sample.offset), 20.0f);
    sum += sample.weight;
  }
  EXPECT_NEAR(sum, 400.0 * kPi, 1e-2 * sum);
}

TEST(RsmProjection, SharesTheSphereAmongTheTexelsOfAnOctahedralMap) {
  double sum = 0.0;
  constexpr int kSize = 256;
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      sum += octahedral_solid_angle(texel_middle(x, y, kSize)) * 4.0 / (kSize * kSize);
    }
  }
  EXPECT_NEAR(sum, 4.0 * kPi, 1e-3);
}

TEST(RsmProjection, GivesASpotsMapTheSolidAngleOfItsPyramid) {
  double sum = 0.0;
  constexpr int kSize = 256;
  const vec2 half(1.0f);  // 45 degrees: a face of the cube, a sixth of the sphere
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      sum += perspective_solid_angle(texel_middle(x, y, kSize), half) * 4.0 / (kSize * kSize);
    }
  }
  EXPECT_NEAR(sum, 4.0 * kPi / 6.0, 1e-3);
}

double total_flux(const ReflectiveShadowMap& map) {
  double sum = 0.0;
  for (const RsmTexel& texel : map.texels) sum += texel.flux.x;
  return sum;
}

/// A room of albedo 0.5, 2 m wide, with one light.
Scene lit_room(const Light& light) {
  Scene scene;
  scene.materials.push_back(test::lambert(vec3(0.5f)));
  test::add_room(scene, 2.0f, 0);
  scene.lights.push_back(light);
  return scene;
}

TEST(RsmMap, OfAPointLightInAClosedRoomReflectsItsAlbedoOfAllItsLight) {
  const Stage stage(lit_room(test::point_light(vec3(1.0f), vec3(0.3f, -0.2f, 0.1f))));
  const ReflectiveShadowMap map = render_rsm(stage.world, stage.scene.lights[0], {}).value();
  EXPECT_NEAR(total_flux(map), 0.5 * 4.0 * kPi, 0.01);
}

TEST(RsmMap, OfASpotReflectsTheLightOfItsCone) {
  for (const float angle : {0.3f, 1.0f, 1.4f}) {  // the last is too wide for a plane
    Light spot = test::point_light(vec3(1.0f), vec3(0.0f));
    spot.type = Light::Type::spot;
    spot.direction_ws = normalize(vec3(0.2f, -1.0f, 0.1f));
    spot.outer_cone_angle = angle;
    spot.inner_cone_angle = angle - 0.01f;
    const Stage stage(lit_room(spot));
    const ReflectiveShadowMap map = render_rsm(stage.world, stage.scene.lights[0], {}).value();
    const double cone = kTwoPi * (1.0 - std::cos(angle - 0.006));  // about half of the soft edge
    EXPECT_NEAR(total_flux(map) / (0.5 * cone), 1.0, 0.01) << angle;
  }
}

TEST(RsmMap, OfASunReflectsWhatFallsOnTheScene) {
  Scene scene;
  scene.materials.push_back(test::lambert(vec3(0.5f)));
  test::add(scene, test::quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, 0));
  scene.lights.push_back(test::sun(vec3(10.0f), vec3(0.5f, -1.0f, 0.2f)));
  const Stage stage(std::move(scene));
  const ReflectiveShadowMap map = render_rsm(stage.world, stage.scene.lights[0], {}).value();
  const double cosine = -stage.scene.lights[0].direction_ws.y;
  EXPECT_NEAR(total_flux(map), 0.5 * 10.0 * 4.0 * cosine, 0.1);
}

TEST(RsmMap, IsDarkWhereALightSeesNothingOrShinesIntoItsWall) {
  Scene scene;
  scene.materials.push_back(test::lambert(vec3(0.5f)));
  test::add(scene, test::quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, 0));
  Light away = test::point_light(vec3(1.0f), vec3(0.0f, 1.0f, 0.0f));
  away.type = Light::Type::spot;
  away.direction_ws = vec3(0.0f, 1.0f, 0.0f);
  scene.lights.push_back(away);
  scene.lights.push_back(test::point_light(vec3(1.0f), vec3(0.0f)));  // on the surface
  const Stage stage(std::move(scene));
  const WallView wall(5, 5);
  for (const Light& light : stage.scene.lights) {
    const ReflectiveShadowMap map = render_rsm(stage.world, light, {}).value();
    for (const vec3& e : gather({&map, 1}, wall.view(), {}).irradiance) {
      EXPECT_TRUE(std::isfinite(e.x) && e.x >= 0.0f);
    }
  }
  EXPECT_EQ(total_flux(render_rsm(stage.world, stage.scene.lights[0], {}).value()), 0.0);
}

TEST(RsmMap, OfAnEmptySceneIsDark) {
  Scene scene;
  scene.lights.push_back(test::sun(vec3(10.0f), vec3(0.5f, -1.0f, 0.2f)));
  const Stage stage(std::move(scene));
  const ReflectiveShadowMap map = render_rsm(stage.world, stage.scene.lights[0], {}).value();
  EXPECT_EQ(total_flux(map), 0.0);
}

TEST(RsmGather, WithoutLightsIsBlack) {
  const WallView wall(5, 5);
  for (const RsmPattern pattern : {RsmPattern::whole, RsmPattern::disk}) {
    RsmSettings settings;
    settings.pattern = pattern;
    for (const vec3& e : gather({}, wall.view(), settings).irradiance) EXPECT_EQ(e, vec3(0.0f));
  }
}

TEST(RsmVisibility, TakesAwayTheLightBehindAnObstacle) {
  // A shelf hides the texel from the upper half of the wall
  Scene scene;
  scene.materials.push_back(test::lambert(vec3(0.5f)));
  test::add(scene, test::quad({-5, 0.35f, 0.5f}, {10, 0, 0}, {0, 5, 0}, 0));
  const World world(scene);
  const ReflectiveShadowMap map = single_texel();
  WallView wall(9, 9);
  RsmSettings settings = plain_gather();
  settings.visibility_rays = 1;
  RsmIrradiance lit, seen;
  EXPECT_TRUE(RsmGatherer().gather(world, {&map, 1}, wall.view(), plain_gather(), lit));
  EXPECT_TRUE(RsmGatherer().gather(world, {&map, 1}, wall.view(), settings, seen));
  EXPECT_GT(seen.rays, 0u);
  for (std::size_t i = 0; i < wall.positions.size(); ++i) {
    // Where the way from the texel to the wall passes z = 0.5
    const float crossing = 0.5f * (wall.positions[i].y + 0.3f);
    const vec3 expected = crossing > 0.35f ? vec3(0.0f) : lit.irradiance[i];
    EXPECT_EQ(seen.irradiance[i], expected) << i;
  }
}

TEST(RsmSettings, OutOfRangeAreRefusedByName) {
  const auto name_of = [](auto change) {
    RsmSettings settings;
    change(settings);
    const Expected<void> result = check(settings);
    return result ? std::string("accepted") : result.error().place;
  };
  EXPECT_EQ(name_of([](RsmSettings&) {}), "accepted");
  EXPECT_EQ(name_of([](RsmSettings& s) { s.resolution = 0; }), "resolution");
  EXPECT_EQ(name_of([](RsmSettings& s) { s.texels = 2000000000; }), "texels");
  EXPECT_EQ(name_of([](RsmSettings& s) { s.texels = -1; }), "texels");
  EXPECT_EQ(name_of([](RsmSettings& s) { s.sub_maps = 3; }), "sub_images");
  EXPECT_EQ(name_of([](RsmSettings& s) { s.sub_images = 17; }), "sub_images");
  EXPECT_EQ(name_of([](RsmSettings& s) { s.softening = NAN; }), "softening");
  EXPECT_EQ(name_of([](RsmSettings& s) { s.disk_radius = 0.0f; }), "disk_radius");
  EXPECT_EQ(name_of([](RsmSettings& s) { s.visibility_rays = 1000; }), "visibility_rays");
  EXPECT_EQ(name_of([](RsmSettings& s) { s.downscale = 0; }), "downscale");
  EXPECT_EQ(name_of([](RsmSettings& s) { s.plane_tolerance = 0.0f; }), "plane_tolerance");
}

}  // namespace
}  // namespace lambent::rsm_gather_test
