// SPDX-License-Identifier: Apache-2.0
// Whole frames: what the device renders is what the processor does, on the same seeds and schedule.
#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "compose/unlit.h"
#include "lambent/field.h"
#include "lambent/renderer.h"
#include "lambent/rsm.h"
#include "lambent/world.h"
#include "scenes/builtin.h"
#include "support/bright_skies.h"
#include "support/floor_under_a_pane.h"
#include "support/frame_twin.h"
#include "support/hand_made.h"

namespace lambent::frame_test {
namespace {

class Frame : public test::FrameTwin {};

TEST_F(Frame, OfCornellIsTheSame) {
  expect_alike(render_both(small("cornell")));
}

TEST_F(Frame, OfTwoRoomsIsTheSame) {
  expect_alike(render_both(small("two-rooms")));
}

// The red wall is unlit, and seen at eight times its colour.
TEST_F(Frame, OfUnlitSurfacesIsTheSame) {
  Job job = small("cornell");
  job.field.rays_per_probe = 64;  // one with a pick as close as rounding then changes less
  job.frame.unlit_radiance = 8.0f;
  Scene scene = *scenes::make(job.scene);
  for (Material& material : scene.materials) {
    material.unlit = material.emission == glm::vec3(0.0f) && material.base_color.x > 0.5f &&
                     material.base_color.y < 0.2f;
  }
  ASSERT_TRUE(shows_unlit(scene));
  const Frames frames = render_both(scene, job);
  expect_alike(frames);
  const Image& emission = *frames.device.find("emission");
  float reddest = 0.0f;
  for (std::size_t i = 0; i < emission.pixels.size(); i += 3) {
    // The lamp, which emits green, too, is brighter
    const bool of_lamp = emission.pixels[i + 1] > 1.0f;
    if (!of_lamp) reddest = std::max(reddest, emission.pixels[i]);
  }
  EXPECT_NEAR(reddest, 8.0f * 0.63f, 1e-3f);
}

// Its bumps turn reflections: directions of rays hang on textures that both sides filter alike.
TEST_F(Frame, OfTheAtriumIsTheSame) {
  expect_alike(render_both(small("atrium")));
}

// A pane, and a ball that refracts; half of the light comes through the pane. A hash of a ray's
// bits decides whether it crosses glass. Rays of probes have the same bits on both sides; those
// that learn corrections start at hits, which are rounded differently, so that what they learn of
// glass differs by noise.
TEST_F(Frame, OfGlassIsTheSame) {
  Job job = small("glass");
  job.field.corrections = false;
  expect_alike(render_both(job));
}

// The lamp behind the pane has the weights of the floor's own samples on both sides.
TEST_F(Frame, OfALampBehindAPaneIsTheSameWhateverTheNumbersOfSamples) {
  Job job = small("");
  job.frame.emissive_samples = 1;
  job.frame.reflected_emissive_samples = 16;
  EXPECT_LE(relative_rmse(render_both(test::floor_under_a_pane(), job), "glossy"), kTolerance);
}

// A ray that grazes a sphere on one side alone changes a pixel and those that take its rays.
TEST_F(Frame, WithReflectionsIsTheSame) {
  for (const int rows : {0, 1, 2}) {
    Job job = small("spheres");
    job.frame.glossy_rows = rows;
    job.frame.coat_rays = rows + 1;
    job.frame.reflected_emissive_samples = 3;
    job.frame.samples = 2;
    const Frames frames = render_both(job);
    EXPECT_LE(relative_rmse(frames, "glossy"), rows == 0 ? kTolerance : kGrazing) << rows;
    EXPECT_LE(relative_rmse(frames, "direct"), kTolerance) << rows;
  }
}

// Rows of a picture rendered in parts take the rays of those above and below on the device, too.
TEST_F(Frame, UnderAMapOfTheSkyIsTheSame) {
  Scene scene;
  scene.materials.resize(1);
  scene.materials[0].metallic = 1.0f;
  scene.materials[0].roughness = 0.4f;
  // Each ball also shows the sky that the other one reflects
  test::add(scene, test::sphere(1.0f, 16, 0));
  test::add(scene, test::sphere(1.0f, 16, 0),
            glm::translate(glm::mat4(1.0f), glm::vec3(1.6f, 0.4f, -1.6f)));
  scene.materials[0].clearcoat = 1.0f;
  scene.materials[0].clearcoat_roughness = 0.3f;
  // Finer than pixels in the middle and coarser than lobes at the edge
  scene.environment = test::checkered_sky();
  scene.cameras.push_back(look_at({0.0f, 0.3f, 4.0f}, {0.0f, 0.0f, 0.0f}, 0.8f));
  const Frames frames = render_both(scene, small(""));
  expect_alike(frames);
  const std::vector<float>& glossy = frames.cpu.find("glossy")->pixels;
  EXPECT_GT(*std::max_element(glossy.begin(), glossy.end()), 1.0f);
}

TEST_F(Frame, WithReflectionsIsTheSameInRows) {
  Job job = small("spheres");
  job.frame.first_row = 13;
  job.frame.rows = 6;
  EXPECT_LE(relative_rmse(render_both(job), "glossy"), 0.02);
}

// Light that lamps send through fog, that surfaces send on, and that it scatters to the camera.
TEST_F(Frame, InFogIsTheSame) {
  FogVolume thin, low;
  thin.size = low.size = glm::vec3(20.0f);
  thin.density = 0.05f;
  thin.anisotropy = 0.4f;
  low.centre.y = 10.0f;
  low.density = 0.5f;
  low.scale_height = 0.5f;
  low.albedo = {0.9f, 0.5f, 0.2f};
  for (const char* scene : {"cornell", "two-rooms"}) {
    for (const bool filters : {false, true}) {
      Job job = small(scene);
      job.fog = {thin, low};
      job.frame.fog = {4, 24, 2};
      job.frame.denoise = filters;
      job.frame.gather_rays = filters ? 1 : 0;
      const Frames frames = render_both(job);
      expect_alike(frames);
      const std::vector<float>& fog = frames.device.find("fog")->pixels;
      EXPECT_GT(*std::min_element(fog.begin(), fog.end()), 0.0f);
    }
  }
}

TEST_F(Frame, InFogIsTheSameInRows) {
  Job job = small("cornell");
  job.fog = {FogVolume{}};
  job.fog[0].size = glm::vec3(20.0f);
  job.frame.samples = 2;
  job.frame.first_row = 13;
  job.frame.rows = 6;
  expect_alike(render_both(job));
}

TEST_F(Frame, SeenByRaysIsTheSame) {
  Job job = small("two-rooms");
  job.field.visibility = Visibility::hybrid;
  expect_alike(render_both(job));
}

TEST_F(Frame, WithGatheredLightIsTheSame) {
  Job job = small("cornell");
  job.frame.width = 24, job.frame.height = 16;
  job.frame.gather_rays = 4, job.frame.samples = 2;
  const Frames guided = render_both(job);
  expect_alike(guided);
  job.frame.guides_gathers = false;  // which the device's rays were, too
  EXPECT_NE(guided.device.find("indirect")->pixels,
            render_both(job).device.find("indirect")->pixels);
}

TEST_F(Frame, WithMapsIsTheSame) {
  Job job = small("cornell");
  job.with_rsm = true;
  job.updates = 1;
  expect_alike(render_both(job));
}

// Suns, points and spots over metals, through glass and through fog, all asked or shared out. A
// picture that is wider than a workgroup's part of a sub-image, and several samples.
TEST_F(Frame, WithDirectLightInSubImagesIsTheSame) {
  FogVolume fog;
  fog.size = glm::vec3(20.0f);
  fog.density = 0.05f;
  for (const char* scene : {"spheres", "glass"}) {
    for (const int direct_lights : {0, 3}) {
      Job job = small(scene);
      job.lights = 20;
      job.direct_lights = direct_lights;
      job.frame.width = 70;
      job.frame.samples = 2;
      if (direct_lights > 0) job.fog = {fog};
      const Frames frames = render_both(job);
      for (const char* layer : {"direct", "glossy"}) {
        EXPECT_GT(frames.cpu.find(layer)->pixels.size(), 0u);
        EXPECT_LE(relative_rmse(frames, layer), kTolerance) << scene << ", " << layer;
      }
    }
  }
}

// More lights than fit into memory at once for a band's rays.
TEST_F(Frame, WithDirectLightOfManyLightsIsTheSame) {
  Job job = small("cornell-spot");
  job.lights = 300;
  job.frame.width = 128, job.frame.height = 96;
  EXPECT_LE(relative_rmse(render_both(job), "direct"), kTolerance);
}

// Clusters that are brought together are others where hits are rounded differently.
TEST_F(Frame, WithMergedMapsIsAlike) {
  constexpr double kOtherClusters = 0.1;
  Job job = small("cornell-spot");
  job.lights = 12;
  job.merge_maps = true;
  EXPECT_LE(relative_rmse(render_both(job), "indirect"), kOtherClusters);
}

}  // namespace
}  // namespace lambent::frame_test
