// SPDX-License-Identifier: Apache-2.0
// Hits become surfaces and are lit directly, on the host and on a device.

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "compose/gbuffer.h"
#include "raytracing/camera_rays.h"
#include "raytracing/surface.h"
#include "raytracing/world_access.h"
#include "scene/coverage.h"
#include "scene/light_tree/light_tree.h"
#include "scenes/builtin.h"
#include "support/many_lights.h"
#include "support/panels.h"
#include "support/vulkan_device.h"
#include "twin/material_scene.h"
#include "twin/shading_agreement.h"
#include "twin/trace_agreement.h"

namespace lambent::shading_test {
namespace {

using test::Agreement;
using test::HitBatch;
using test::HostTracer;
using test::shade_on_device;
using test::Shaded;
using test::shading_on;
using test::TwinWorld;

using ShadingTwin = test::OnDevice;

constexpr int kRays = 1500;
constexpr std::uint32_t kFirstIndex = 4096;
// Rounding: sines, square roots and fused products of devices.
constexpr float kTolerance = 1e-3f;
// Bilinear weights of texture units have 8 bits (VkPhysicalDeviceLimits::subTexelPrecisionBits is
// at least 4), their decoded sRGB half a step of 8 bits.
constexpr float kFilterTolerance = 8e-3f;
// Hits where rounding decides otherwise: between MIP levels and texels, at the edges of shadows.
constexpr double kUndecidedShare = 0.01;
// Light is chosen among candidates by what they bring: where textures weigh these a little
// differently, some choices are others.
constexpr double kUndecidedLightShare = 0.03;

/// Built once for all tests.
const TwinWorld& built_in(const vulkan::Device& device, const std::string& name) {
  static std::map<std::string, TwinWorld> worlds;
  const auto known = worlds.find(name);
  if (known != worlds.end()) return known->second;
  return worlds.try_emplace(name, device, scenes::make(name).value()).first->second;
}

/// Shades random hits on both sides and expects the same. Stores how many are on mirrors, where
/// asked.
void expect_same_shading(const vulkan::Device& device, const World& world, const DeviceScene& scene,
                         const ShadeHitsSettings& settings, float texture_tolerance,
                         std::size_t* mirrored_hits = nullptr) {
  const HitBatch batch = test::trace_batch(world, test::random_rays(world.scene(), kRays, 11u));
  std::vector<ShadedHit> host(batch.rays.size());
  ShadeHitsScratch scratch;
  const std::size_t shadow_rays =
      shade_hits(world, batch.rays, batch.hits, settings, kFirstIndex, scratch, host);
  const Shaded found = shade_on_device(device, world, scene, batch, settings, kFirstIndex);

  Agreement position("position", kTolerance), normal("normal", texture_tolerance);
  Agreement geometric("geometric normal", kTolerance), distances("distances", kTolerance),
      albedo("albedo", texture_tolerance);
  // Emitters are always read at full resolution
  Agreement radiance("radiance", texture_tolerance), light("irradiance", kFilterTolerance);
  Agreement light_distances("distances of lights", kTolerance);
  std::size_t lit = 0, mirrored = 0;
  for (std::size_t i = 0; i < host.size(); ++i) {
    const ShadedHitRecord& device_hit = found.shaded[i];
    const LitPoint& point = host[i].point;
    ASSERT_EQ((device_hit.flags & kSurfaceMissed) != 0, batch.hits[i].missed()) << i;
    ASSERT_EQ(device_hit.flags, host[i].surface.flags) << i;
    ASSERT_EQ(device_hit.material, host[i].surface.material) << i;
    position.compare(point.position_ws, found.points[i].position_ws, i);
    normal.compare(point.normal_ws, found.points[i].normal_ws, i);
    geometric.compare(point.geometric_normal_ws, found.points[i].geometric_normal_ws, i);
    albedo.compare(host[i].surface.albedo_over_pi, device_hit.albedo_over_pi, i);
    radiance.compare(host[i].surface.radiance, device_hit.radiance, i);
    distances.compare(
        {host[i].surface.mirror_distance, host[i].surface.gi_share, point.viewer_distance},
        {device_hit.mirror_distance, device_hit.gi_share, found.points[i].viewer_distance}, i);
    light.compare(host[i].direct_irradiance, found.irradiance[i], i);
    const float nearest = host[i].light_distance, found_nearest = found.points[i].light_distance;
    if (!std::isinf(nearest) || !std::isinf(found_nearest)) {
      light_distances.compare(glm::vec3(nearest), glm::vec3(found_nearest), i);
    }
    if (host[i].direct_irradiance != glm::vec3(0.0f)) ++lit;
    if (host[i].surface.mirror_distance > 0.0f) ++mirrored;
  }
  for (const Agreement* each : {&position, &normal, &geometric, &distances, &albedo, &radiance}) {
    each->expect(kUndecidedShare);
  }
  light.expect(kUndecidedLightShare);
  light_distances.expect(kUndecidedLightShare);
  EXPECT_GT(shadow_rays, 0u);
  EXPECT_GT(lit, host.size() / 20);
  if (mirrored_hits != nullptr) *mirrored_hits = mirrored;
}

TEST_F(ShadingTwin, LightsHitsOfBuiltInScenesAsTheHostDoes) {
  for (const char* name : {"cornell", "two-rooms", "atrium", "spheres"}) {
    SCOPED_TRACE(name);
    const TwinWorld& twin = built_in(device(), name);
    ShadeHitsSettings settings;
    settings.follow_mirrors = true;
    settings.cone_width = 0.1f;
    settings.emissive_samples = 2;
    settings.salt = 3;
    std::size_t mirrored = 0;
    expect_same_shading(device(), twin.world, twin.on_device, settings, kTolerance, &mirrored);
    EXPECT_EQ(mirrored > 0, std::string(name) == "spheres");
  }
}

TEST_F(ShadingTwin, LightsMaterialsOfAllKindsAsTheHostDoes) {
  const TwinWorld twin(device(), test::material_scene());
  ShadeHitsSettings settings;
  settings.max_albedo = 0.9f;
  const SolidSides sides = solid_sides_by_winding(twin.world.scene());
  for (const float cone_width : {0.0f, 0.02f, 0.3f}) {
    SCOPED_TRACE(cone_width);
    settings.cone_width = cone_width;
    settings.solid_sides = cone_width == 0.02f ? nullptr : &sides;
    expect_same_shading(device(), twin.world, twin.on_device, settings,
                        cone_width > 0.0f ? kTolerance : kFilterTolerance);
  }
}

TEST_F(ShadingTwin, DrawsFromManyLightsAsTheHostDoes) {
  Scene scene = test::many_lights(60);
  World world(scene);
  DeviceScene on_device(device(), scene, emissive_of(world), lights_of(world));
  ASSERT_FALSE(lights_of(world).visibility().empty());  // which both draw by
  ShadeHitsSettings settings;
  settings.emissive_samples = 2;
  const auto expect_same = [&](const char* edit) {
    SCOPED_TRACE(edit);
    ASSERT_TRUE(world.update());
    on_device.update(scene, emissive_of(world), lights_of(world));
    expect_same_shading(device(), world, on_device, settings, kTolerance);
  };
  expect_same("none");
  scene.lights[4].position_ws.x += 0.7f;
  scene.instances[8].world_from_object[3].y -= 0.5f;
  expect_same("a light and a lamp moved");
  scene.lights.resize(5);
  expect_same("few point lights are left, which are asked");
  EXPECT_EQ(lights_of(world).asked().size(), 5u);
}

TEST_F(ShadingTwin, DrawsFromPiecesOfTrianglesAsTheHostDoes) {
  const TwinWorld twin(device(), test::panel_room());
  ASSERT_GT(emissive_of(twin.world).size(), 100u);
  ShadeHitsSettings settings;
  settings.emissive_samples = 2;
  expect_same_shading(device(), twin.world, twin.on_device, settings, kFilterTolerance);
}

TEST_F(ShadingTwin, FollowsEdits) {
  Scene scene = test::material_scene();
  World world(scene);
  DeviceScene on_device(device(), scene, emissive_of(world), lights_of(world));
  ShadeHitsSettings settings;
  settings.cone_width = 0.02f;
  const auto expect_same = [&](const char* edit) {
    SCOPED_TRACE(edit);
    ASSERT_TRUE(world.update());
    on_device.update(scene, emissive_of(world), lights_of(world));
    expect_same_shading(device(), world, on_device, settings, kTolerance);
  };
  scene.instances[6].world_from_object[3].x += 0.5f;
  scene.lights[1].intensity *= 2.0f;
  expect_same("moved and brighter");
  scene.textures[test::kColors] = test::noise_texture(16, 16, true, 20);
  scene.textures[test::kColors].revision = 1;
  scene.materials[1].roughness = 0.2f;
  scene.environment.map.pixels[5] = 3.0f;
  scene.environment.revision = 1;
  expect_same("other texels");
  for (glm::vec3& p : scene.meshes[6].positions) p *= 1.2f;
  scene.meshes[6].revision = 1;
  expect_same("bent");
  scene.meshes[7] = test::sphere(0.9f, 12, 1);
  scene.meshes[7].revision = 1;
  test::add(scene, test::sphere(0.3f, 6, scene.meshes.back().material));
  scene.instances.erase(scene.instances.begin() + 2);
  scene.lights.push_back(test::point_light(glm::vec3(2.0f), {0.0f, 0.5f, 0.0f}));
  expect_same("other meshes, and another list of instances and lights");
  scene.environment.map = {};
  scene.materials[static_cast<std::size_t>(scene.meshes.back().material)].unlit = false;
  expect_same("an even sky, and a sign put out");
}

TEST_F(ShadingTwin, LightsPointsAtAnyTimeAsWhenTheyWereHit) {
  const TwinWorld twin(device(), test::material_scene());
  const HitBatch batch = test::trace_batch(twin.world, test::random_rays(twin.scene, 300, 5u));
  ShadeHitsSettings settings;
  const Shaded shaded =
      shade_on_device(device(), twin.world, twin.on_device, batch, settings, kFirstIndex);

  const vulkan::Buffer points = vulkan::upload(device(), shaded.points, "points");
  const vulkan::Buffer irradiance(device(), shaded.points.size() * sizeof(glm::vec3),
                                  vulkan::Memory::device, "irradiance");
  HostTracer tracer(device(), tracer_of(twin.world));
  HitShading& shading = shading_on(device());
  tracer.run([&](vulkan::Recorder& to) {
    shading.direct_irradiance(to, {twin.on_device, tracer}, {points.address()},
                              static_cast<std::uint32_t>(shaded.points.size()), settings,
                              {irradiance.address()});
  });
  EXPECT_EQ(vulkan::download<glm::vec3>(device(), irradiance), shaded.irradiance);
}

TEST_F(ShadingTwin, ShadesSmallAndLargeBatchesInOneCommandBuffer) {
  const TwinWorld twin(device(), test::material_scene());
  constexpr int kSmall = 50, kLarge = 5000;  // larger than any before, so that memory must grow
  const ShadeHitsSettings settings;
  std::vector<vulkan::Buffer> points, irradiance;
  for (const int count : {kSmall, kLarge}) {
    const HitBatch batch = test::trace_batch(twin.world, test::random_rays(twin.scene, count, 5u));
    std::vector<LitPointRecord> records(batch.rays.size());
    for (std::size_t i = 0; i < records.size(); ++i) {
      if (batch.hits[i].missed()) {
        records[i].random_index = kNoDirectLight;
        continue;
      }
      const Surface surface = surface_at(twin.scene, batch.rays[i], batch.hits[i]);
      const auto index = static_cast<std::uint32_t>(i);
      records[i] = {surface.position_ws,
                    surface.normal_ws,
                    surface.geometric_normal_ws,
                    index,
                    0u,
                    vec3(0.0f),
                    0.0f,
                    0.0f,
                    1.0f};
    }
    points.push_back(vulkan::upload(device(), records, "points"));
    irradiance.emplace_back(device(), records.size() * sizeof(glm::vec3), vulkan::Memory::device,
                            "irradiance");
  }
  HostTracer tracer(device(), tracer_of(twin.world));
  const auto light = [&](std::initializer_list<int> batches) {
    tracer.run([&](vulkan::Recorder& to) {
      for (const int b : batches) {
        shading_on(device()).direct_irradiance(
            to, {twin.on_device, tracer}, {points[b].address()},
            static_cast<std::uint32_t>(points[b].bytes() / sizeof(LitPointRecord)), settings,
            {irradiance[b].address()});
      }
    });
  };
  light({0, 1});
  const auto small = vulkan::download<glm::vec3>(device(), irradiance[0]);
  const auto large = vulkan::download<glm::vec3>(device(), irradiance[1]);
  light({0});
  light({1});
  EXPECT_EQ(vulkan::download<glm::vec3>(device(), irradiance[0]), small);
  EXPECT_EQ(vulkan::download<glm::vec3>(device(), irradiance[1]), large);
  EXPECT_GT(std::count_if(large.begin(), large.end(),
                          [](const glm::vec3& e) { return e != glm::vec3(0.0f); }),
            kLarge / 10);
}

/// Pixels of a camera on both sides: their surfaces, and the light that they reflect.
void expect_same_pixels(const vulkan::Device& device, const TwinWorld& twin, const Camera& camera) {
  const World& world = twin.world;
  FrameSettings frame;
  frame.width = 40;
  frame.height = 24;
  frame.emissive_samples = 2;
  frame.seed = 5;
  const Band band = {0, frame.height};
  GBuffer gbuffer;
  trace_gbuffer(world, camera, frame, band, 0, gbuffer);
  ReflectedLight host;
  shade_direct(world, gbuffer, frame, band, 0, false, host);

  std::vector<Ray> rays;
  for (int i = 0; i < frame.width * frame.height; ++i) {
    const glm::vec2 at = glm::vec2(i % frame.width, i / frame.width) + 0.5f;
    rays.push_back(camera_ray(camera, frame.width, frame.height, at.x, at.y));
    rays.back().mask = sample_mask(static_cast<std::uint32_t>(i), 0,
                                   static_cast<std::uint32_t>(frame.samples), frame.seed);
  }
  const auto count = static_cast<std::uint32_t>(rays.size());
  const test::UploadedHits hits =
      test::upload_hits(device, test::trace_batch(world, std::move(rays)));
  const auto room = [&](std::size_t bytes) {
    return vulkan::Buffer(device, count * bytes, vulkan::Memory::device, "pixels");
  };
  const vulkan::Buffer points = room(sizeof(LitPointRecord)),
                       surfaces = room(sizeof(PixelSurfaceRecord));
  const vulkan::Buffer diffuse = room(sizeof(glm::vec3)), specular = room(sizeof(glm::vec3));
  const DevicePixels pixels = {{points.address()}, {surfaces.address()}};
  std::vector<RayCone> widths;
  for (const glm::vec3& to_viewer : gbuffer.to_viewer_ws) {
    widths.push_back(
        camera_cone(camera_record(camera, frame.width, frame.height), -to_viewer, 1u, 0u));
  }
  const vulkan::Buffer cones = vulkan::upload(device, widths, "cones");
  ShadeHitsSettings settings;
  settings.emissive_samples = frame.emissive_samples;
  settings.salt = 0;
  settings.seed = frame.seed;
  HostTracer tracer(device, tracer_of(world));
  HitShading& shading = shading_on(device);
  tracer.run([&](vulkan::Recorder& to) {
    const DeviceStage stage = {twin.on_device, tracer};
    shading.pixel_surfaces(to, stage,
                           {hits.view.rays, hits.view.hits, {cones.address()}, hits.view.count}, 0,
                           false, pixels);
    shading.reflected_light(to, stage, pixels, count, settings,
                            {{diffuse.address()}, {specular.address()}});
  });

  const auto found_points = vulkan::download<LitPointRecord>(device, points);
  const auto found_surfaces = vulkan::download<PixelSurfaceRecord>(device, surfaces);
  const auto found_diffuse = vulkan::download<glm::vec3>(device, diffuse);
  const auto found_specular = vulkan::download<glm::vec3>(device, specular);
  Agreement normal("normal", kFilterTolerance), base("diffuse albedo", kFilterTolerance);
  Agreement f0("specular reflectance", kFilterTolerance), rest("widths", kFilterTolerance);
  Agreement fluence("fluence", kFilterTolerance);
  Agreement emission("emission", kFilterTolerance), viewer("to the viewer", kTolerance);
  Agreement diffuse_light("diffuse light", kFilterTolerance);
  // Narrow lobes turn small differences of normals into large ones of light
  Agreement specular_light("specular light", 4.0f * kFilterTolerance);
  for (std::uint32_t i = 0; i < count; ++i) {
    const PixelSurfaceRecord& pixel = found_surfaces[i];
    ASSERT_EQ((pixel.flags & kSurfaceMissed) == 0, gbuffer.hit[i] != 0) << i;
    diffuse_light.compare(host.diffuse[i], found_diffuse[i], i);
    specular_light.compare(host.specular[i], found_specular[i], i);
    if (gbuffer.hit[i] == 0) continue;
    const Surface& surface = gbuffer.surfaces[i];
    const Reflectance& r = surface.reflectance;
    ASSERT_NEAR(pixel.gi_share, surface.gi_share, kFilterTolerance) << i;
    normal.compare(surface.normal_ws, found_points[i].normal_ws, i);
    base.compare(r.diffuse, pixel.reflectance.diffuse, i);
    f0.compare(r.f0, pixel.reflectance.f0, i);
    rest.compare({r.alpha, r.f90, 0.0f}, {pixel.reflectance.alpha, pixel.reflectance.f90, 0.0f}, i);
    emission.compare(surface.emission, pixel.emission, i);
    fluence.compare(glm::vec3(lights_of(world).fluence(surface.position_ws)),
                    glm::vec3(pixel.fluence), i);
    EXPECT_LE(luminance(pixel.emission), pixel.emission_luminance * (1.0f + kFilterTolerance)) << i;
    viewer.compare(gbuffer.to_viewer_ws[i], pixel.to_viewer_ws, i);
  }
  for (const Agreement* each : {&normal, &base, &f0, &rest, &emission, &fluence, &viewer}) {
    each->expect(kUndecidedShare);
  }
  diffuse_light.expect(kUndecidedLightShare);
  specular_light.expect(kUndecidedLightShare);
}

TEST_F(ShadingTwin, LightsPixelsAsTheHostDoes) {
  for (const char* name : {"cornell", "two-rooms", "atrium"}) {
    SCOPED_TRACE(name);
    const TwinWorld& twin = built_in(device(), name);
    ASSERT_FALSE(twin.scene.cameras.empty());
    expect_same_pixels(device(), twin, twin.scene.cameras[0]);
  }
  SCOPED_TRACE("all kinds of materials");
  expect_same_pixels(device(), TwinWorld(device(), test::material_scene()),
                     look_at({0.0f, 0.5f, 2.8f}, {0.0f, -0.5f, 0.0f}, 1.2f));
}

}  // namespace
}  // namespace lambent::shading_test
