// SPDX-License-Identifier: Apache-2.0
// Frames of the processor and of a device, beside each other.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "lambent/field.h"
#include "lambent/renderer.h"
#include "lambent/rsm.h"
#include "lambent/world.h"
#include "scenes/builtin.h"
#include "support/lit_box.h"
#include "support/vulkan_device.h"

namespace lambent::test {

struct Frames {
  LayeredImage cpu, device;
};

struct Job {
  const char* scene;
  FieldSettings field;
  FrameSettings frame;
  int updates = 2;
  bool with_rsm = false;
  std::vector<FogVolume> fog = {};
  int lights = 0;  // that shine in place of the scene's, if any, and how many a pixel asks
  int direct_lights = 0;
  bool merge_maps = false;
};

/// The light of maps alone, and direct light in their sub-images.
inline LayeredImage render_directly(const Scene& scene, const World& world, const Job& job) {
  IndirectSources sources;
  sources.rsm.emplace();
  sources.rsm->resolution = 32;
  sources.rsm->texels = 256;
  sources.rsm->direct = true;
  sources.rsm->direct_lights = job.direct_lights;
  sources.rsm->merge_maps = job.merge_maps;
  return Renderer(world, sources).render(scene.cameras.front(), job.frame).value().image;
}

inline LayeredImage render(const Scene& scene, const World& world, const Job& job) {
  Expected<IrradianceField> field = IrradianceField::make(job.field, open_bounds(world));
  for (int i = 0; i < job.updates; ++i) field->update(world);
  RsmSettings maps;
  maps.resolution = 64;
  maps.texels = 256;
  IndirectSources sources;
  sources.field = &*field;
  if (job.with_rsm) sources.rsm = maps;
  return Renderer(world, sources).render(scene.cameras.front(), job.frame).value().image;
}

/// Renders frames on both sides.
class FrameTwin : public OnDevice {
 protected:
  using Frames = test::Frames;
  using Job = test::Job;

  // The bar for pictures. Both sides draw the same random numbers; where a ray grazes an edge
  // or a random decision is as close as rounding, single pixels differ.
  static constexpr double kTolerance = 0.01,
                          kGrazing = 0.02;  // the latter for rays that graze surfaces

  static constexpr int kWidth = 48, kHeight = 32;

  /// Root mean square of the difference of a layer over its root mean square on the processor.
  static double relative_rmse(const Frames& frames, const std::string& name) {
    const Image& a = *frames.cpu.find(name);
    const Image& b = *frames.device.find(name);
    double difference = 0.0, whole = 0.0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
      const double d = static_cast<double>(a.pixels[i]) - b.pixels[i];
      difference += d * d;
      whole += static_cast<double>(a.pixels[i]) * a.pixels[i];
    }
    return whole > 0.0 ? std::sqrt(difference / whole) : std::sqrt(difference);
  }

  static Frames render_both(const Job& job) {
    Scene scene = *scenes::make(job.scene);
    scene.fog = job.fog;
    if (job.lights > 0) {
      scene.lights = lit_box(job.scene, job.lights).lights;
      const World here(scene), there(scene, shared_device());
      return {render_directly(scene, here, job), render_directly(scene, there, job)};
    }
    return render_both(scene, job);
  }

  static Frames render_both(const Scene& scene, const Job& job) {
    const World here(scene), there(scene, shared_device());
    return {render(scene, here, job), render(scene, there, job)};
  }

  static Job small(const char* scene) {
    Job job{scene, {}, {}};
    job.field.probe_count = {4, 4, 4};
    job.field.rays_per_probe = 32;
    job.frame.width = kWidth;
    job.frame.height = kHeight;
    return job;
  }

  /// Few rows in the middle of a picture that is higher than what their filter reads.
  static Job filtered_rows(const char* scene) {
    Job job = small(scene);
    job.frame.width = 20;
    job.frame.height = 150;
    job.frame.first_row = 70;
    job.frame.rows = 9;
    job.frame.denoise = true;
    return job;
  }

  static void expect_alike(const Frames& frames) {
    for (const Layer& layer : frames.cpu.layers) {
      EXPECT_LE(relative_rmse(frames, layer.name), kTolerance) << "layer " << layer.name;
    }
  }
};

}  // namespace lambent::test
