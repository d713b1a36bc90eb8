// SPDX-License-Identifier: Apache-2.0
// The light that surfaces receive which average over the bumps of a normal map.
#include "shared/bumps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "raytracing/surface.h"
#include "scene/texture.h"
#include "shared/random.h"
#include "shared/sampling.h"
#include "support/hand_made.h"

namespace lambent::bumps_test {
namespace {

constexpr int kEdge = 64;
constexpr std::array kCosines = {0.95f, 0.6f, 0.3f, 0.15f};

/// Two independent numbers, normally distributed with variance 1. Box and Muller, "A Note on the
/// Generation of Random Normal Deviates", 1958.
vec2 next_normal2(RandomStream& random) {
  const float radius = std::sqrt(-2.0f * std::log(std::max(next_uniform(random), 1e-7f)));
  const float angle = kTwoPi * next_uniform(random);
  return radius * vec2(std::cos(angle), std::sin(angle));
}

vec3 to_light(float cosine) {
  return {std::sqrt(1.0f - cosine * cosine), 0.0f, cosine};
}

/// What bumps with slopes of this deviation along each axis receive of a light at this cosine to
/// their mean normal, and the length of the mean of their normals.
struct Received {
  Received(float slope, float cosine) {
    RandomStream random = make_random_stream(1, 2, 3);
    constexpr int kNormals = 200000;
    double sum = 0.0, up = 0.0;
    for (int i = 0; i < kNormals; ++i) {
      const vec3 normal = glm::normalize(vec3(slope * next_normal2(random), 1.0f));
      sum += std::max(0.0f, glm::dot(normal, to_light(cosine)));
      up += normal.z;
    }
    mean = sum / kNormals;
    length = static_cast<float>(up / kNormals);
  }
  double mean;
  float length;
};

TEST(BumpyCosine, IsTheMeanOverNormallyDistributedSlopes) {
  for (const float slope : {0.05f, 0.15f, 0.3f}) {
    for (const float cosine : kCosines) {
      const Received found(slope, cosine);
      EXPECT_NEAR(bumpy_cosine(cosine, found.length), found.mean, 0.02 * found.mean)
          << slope << ", " << cosine;
    }
  }
}

TEST(BumpyCosine, GoesOnBelowTheHorizon) {
  for (const float cosine : {0.05f, 0.0f, -0.05f, -0.15f}) {
    const Received found(0.2f, cosine);
    EXPECT_NEAR(bumpy_cosine(cosine, found.length), found.mean, 0.003) << cosine;
  }
}

TEST(BumpyCosine, IsTheCosineWithoutBumpsAndHasNoStep) {
  EXPECT_EQ(bumpy_cosine(0.3f, 1.0f), 0.3f);
  float before = bumpy_cosine(-1.0f, 0.9f);
  EXPECT_EQ(before, 0.0f);
  for (float cosine = -0.999f; cosine <= 1.0f; cosine += 0.001f) {
    const float now = bumpy_cosine(cosine, 0.9f);
    EXPECT_GE(now, before) << cosine;
    EXPECT_LT(now - before, 0.0015f) << cosine;
    before = now;
  }
  EXPECT_FLOAT_EQ(bumpy_cosine(1.0f, 0.9f), 0.9f);
}

TEST(ScaledMeanLength, IsThatOfNormalsWhoseSlopesAreScaled) {
  // Normals that lean by one angle to all sides
  for (const float angle : {0.1f, 0.5f, 1.0f}) {
    for (const float scale : {0.0f, 0.5f, 1.0f, 2.0f}) {
      EXPECT_NEAR(scaled_mean_length(std::cos(angle), scale),
                  std::cos(std::atan(scale * std::tan(angle))), 1e-5f);
    }
  }
  EXPECT_EQ(scaled_mean_length(0.0f, 1.0f), kLeastMeanLength);
  EXPECT_EQ(scaled_mean_length(1.2f, 1.0f), 1.0f);
}

TEST(MeanLengthOfShare, TakesBackTheHorizonsShare) {
  for (const float length : {0.3f, 0.8f, 1.0f}) {
    for (const float cosine : {0.4f, 1.0f}) {
      EXPECT_NEAR(mean_length_of_share(horizon_share(length, cosine), cosine), length, 1e-5f);
    }
  }
  EXPECT_EQ(mean_length_of_share(0.0f, 1.0f), 1.0f);
}

/// A unit square in the plane z = 0 that faces +Z, with a normal map of noise from texel to texel.
/// Vectors have a length of 0.9, as compression may leave them.
Scene noisy_square(float slope, float normal_scale) {
  Scene scene;
  Material material = test::lambert(glm::vec3(1.0f));
  material.normal_texture.texture = 0;
  material.normal_scale = normal_scale;
  scene.materials = {material};
  test::add(scene, test::quad({-0.5f, -0.5f, 0.0f}, {1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, 0));
  Texture texture;
  texture.levels.resize(1);
  texture.levels[0].width = texture.levels[0].height = kEdge;
  RandomStream random = make_random_stream(4, 5, 6);
  for (int i = 0; i < kEdge * kEdge; ++i) {
    const vec3 normal = 0.9f * glm::normalize(vec3(slope * next_normal2(random), 1.0f));
    for (int c = 0; c < 3; ++c) {
      texture.levels[0].rgba.push_back(
          static_cast<std::uint8_t>(std::lround(127.5f * normal[c] + 127.5f)));
    }
    texture.levels[0].rgba.push_back(255);
  }
  build_normal_mips(texture);
  scene.textures = {std::move(texture)};
  return scene;
}

class Seen {
 public:
  explicit Seen(const Scene& scene) : scene_(scene), tracer_(make_embree_raytracer(scene)) {}
  /// The surface at a place of the square, seen from above, as pixels or as other rays see it.
  Surface at(const vec2& place, float footprint, bool by_pixels) const {
    const Ray ray{{place - 0.5f, 1.0f}, 0.0f, {0.0f, 0.0f, -1.0f}};
    const Hit hit = tracer_->closest_hit(ray);
    return by_pixels ? seen_surface_at(scene_, ray, hit, footprint)
                     : surface_at(scene_, ray, hit, footprint);
  }

 private:
  const Scene& scene_;
  std::unique_ptr<RayTracer> tracer_;
};

TEST(SurfaceInView, BumpsReceiveWhatTheyWouldOneByOne) {
  for (const float normal_scale : {0.5f, 1.0f}) {
    const Scene scene = noisy_square(0.4f, normal_scale);
    const Seen seen(scene);
    for (const float cosine : kCosines) {
      const auto received = [&](float footprint, bool by_pixels) {
        constexpr uint kPlaces = 4096;
        double sum = 0.0;
        for (uint i = 0; i < kPlaces; ++i) {
          const Surface surface = seen.at(glm::fract(plastic_sequence(i)), footprint, by_pixels);
          const vec3 light = to_local(make_frame(surface.normal_ws), to_light(cosine));
          if (light.z <= 0.0f) continue;
          sum += kPi * evaluate_lobes(surface.reflectance, vec3(0.0f, 0.0f, 1.0f), light).diffuse.x;
        }
        return sum / kPlaces;
      };
      const double each = received(0.0f, true);
      EXPECT_EQ(received(0.5f / kEdge, true), each);
      for (const bool by_pixels : {false, true}) {
        EXPECT_NEAR(received(8.0f / kEdge, by_pixels), each, 0.03 * each)
            << normal_scale << ", " << cosine << ", " << by_pixels;
        EXPECT_NEAR(received(1.0f, by_pixels), each, 0.03 * each)
            << normal_scale << ", " << cosine << ", " << by_pixels;
      }
    }
  }
}

}  // namespace
}  // namespace lambent::bumps_test
