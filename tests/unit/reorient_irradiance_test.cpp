// SPDX-License-Identifier: Apache-2.0
// Light that is blurred over bumps and still lights each by its own normal.
#include "shared/reorient_irradiance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "lambent/rsm.h"
#include "lambent/world.h"
#include "rsm/texel_light.h"
#include "shared/constants.h"
#include "shared/random.h"
#include "support/made_view.h"

namespace lambent::reorient_irradiance_test {
namespace {

const vec3 kUp(0.0f, 0.0f, 1.0f);

vec3 tilted(float angle) {
  return {std::sin(angle), 0.0f, std::cos(angle)};
}

TEST(Relight, ChangesNothingForTheNormalThatGathered) {
  for (const vec3& way : {vec3(0.0f), kUp, vec3(3.0f, -1.0f, 0.2f), vec3(5.0f, 0.0f, -1.0f)}) {
    for (const float light : {1e-6f, 1.0f, 300.0f}) {
      const vec3 normal = normalize(vec3(0.1f, 0.3f, 1.0f));
      EXPECT_NEAR(reoriented_fraction(reorientation(way, normal, light), normal, light), 1.0f,
                  1e-5f);
    }
  }
}

TEST(Relight, LiesMidwayBetweenLightFromAloftAndFromAllAround) {
  // For a normal at angle a, light from above brings cos a, an evenly lit half-space (1 + cos a) /
  // 2 of what it brings the normal up; G is up in both
  for (const float angle : {0.0f, 0.3f, 1.0f, 1.5f}) {
    const float aloft = std::cos(angle), around = 0.5f * (1.0f + std::cos(angle));
    EXPECT_NEAR(reoriented_fraction(reorientation(kPi * kUp, kUp, kPi), tilted(angle), kPi),
                0.5f * (aloft + around), 1e-5f);
  }
}

TEST(Relight, IsExactToFirstOrderUnderOneLight) {
  constexpr float kStep = 0.02f, kLight = 0.8f;
  const vec3 way = tilted(0.9f);
  const float cosine = dot(way, kUp);
  for (const float step : {-kStep, kStep}) {
    const vec3 normal = tilted(step);
    const float expected = dot(way, normal) / cosine;
    EXPECT_NEAR(reoriented_fraction(reorientation(way, kUp, kLight), normal, kLight), expected,
                kStep * kStep);
  }
}

TEST(Relight, BoundsWhatGrazingLightBringsAnotherNormal) {
  for (const float height : {0.1f, 1e-3f, 0.0f, -0.5f}) {
    const vec3 way = normalize(vec3(1.0f, 0.0f, height));
    const float share = reoriented_fraction(reorientation(way, kUp, 1.0f), tilted(1.5f), 1.0f);
    EXPECT_GE(share, 0.0f);
    EXPECT_LE(share, 1.0f / kLeastDirectedCosine + 1.0f);
  }
}

TEST(Relight, TakesNoWayFromTexelsOfHardlyAnyLight) {
  for (const float tiny : {1e-44f, 1e-38f, 1e-30f}) {
    const vec3 r = reorientation(tiny * tilted(1.0f), kUp, 1.0f);
    EXPECT_NEAR(reoriented_fraction(r, tilted(0.5f), 1.0f),
                reoriented_fraction(reorientation(vec3(0.0f), kUp, 1.0f), tilted(0.5f), 1.0f),
                1e-6f);
  }
}

TEST(Relight, OfNoLightIsNone) {
  EXPECT_EQ(reoriented_fraction(reorientation(vec3(0.0f), kUp, 0.0f), kUp, 0.0f), 0.0f);
}

/// A wall whose normals are tilted at random, pixel by pixel, by up to `most` along each axis.
struct BumpyWall : test::MadeView {
  BumpyWall(int w, int h, float most) : MadeView(w, h) {
    RandomStream random = make_random_stream(1, 2, 3);
    for (int y = 0; y < h; ++y) {
      for (int x = 0; x < w; ++x) {
        const vec2 tilt = most * (next_uniform2(random) * 2.0f - 1.0f);
        add(0.02f * vec3(x, y, 0), normalize(vec3(tilt, 1.0f)), 2.0f);
      }
    }
  }
};

/// A lit floor that leads up to the wall.
ReflectiveShadowMap floor_map() {
  ReflectiveShadowMap map;
  map.resolution = 64;
  for (int y = 0; y < map.resolution; ++y) {
    for (int x = 0; x < map.resolution; ++x) {
      RsmTexel texel;
      texel.position_ws =
          vec3(0.05f * static_cast<float>(x) - 1.0f, -0.3f, 0.05f * static_cast<float>(y) + 0.3f);
      texel.normal_ws = vec3(0.0f, 1.0f, 0.0f);
      texel.area = 0.0025f;
      texel.softening = kSofteningPerArea * texel.area;
      texel.flux = vec3(1.0f, 0.8f, 0.5f) * texel.area;
      map.texels.push_back(texel);
    }
  }
  return map;
}

struct Comparison {
  double relative_rmse, mean_ratio;
};

/// A gather against every pixel of a wall of bumps taking all texels, on that wall or another.
Comparison compare(const BumpyWall& bumps, const BumpyWall& wall, const RsmSettings& settings) {
  static const Scene empty;
  static const World world(empty);
  const ReflectiveShadowMap map = floor_map();
  RsmSettings all = plain_gather();
  all.texels = 0;
  RsmIrradiance truth, light;
  EXPECT_TRUE(RsmGatherer().gather(world, {&map, 1}, bumps.view(), all, truth));
  EXPECT_TRUE(RsmGatherer().gather(world, {&map, 1}, wall.view(), settings, light));
  double square = 0.0, sum = 0.0, mean = 0.0;
  for (std::size_t i = 0; i < truth.irradiance.size(); ++i) {
    square += std::pow(light.irradiance[i].x - truth.irradiance[i].x, 2.0);
    sum += truth.irradiance[i].x;
    mean += light.irradiance[i].x;
  }
  const auto count = static_cast<double>(truth.irradiance.size());
  return {std::sqrt(square / count) / (sum / count), mean / sum};
}

RsmSettings unblurred(RsmSettings settings) {
  settings.sub_blur_radius = 0;
  settings.final_blur = false;
  return settings;
}

const BumpyWall kBumps(64, 48, 0.2f), kFlat(64, 48, 0.0f);

TEST(RsmRelight, KeepsBumpsSharpUnderTheBlurs) {
  const Comparison blurred = compare(kBumps, kBumps, {});
  // What is left of the error of a wall whose bumps are washed out
  const Comparison washed_out = compare(kBumps, kFlat, {});
  EXPECT_GT(washed_out.relative_rmse, 0.05);
  EXPECT_LT(blurred.relative_rmse, 0.25 * washed_out.relative_rmse);
}

TEST(RsmRelight, KeepsTheMeanOfBumpyLight) {
  const Comparison before = compare(kBumps, kBumps, unblurred({}));
  EXPECT_NEAR(compare(kBumps, kBumps, {}).mean_ratio / before.mean_ratio, 1.0, 0.01);
}

TEST(RsmRelight, ServesTheDiskAndEachBlurAlone) {
  RsmSettings sub_blur, final_blur, disk;
  sub_blur.final_blur = false;
  sub_blur.texels = 0;  // so that the pattern is faint, which sub-images alone keep
  final_blur.sub_blur_radius = 0;
  disk.pattern = RsmPattern::disk;
  disk.disk_radius = 1.0f;
  EXPECT_LT(compare(kBumps, kBumps, sub_blur).relative_rmse, 0.05);
  EXPECT_LT(compare(kBumps, kBumps, final_blur).relative_rmse, 0.05);
  EXPECT_LT(compare(kBumps, kBumps, disk).relative_rmse,
            compare(kBumps, kBumps, unblurred(disk)).relative_rmse);
}

}  // namespace
}  // namespace lambent::reorient_irradiance_test
