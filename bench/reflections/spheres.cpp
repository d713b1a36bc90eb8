// SPDX-License-Identifier: Apache-2.0
// The error of what metal spheres reflect in the Cornell box, by their roughness.
#include <cstdio>

#include "bench/reflections/subject.h"
#include "bench/stage.h"

namespace lambent::reflections {
namespace {

constexpr int kBlock = 8;

/// The spheres, all of one roughness.
Scene spheres_of(float roughness) {
  Scene scene = bench::open_stage("spheres");
  for (Material& material : scene.materials) {
    if (!material.lambert) material.roughness = roughness;
  }
  return scene;
}

}  // namespace

void measure_spheres() {
  std::printf("### Reflections of metal spheres in the Cornell box, 8x8 blocks\n");
  std::printf("| roughness | mean ratio | relative RMSE |\n|---|---|---|\n");
  for (const float roughness : {0.0f, 0.1f, 0.2f, 0.4f, 0.6f, 0.8f}) {
    const Subject subject(spheres_of(roughness));
    const Reflected found = reflected_in(subject, subject.scene.cameras.front(), kSide, kSamples);
    const Metrics metrics = bench::value_or_throw(compare_images(
        found.ours, found.reference,
        {.block = kBlock, .standard_error = &found.standard_error, .perceptual = false}));
    std::printf("| %.1f | %.4f | %.4f |\n", roughness, metrics.mean_ratio,
                metrics.noise_corrected_relative_rmse.value_or(metrics.relative_rmse));
    std::fflush(stdout);
  }
}

}  // namespace lambent::reflections
