// SPDX-License-Identifier: Apache-2.0
// What is see-through lets the same rays pass on a device as on the host.
#include <cmath>
#include <numeric>

#include "raytracing/vulkan/device_world.h"
#include "raytracing/world_access.h"
#include "scene/coverage.h"
#include "support/hand_made.h"
#include "support/vulkan_device.h"
#include "twin/trace_agreement.h"

namespace lambent::see_through_test {
namespace {

using test::expect_same_answers;
using test::random_rays;

using SeeThroughTwin = test::OnDevice;

constexpr int kRays = 6000;

/// A texture whose coverage goes up and down in waves.
Texture wavy_texture() {
  constexpr int kSize = 32;
  Texture texture;
  TextureLevel level{kSize, kSize, {}};
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const float wave =
          std::sin(0.7f * static_cast<float>(x)) * std::cos(0.4f * static_cast<float>(y));
      level.rgba.insert(level.rgba.end(),
                        {200, 100, 50, static_cast<std::uint8_t>(127.0f + 127.0f * wave)});
    }
  }
  texture.levels.push_back(std::move(level));
  build_mips(texture);
  return texture;
}

/// A room with a curtain whose coverage is decided by a texture, which is turned and scaled, and
/// vertex colours; a net that repeats its texture point-sampled stands behind.
Scene room_with_curtains() {
  Scene scene;
  scene.textures = {wavy_texture()};
  scene.materials.assign(3, test::lambert(glm::vec3(0.5f)));
  for (const int curtain : {1, 2}) {
    Material& material = scene.materials[curtain];
    material.alpha_mode = AlphaMode::mask;
    material.alpha_cutoff = 0.4f;
    material.base_color.a = 0.9f;
    material.base_color_texture.texture = 0;
    material.base_color_texture.uv_rotation = 0.3f;
    material.base_color_texture.uv_scale = glm::vec2(1.7f, 0.8f);
    material.base_color_texture.uv_offset = glm::vec2(0.2f, 0.1f);
  }
  scene.materials[2].base_color_texture.nearest = true;
  scene.materials[2].base_color_texture.wrap_u = Wrap::mirrored_repeat;
  scene.materials[2].base_color_texture.wrap_v = Wrap::clamp_to_edge;
  test::add_room(scene, 6.0f, 0);
  Mesh curtain = test::quad({-2, -2, -1}, {4, 0, 0}, {0, 4, 0}, 1);
  curtain.colors = {glm::vec4(1.0f), glm::vec4(1, 1, 1, 0.8f), glm::vec4(1, 1, 1, 0.6f),
                    glm::vec4(1.0f)};
  test::add(scene, curtain);
  test::add(scene, test::quad({-2, -2, 1}, {4, 0, 1}, {0, 4, 0}, 2));
  return scene;
}
constexpr std::size_t kCurtain = 6;

int hits_on(const World& world, std::span<const Ray> rays, std::size_t instance) {
  std::vector<Hit> hits(rays.size());
  tracer_of(world).closest_hits(rays, hits);
  return static_cast<int>(std::count_if(hits.begin(), hits.end(), [&](const Hit& hit) {
    return !hit.missed() && hit.instance == instance;
  }));
}

TEST_F(SeeThroughTwin, MasksLetTheSameRaysPass) {
  Scene scene = room_with_curtains();
  World on_host(scene), on_device(scene, shared_device());
  const std::vector<Ray> rays = random_rays(scene, kRays, 1u);
  const auto expect_followed = [&](const char* what) {
    SCOPED_TRACE(what);
    ASSERT_TRUE(on_host.update());
    ASSERT_TRUE(on_device.update());
    expect_same_answers(on_device, on_host, rays);
  };
  expect_followed("as built");
  const int some = hits_on(on_device, rays, kCurtain);
  scene.materials[1].alpha_cutoff = 0.6f;
  expect_followed("a higher cutoff");
  EXPECT_LT(hits_on(on_device, rays, kCurtain), some);
  scene.materials[1].alpha_mode = AlphaMode::opaque;
  expect_followed("opaque");
  EXPECT_GT(hits_on(on_device, rays, kCurtain), some);
  scene.materials[1].alpha_mode = AlphaMode::mask;
  for (std::size_t i = 3; i < scene.textures[0].levels[0].rgba.size(); i += 4) {
    std::uint8_t& alpha = scene.textures[0].levels[0].rgba[i];
    alpha = static_cast<std::uint8_t>(255 - alpha);
  }
  build_mips(scene.textures[0]);
  ++scene.textures[0].revision;
  expect_followed("a mask again, of another texture");
}

// Which rays are stopped hangs on the last bits of a hit; how many are does not.
TEST_F(SeeThroughTwin, BlendsLetTheSameShareOfRaysPass) {
  constexpr float kCoverage = 0.3f;
  constexpr int kSheets = 3, kAcross = 100;
  Scene scene;
  scene.materials = {test::lambert(glm::vec3(0.5f))};
  scene.materials[0].alpha_mode = AlphaMode::blend;
  scene.materials[0].base_color.a = kCoverage;
  for (int i = 0; i < kSheets; ++i) {
    test::add(scene, test::quad({0, 0, static_cast<float>(i)}, {1, 0, 0}, {0, 1, 0}, 0));
  }
  const World on_host(scene), on_device(scene, shared_device());
  std::vector<Ray> rays;
  for (int i = 0; i < kAcross * kAcross; ++i) {
    const float x = static_cast<float>(i % kAcross) + 0.3f,
                y = static_cast<float>(i / kAcross) + 0.6f;
    rays.push_back({glm::vec3(x / kAcross, y / kAcross, -1.0f), 0.0f, {0, 0, 1}});
  }
  const double through = std::pow(1.0 - kCoverage, kSheets);
  const double rays_cast = static_cast<double>(rays.size());
  const double deviation = std::sqrt(through * (1.0 - through) / rays_cast);
  for (const World* world : {&on_host, &on_device}) {
    std::vector<Hit> hits(rays.size());
    std::vector<std::uint8_t> occluded(rays.size());
    tracer_of(*world).closest_hits(rays, hits);
    tracer_of(*world).occlusions(rays, occluded);
    int passed = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      // The two kinds of query agree on every ray
      ASSERT_EQ(occluded[i] != 0, !hits[i].missed()) << i;
      passed += hits[i].missed() ? 1 : 0;
    }
    EXPECT_NEAR(passed / rays_cast, through, 4.0 * deviation);
  }
}

// Samples of pixels meet sheets in their order, and end at the same ones. An opaque wall behind
// them stops the rest; the foremost sheet is hidden by a post here and there.
TEST_F(SeeThroughTwin, SamplesEndAtTheSameSurfaces) {
  constexpr int kSheets = 20, kSamples = 16, kPixels = 600;
  Scene scene;
  scene.materials.assign(2, test::lambert(glm::vec3(0.5f)));
  scene.materials[0].alpha_mode = AlphaMode::blend;
  scene.materials[0].base_color.a = 0.1f;
  test::add(scene, test::quad({0, 0, kSheets}, {1, 0, 0}, {0, 1, 0}, 1));
  test::add(scene, test::quad({0.4f, 0, -0.5f}, {0.2f, 0, 0}, {0, 1, 0}, 1));
  for (int i = 0; i < kSheets; ++i) {
    test::add(scene, test::quad({0, 0, static_cast<float>(i)}, {1, 0, 0}, {0, 1, 0}, 0));
  }
  const World on_host(scene), on_device(scene, shared_device());
  std::vector<Ray> rays;
  for (int i = 0; i < kPixels * kSamples; ++i) {
    const int pixel = i / kSamples;
    const float x = (static_cast<float>(pixel % 30) + 0.3f) / 30.0f,
                y = (static_cast<float>(pixel) + 0.6f) / kPixels;
    rays.push_back({glm::vec3(x, y, -1.0f), 0.0f, {0, 0, 1}});
    rays.back().mask =
        sample_mask(static_cast<uint>(pixel), static_cast<uint>(i % kSamples), kSamples, 3u);
  }
  std::vector<Hit> host(rays.size()), device_hits(rays.size());
  tracer_of(on_host).closest_hits(rays, host);
  tracer_of(on_device).closest_hits(rays, device_hits);
  std::vector<double> ends(scene.instances.size(), 0.0);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    ASSERT_FALSE(host[i].missed());
    ends[host[i].instance] += host[i].sample_weight;
    // Behind more sheets than are met in order, chance hangs on the last bits of a hit
    const bool ordered = host[i].instance < 2u + kMaxOrderedSurfaces && host[i].instance != 0;
    if (ordered) {
      ASSERT_EQ(device_hits[i].instance, host[i].instance) << "ray " << i;
      ASSERT_NEAR(device_hits[i].sample_weight, host[i].sample_weight, 1e-4f) << "ray " << i;
    }
  }
  // Of the rays beside the post a tenth, by weight, ends at the first sheet, and so on
  const double beside = static_cast<double>(rays.size()) - ends[1];
  EXPECT_GT(ends[1], 0.0);
  for (int i = 0; i < kSheets; ++i) {
    EXPECT_NEAR(ends[i + 2] / beside, 0.1 * std::pow(0.9, i), 0.01) << "sheet " << i;
  }
}

}  // namespace
}  // namespace lambent::see_through_test
