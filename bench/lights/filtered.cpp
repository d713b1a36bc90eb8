// SPDX-License-Identifier: Apache-2.0
// Measures the error of filtered direct light: prints a row of a Markdown table for each scene.
//
// usage: lambent_filtered_lights SCENE...    built-in names or glTF files
#include <cstdio>
#include <exception>
#include <string>

#include "bench/stage.h"
#include "core/image/metrics.h"
#include "lambent/first_picture.h"
#include "lambent/renderer.h"
#include "lambent/world.h"
#include "scenes/builtin.h"

namespace lambent::bench {
namespace {

constexpr int kWidth = 320, kHeight = 180;
// Shadow rays of the reference, through the same points of the pixels. Its noise is a sixteenth of
// that of four rays.
constexpr int kManyRays = 1024;
constexpr int kFrames = 16, kAveragedFrames = 10;

Scene open_scene(const std::string& name) {
  return value_or_throw(scenes::is_name(name) ? scenes::make(name) : load_scene(name));
}

/// Settings for direct light only, at the centres of pixels.
FrameSettings one_sample(Quality quality) {
  FrameSettings settings = quality_settings(quality);
  settings.width = kWidth;
  settings.height = kHeight;
  settings.samples = 1;
  settings.gather_rays = 0;
  return settings;
}

LayeredImage last_picture(const World& world, const Camera& camera, const FrameSettings& settings,
                          int frames = 1) {
  Renderer renderer(world);
  RenderedFrame frame;
  for (int i = 0; i < frames; ++i) {
    frame = value_or_throw(renderer.render(camera, settings));
  }
  return std::move(frame.image);
}

/// Prints relative RMSE of pixels and of 8x8 blocks of the direct light, and FLIP of the picture.
void print_errors(const LayeredImage& image, const LayeredImage& truth) {
  const auto compare = [&](const char* layer, int block, bool perceptual) {
    return value_or_throw(compare_images(*image.find(layer), *truth.find(layer),
                                         {.block = block, .perceptual = perceptual}));
  };
  std::printf(" %.3f; %.3f; %.3f |", compare("direct", 1, false).relative_rmse,
              compare("direct", 8, false).relative_rmse, compare("", 1, true).flip);
}

void measure(const std::string& name) {
  const Scene scene = open_scene(name);
  const World world(scene);
  const Camera camera =
      scene.cameras.empty() ? value_or_throw(first_view(world)).camera : scene.cameras.front();
  FrameSettings many = one_sample(Quality::draft);
  many.emissive_samples = kManyRays;
  many.seed = 77;
  const LayeredImage truth = last_picture(world, camera, many);
  FrameSettings filtered = one_sample(Quality::interactive), raw = filtered;
  raw.denoise = false;
  std::printf("| %s |", name.c_str());
  print_errors(last_picture(world, camera, raw), truth);
  print_errors(last_picture(world, camera, filtered), truth);
  filtered.averaged_frames = kAveragedFrames;
  print_errors(last_picture(world, camera, filtered, kFrames), truth);
  std::printf("\n");
}

}  // namespace
}  // namespace lambent::bench

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: lambent_filtered_lights SCENE...\n");
    return 2;
  }
  try {
    std::printf(
        "| direct light: relative RMSE of pixels; of 8x8; FLIP | not filtered | filtered | after "
        "16 "
        "frames |\n|---|---|---|---|\n");
    for (int i = 1; i < argc; ++i) lambent::bench::measure(argv[i]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "lambent_filtered_lights: %s\n", error.what());
    return 1;
  }
  return 0;
}
