// SPDX-License-Identifier: Apache-2.0
// Frames whose noise is filtered: what the device renders is what the processor does.
#include <gtest/gtest.h>

#include "lambent/renderer.h"
#include "support/bright_skies.h"
#include "support/floor_behind_a_pane.h"
#include "support/floor_under_a_pane.h"
#include "support/frame_twin.h"
#include "support/hand_made.h"
#include "support/wall_in_a_mirror.h"

namespace lambent::filtered_frame_test {
namespace {

class FilteredFrame : public test::FrameTwin {};

// Coats, with and without a field's gather beside them, lamps' highlights, and what mirrors show.
TEST_F(FilteredFrame, WithFilteredReflectionsIsTheSame) {
  for (const int rows : {1, 2}) {
    Job job = small("spheres");
    job.frame.glossy_rows = rows;
    job.frame.gather_rays = rows - 1;
    job.frame.samples = 2;
    job.frame.denoise = true;
    EXPECT_LE(relative_rmse(render_both(job), "glossy"), kGrazing) << rows;
  }
  Job job = small("");
  job.frame.denoise = true;
  EXPECT_LE(relative_rmse(render_both(test::wall_in_a_mirror(0, 0.5f), job), "glossy"), kTolerance);
  Job gathering = job;
  gathering.frame.gather_rays = 8;
  const Frames in_mirrors = render_both(test::wall_in_a_mirror(0, 0.5f), gathering);
  EXPECT_LE(relative_rmse(in_mirrors, "glossy"), kTolerance);
  Job lookups = gathering;
  lookups.frame.gather_rays = 1;
  // Gathering makes a difference
  EXPECT_GT(
      relative_rmse({in_mirrors.cpu, render_both(test::wall_in_a_mirror(0, 0.5f), lookups).device},
                    "glossy"),
      1.5 * kTolerance);
  Scene scene = test::floor_under_a_pane();
  scene.materials[0].clearcoat = 1.0f;
  scene.materials[0].clearcoat_roughness = 0.4f;
  // Over a glossy base, and over one so rough that rays light the clearcoat alone
  for (const float roughness : {scene.materials[0].roughness, 1.0f}) {
    scene.materials[0].roughness = roughness;
    const Frames frames = render_both(scene, job);
    EXPECT_LE(relative_rmse(frames, "glossy"), kTolerance) << roughness;
    Job noisy = job;
    noisy.frame.denoise = false;
    // Filtering makes a difference, the less the more of the light is the field's
    EXPECT_GT(relative_rmse({frames.cpu, render_both(scene, noisy).device}, "glossy"),
              1.5 * kTolerance)
        << roughness;
  }
}

// What panes show: of matte, glossy and lacquered floors, sharp and blurred, whole and in part.
TEST_F(FilteredFrame, WithFilteredLightBehindGlassIsTheSame) {
  Job job = small("");
  job.frame.denoise = true;
  job.field.rays_per_probe = 64;  // of 32, one that crosses glass on one side alone is 1.4 %
  for (const float roughness : {0.0f, 0.4f}) {
    for (const Material& floor : test::floors_to_show()) {
      for (const bool slab : {false, true}) {
        Scene scene = test::floor_behind_a_pane(floor, roughness, slab);
        if (slab) scene.environment = test::checkered_sky();
        const Light lamp = test::point_light(glm::vec3(0.5f), {0.3f, 1.0f, -0.5f});
        if (!slab) scene.lights.push_back(lamp);
        const Frames frames = render_both(scene, job);
        EXPECT_LE(relative_rmse(frames, "transmission"), kTolerance) << roughness << slab;
        EXPECT_LE(relative_rmse(frames, ""), kTolerance) << roughness << slab;
      }
    }
    job.frame.emissive_samples = job.frame.reflected_emissive_samples = 1;
    job.frame.first_row = 9;
    job.frame.rows = 5;
  }
}

TEST_F(FilteredFrame, WithGatheredLightBehindGlassIsTheSame) {
  Job job = small("");
  job.frame.denoise = true;
  job.frame.gather_rays = 32;  // of fewer, one that crosses glass on one side alone is 1 %
  job.field.rays_per_probe = 64;
  Scene scene = test::floor_behind_a_pane(test::lambert(glm::vec3(0.6f)), 0.0f, true);
  scene.environment = test::checkered_sky();
  const Frames frames = render_both(scene, job);
  EXPECT_LE(relative_rmse(frames, "transmission"), kTolerance);
  job.frame.gather_rays = 1;
  const Frames lookups = render_both(scene, job);
  EXPECT_GT(relative_rmse({frames.cpu, lookups.device}, "transmission"), 1.5 * kTolerance)
      << "gathering makes no difference";
}

TEST_F(FilteredFrame, WithRowsOfFilteredReflectionsIsTheSame) {
  Job job = filtered_rows("");
  EXPECT_LE(relative_rmse(render_both(test::floor_under_a_pane(), job), "glossy"), kTolerance);
}

TEST_F(FilteredFrame, WithRowsOfFilteredLightIsTheSame) {
  Job job = filtered_rows("cornell");
  job.frame.gather_rays = 1;
  expect_alike(render_both(job));
}

TEST_F(FilteredFrame, WithFilteredLightIsTheSame) {
  // Of one ray a pixel, whose variance is estimated, and of several, whose variance is measured
  for (const int rays : {1, 4}) {
    Job job = small("cornell");
    job.frame.width = 32, job.frame.height = 24;
    job.frame.gather_rays = rays;
    job.frame.denoise = true;
    expect_alike(render_both(job));
  }
}

}  // namespace
}  // namespace lambent::filtered_frame_test
