// SPDX-License-Identifier: Apache-2.0
// Numbers at and beyond the ends of the ranges of scene/limits.h.
#include "scene/limits.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "lambent/field.h"
#include "lambent/renderer.h"
#include "lambent/rsm.h"
#include "lambent/world.h"
#include "reference/path_tracer.h"
#include "scene/animation/pose.h"
#include "support/hand_made.h"

namespace lambent::limits_test {
namespace {

using ::testing::HasSubstr;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kHuge = std::numeric_limits<float>::max();

Bounds unit_box() {
  return {glm::vec3(-1.0f), glm::vec3(1.0f)};
}

/// A room with a shiny ball in it, `size` metres wide, without light.
Scene room(float size) {
  Scene scene;
  scene.materials = {test::lambert(glm::vec3(0.7f)), Material{}};
  scene.materials[1].roughness = 0.0f;
  test::add_room(scene, size, 0);
  test::add(scene, test::sphere(0.2f * size, 8, 1));
  return scene;
}

Camera camera_in(float size) {
  return look_at(size * glm::vec3(0.3f, 0.2f, 0.45f), glm::vec3(0.0f), 1.0f);
}

void expect_finite(const LayeredImage& image, const std::string& what, bool lit) {
  double sum = 0.0;
  for (const Layer& layer : image.layers) {
    for (const float value : layer.image.pixels) {
      ASSERT_TRUE(std::isfinite(value)) << what << ", layer '" << layer.name << "'";
      if (layer.name.empty()) sum += value;
    }
  }
  if (lit) {
    EXPECT_GT(sum, 0.0) << what;
  }
}

/// Renders by every method. The field goes through its packed stores.
void expect_finite_pictures(const Scene& scene, float size) {
  ASSERT_TRUE(validate(scene)) << validate(scene).error().message();
  const World world(scene);
  const Camera camera = camera_in(size);
  FrameSettings frame;
  frame.width = 32;
  frame.height = 18;
  for (const auto format :
       {IrradianceFormat::rgb9e5, IrradianceFormat::r11g11b10f, IrradianceFormat::float32}) {
    FieldSettings settings;
    settings.probe_count = glm::ivec3(4);
    settings.rays_per_probe = 32;
    settings.irradiance_format = format;
    auto field = IrradianceField::make(settings, world_bounds(scene));
    ASSERT_TRUE(field) << field.error().message();
    for (int update = 0; update < 3; ++update) field->update(world);
    expect_finite(Renderer(world, {.field = &*field}).render(camera, frame).value().image, "field",
                  true);
    frame.gather_rays = 1;
    expect_finite(Renderer(world, {.field = &*field}).render(camera, frame).value().image,
                  "gathered", true);
    frame.gather_rays = 0;
  }
  RsmSettings rsm;
  rsm.resolution = 32;
  IndirectSources sources;
  sources.rsm = rsm;
  expect_finite(Renderer(world, sources).render(camera, frame).value().image, "rsm",
                !scene.lights.empty());
  ReferenceSettings reference;
  reference.width = 32;
  reference.height = 18;
  reference.samples = 4;
  expect_finite(render_reference(world, camera, reference).image, "reference", true);
}

TEST(Limits, TheBrightestLightsGiveFinitePictures) {
  constexpr float kSize = 4.0f;
  Light point;
  point.intensity = glm::vec3(kMaxIntensity, 0.0f, kMaxIntensity);
  Light sun;
  sun.type = Light::Type::directional;
  sun.direction_ws = glm::vec3(0.0f, -1.0f, 0.0f);
  sun.intensity = glm::vec3(kMaxIrradiance);
  Light spot = point;
  spot.type = Light::Type::spot;

  // On the floor, where squared distances come to 0; above the ball; and in a corner
  for (const glm::vec3& place :
       {glm::vec3(0.0f, -0.5f, 0.0f), glm::vec3(0.0f, 0.4f, 0.0f), glm::vec3(0.49f)}) {
    Scene scene = room(kSize);
    point.position_ws = spot.position_ws = kSize * place;
    scene.lights = {point, spot, sun};
    SCOPED_TRACE(::testing::Message() << "light at " << place.x << " " << place.y);
    expect_finite_pictures(scene, kSize);
  }
  Scene glowing = room(kSize);
  glowing.materials[0].emission = glm::vec3(kMaxRadiance);
  expect_finite_pictures(glowing, kSize);

  Scene open = room(kSize);
  open.instances.erase(open.instances.begin() + 1);  // its ceiling
  open.environment.radiance = glm::vec3(kMaxRadiance);
  expect_finite_pictures(open, kSize);
}

TEST(Limits, ScenesOfAnySizeGiveFinitePictures) {
  for (const float size : {1e-3f, 1e3f, 1e6f, kMaxCoordinate}) {
    Scene scene = room(size);
    scene.materials[0].emission = glm::vec3(1.0f);
    Light light;
    light.intensity = glm::vec3(std::min(size * size, kMaxIntensity));
    scene.lights.push_back(light);
    expect_finite_pictures(scene, size);
  }
}

TEST(Limits, FieldsBeyondThemAreRefused) {
  const auto error = [](const std::function<void(FieldSettings&)>& spoil,
                        const Bounds& bounds = unit_box()) {
    FieldSettings settings;
    spoil(settings);
    const auto field = IrradianceField::make(settings, bounds);
    return field ? std::string("none") : field.error().message();
  };
  EXPECT_EQ(error([](FieldSettings&) {}), "none");
  for (const float bad : {1e20f, kHuge, kInfinity, kNan}) {
    EXPECT_THAT(error([&](FieldSettings& s) {
                  s.volume = {glm::vec3(0.0f), glm::vec3(bad)};
                }),
                HasSubstr("within 1e9 m"))
        << bad;
    EXPECT_THAT(error([](FieldSettings&) {}, {glm::vec3(0.0f), glm::vec3(bad)}),
                HasSubstr("within 1e9 m"))
        << bad;
    EXPECT_THAT(error([&](FieldSettings& s) { s.probe_spacing = bad; }), HasSubstr("at most 1e9 m"))
        << bad;
    EXPECT_THAT(error([&](FieldSettings& s) {
                  s.cascades = 2;
                  s.probe_spacing = bad;
                }),
                HasSubstr("probe spacing"))
        << bad;
    EXPECT_THAT(error([&](FieldSettings& s) { s.volumes.emplace_back().size.y = bad; }),
                HasSubstr("within 0 to 1e9 m"))
        << bad;
    EXPECT_THAT(error([&](FieldSettings& s) { s.volumes.emplace_back().centre.x = bad; }),
                HasSubstr("within 1e9 m"))
        << bad;
  }
}

TEST(Limits, EditsBeyondThemAreRefused) {
  Scene scene = room(1.0f);
  World world(scene);
  scene.instances[2].world_from_object[3].x = 2e9f;
  const auto moved = world.update();
  ASSERT_FALSE(moved);
  EXPECT_EQ(moved.error().place, "instances[2]");
  EXPECT_THAT(moved.error().cause, HasSubstr("1e9 m"));
  scene.instances[2].world_from_object[3].x = 0.0f;
  EXPECT_TRUE(world.update());

  // The instance stands still, its mesh grows
  scene.instances[2].world_from_object[0].x = 10.0f;
  ASSERT_TRUE(world.update());
  scene.meshes[2].positions[0].x = -5e8f;
  ++scene.meshes[2].revision;
  EXPECT_FALSE(world.update());
}

TEST(Limits, FlatTransformsKeepTheirPlaneAndGetAnInverse) {
  const glm::mat4 turn(glm::vec4(0.36f, 0.48f, -0.8f, 0), glm::vec4(-0.8f, 0.6f, 0, 0),
                       glm::vec4(0.48f, 0.64f, 0.6f, 0), glm::vec4(0, 0, 0, 1));
  for (const float mirrored : {1.0f, -1.0f}) {
    for (int axis = 0; axis < 3; ++axis) {
      glm::mat4 flat(2.0f);
      flat[(axis + 1) % 3] *= mirrored;
      flat[axis] = glm::vec4(0.0f);
      flat[3] = glm::vec4(5.0f, 6.0f, 7.0f, 1.0f);
      for (const glm::mat4& placed : {flat, turn * flat, flat * turn}) {
        const auto drawn = drawable(placed);
        ASSERT_TRUE(drawn);
        EXPECT_TRUE(std::isfinite(glm::inverse(*drawn)[0][0]));
        EXPECT_NE(glm::determinant(*drawn), 0.0f);
        for (const glm::vec4& p : {glm::vec4(1, 0, 0, 1), glm::vec4(0, 1, 0, 1),
                                   glm::vec4(0, 0, 1, 1), glm::vec4(1, 1, 1, 1)}) {
          EXPECT_LT(glm::distance(*drawn * p, placed * p), 1e-3f);
        }
      }
    }
  }
  // What is thin, but not flat, stays as it is
  glm::mat4 thin(1.0f);
  thin[1].y = -1e-4f;
  EXPECT_EQ(*drawable(thin), thin);
}

TEST(Limits, LinesPointsAndAbsurdScalesAreNotDrawn) {
  const auto scaled = [](const glm::vec3& scale) {
    glm::mat4 m(1.0f);
    for (int axis = 0; axis < 3; ++axis) m[axis] *= scale[axis];
    return m;
  };
  EXPECT_TRUE(drawable(scaled({1e10f, 1e10f, 1e10f})));
  EXPECT_TRUE(drawable(scaled({1e-10f, 1e-10f, 1e-10f})));
  EXPECT_TRUE(drawable(scaled({1e-10f, 0.0f, 1e-10f})));
  EXPECT_FALSE(drawable(scaled({0.0f, 0.0f, 0.0f})));
  EXPECT_FALSE(drawable(scaled({1.0f, 0.0f, 0.0f})));
  EXPECT_FALSE(drawable(scaled({1e-39f, 1e-39f, 1e-39f})));
  EXPECT_FALSE(drawable(scaled({1e20f, 1e20f, 1e20f})));
  EXPECT_FALSE(drawable(scaled({kNan, 1.0f, 1.0f})));
  EXPECT_FALSE(drawable(scaled({1.0f, kInfinity, 1.0f})));
}

TEST(Limits, ColorsKeepTheirHueWhenTheyAreReduced) {
  EXPECT_EQ(limited({1.0, 2.0, 3.0}, 10.0f), glm::vec3(1.0f, 2.0f, 3.0f));
  EXPECT_EQ(limited({10.0, 20.0, 40.0}, 10.0f), glm::vec3(2.5f, 5.0f, 10.0f));
  EXPECT_EQ(limited({0.0, 5e75, 1e76}, 10.0f), glm::vec3(0.0f, 5.0f, 10.0f));
}

}  // namespace
}  // namespace lambent::limits_test
