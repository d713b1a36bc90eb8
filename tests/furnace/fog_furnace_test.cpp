// SPDX-License-Identifier: Apache-2.0
// Fog of frames and of the reference against closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "lambent/renderer.h"
#include "raytracing/camera_rays.h"
#include "raytracing/world_access.h"
#include "reference/path_tracer.h"
#include "scene/media/media.h"
#include "shared/constants.h"
#include "shared/phase.h"
#include "support/box_scenes.h"
#include "support/field_scenes.h"

namespace lambent::fog_furnace_test {
namespace {

using test::Stage;

// Of light that fog lets through, at each pixel.
constexpr double kTransmittanceTolerance = 0.001;
// Of light that fog scatters where all light is even.
constexpr double kScatterTolerance = 0.01;

constexpr int kWidth = 48, kHeight = 27;

FogVolume fog_around(float density, const glm::vec3& albedo, float anisotropy = 0.0f,
                     float scale_height = 0.0f) {
  FogVolume fog;
  fog.centre = {0.0f, 0.0f, 0.0f};
  fog.size = {8.0f, 6.0f, 8.0f};
  fog.density = density;
  fog.albedo = albedo;
  fog.anisotropy = anisotropy;
  fog.scale_height = scale_height;
  return fog;
}

/// A small body under an even sky of radiance 1, in fog.
Scene sky_in_fog(const FogVolume& fog) {
  Scene scene = test::scene_of({test::box_mesh(glm::vec3(-0.1f), glm::vec3(0.1f))});
  scene.materials[0].base_color = glm::vec4(0.9f, 0.9f, 0.9f, 1.0f);
  scene.environment.radiance = glm::vec3(1.0f);
  scene.fog = {fog};
  Camera camera = look_at({0.5f, 0.4f, 3.0f}, {0.5f, 0.5f, 0.0f}, 1.0f);
  scene.cameras = {camera};
  return scene;
}

FrameSettings small_frame() {
  FrameSettings settings;
  settings.width = kWidth;
  settings.height = kHeight;
  return settings;
}

LayeredImage frame_of(const Stage& stage, const FrameSettings& settings = small_frame(),
                      const IrradianceField* field = nullptr) {
  return Renderer(stage.world, {.field = field})
      .render(stage.scene.cameras[0], settings)
      .value()
      .image;
}

LayeredImage reference_of(const Stage& stage, int samples) {
  ReferenceSettings settings;
  settings.width = kWidth;
  settings.height = kHeight;
  settings.samples = samples;
  return render_reference(stage.world, stage.scene.cameras[0], settings).image;
}

double mean_of(const Image& image) {
  double sum = 0.0;
  for (const float value : image.pixels) sum += value;
  return sum / static_cast<double>(image.pixels.size());
}

/// Share of light that passes along the ray through a pixel's middle, by the integral in double.
double passed(const Stage& stage, int x, int y) {
  const FogVolume& fog = stage.scene.fog[0];
  const Ray ray = camera_ray(stage.scene.cameras[0], kWidth, kHeight, x + 0.5f, y + 0.5f);
  constexpr int kSteps = 40000;
  constexpr double kFar = 20.0;
  double depth = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const glm::dvec3 p =
        glm::dvec3(ray.origin) + (i + 0.5) / kSteps * kFar * glm::dvec3(ray.direction);
    const glm::dvec3 half = 0.5 * glm::dvec3(fog.size);
    if (glm::any(glm::greaterThan(glm::abs(p), half))) continue;
    const double height = fog.scale_height > 0.0f ? (p.y + half.y) / fog.scale_height : 0.0;
    depth += fog.density * std::exp(-height) * kFar / kSteps;
  }
  return std::exp(-depth);
}

struct Thinning {
  float density, scale_height;
};

class FogTransmittance : public testing::TestWithParam<Thinning> {};

// Fog that scatters nothing lets exp(-depth) of the sky through.
TEST_P(FogTransmittance, IsTheClosedForm) {
  const Stage stage(
      sky_in_fog(fog_around(GetParam().density, glm::vec3(0.0f), 0.0f, GetParam().scale_height)));
  const LayeredImage frame = frame_of(stage);
  const Image& albedo = *frame.find("albedo");
  int compared = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      if (albedo.at(x, y)[0] > 0.0f) continue;
      const double truth = passed(stage, x, y);
      EXPECT_NEAR(frame.find("emission")->at(x, y)[0] / truth, 1.0, kTransmittanceTolerance);
      EXPECT_EQ(frame.find("fog")->at(x, y)[0], 0.0f);
      ++compared;
    }
  }
  EXPECT_GT(compared, kWidth * kHeight / 2);
  // The reference spreads its rays over pixels
  EXPECT_NEAR(mean_of(*reference_of(stage, 64).find("emission")) / mean_of(*frame.find("emission")),
              1.0, 0.005);
}

INSTANTIATE_TEST_SUITE_P(Densities, FogTransmittance,
                         testing::Values(Thinning{0.2f, 0.0f}, Thinning{1.0f, 0.7f},
                                         Thinning{0.01f, 100.0f}));

class FogFurnace : public testing::TestWithParam<float> {};

// Where light is even, fog that absorbs nothing does not show, however it scatters.
TEST_P(FogFurnace, WhiteFogInEvenLightDoesNotShow) {
  const Stage stage(sky_in_fog(fog_around(0.3f, glm::vec3(1.0f), GetParam())));
  FieldSettings settings;
  settings.probe_count = {4, 4, 4};
  settings.volume = {glm::vec3(-3.0f), glm::vec3(3.0f)};
  settings.rays_per_probe = 256;
  Expected<IrradianceField> field = IrradianceField::make(settings, stage.bounds());
  ASSERT_TRUE(field) << field.error().message();
  field->update(stage.world);
  const LayeredImage frame = frame_of(stage, small_frame(), &*field);
  EXPECT_NEAR(mean_of(*frame.find("")), 1.0, kScatterTolerance);
  // Fog alone: its share of the view
  const double share = 1.0 - mean_of(*frame.find("emission"));
  ASSERT_GT(share, 0.5);
  EXPECT_NEAR(mean_of(*frame.find("fog")) / share, 1.0, 2.0 * kScatterTolerance);
  EXPECT_NEAR(mean_of(*reference_of(stage, 256).find("")), 1.0, kScatterTolerance);
}

INSTANTIATE_TEST_SUITE_P(Anisotropies, FogFurnace, testing::Values(0.0f, 0.8f, -0.5f));

// Light of a lamp in black surroundings is scattered once: an integral of one variable.
TEST(Fog, ScattersALampsLightAsTheIntegralSays) {
  const FogVolume fog = fog_around(0.15f, glm::vec3(0.8f), 0.4f);
  Scene scene = sky_in_fog(fog);
  scene.environment.radiance = glm::vec3(0.0f);
  scene.materials[0].base_color = glm::vec4(0.0f, 0.0f, 0.0f, 1.0f);
  Light lamp;
  lamp.position_ws = {0.9f, 1.4f, -0.6f};
  lamp.intensity = glm::vec3(5.0f);
  scene.lights = {lamp};
  const Stage stage(std::move(scene));
  const Media media(stage.scene.fog);
  double truth = 0.0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const Ray ray = camera_ray(stage.scene.cameras[0], kWidth, kHeight, x + 0.5f, y + 0.5f);
      constexpr int kSteps = 4000;
      const float end = tracer_of(stage.world).closest_hit(ray).missed() ? 8.0f : 2.9f;
      for (int i = 0; i < kSteps; ++i) {
        const float t = end * (static_cast<float>(i) + 0.5f) / kSteps;
        const glm::vec3 p = ray.origin + t * ray.direction;
        const glm::vec3 way = lamp.position_ws - p;
        const float distance = glm::length(way);
        const float here =
            fog_density(media, p) * transmittance(media, ray.origin, ray.direction, t);
        truth += here * transmittance(media, p, way / distance, distance) * 0.8f * 5.0f /
                 (distance * distance) * phase(0.4f, glm::dot(way / distance, ray.direction)) *
                 end / kSteps;
      }
    }
  }
  truth /= kWidth * kHeight;
  FrameSettings settings = small_frame();
  settings.fog = {4, 64, 4};
  EXPECT_NEAR(mean_of(*frame_of(stage, settings).find("fog")) / truth, 1.0, 0.02);
  ReferenceSettings once;
  once.width = kWidth;
  once.height = kHeight;
  once.samples = 256;
  once.max_bounces = 0;
  const LayeredImage reference = render_reference(stage.world, stage.scene.cameras[0], once).image;
  EXPECT_NEAR(mean_of(*reference.find("fog")) / truth, 1.0, 0.02);
}

// Emissive triangles are drawn by the light tree, at points that have no normal.
TEST(Fog, ScattersLightOfEmissiveSurfacesAsTheReferenceDoes) {
  Scene scene = sky_in_fog(fog_around(0.2f, glm::vec3(0.8f), 0.3f));
  scene.environment.radiance = glm::vec3(0.0f);
  scene.materials[0].base_color = glm::vec4(0.0f, 0.0f, 0.0f, 1.0f);
  scene.materials[0].emission = glm::vec3(50.0f, 20.0f, 10.0f);
  const Stage stage(std::move(scene));
  FrameSettings settings = small_frame();
  settings.fog = {2, 64, 8};
  ReferenceSettings once;
  once.width = kWidth;
  once.height = kHeight;
  once.samples = 512;
  once.max_bounces = 0;
  const LayeredImage reference = render_reference(stage.world, stage.scene.cameras[0], once).image;
  const double truth = mean_of(*reference.find("fog"));
  ASSERT_GT(truth, 0.0);
  EXPECT_NEAR(mean_of(*frame_of(stage, settings).find("fog")) / truth, 1.0, 0.03);
}

TEST(Fog, IsFiniteAtAnyDensityAndNumberOfFroxels) {
  for (const float density : {1e-35f, 1e-6f, 0.1f, 10.0f, 1e6f}) {
    for (const float height : {0.0f, 1e-3f, 1.0f, 1e9f}) {
      Scene scene = sky_in_fog(fog_around(density, glm::vec3(1.0f), 0.95f, height));
      Light lamp;
      lamp.position_ws = {0.0f, 0.5f, 1.0f};
      Light sun;
      sun.type = Light::Type::directional;
      sun.direction_ws = {0.0f, -1.0f, 0.0f};
      scene.lights = {lamp, sun};
      const Stage stage(std::move(scene));
      for (const FogSettings& froxels :
           {FogSettings{1, 4, 1}, FogSettings{7, 65, 2}, FogSettings{64, 512, 1}}) {
        FrameSettings settings;
        settings.width = 19;
        settings.height = 11;
        settings.fog = froxels;
        const LayeredImage frame = frame_of(stage, settings);
        for (const char* layer : {"", "fog", "emission", "direct"}) {
          for (const float value : frame.find(layer)->pixels) {
            ASSERT_TRUE(std::isfinite(value) && value >= 0.0f)
                << layer << " at density " << density << ", height " << height;
          }
        }
      }
    }
  }
}

TEST(Fog, LetsNoLightThroughWalls) {
  // A closed room, and a lamp just behind its wall
  Scene scene = test::scene_of({test::box_mesh({-2, -1, -2}, {2, 2, 2}, true)});
  scene.fog = {fog_around(0.5f, glm::vec3(1.0f))};
  scene.cameras = {look_at({0.0f, 0.5f, 1.8f}, {0.0f, 0.5f, 0.0f}, 1.2f)};
  Light lamp;
  lamp.position_ws = {0.2f, 0.6f, -2.05f};
  lamp.intensity = glm::vec3(1e4f);
  scene.lights = {lamp};
  const Stage stage(std::move(scene));
  for (const int pixels : {1, 8, 64}) {
    FrameSettings settings = small_frame();
    settings.fog.froxel_pixels = pixels;
    const LayeredImage frame = frame_of(stage, settings);
    EXPECT_EQ(mean_of(*frame.find("fog")), 0.0) << pixels;
  }
}

TEST(Fog, OfSomeRowsHasTheBitsOfTheWholePicture) {
  Scene scene = sky_in_fog(fog_around(0.3f, glm::vec3(0.9f)));
  Light lamp;
  lamp.position_ws = {0.0f, 0.5f, 1.0f};
  scene.lights = {lamp};
  const Stage stage(std::move(scene));
  const Image whole = *frame_of(stage).find("fog");
  FrameSettings part = small_frame();
  part.first_row = 10;
  part.rows = 9;
  const Image some = *frame_of(stage, part).find("fog");
  EXPECT_TRUE(std::equal(some.pixels.begin(), some.pixels.end(), whole.at(0, 10)));
  EXPECT_GT(mean_of(some), 0.0);
}

// Godot's froxels, which are averaged over frames, trail behind lamps.
TEST(Fog, OfALampThatMovesIsAsBrightAsOfOneThatStands) {
  Scene scene = sky_in_fog(fog_around(0.3f, glm::vec3(0.9f)));
  scene.environment.radiance = glm::vec3(0.0f);
  Light lamp;
  lamp.position_ws = {0.4f, 0.6f, -2.0f};
  scene.lights = {lamp};
  World world(scene);
  FrameSettings settings = small_frame();
  settings.denoise = true;
  settings.averaged_frames = 10;
  settings.fog = {4, 64, 16};
  Renderer moving(world);
  double brightness[2][4] = {};
  for (const int way : {0, 1}) {
    for (int i = 0; i < 4; ++i) {
      const int place = way == 0 ? i : 3 - i;
      scene.lights[0].position_ws.z = -2.0f + static_cast<float>(place);
      ASSERT_TRUE(world.update());
      const RenderedFrame frame = moving.render(scene.cameras[0], settings).value();
      brightness[way][place] = mean_of(*frame.image.find("fog"));
    }
  }
  for (int place = 0; place < 4; ++place) {
    EXPECT_GT(brightness[0][place], 0.0);
    EXPECT_NEAR(brightness[1][place] / brightness[0][place], 1.0, 0.01) << place;
  }
}

TEST(Fog, AveragedOverFramesHasLessNoise) {
  Scene scene = sky_in_fog(fog_around(0.3f, glm::vec3(0.9f)));
  scene.environment.radiance = glm::vec3(0.0f);
  Light sun;
  sun.type = Light::Type::directional;
  sun.direction_ws = glm::normalize(glm::vec3(1.0f, -2.0f, 0.3f));
  scene.lights = {sun};
  const Stage stage(std::move(scene));
  FrameSettings settings = small_frame();
  settings.denoise = true;
  settings.fog = {2, 32, 1};
  FrameSettings many = settings;
  many.fog.samples = 64;
  const Image truth = *frame_of(stage, many).find("fog");
  const auto error_of = [&](const Image& image) {
    double sum = 0.0;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
      sum += std::pow(image.pixels[i] - truth.pixels[i], 2.0);
    }
    return std::sqrt(sum);
  };
  settings.averaged_frames = 16;
  Renderer renderer(stage.world);
  const Camera& camera = stage.scene.cameras[0];
  const double first = error_of(*renderer.render(camera, settings).value().image.find("fog"));
  for (int i = 0; i < 14; ++i) ASSERT_TRUE(renderer.render(camera, settings));
  const double last = error_of(*renderer.render(camera, settings).value().image.find("fog"));
  EXPECT_LT(last, 0.6 * first);
}

TEST(Fog, RefusesSettingsOutOfRange) {
  const Stage stage(sky_in_fog(fog_around(0.3f, glm::vec3(0.9f))));
  const std::pair<const char*, FogSettings> cases[] = {
      {"froxel pixels", {0, 64, 4}}, {"froxel pixels", {65, 64, 4}}, {"fog slices", {8, 3, 4}},
      {"fog slices", {8, 513, 4}},   {"fog samples", {8, 64, 0}},    {"fog samples", {8, 64, 65}}};
  for (const auto& [what, froxels] : cases) {
    FrameSettings settings = small_frame();
    settings.fog = froxels;
    const auto frame = Renderer(stage.world).render(stage.scene.cameras[0], settings);
    ASSERT_FALSE(frame);
    EXPECT_NE(frame.error().message().find(what), std::string::npos) << frame.error().message();
  }
  FrameSettings large;
  large.width = large.height = 16384;
  large.fog = {1, 512, 1};
  EXPECT_FALSE(Renderer(stage.world).render(stage.scene.cameras[0], large));
  // Without fog there are no froxels
  EXPECT_TRUE(check(large));
}

}  // namespace
}  // namespace lambent::fog_furnace_test
