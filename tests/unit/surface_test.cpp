// SPDX-License-Identifier: Apache-2.0
#include "raytracing/surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "raytracing/camera_rays.h"
#include "scene/attributes.h"
#include "shared/constants.h"
#include "shared/sampling.h"
#include "support/hand_made.h"

namespace lambent::surface_test {
namespace {

using test::add;
using test::lambert;
using test::quad;

// A unit square in the plane z = 0 that faces +Z, with the given material, placed by a transform.
Scene square(const Material& material, const glm::mat4& world_from_object = glm::mat4(1.0f)) {
  Scene scene;
  scene.materials = {material};
  add(scene, quad({-0.5f, -0.5f, 0.0f}, {1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, 0),
      world_from_object);
  return scene;
}

Hit hit_along(const Scene& scene, const glm::vec3& origin, const glm::vec3& direction) {
  Ray ray;
  ray.origin = origin;
  ray.direction = direction;
  return make_embree_raytracer(scene)->closest_hit(ray);
}

Surface look(const Scene& scene, const glm::vec3& origin, const glm::vec3& direction,
             float footprint = 0.0f) {
  const auto tracer = make_embree_raytracer(scene);
  Ray ray;
  ray.origin = origin;
  ray.direction = glm::normalize(direction);
  const Hit hit = tracer->closest_hit(ray);
  EXPECT_FALSE(hit.missed());
  return surface_at(scene, ray, hit, footprint);
}

Texture constant_texture(const glm::u8vec4& rgba, bool srgb = false) {
  Texture texture;
  texture.srgb = srgb;
  texture.levels.resize(1);
  texture.levels[0].width = texture.levels[0].height = 1;
  texture.levels[0].rgba = {rgba.r, rgba.g, rgba.b, rgba.a};
  return texture;
}

void expect_near(const glm::vec3& a, const glm::vec3& b, float tolerance = 1e-5f) {
  EXPECT_NEAR(glm::length(a - b), 0.0f, tolerance) << a.x << " " << a.y << " " << a.z;
}

TEST(Surface, FacesTheRayFromBothSides) {
  const Scene scene = square(lambert(glm::vec3(0.5f)));
  const Surface front = look(scene, {0.1f, 0.2f, 1.0f}, {0.0f, 0.0f, -1.0f});
  expect_near(front.position_ws, {0.1f, 0.2f, 0.0f});
  expect_near(front.normal_ws, {0.0f, 0.0f, 1.0f});
  const Surface back = look(scene, {0.1f, 0.2f, -1.0f}, {0.0f, 0.0f, 1.0f});
  expect_near(back.normal_ws, {0.0f, 0.0f, -1.0f});
  expect_near(back.geometric_normal_ws, {0.0f, 0.0f, -1.0f});
}

TEST(Surface, ReceivesWhatComesFromAboveItsHorizon) {
  // Integrate the cosine over the directions above the horizon of the triangle and of the normal
  const glm::vec3 geometric(0.0f, 0.0f, 1.0f);
  for (const float tilt : {0.0f, 0.4f, 1.1f}) {
    const glm::vec3 normal(std::sin(tilt), 0.0f, std::cos(tilt));
    constexpr uint kDirections = 100000;
    double sum = 0.0;
    for (uint i = 0; i < kDirections; ++i) {
      const vec3 direction = spherical_fibonacci(i, kDirections);
      if (glm::dot(direction, geometric) > 0.0f) sum += std::max(0.0f, glm::dot(direction, normal));
    }
    const double irradiance = 4.0 * kPi * sum / kDirections;
    EXPECT_NEAR(horizon_share(1.0f, glm::dot(normal, geometric)), irradiance / kPi, 1e-3);
  }
}

TEST(Surface, ReceivesAsMuchOnAverageAsUnderTheMeanOfItsNormals) {
  // Two halves of a normal map lean to either side; their mean is upright, and short
  const float cosine = std::cos(0.7f);
  EXPECT_FLOAT_EQ(horizon_share(cosine, 1.0f), horizon_share(1.0f, cosine));
}

TEST(Surface, MirroredInstanceKeepsItsFront) {
  const glm::mat4 mirror = glm::scale(glm::mat4(1.0f), {-1.0f, 1.0f, 1.0f});
  const Scene mirrored = square(lambert(glm::vec3(0.5f)), mirror);
  EXPECT_TRUE(hit_along(mirrored, {0.1f, 0.2f, 1.0f}, {0.0f, 0.0f, -1.0f}).front_face);
  const Surface surface = look(mirrored, {0.1f, 0.2f, 1.0f}, {0.0f, 0.0f, -1.0f});
  expect_near(surface.normal_ws, {0.0f, 0.0f, 1.0f});
  expect_near(surface.position_ws, {0.1f, 0.2f, 0.0f});
}

TEST(Surface, NormalsGoThroughTheInverseTranspose) {
  // A plane at 45 degrees, stretched along x: its normal turns the other way
  Scene scene;
  scene.materials = {lambert(glm::vec3(0.5f))};
  add(scene, quad({-1.0f, 1.0f, -1.0f}, {0.0f, 0.0f, 2.0f}, {2.0f, -2.0f, 0.0f}, 0),
      glm::scale(glm::mat4(1.0f), {3.0f, 1.0f, 1.0f}));
  const Surface surface = look(scene, {0.3f, 5.0f, 0.0f}, {0.0f, -1.0f, 0.0f});
  expect_near(surface.normal_ws, glm::normalize(glm::vec3(1.0f, 3.0f, 0.0f)));
  expect_near(surface.geometric_normal_ws, surface.normal_ws);
}

TEST(Surface, InterpolatesNormals) {
  Scene scene;
  scene.materials = {lambert(glm::vec3(0.5f))};
  add(scene, test::sphere(2.0f, 16, 0));
  const glm::vec3 direction = glm::normalize(glm::vec3(0.31f, 0.42f, 0.53f));
  const Surface surface = look(scene, direction * 5.0f, -direction);
  EXPECT_GT(glm::dot(surface.normal_ws, direction), 0.9995f);
  EXPECT_LT(glm::dot(surface.geometric_normal_ws, direction), 0.9995f);
}

TEST(Surface, NormalsThatWindAgainstTheTriangleAreTurned) {
  Scene scene = square(lambert(glm::vec3(0.5f)));
  for (glm::vec3& n : scene.meshes[0].normals) n = -n;
  expect_near(look(scene, {0.1f, 0.2f, 1.0f}, {0.0f, 0.0f, -1.0f}).normal_ws, {0.0f, 0.0f, 1.0f});
}

TEST(Surface, NeverShadesASideThatTheRayCannotSee) {
  Scene scene = square(lambert(glm::vec3(0.5f)));
  for (glm::vec3& n : scene.meshes[0].normals) n = glm::normalize(glm::vec3(1.0f, 0.0f, 0.2f));
  const glm::vec3 direction = glm::normalize(glm::vec3(1.0f, 0.0f, -0.1f));
  const Surface surface = look(scene, -direction, direction);
  EXPECT_GT(glm::dot(surface.normal_ws, -direction), 0.0f);
  EXPECT_NEAR(glm::length(surface.normal_ws), 1.0f, 1e-5f);
}

// Near silhouettes a smooth shape's normals lean further from the viewer than its triangles do.
TEST(Surface, OfSmoothShapesReflectsUpwardsAtTheirRims) {
  Scene scene;
  Material lacquer = lambert(glm::vec3(0.5f));
  lacquer.clearcoat = 1.0f;
  scene.materials = {lacquer};
  add(scene, test::sphere(1.0f, 16, 0));
  const auto tracer = make_embree_raytracer(scene);
  int seen = 0, bent = 0;
  for (int i = 0; i < 400; ++i) {
    Ray ray;
    ray.origin = {0.8f + 0.0005f * static_cast<float>(i), 0.03f, 5.0f};
    ray.direction = {0.0f, 0.0f, -1.0f};
    const Hit hit = tracer->closest_hit(ray);
    if (hit.missed()) continue;
    ++seen;
    const Surface surface = surface_at(scene, ray, hit, 0.0f);
    const float cosine =
        glm::dot(glm::reflect(ray.direction, surface.normal_ws), surface.geometric_normal_ws);
    ASSERT_GT(cosine, 0.0f) << ray.origin.x;
    ASSERT_NEAR(glm::length(surface.normal_ws), 1.0f, 1e-5f);
    ASSERT_EQ(surface.reflectance.layers.clearcoat_normal.z, 1.0f);
    bent += cosine < 1.001f * kMinMirrorCosine;
  }
  EXPECT_GT(seen, 300);
  EXPECT_GT(bent, 5);
  EXPECT_LT(bent, seen / 2);
}

// A normal map whose normal leans towards +x (u) and +y (up, against v).
Scene normal_mapped(const glm::mat4& world_from_object) {
  Scene scene = square(lambert(glm::vec3(0.5f)), world_from_object);
  scene.textures = {constant_texture({204, 217, 230, 255})};  // (0.6, 0.7, 0.8)
  scene.materials[0].normal_texture.texture = 0;
  scene.meshes[0].tangents.assign(4, {1.0f, 0.0f, 0.0f, 1.0f});
  return scene;
}

TEST(Surface, NormalMapLeansAlongTangentAndBitangent) {
  const Scene scene = normal_mapped(glm::mat4(1.0f));
  const glm::vec3 n = look(scene, {0.1f, 0.2f, 1.0f}, {0.0f, 0.0f, -1.0f}).normal_ws;
  expect_near(n, glm::normalize(glm::vec3(0.6f, 0.702f, 0.804f)), 5e-3f);
  // From behind the whole bump is turned over
  expect_near(look(scene, {0.1f, 0.2f, -1.0f}, {0.0f, 0.0f, 1.0f}).normal_ws, -n);
}

TEST(Surface, NormalMapIsMirroredWithItsInstance) {
  const glm::vec3 plain =
      look(normal_mapped(glm::mat4(1.0f)), {0.1f, 0.2f, 1.0f}, {0.0f, 0.0f, -1.0f}).normal_ws;
  const Scene mirrored = normal_mapped(glm::scale(glm::mat4(1.0f), {-1.0f, 1.0f, 1.0f}));
  expect_near(look(mirrored, {0.1f, 0.2f, 1.0f}, {0.0f, 0.0f, -1.0f}).normal_ws,
              plain * glm::vec3(-1.0f, 1.0f, 1.0f));
}

TEST(Surface, TangentsAreMadeFromTextureCoordinatesWhereMissing) {
  Scene scene = normal_mapped(glm::mat4(1.0f));
  const glm::vec3 with = look(scene, {0.1f, 0.2f, 1.0f}, {0.0f, 0.0f, -1.0f}).normal_ws;
  scene.meshes[0].tangents.clear();
  expect_near(look(scene, {0.1f, 0.2f, 1.0f}, {0.0f, 0.0f, -1.0f}).normal_ws, with);
}

TEST(Surface, DielectricAndMetalFollowTheSpecification) {
  Material material;
  material.base_color = {0.2f, 0.4f, 0.8f, 1.0f};
  material.metallic = 0.25f;
  material.roughness = 0.5f;
  const Reflectance r = look(square(material), {0.1f, 0.2f, 1.0f}, {0.0f, 0.0f, -1.0f}).reflectance;
  expect_near(r.diffuse, glm::vec3(0.15f, 0.3f, 0.6f));
  EXPECT_FLOAT_EQ(r.alpha, 0.25f);
  expect_near(r.f0, 0.75f * glm::vec3(0.04f) + 0.25f * glm::vec3(0.2f, 0.4f, 0.8f));
  EXPECT_FLOAT_EQ(r.f90, 1.0f);
}

TEST(Surface, IorAndSpecularChangeTheCoat) {
  Material material;
  material.metallic = 0.0f;
  material.ior = 2.0f;
  material.specular = 0.5f;
  material.specular_color = {1.0f, 0.5f, 20.0f};
  const Reflectance r = look(square(material), {0.1f, 0.2f, 1.0f}, {0.0f, 0.0f, -1.0f}).reflectance;
  expect_near(r.f0, glm::vec3(1.0f / 18.0f, 1.0f / 36.0f, 0.5f));
  EXPECT_FLOAT_EQ(r.f90, 0.5f);
}

TEST(Surface, LambertIsExact) {
  Material material = lambert(glm::vec3(0.8f));
  material.metallic = 0.5f;
  const Reflectance r = look(square(material), {0.1f, 0.2f, 1.0f}, {0.0f, 0.0f, -1.0f}).reflectance;
  expect_near(r.diffuse, glm::vec3(0.4f));
  EXPECT_EQ(r.f0, glm::vec3(0.0f));
  EXPECT_EQ(r.f90, 0.0f);
}

TEST(Surface, TexturesMultiplyTheirFactors) {
  Material material;
  material.metallic = 0.5f;
  material.base_color = {0.5f, 0.5f, 0.5f, 1.0f};
  material.emission = glm::vec3(4.0f);
  material.base_color_texture.texture = 0;
  material.metallic_roughness_texture.texture = 1;
  material.emission_texture.texture = 2;
  Scene scene = square(material);
  scene.textures = {constant_texture({188, 255, 0, 255}, true), constant_texture({0, 51, 102, 255}),
                    constant_texture({255, 0, 128, 255})};
  scene.meshes[0].colors.assign(4, {1.0f, 0.5f, 1.0f, 1.0f});
  const Surface surface = look(scene, {0.1f, 0.2f, 1.0f}, {0.0f, 0.0f, -1.0f});
  const float metallic = 0.5f * 0.4f;
  expect_near(surface.reflectance.diffuse, glm::vec3(0.25f, 0.25f, 0.0f) * (1.0f - metallic),
              2e-3f);
  EXPECT_NEAR(surface.reflectance.alpha, 0.04f, 1e-4f);
  expect_near(surface.emission, {4.0f, 0.0f, 4.0f * 128.0f / 255.0f});
}

TEST(Surface, UnlitEmitsItsColourAndReflectsNothing) {
  Material material;
  material.unlit = true;
  material.base_color = {0.2f, 0.4f, 0.8f, 1.0f};
  const Surface surface = look(square(material), {0.1f, 0.2f, 1.0f}, {0.0f, 0.0f, -1.0f});
  expect_near(surface.emission, {0.2f, 0.4f, 0.8f});
  EXPECT_EQ(surface.reflectance.diffuse, glm::vec3(0.0f));
  EXPECT_EQ(surface.reflectance.f90, 0.0f);
}

TEST(Surface, EmitsThroughItsClearcoat) {
  Material material;
  material.emission = glm::vec3(2.0f, 1.0f, 0.5f);
  material.clearcoat = 0.7f;
  for (const float angle : {0.0f, 1.2f}) {
    const glm::vec3 direction(std::sin(angle), 0.0f, -std::cos(angle));
    const float schlick = std::pow(1.0f - std::cos(angle), 5.0f);
    const glm::vec3 seen = look(square(material), -direction, direction).emission;
    expect_near(seen, (1.0f - 0.7f * (0.04f + 0.96f * schlick)) * material.emission);
  }
  material.lambert = true;
  const glm::vec3 direction(std::sin(1.2f), 0.0f, -std::cos(1.2f));
  expect_near(look(square(material), -direction, direction).emission, material.emission);
}

TEST(Surface, FootprintPicksTheMipLevel) {
  // A checkerboard of texels: full resolution is black or white, a wide cone sees grey
  Texture texture;
  texture.levels.resize(1);
  texture.levels[0].width = texture.levels[0].height = 64;
  for (int i = 0; i < 64 * 64; ++i) {
    const std::uint8_t v = (i % 64 + i / 64) % 2 == 0 ? 255 : 0;
    texture.levels[0].rgba.insert(texture.levels[0].rgba.end(), {v, v, v, 255});
  }
  build_mips(texture);
  Scene scene = square(lambert(glm::vec3(1.0f)));
  scene.textures = {texture};
  scene.materials[0].base_color_texture.texture = 0;
  const glm::vec3 texel_centre(0.5f / 64.0f, 0.5f / 64.0f, 1.0f);
  const auto albedo = [&](float footprint) {
    return look(scene, texel_centre, {0.0f, 0.0f, -1.0f}, footprint).reflectance.diffuse.x;
  };
  const float sharp = albedo(0.0f);
  EXPECT_TRUE(sharp < 0.01f || sharp > 0.99f);
  // Where the ray hits is rounded as the instruction set has it, to 1e-7 of 64 texels
  constexpr float kRounding = 1e-4f;
  EXPECT_NEAR(albedo(0.5f / 64.0f), sharp, kRounding);
  EXPECT_NEAR(albedo(2.0f / 64.0f), 0.5f, 0.01f);
  // A cone 1.4 texels wide covers 2: halfway between the levels
  EXPECT_NEAR(albedo(1.3f / 64.0f), sharp, kRounding);
  EXPECT_NEAR(albedo(1.5f / 64.0f), 0.5f, 0.01f);
}

TEST(Surface, CoverageIsAlphaTimesVertexAlpha) {
  Scene scene = square(lambert(glm::vec3(0.5f)));
  scene.textures = {constant_texture({255, 255, 255, 128})};
  scene.materials[0].base_color_texture.texture = 0;
  scene.materials[0].base_color.a = 0.5f;
  scene.meshes[0].colors.assign(4, {1.0f, 1.0f, 1.0f, 0.5f});
  const TrianglePoint point = triangle_point(scene.meshes[0], 0, {0.2f, 0.3f});
  EXPECT_NEAR(coverage_at(scene, scene.meshes[0], scene.materials[0], point),
              0.5f * 0.5f * 128.0f / 255.0f, 1e-5f);
}

TEST(CameraRays, CornersAndCentreOfAPerspectiveView) {
  const Camera camera = look_at({1.0f, 2.0f, 3.0f}, {1.0f, 2.0f, 0.0f}, 2.0f * std::atan(0.5f));
  expect_near(camera_ray(camera, 40, 20, 20.0f, 10.0f).direction, {0.0f, 0.0f, -1.0f});
  expect_near(camera_ray(camera, 40, 20, 0.0f, 0.0f).direction,
              glm::normalize(glm::vec3(-1.0f, 0.5f, -1.0f)));
  expect_near(camera_ray(camera, 40, 20, 40.0f, 20.0f).direction,
              glm::normalize(glm::vec3(1.0f, -0.5f, -1.0f)));
  EXPECT_NEAR(view_depth(camera, {5.0f, 5.0f, -1.0f}), 4.0f, 1e-5f);
}

TEST(CameraRays, OrthographicRaysAreParallel) {
  Camera camera = look_at({0.0f, 0.0f, 3.0f}, {0.0f, 0.0f, 0.0f}, 1.0f);
  camera.orthographic = true;
  camera.vertical_extent = 4.0f;
  const Ray ray = camera_ray(camera, 40, 20, 0.0f, 0.0f);
  expect_near(ray.direction, {0.0f, 0.0f, -1.0f});
  expect_near(ray.origin, {-4.0f, 2.0f, 3.0f});
}

}  // namespace
}  // namespace lambent::surface_test
