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
#include "support/floor_behind_a_pane.h"
#include "support/floor_under_a_pane.h"
#include "support/hand_made.h"
#include "support/lit_box.h"
#include "support/vulkan_device.h"
#include "support/wall_in_a_mirror.h"

namespace lambent::frame_test {
namespace {

// The bar for pictures. Both sides draw the same random numbers; where a ray grazes an edge
// or a random decision is as close as rounding, single pixels differ.
constexpr double kTolerance = 0.01, kGrazing = 0.02;  // the latter for rays that graze surfaces

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
  std::vector<FogVolume> fog = {};
  int lights = 0;  // that shine in place of the scene's, if any, and how many a pixel asks
  int direct_lights = 0;
  bool merge_maps = false;
};

/// The light of maps alone, and direct light in their sub-images.
LayeredImage render_directly(const Scene& scene, const World& world, const Job& job) {
  IndirectSources sources;
  sources.rsm.emplace();
  sources.rsm->resolution = 32;
  sources.rsm->texels = 256;
  sources.rsm->direct = true;
  sources.rsm->direct_lights = job.direct_lights;
  sources.rsm->merge_maps = job.merge_maps;
  return Renderer(world, sources).render(scene.cameras.front(), job.frame).value().image;
}

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
    Scene scene = *scenes::make(job.scene);
    scene.fog = job.fog;
    if (job.lights > 0) {
      scene.lights = test::lit_box(job.scene, job.lights).lights;
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

TEST_F(Frame, WithFilteredLightIsTheSame) {
  // Of one ray a pixel, whose variance is estimated, and of several, whose variance is measured
  for (const int rays : {1, 4}) {
    Job job = small("cornell");
    job.frame.width = 32, job.frame.height = 24;
    job.frame.gather_rays = rays;
    job.frame.denoise = true;
    expect_alike(render_both(job));
  }
}

// Coats, with and without a field's gather beside them, lamps' highlights, and what mirrors show.
TEST_F(Frame, WithFilteredReflectionsIsTheSame) {
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
TEST_F(Frame, WithFilteredLightBehindGlassIsTheSame) {
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

TEST_F(Frame, WithRowsOfFilteredReflectionsIsTheSame) {
  Job job = filtered_rows("");
  EXPECT_LE(relative_rmse(render_both(test::floor_under_a_pane(), job), "glossy"), kTolerance);
}

TEST_F(Frame, WithRowsOfFilteredLightIsTheSame) {
  Job job = filtered_rows("cornell");
  job.frame.gather_rays = 1;
  expect_alike(render_both(job));
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
