// SPDX-License-Identifier: Apache-2.0
// Direct light that is found in the sub-images of reflective shadow maps, against that which every
// sample finds for itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "lambent/renderer.h"
#include "rsm/direct_lights.h"
#include "support/field_scenes.h"
#include "support/lit_box.h"

namespace lambent::rsm_direct_test {
namespace {

using test::Stage;

RsmSettings small_maps() {
  RsmSettings maps;
  maps.resolution = 16;
  maps.texels = 16;
  return maps;
}

FrameSettings small_frame() {
  FrameSettings frame;
  frame.width = 61;
  frame.height = 43;
  frame.samples = 1;
  return frame;
}

LayeredImage render(const Stage& stage, const RsmSettings& maps, const FrameSettings& frame) {
  IndirectSources sources;
  sources.rsm = maps;
  return Renderer(stage.world, sources).render(stage.scene.cameras.front(), frame).value().image;
}

LayeredImage render_directly(const Stage& stage, RsmSettings maps, int lights,
                             const FrameSettings& frame) {
  maps.direct = true;
  maps.direct_lights = lights;
  return render(stage, maps, frame);
}

double mean(const LayeredImage& image, const char* layer) {
  const std::vector<float>& pixels = image.find(layer)->pixels;
  return std::accumulate(pixels.begin(), pixels.end(), 0.0) / static_cast<double>(pixels.size());
}

/// Root mean square of the difference of a layer over its mean.
double error(const LayeredImage& image, const LayeredImage& truth, const char* layer) {
  const std::vector<float>&a = image.find(layer)->pixels, &b = truth.find(layer)->pixels;
  double squares = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) squares += std::pow(double{a[i]} - b[i], 2.0);
  return std::sqrt(squares / static_cast<double>(a.size())) / mean(truth, layer);
}

TEST(RsmDirectLights, AreEachAskedByAsManySubMaps) {
  for (const int sub_maps : {1, 3, 4, 16}) {
    for (const std::size_t lights : {0u, 1u, 2u, 8u, 64u, 1000u}) {
      for (const int asked : {0, 1, 4, 100}) {
        RsmSettings settings;
        settings.sub_maps = settings.sub_images = sub_maps;
        settings.direct = true;
        settings.direct_lights = asked;
        const DealtLights dealt = deal_direct_lights(lights, settings);
        const std::size_t subs = static_cast<std::size_t>(sub_maps) * sub_maps;
        EXPECT_EQ(dealt.dealt.size(), subs * dealt.per_sub_map);
        EXPECT_EQ(dealt.shared(), dealt.per_sub_map < lights);
        EXPECT_GE(dealt.per_sub_map, asked == 0 ? lights : std::min<std::size_t>(asked, lights));
        std::vector<double> sums(lights, 0.0);
        std::vector<int> counts(lights, 0);
        for (std::size_t s = 0; s < subs; ++s) {
          const auto of_sub = dealt.of(static_cast<int>(s));
          for (std::size_t k = 0; k < of_sub.size(); ++k) {
            EXPECT_TRUE(k == 0 || of_sub[k - 1].light < of_sub[k].light);  // none twice
            sums[of_sub[k].light] += of_sub[k].weight;
            ++counts[of_sub[k].light];
          }
        }
        for (const double sum : sums) EXPECT_NEAR(sum, static_cast<double>(subs), 1e-4);
        if (lights == 0) continue;
        const auto [least, most] = std::minmax_element(counts.begin(), counts.end());
        EXPECT_LE(*most - *least, 1) << lights << " lights, " << asked << " asked";
      }
    }
  }
}

// Metals, emissive surfaces, fog and all kinds of light: a pixel that asks all lights finds what a
// sample of a plain frame finds.
TEST(RsmDirect, IsPlainDirectLightWhereAllLightsAreAsked) {
  for (const bool fog : {false, true}) {
    Scene scene = test::lit_box("spheres", 7);
    if (fog) {
      FogVolume low;
      low.size = glm::vec3(20.0f);
      low.density = 0.1f;
      low.albedo = {0.9f, 0.5f, 0.2f};
      scene.fog = {low};
    }
    const Stage stage(std::move(scene));
    const LayeredImage plain = render(stage, small_maps(), small_frame());
    const LayeredImage ours = render_directly(stage, small_maps(), 0, small_frame());
    ASSERT_GT(mean(plain, "glossy"), 0.0);
    for (const Layer& layer : plain.layers) {
      const std::vector<float>& pixels = ours.find(layer.name)->pixels;
      for (std::size_t i = 0; i < pixels.size(); ++i) {
        const float expected = layer.image.pixels[i];
        ASSERT_NEAR(pixels[i], expected, 1e-5f * std::abs(expected) + 1e-6f)
            << layer.name << ", number " << i;
      }
    }
  }
}

TEST(RsmDirect, IsPlainDirectLightBehindGlass) {
  const Stage stage(test::lit_box("glass", 4));
  const LayeredImage plain = render(stage, small_maps(), small_frame());
  const LayeredImage ours = render_directly(stage, small_maps(), 0, small_frame());
  ASSERT_GT(mean(plain, "direct"), 0.0);
  EXPECT_LT(error(ours, plain, "direct"), 1e-5);
}

// More lights than a plain frame asks: it draws from them. Its mean over many samples is what we
// find with one.
TEST(RsmDirect, IsTheMeanOfDrawnLight) {
  const Stage stage(test::lit_box("cornell-spot", 40));
  FrameSettings many = small_frame();
  many.samples = 64;
  const LayeredImage plain = render(stage, small_maps(), many);
  RsmSettings maps = small_maps();
  const LayeredImage ours = render_directly(stage, maps, 0, small_frame());
  EXPECT_NEAR(mean(ours, "direct") / mean(plain, "direct"), 1.0, 0.01);
}

// Lights are shared out: the brightest and 4 of 40 to each pixel. Where nothing is in the way
// nothing changes; errors are where shadows end.
TEST(RsmDirect, OfLightsThatAreSharedOutKeepsItsMeanAndMostOfItsDetail) {
  const Stage stage(test::lit_box("spheres", 40));
  FrameSettings frame = small_frame();
  frame.width = 160;
  frame.height = 120;
  const LayeredImage all = render_directly(stage, small_maps(), 0, frame);
  const LayeredImage few = render_directly(stage, small_maps(), 4, frame);
  EXPECT_NEAR(mean(few, "direct") / mean(all, "direct"), 1.0, 0.01);
  EXPECT_NEAR(mean(few, "glossy") / mean(all, "glossy"), 1.0, 0.01);
  EXPECT_LT(error(few, all, "direct"), 0.15);
  // Without the blur each pixel knows of its own lights alone
  RsmSettings unblurred = small_maps();
  unblurred.final_blur = false;
  const LayeredImage noisy = render_directly(stage, unblurred, 4, frame);
  EXPECT_GT(error(noisy, all, "direct"), 2.0 * error(few, all, "direct"));
}

TEST(RsmDirect, OfLightsThatAreSharedOutIsExactWhereNothingIsInTheWay) {
  Scene scene = test::lit_box("cornell-spot", 40);
  scene.instances.resize(1);  // the floor
  const Stage stage(std::move(scene));
  const LayeredImage all = render_directly(stage, small_maps(), 0, small_frame());
  const LayeredImage few = render_directly(stage, small_maps(), 4, small_frame());
  ASSERT_GT(mean(all, "direct"), 0.0);
  EXPECT_LT(error(few, all, "direct"), 1e-5);
}

TEST(RsmDirect, TakesOneRayAPixelAndLightThatIsAsked) {
  const Stage stage(test::lit_box("cornell-spot", 40));
  IndirectSources sources;
  sources.rsm = small_maps();
  sources.rsm->direct = true;
  const auto rays = [&](int lights) {
    sources.rsm->direct_lights = lights;
    return Renderer(stage.world, sources)
        .render(stage.scene.cameras.front(), small_frame())
        .value()
        .rays;
  };
  const std::uint64_t pixels = 61u * 43u;
  EXPECT_LE(rays(4) - pixels, 5u * pixels);  // and one to the brightest
  EXPECT_GT(rays(4) - pixels, pixels);
  EXPECT_GT(rays(0), 5u * rays(4));
}

TEST(RsmDirect, OfRowsIsThatOfTheWholePicture) {
  const Stage stage(test::lit_box("spheres", 20));
  IndirectSources sources;
  sources.rsm = small_maps();
  sources.rsm->direct = true;
  sources.rsm->direct_lights = 3;
  FrameSettings frame = small_frame();
  const Camera& camera = stage.scene.cameras.front();
  const LayeredImage whole = Renderer(stage.world, sources).render(camera, frame).value().image;
  Renderer renderer(stage.world, sources);
  for (frame.first_row = 0; frame.first_row < frame.height; frame.first_row += frame.rows) {
    frame.rows = std::min(10, frame.height - frame.first_row);
    const LayeredImage part = renderer.render(camera, frame).value().image;
    for (const char* layer : {"direct", "glossy", ""}) {
      const std::vector<float>& pixels = part.find(layer)->pixels;
      EXPECT_TRUE(
          std::equal(pixels.begin(), pixels.end(), whole.find(layer)->at(0, frame.first_row)))
          << layer << ", row " << frame.first_row;
    }
  }
}

// Odd sizes, few pixels, coarse views and many sub-images.
TEST(RsmDirect, IsFiniteAndCloseInPicturesOfAnySizeAndScale) {
  const Stage stage(test::lit_box("spheres", 20));
  for (const ivec2 size : {ivec2(1, 1), ivec2(3, 70), ivec2(90, 5), ivec2(48, 32)}) {
    for (const int sub_images : {1, 3, 16}) {
      FrameSettings frame = small_frame();
      frame.width = size.x;
      frame.height = size.y;
      frame.samples = 2;
      RsmSettings maps = small_maps();
      maps.sub_images = maps.sub_maps = sub_images;
      maps.downscale = sub_images == 3 ? 2 : 1;
      const LayeredImage image = render_directly(stage, maps, 2, frame);
      for (const char* layer : {"direct", "glossy"}) {
        for (const float value : image.find(layer)->pixels) {
          ASSERT_TRUE(std::isfinite(value) && value >= 0.0f) << layer;
        }
      }
      if (size != ivec2(48, 32)) continue;
      const LayeredImage all = render_directly(stage, maps, 0, frame);
      EXPECT_NEAR(mean(image, "direct") / mean(all, "direct"), 1.0, 0.1) << sub_images;
    }
  }
}

TEST(RsmDirect, SettingsAreRefusedWhereTheyMeanNothing) {
  const auto refused = [](RsmSettings settings) {
    const Expected<void> fine = check(settings);
    return fine ? std::string() : fine.error().place;
  };
  EXPECT_EQ(refused({.direct = true}), "");
  EXPECT_EQ(refused({.direct = true, .direct_lights = 65536}), "");
  EXPECT_EQ(refused({.direct = true, .direct_lights = 65537}), "direct_lights");
  EXPECT_EQ(refused({.direct = true, .direct_lights = -1}), "direct_lights");
  EXPECT_EQ(refused({.direct_lights = 4}), "direct_lights");
  EXPECT_EQ(refused({.from_camera = true, .direct = true}), "direct");
  EXPECT_EQ(refused({.merge_maps = true}), "");
  EXPECT_EQ(refused({.texels = 0, .merge_maps = true}), "merge_maps");
  EXPECT_EQ(refused({.pattern = RsmPattern::disk, .merge_maps = true}), "merge_maps");
}

}  // namespace
}  // namespace lambent::rsm_direct_test
