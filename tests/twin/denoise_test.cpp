// SPDX-License-Identifier: Apache-2.0
// The filter on the processor and on a device: the same picture, the same light.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "denoise/denoise_vulkan.h"
#include "lambent/denoise.h"
#include "shared/random.h"
#include "support/vulkan_device.h"

namespace lambent::denoise_test {
namespace {

/// A bent wall with a step in it and a hole that shows nothing, under noisy light.
struct NoisyWall {
  NoisyWall(int w, int h) : width(w), height(h) {
    RandomStream random = make_random_stream(3, 1, 4);
    for (int y = 0; y < h; ++y) {
      for (int x = 0; x < w; ++x) {
        const float along = static_cast<float>(x) / static_cast<float>(w);
        const float z = 2 * x > w ? 0.2f : 0.0f;
        positions.emplace_back(0.01f * static_cast<float>(x), 0.01f * static_cast<float>(y), z);
        normals.push_back(normalize(vec3(0.4f * along, 0.1f, 1.0f)));
        depths.push_back((x * 5 + y * 3) % 17 == 3 ? 0.0f : 1.5f - z);
        const float u = next_uniform(random);
        light.push_back(u < 0.2f ? vec3(3.0f, 2.0f, along) : vec3(0.1f));
        base.push_back(vec3(0.5f + 0.2f * next_uniform(random)));
        // Some of the bright pixels are fireflies
        variance.push_back(u < 0.1f ? 9.0f : u * u);
        levels.push_back(0.1f + along);
        to_viewer.push_back(normalize(vec3(0.3f - along, 0.2f, 1.0f)));
        alphas.push_back((x + 2 * y) % 13 == 5 ? 0.0f : 0.05f + 0.3f * along);
        inverse_distances.push_back(0.3f * u);
      }
    }
  }
  DenoiseView view() const { return {width, height, positions, normals, depths}; }
  DenoiseView view_with_lobes() const {
    return {width, height, positions, normals, depths, {to_viewer, alphas, inverse_distances}};
  }

  int width, height;
  std::vector<vec3> positions, normals, light, base, to_viewer;
  std::vector<float> depths, variance, levels, alphas, inverse_distances;
};

/// The lobes of a view as a device reads them; none if it has none.
std::vector<LobeGuide> lobes_of(const DenoiseView& view) {
  const DenoiseLobes& of = view.lobes;
  std::vector<LobeGuide> lobes(of.alphas.size());
  for (std::size_t i = 0; i < lobes.size(); ++i) {
    if (of.alphas[i] <= 0.0f) continue;
    lobes[i] =
        lobe_guide(view.normals_ws[i], of.to_viewer_ws[i], of.alphas[i], of.inverse_distances[i]);
  }
  return lobes;
}

/// Largest difference, over the light and a hundredth of the mean.
float difference(const std::vector<vec3>& a, const std::vector<vec3>& b) {
  vec3 mean(0.0f);
  for (const vec3& e : a) mean += e / static_cast<float>(a.size());
  float worst = 0.0f;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      worst = std::max(worst, std::abs(a[i][c] - b[i][c]) / (a[i][c] + 0.01f * mean[c] + 1e-30f));
    }
  }
  return worst;
}

class DenoiseTwin : public test::OnDevice {
 protected:
  static std::vector<vec3> on_device(const DenoiseView& view, const NoisyLight& light,
                                     const DenoiseSettings& settings,
                                     const std::vector<vec3>& added = {}) {
    const auto buffer = [&](auto span) { return vulkan::upload(device(), span, "wall"); };
    const vulkan::Buffer positions = buffer(view.positions_ws), normals = buffer(view.normals_ws),
                         depths = buffer(view.depths), noisy = buffer(light.light),
                         base = buffer(light.base), variance = buffer(light.variance),
                         levels = buffer(light.levels);
    const std::vector<LobeGuide> guides = lobes_of(view);
    const vulkan::Buffer lobes = buffer(std::span<const LobeGuide>(guides));
    std::vector<vec3> result = added;
    result.resize(light.light.size());
    const vulkan::Buffer filtered = buffer(std::span<const vec3>(result));
    DenoiserVulkan denoiser(device());
    denoiser.reserve(light.light.size());
    device().run([&](vulkan::Recorder& to) {
      denoiser.record(to,
                      {static_cast<std::uint32_t>(view.width),
                       static_cast<std::uint32_t>(view.height),
                       {positions.address()},
                       {normals.address()},
                       {depths.address()},
                       {guides.empty() ? 0 : lobes.address()}},
                      {{noisy.address()},
                       {light.base.empty() ? 0 : base.address()},
                       {light.variance.empty() ? 0 : variance.address()},
                       {light.levels.empty() ? 0 : levels.address()}},
                      settings, {filtered.address()}, !added.empty());
    });
    vulkan::read(device(), filtered, std::span(result));
    return result;
  }
  static std::vector<vec3> on_host(const DenoiseView& view, const NoisyLight& light,
                                   const DenoiseSettings& settings) {
    std::vector<vec3> result(light.light.size());
    EXPECT_TRUE(Denoiser().filter(view, light, settings, result));
    return result;
  }
};

// The same operations, of which a device may fuse some.
constexpr float kTolerance = 1e-3f;

TEST_F(DenoiseTwin, FiltersTheSameLight) {
  for (const ivec2 size : {ivec2(1, 1), ivec2(37, 23), ivec2(5, 70), ivec2(130, 33)}) {
    const NoisyWall wall(size.x, size.y);
    for (const char* beside : {"nothing", "base", "levels"}) {
      for (const bool measured : {false, true}) {
        NoisyLight light{wall.light, {}, {}};
        if (beside == std::string("base")) light.base = wall.base;
        if (beside == std::string("levels")) light.levels = wall.levels;
        if (measured) light.variance = wall.variance;
        for (const DenoiseSettings& settings : {DenoiseSettings(), emitter_denoising()}) {
          const std::vector<vec3> expected = on_host(wall.view(), light, settings);
          EXPECT_LT(difference(expected, on_device(wall.view(), light, settings)), kTolerance)
              << size.x << " x " << size.y << " " << beside << " measured " << measured;
        }
      }
    }
  }
}

TEST_F(DenoiseTwin, SpreadsNothingThatIsNoNumber) {
  NoisyWall wall(37, 23);
  wall.light[100] = vec3(std::numeric_limits<float>::quiet_NaN());
  wall.light[300] = vec3(std::numeric_limits<float>::infinity());
  wall.variance[500] = std::numeric_limits<float>::infinity();
  const NoisyLight light{wall.light, {}, wall.variance};
  const std::vector<vec3> expected = on_host(wall.view(), light, {});
  const std::vector<vec3> on_it = on_device(wall.view(), light, {});
  for (const vec3& e : on_it) EXPECT_TRUE(e.x >= 0.0f && e.x < 1e6f);
  EXPECT_LT(difference(expected, on_it), kTolerance);
}

TEST_F(DenoiseTwin, FiltersTheSameLightOfLobes) {
  for (const ivec2 size : {ivec2(1, 1), ivec2(37, 23), ivec2(130, 33)}) {
    const NoisyWall wall(size.x, size.y);
    for (const bool measured : {false, true}) {
      NoisyLight light{wall.light, {}, {}};
      if (measured) light.variance = wall.variance;
      DenoiseSettings far_emitters = emitter_denoising();
      far_emitters.far_lobe_share = 1.0f;
      for (const DenoiseSettings& settings :
           {geometric_denoising(), emitter_denoising(), excess_denoising(), reflection_denoising(4),
            far_emitters}) {
        const std::vector<vec3> expected = on_host(wall.view_with_lobes(), light, settings);
        EXPECT_LT(difference(expected, on_device(wall.view_with_lobes(), light, settings)),
                  kTolerance)
            << size.x << " x " << size.y << " measured " << measured;
        if (size.x == 1) continue;
        EXPECT_GT(difference(expected, on_host(wall.view(), light, settings)), 0.01f);
      }
    }
  }
}

TEST_F(DenoiseTwin, AddsToWhatIsThereWhereItIsAskedTo) {
  const NoisyWall wall(20, 14);
  const NoisyLight light{wall.light, {}, {}};
  std::vector<vec3> expected = on_host(wall.view(), light, {});
  for (std::size_t i = 0; i < expected.size(); ++i) expected[i] += wall.base[i];
  EXPECT_LT(difference(expected, on_device(wall.view(), light, {}, wall.base)), kTolerance);
}

}  // namespace
}  // namespace lambent::denoise_test
