// SPDX-License-Identifier: Apache-2.0
// Further samples of some pixels: the device takes as many as the processor, and shows the same.
#include <algorithm>
#include <cmath>

#include "lambent/field.h"
#include "lambent/renderer.h"
#include "lambent/world.h"
#include "scenes/builtin.h"
#include "support/vulkan_device.h"

namespace lambent::further_samples_twin {
namespace {

constexpr int kWidth = 32, kHeight = 24;

FrameSettings two_to_eight_samples(int gather_rays) {
  FrameSettings settings;
  settings.width = kWidth;
  settings.height = kHeight;
  settings.samples = 2;
  settings.most_samples = 8;
  settings.gather_rays = gather_rays;
  settings.denoise = true;
  settings.motion = true;
  return settings;
}

LayeredImage render(const Scene& scene, const World& world, const FrameSettings& settings) {
  FieldSettings field_settings;
  field_settings.probe_count = {4, 4, 4};
  field_settings.rays_per_probe = 32;
  field_settings.corrections = false;
  Expected<IrradianceField> field = IrradianceField::make(field_settings, open_bounds(world));
  for (int i = 0; i < 2; ++i) field->update(world);
  IndirectSources sources;
  sources.field = &*field;
  return Renderer(world, sources).render(scene.cameras.front(), settings).value().image;
}

/// For each pixel, whether its position is the same in both, up to rounding: a mean of as many
/// samples.
std::vector<bool> where_alike(const LayeredImage& a, const LayeredImage& b) {
  constexpr float kRounding = 1e-4f;
  const std::vector<float>&here = a.find("position")->pixels, &there = b.find("position")->pixels;
  std::vector<bool> alike(here.size() / 3, true);
  for (std::size_t i = 0; i < here.size(); ++i) {
    if (std::abs(here[i] - there[i]) > kRounding) alike[i / 3] = false;
  }
  return alike;
}

/// Root mean square of the difference of a layer in some pixels over its root mean square in `a`.
double relative_rmse(const Image& a, const Image& b, const std::vector<bool>& pixels) {
  double difference = 0.0, whole = 0.0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    if (!pixels[i / static_cast<std::size_t>(a.channels)]) continue;
    const double d = static_cast<double>(a.pixels[i]) - b.pixels[i];
    difference += d * d;
    whole += static_cast<double>(a.pixels[i]) * a.pixels[i];
  }
  return whole > 0.0 ? std::sqrt(difference / whole) : std::sqrt(difference);
}

class FurtherSamplesTwin : public test::OnDevice {};

// Light behind glass, clearcoats, coats in mirrors and samples of emitters, in two rounds. Where a
// pixel's samples differ by about as much as is visible, one side alone takes more. Gathering rays
// that meet glass draw by a hash of their bits, and differ.
TEST_F(FurtherSamplesTwin, ShowTheSameAsOnTheProcessor) {
  for (const char* name : {"glass", "spheres", "cornell"}) {
    Scene scene = *scenes::make(name);
    if (std::string_view(name) == "cornell") {
      scene.fog.emplace_back();
      scene.fog.back().density = 0.1f;
    }
    const bool has_glass = std::string_view(name) == "glass";
    const FrameSettings settings = two_to_eight_samples(has_glass ? 0 : 4);
    const World here(scene), there(scene, shared_device());
    const LayeredImage cpu = render(scene, here, settings);
    const LayeredImage device = render(scene, there, settings);
    const std::vector<bool> pixels = where_alike(cpu, device);
    EXPECT_LE(std::count(pixels.begin(), pixels.end(), false), kWidth * kHeight / 30) << name;
    for (const Layer& layer : cpu.layers) {
      if (layer.name == "motion") continue;  // unknown in a first picture
      EXPECT_LE(relative_rmse(layer.image, *device.find(layer.name), pixels), 0.01)
          << name << ", layer " << layer.name;
    }

    FrameSettings two = settings;
    two.most_samples = 0;
    const std::vector<bool> alone = where_alike(cpu, render(scene, here, two));
    EXPECT_GT(std::count(alone.begin(), alone.end(), false), kWidth * kHeight / 50) << name;
  }
}

}  // namespace
}  // namespace lambent::further_samples_twin
