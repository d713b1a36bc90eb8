// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>

#include "raytracing/raytracer.h"
#include "scenes/recipes.h"
#include "shared/color.h"
#include "shared/sampling.h"

namespace lambent::scenes::builtin_atrium_test {
namespace {

const AnimatedScene& atrium() {
  // The patterns are what they are at any resolution; small textures are made fast.
  static const AnimatedScene made = make_atrium(256);
  return made;
}

glm::vec3 eye_of(const Camera& camera) {
  return glm::vec3(camera.world_from_view[3]);
}

std::vector<Hit> hits_of(const std::vector<Ray>& rays) {
  static const std::unique_ptr<RayTracer> tracer = make_embree_raytracer(atrium().scene);
  std::vector<Hit> hits(rays.size());
  tracer->closest_hits(rays, hits);
  return hits;
}

std::vector<Ray> rays_from(const glm::vec3& origin, int count) {
  std::vector<Ray> rays(count);
  for (int i = 0; i < count; ++i) {
    rays[i].origin = origin;
    rays[i].direction = spherical_fibonacci(i, count);
  }
  return rays;
}

TEST(Atrium, HasTheSizeItPromises) {
  const std::size_t triangles = triangle_count(atrium().scene);
  EXPECT_GE(triangles, 80'000u);
  EXPECT_LE(triangles, 120'000u);
  EXPECT_GE(atrium().scene.cameras.size(), 3u);
}

TEST(Atrium, ReflectsAsRealSurfacesDo) {
  // Means of what the materials show, black iron to lime plaster
  constexpr float kDarkest = 0.03f, kLightest = 0.8f;
  for (const Material& material : atrium().scene.materials) {
    glm::vec3 albedo(material.base_color);
    if (material.base_color_texture.texture >= 0) {
      const Texture& texture = atrium().scene.textures[material.base_color_texture.texture];
      const std::vector<std::uint8_t>& mean = texture.levels.back().rgba;
      for (int c = 0; c < 3; ++c) albedo[c] *= linear_from_srgb(mean[c] / 255.0f);
    }
    const float brightest = std::max({albedo.x, albedo.y, albedo.z});
    EXPECT_GE(brightest, kDarkest) << material.name;
    EXPECT_LE(brightest, kLightest) << material.name;
  }
}

TEST(Atrium, ShowsOnlyFrontFacesOfWhatHasTwoSides) {
  for (const Camera& camera : atrium().scene.cameras) {
    const std::vector<Ray> rays = rays_from(eye_of(camera), 20'000);
    const std::vector<Hit> hits = hits_of(rays);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (hits[i].missed() || hits[i].front_face) continue;
      const Instance& instance = atrium().scene.instances[hits[i].instance];
      const Mesh& mesh = atrium().scene.meshes[instance.mesh];
      const glm::vec3 p = rays[i].origin + rays[i].direction * hits[i].distance;
      EXPECT_TRUE(atrium().scene.materials[mesh.material].double_sided)
          << camera.name << " sees the back of " << instance.name << " at " << p.x << ", " << p.y
          << ", " << p.z;
    }
  }
}

TEST(Atrium, OpensToTheSkyOverTheCourtOnly) {
  // What leaves goes up through the rectangle between the eaves.
  constexpr float kEave = 8.5f, kHalfX = 7.5f, kHalfZ = 4.5f;
  for (const glm::vec3 origin : {glm::vec3(0.0f, 3.0f, 2.5f), glm::vec3(-9.0f, 1.7f, 6.0f),
                                 glm::vec3(9.0f, 6.5f, -6.0f), glm::vec3(13.5f, 1.5f, 1.0f)}) {
    const std::vector<Ray> rays = rays_from(origin, 20'000);
    const std::vector<Hit> hits = hits_of(rays);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (!hits[i].missed()) continue;
      ASSERT_GT(rays[i].direction.y, 0.0f) << "from " << origin.x << ", " << origin.z;
      const glm::vec3 p = origin + rays[i].direction * ((kEave - origin.y) / rays[i].direction.y);
      ASSERT_LT(std::abs(p.x), kHalfX);
      ASSERT_LT(std::abs(p.z), kHalfZ);
    }
  }
}

TEST(Atrium, CamerasStandUprightInFreeSpace) {
  for (const Camera& camera : atrium().scene.cameras) {
    const glm::vec3 view = -glm::vec3(camera.world_from_view[2]);
    EXPECT_NEAR(view.y, 0.0f, 1e-5f) << camera.name;
    for (const Hit& hit : hits_of(rays_from(eye_of(camera), 2'000))) {
      EXPECT_GT(hit.distance, 0.3f) << camera.name;
    }
  }
}

TEST(Atrium, SunReachesTheCourtAndLeavesTheAislesInShade) {
  const glm::vec3 to_sun = -atrium().scene.lights[0].direction_ws;
  int lit = 0, total = 0;
  for (float x = -6.5f; x < 6.6f; x += 0.5f) {
    for (float z = -3.5f; z < 3.6f; z += 0.5f) {
      const Hit hit = hits_of({{{x, 0.01f, z}, 0.0f, to_sun, kInfiniteDistance}})[0];
      lit += hit.missed();
      ++total;
    }
  }
  EXPECT_GT(lit, total / 10);
  EXPECT_LT(lit, total * 6 / 10);
}

TEST(Atrium, TheSunSetsOnTheOtherSideAndTheDoorSwings) {
  const AnimatedScene& made = atrium();
  int tracks = 0;
  for (const Animation& animation : made.animations) {
    for (const Track& track : animation.tracks) {
      ++tracks;
      ASSERT_GE(track.keyframes.size(), 2u);
      EXPECT_EQ(track.keyframes.front().time, 0.0f);
      EXPECT_EQ(track.keyframes.back().time, 20.0f);
      EXPECT_TRUE(
          std::is_sorted(track.keyframes.begin(), track.keyframes.end(),
                         [](const Keyframe& a, const Keyframe& b) { return a.time < b.time; }));
      // The rest pose is the first keyframe.
      const Keyframe& first = track.keyframes.front();
      if (track.target == Track::Target::light) {
        const auto direction = [](const Keyframe& key) {
          return key.rotation * glm::vec3(0.0f, 0.0f, -1.0f);
        };
        const glm::vec3 morning = direction(first), evening = direction(track.keyframes.back());
        EXPECT_LT(glm::distance(morning, made.scene.lights[track.index].direction_ws), 1e-5f);
        EXPECT_GT(morning.x, 0.3f);
        EXPECT_LT(evening.x, -0.3f);
        for (const Keyframe& key : track.keyframes) EXPECT_LT(direction(key).y, -0.3f);
      } else {
        const glm::mat4 pose =
            glm::mat4_cast(first.rotation) +
            glm::mat4(glm::vec4(0), glm::vec4(0), glm::vec4(0), glm::vec4(first.translation, 0.0f));
        const glm::mat4 rest = made.scene.instances[track.index].world_from_object;
        for (int c = 0; c < 4; ++c) EXPECT_LT(glm::distance(pose[c], rest[c]), 1e-5f);
      }
    }
  }
  EXPECT_EQ(tracks, 3);
}

TEST(Atrium, TexturesAreSeamless) {
  // Across the seam, neighbours differ no more than neighbours inside do.
  for (const Texture& texture : atrium().scene.textures) {
    const TextureLevel& image = texture.levels.front();
    const auto difference = [&](int x0, int y0, int x1, int y1) {
      int sum = 0;
      for (int c = 0; c < 3; ++c) {
        sum += std::abs(image.rgba[4 * (y0 * image.width + x0) + c] -
                        image.rgba[4 * (y1 * image.width + x1) + c]);
      }
      return sum;
    };
    const auto mean_step = [&](bool across, int at, int next) {
      double sum = 0.0;
      const int count = across ? image.height : image.width;
      for (int i = 0; i < count; ++i) {
        sum += across ? difference(at, i, next, i) : difference(i, at, i, next);
      }
      return sum / count;
    };
    for (const bool across : {true, false}) {
      const int last = (across ? image.width : image.height) - 1;
      double largest = 0.0;
      for (int i = 0; i < last; ++i) largest = std::max(largest, mean_step(across, i, i + 1));
      EXPECT_LE(mean_step(across, last, 0), 1.1 * largest + 1.0)
          << texture.name << (across ? ", left to right" : ", top to bottom");
    }
  }
}

}  // namespace
}  // namespace lambent::scenes::builtin_atrium_test
