// SPDX-License-Identifier: Apache-2.0
// The interleaved gather on the CPU and on a device: same maps, same view, same light.
#include <algorithm>
#include <cmath>
#include <vector>

#include "compose/rsm/rsm_frame.h"
#include "lambent/world.h"
#include "raytracing/vulkan/device_world.h"
#include "raytracing/world_access.h"
#include "rsm/vulkan/gather_vulkan.h"
#include "scenes/builtin.h"
#include "shared/random.h"
#include "support/seen_view.h"
#include "support/vulkan_device.h"

namespace lambent::rsm_passes_test {
namespace {

/// Two bumpy walls, one before the other, and nothing here and there.
struct Walls : test::MadeView {
  Walls(int w, int h) : MadeView(w, h) {
    RandomStream random = make_random_stream(7, 8, 9);
    for (int y = 0; y < h; ++y) {
      for (int x = 0; x < w; ++x) {
        const float z = 3 * x > 2 * w ? 0.4f : 0.0f;
        const vec2 tilt = 0.3f * (next_uniform2(random) - vec2(0.5f));
        const bool seen = (x * 7 + y * 3) % 11 != 5;
        const vec3 place(0.05f * static_cast<float>(x), 0.05f * static_cast<float>(y), z);
        add(place, seen ? normalize(vec3(tilt.x, tilt.y, 1.0f)) : vec3(0.0f),
            seen ? 2.0f - z : 0.0f);
      }
    }
  }
};

/// The map of a light that sees a lit patch of floor before the walls.
ReflectiveShadowMap floor_map(int resolution, const vec3& color, RsmProjection::Kind kind) {
  ReflectiveShadowMap map;
  map.resolution = resolution;
  map.projection.kind = kind;
  map.projection.origin_ws = vec3(1.0f, 3.0f, 1.5f);
  map.projection.world_from_light =
      mat3(vec3(1.0f, 0.0f, 0.0f), vec3(0.0f, 0.0f, -1.0f), vec3(0.0f, 1.0f, 0.0f));
  const float edge = 3.0f / static_cast<float>(resolution);
  for (int y = 0; y < resolution; ++y) {
    for (int x = 0; x < resolution; ++x) {
      RsmTexel texel;
      texel.position_ws = vec3((static_cast<float>(x) + 0.5f) * edge - 0.2f, -0.05f,
                               (static_cast<float>(y) + 0.5f) * edge);
      texel.normal_ws = vec3(0.0f, 1.0f, 0.0f);
      texel.area = edge * edge;
      texel.softening = 0.3f * texel.area;
      texel.flux = color * texel.area * (1.0f + std::sin(static_cast<float>(3 * x + y)));
      map.texels.push_back(texel);
    }
  }
  return map;
}

std::vector<ReflectiveShadowMap> three_maps(int resolution) {
  using Kind = RsmProjection::Kind;
  return {floor_map(resolution, vec3(1.0f, 0.8f, 0.5f), Kind::orthographic),
          floor_map(resolution, vec3(0.2f, 0.5f, 1.0f), Kind::perspective),
          floor_map(resolution + 3, vec3(0.5f, 0.1f, 0.1f), Kind::octahedral)};
}

/// Largest difference of a pixel's light, over it and a hundredth of the mean.
float difference(std::span<const float> a, std::span<const float> b) {
  float mean = 0.0f, worst = 0.0f;
  for (const float light : a) mean += light / static_cast<float>(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    worst = std::max(worst, std::abs(a[i] - b[i]) / (a[i] + 0.01f * mean + 1e-30f));
  }
  return worst;
}

float difference(const std::vector<vec3>& a, const std::vector<vec3>& b) {
  return difference(std::span(&a[0].x, 3 * a.size()), std::span(&b[0].x, 3 * b.size()));
}

// Light that is not blurred: sums over hundreds of texels whose roundings differ.
constexpr float kPlainDifference = 1e-5f;
// Light that is: it is stored with 8 bits of mantissa up to four times, each of which may round to
// the other side; where normals differ, what it is relit with cancels in part.
constexpr float kBlurredDifference = 0.02f;

class RsmTwin : public test::OnDevice {
 protected:
  RsmIrradiance on_device(std::span<const ReflectiveShadowMap> maps, const RsmView& view,
                          const RsmSettings& settings, bool keep_stages = false) {
    RsmIrradiance result;
    gatherer().gather(maps, view, settings, result, nullptr, VK_NULL_HANDLE, keep_stages);
    return result;
  }
  static RsmIrradiance on_host(std::span<const ReflectiveShadowMap> maps, const RsmView& view,
                               const RsmSettings& settings, bool keep_stages = false) {
    static const Scene empty;
    static const World world(empty);
    RsmIrradiance result;
    EXPECT_TRUE(RsmGatherer().gather(world, maps, view, settings, result, keep_stages));
    return result;
  }
  float difference_of(std::span<const ReflectiveShadowMap> maps, const RsmView& view,
                      const RsmSettings& settings) {
    return difference(on_host(maps, view, settings).irradiance,
                      on_device(maps, view, settings).irradiance);
  }
  static RsmGathererVulkan& gatherer() { return device().kept<RsmGathererVulkan>(); }
};

RsmSettings few_texels() {
  RsmSettings settings;
  settings.texels = 200;
  return settings;
}

const ivec2 kSizes[] = {ivec2(1, 1), ivec2(37, 23), ivec2(3, 70), ivec2(129, 34)};

TEST_F(RsmTwin, GathersTheSameLightOfSeveralMaps) {
  const std::vector<ReflectiveShadowMap> maps = three_maps(24);
  for (const ivec2 size : kSizes) {
    const Walls walls(size.x, size.y);
    for (const RsmLayout layout : {RsmLayout::full, RsmLayout::sub_maps, RsmLayout::restructured}) {
      for (const RsmPattern pattern : {RsmPattern::whole, RsmPattern::disk}) {
        RsmSettings settings = few_texels();
        settings.layout = layout;
        settings.pattern = pattern;
        settings.sub_blur_radius = 0;
        settings.final_blur = false;
        EXPECT_LT(difference_of(maps, walls.view(), settings), kPlainDifference)
            << size.x << " x " << size.y;
      }
    }
  }
}

TEST_F(RsmTwin, BlursTheSameLight) {
  const std::vector<ReflectiveShadowMap> maps = three_maps(24);
  for (const ivec2 size : kSizes) {
    const Walls walls(size.x, size.y);
    for (const RsmPattern pattern : {RsmPattern::whole, RsmPattern::disk}) {
      RsmSettings settings = few_texels();
      settings.pattern = pattern;
      EXPECT_LT(difference_of(maps, walls.view(), settings), kBlurredDifference);
      // The farthest taps that there are
      settings.sub_maps = 3;
      settings.sub_images = 6;
      settings.sub_blur_radius = 4;
      settings.irregular_blur = true;
      EXPECT_LT(difference_of(maps, walls.view(), settings), kBlurredDifference);
      settings.sub_maps = settings.sub_images = 16;
      EXPECT_LT(difference_of(maps, walls.view(), settings), kBlurredDifference);
    }
  }
}

TEST_F(RsmTwin, GivesTheSameBitsInEveryLayoutAndAgain) {
  const std::vector<ReflectiveShadowMap> maps = three_maps(24);
  const Walls walls(37, 23);
  RsmSettings settings = few_texels();
  settings.irregular_blur = true;
  const std::vector<vec3> restructured = on_device(maps, walls.view(), settings).irradiance;
  for (const RsmLayout layout : {RsmLayout::restructured, RsmLayout::sub_maps, RsmLayout::full}) {
    settings.layout = layout;
    EXPECT_EQ(on_device(maps, walls.view(), settings).irradiance, restructured);
  }
}

TEST_F(RsmTwin, KeepsTheSameStages) {
  const std::vector<ReflectiveShadowMap> maps = three_maps(24);
  const Walls walls(37, 23);
  for (const bool blurred : {true, false}) {
    RsmSettings settings = few_texels();
    settings.final_blur = blurred;
    if (!blurred) settings.sub_blur_radius = 0;
    const RsmIrradiance expected = on_host(maps, walls.view(), settings, true);
    const RsmIrradiance result = on_device(maps, walls.view(), settings, true);
    ASSERT_EQ(result.stages.size(), expected.stages.size());
    for (std::size_t i = 0; i < expected.stages.size(); ++i) {
      EXPECT_EQ(result.stages[i].name, expected.stages[i].name);
      EXPECT_LT(difference(expected.stages[i].image.pixels, result.stages[i].image.pixels),
                kBlurredDifference)
          << expected.stages[i].name;
    }
  }
}

TEST_F(RsmTwin, GathersNothingWhereThereIsNoLight) {
  const Walls walls(19, 5);
  ReflectiveShadowMap dark = floor_map(5, vec3(0.0f), RsmProjection::Kind::perspective);
  for (const std::span<const ReflectiveShadowMap> maps :
       {std::span<const ReflectiveShadowMap>(), std::span<const ReflectiveShadowMap>(&dark, 1)}) {
    for (const RsmPattern pattern : {RsmPattern::whole, RsmPattern::disk}) {
      RsmSettings settings = few_texels();
      settings.pattern = pattern;
      for (const vec3& light : on_device(maps, walls.view(), settings).irradiance) {
        EXPECT_EQ(light, vec3(0.0f));
      }
    }
  }
}

TEST_F(RsmTwin, GathersEveryTexelWhereAllAreAskedFor) {
  const std::vector<ReflectiveShadowMap> maps = three_maps(13);
  const Walls walls(33, 9);
  RsmSettings settings;
  settings.texels = 0;
  settings.sub_blur_radius = 0;
  settings.final_blur = false;
  EXPECT_LT(difference_of(maps, walls.view(), settings), kPlainDifference);
}

/// Cornell's box under a spot light, on the device.
struct Cornell {
  explicit Cornell(std::shared_ptr<vulkan::Device> device)
      : scene(scenes::make("cornell-spot").value()),
        host(scene),
        world(scene, std::move(device)),
        seen(test::seen_view(host, scene.cameras[0], 61, 43)) {
    RsmSettings settings;
    settings.resolution = 96;
    maps = render_rsms(host, scene.cameras[0], 61.0f / 43.0f, settings).value();
  }
  const Scene scene;
  const World host, world;
  test::MadeView seen;
  std::vector<ReflectiveShadowMap> maps;
};

TEST_F(RsmTwin, LightsACornellBoxAlike) {
  const Cornell box(shared_device());
  EXPECT_LT(difference_of(box.maps, box.seen.view(), few_texels()), kBlurredDifference);
}

TEST_F(RsmTwin, FindsTheSameTexelsHidden) {
  const Cornell box(shared_device());
  RsmSettings settings = few_texels();
  settings.visibility_rays = 3;
  settings.sub_blur_radius = 0;
  settings.final_blur = false;
  RsmIrradiance expected, result;
  EXPECT_TRUE(RsmGatherer().gather(box.host, box.maps, box.seen.view(), settings, expected));
  for (const RsmLayout layout : {RsmLayout::full, RsmLayout::restructured}) {
    settings.layout = layout;
    gatherer().gather(box.maps, box.seen.view(), settings, result,
                      &device_world_of(box.world)->tracer(),
                      device_world_of(box.world)->scene().textures());
    EXPECT_EQ(result.rays, expected.rays);
    // Rays that graze an edge, or were drawn on one, may be told otherwise: a pixel in a hundred
    std::size_t others = 0;
    for (std::size_t i = 0; i < expected.irradiance.size(); ++i) {
      const vec3 &a = expected.irradiance[i], &b = result.irradiance[i];
      if (length(a - b) > kPlainDifference * length(a)) ++others;
    }
    EXPECT_LT(others, expected.irradiance.size() / 100);
  }
}

TEST_F(RsmTwin, UpsamplesTheSameLight) {
  const Cornell box(shared_device());
  const Camera& camera = box.scene.cameras[0];
  FrameSettings frame;
  frame.width = 61;
  frame.height = 43;
  RsmSettings settings = few_texels();
  settings.resolution = 96;
  settings.downscale = 3;
  const IndirectSources sources = {.rsm = settings};
  RsmFrame small;
  light_by_rsm({box.host, sources, camera, frame}, small);
  GBuffer gbuffer;
  trace_gbuffer(box.host, camera, frame, {0, frame.height}, 0, gbuffer);
  std::vector<vec3> expected;
  look_up_rsm(small, gbuffer, camera, frame.width, {0, frame.height}, expected);

  RsmIrradiance light;
  const RsmView small_view = {small.light.width, small.light.height, small.positions_ws,
                              small.normals_ws, small.depths};
  gatherer().gather(render_rsms(box.host, camera, 61.0f / 43.0f, settings).value(), small_view,
                    settings, light);
  const UploadedRsmView from(device(), small_view), to(device(), box.seen.view());
  // The picture in two bands of rows
  constexpr int kFirstRows = 17;
  const auto first = static_cast<std::size_t>(kFirstRows) * frame.width;
  RsmViewOnDevice upper = to.on_device, lower = to.on_device;
  upper.height = kFirstRows;
  lower.height = frame.height - kFirstRows;
  lower.arrays.positions_ws.address += first * sizeof(vec3);
  lower.arrays.normals_ws.address += first * sizeof(vec3);
  lower.arrays.depths.address += first * sizeof(float);
  const vulkan::Buffer out(device(), expected.size() * sizeof(vec3), vulkan::Memory::device,
                           "upsampled");
  device().run([&](vulkan::Recorder& recorder) {
    gatherer().record_upsampling(recorder, from.on_device, settings, upper, 0, {out.address()});
    gatherer().record_upsampling(recorder, from.on_device, settings, lower, kFirstRows,
                                 {out.address() + first * sizeof(vec3)});
  });
  EXPECT_LT(difference(expected, vulkan::download<vec3>(device(), out)), kBlurredDifference);
}

}  // namespace
}  // namespace lambent::rsm_passes_test
