// SPDX-License-Identifier: Apache-2.0
// Whole frames: what the device renders is what the processor does, on the same seeds and schedule.
#include <cmath>

#include "lambent/field.h"
#include "lambent/renderer.h"
#include "lambent/rsm.h"
#include "lambent/world.h"
#include "scenes/builtin.h"
#include "support/vulkan_device.h"

namespace lambent {
namespace {

// The bar for pictures. Both sides draw the same random numbers; where a ray grazes an edge
// or a random decision is as close as rounding, single pixels differ.
constexpr double kTolerance = 0.01;

constexpr int kWidth = 48, kHeight = 32;

struct Frames {
  LayeredImage cpu, device;
};

/// Root mean square of the difference of a layer over its root mean square on the processor.
double relative_rmse(const Frames& frames, const std::string& name) {
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

struct Job {
  const char* scene;
  FieldSettings field;
  FrameSettings frame;
  int updates = 2;
  bool with_rsm = false;
};

LayeredImage render(const Scene& scene, const World& world, const Job& job) {
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

class Frame : public test::OnDevice {
 protected:
  static Frames render_both(const Job& job) {
    const Scene scene = *scenes::make(job.scene);
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

  static void expect_alike(const Frames& frames) {
    for (const Layer& layer : frames.cpu.layers) {
      EXPECT_LE(relative_rmse(frames, layer.name), kTolerance) << "layer " << layer.name;
    }
  }
};

TEST_F(Frame, OfCornellIsTheSame) {
  expect_alike(render_both(small("cornell")));
}

TEST_F(Frame, OfTwoRoomsIsTheSame) {
  expect_alike(render_both(small("two-rooms")));
}

TEST_F(Frame, OfTheAtriumIsTheSame) {
  expect_alike(render_both(small("atrium")));
}

TEST_F(Frame, SeenByRaysIsTheSame) {
  Job job = small("two-rooms");
  job.field.visibility = Visibility::hybrid;
  expect_alike(render_both(job));
}

TEST_F(Frame, WithGatheredLightIsTheSame) {
  Job job = small("cornell");
  job.frame.width = 24;
  job.frame.height = 16;
  job.frame.gather_rays = 4;
  job.frame.samples = 2;
  expect_alike(render_both(job));
}

TEST_F(Frame, WithMapsIsTheSame) {
  Job job = small("cornell");
  job.with_rsm = true;
  job.updates = 1;
  expect_alike(render_both(job));
}

}  // namespace
}  // namespace lambent
