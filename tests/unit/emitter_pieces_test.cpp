// SPDX-License-Identifier: Apache-2.0
// Emissive triangles that are drawn in pieces, by how bright their texture is there.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "raytracing/shade_hits.h"
#include "raytracing/world_access.h"
#include "scene/light_sampling.h"
#include "scene/light_tree/light_tree.h"
#include "shared/random.h"
#include "support/panels.h"

namespace lambent::emitter_pieces_test {
namespace {

using test::add;
using test::lambert;
using test::panel_room;
using test::panel_texture;
using test::quad;

constexpr int kSamples = 200000;
// Cells that brute force takes along an edge of a triangle, more than texels.
constexpr int kGrid = 600;

/// A slanted quad that shows panels, turned and repeated by its texture coordinates.
Scene panel_quad(Wrap wrap, glm::vec2 uv_offset, float uv_scale) {
  Scene scene;
  scene.textures = {panel_texture(64)};
  scene.materials = {lambert(glm::vec3(0.5f), glm::vec3(2.0f))};
  TextureView& view = scene.materials[0].emission_texture;
  view.texture = 0;
  view.wrap_u = view.wrap_v = wrap;
  view.uv_offset = uv_offset;
  view.uv_scale = glm::vec2(uv_scale);
  view.uv_rotation = 0.3f;
  add(scene, quad({0.5f, -1.0f, 2.0f}, {1.5f, 0.5f, 0.0f}, {0.25f, 0.0f, 2.0f}, 0));
  return scene;
}

/// A triangle of an instance in the world, as one record.
EmitterRecord whole_triangle(const Scene& scene, std::uint32_t instance, std::uint32_t triangle) {
  const Mesh& mesh = scene.meshes[scene.instances[instance].mesh];
  const glm::uvec3 v = mesh.triangles[triangle];
  EmitterRecord whole{};
  whole.instance = instance;
  whole.triangle = triangle;
  whole.corner_ws = mesh.positions[v.x];
  whole.edge1_ws = mesh.positions[v.y] - mesh.positions[v.x];
  whole.edge2_ws = mesh.positions[v.z] - mesh.positions[v.x];
  whole.area = 0.5f * glm::length(glm::cross(whole.edge1_ws, whole.edge2_ws));
  whole.piece_size = 1.0f;
  return whole;
}

/// Barycentrics of a point in a triangle's plane.
glm::vec2 barycentrics_of(const EmitterRecord& whole, const glm::vec3& position_ws) {
  const glm::vec3 normal = glm::cross(whole.edge1_ws, whole.edge2_ws);
  const glm::vec3 offset = position_ws - whole.corner_ws;
  return glm::vec2(glm::dot(glm::cross(offset, whole.edge2_ws), normal),
                   glm::dot(glm::cross(whole.edge1_ws, offset), normal)) /
         glm::dot(normal, normal);
}

float sent_at(const EmissiveTriangles& lights, const EmitterRecord& emitter, glm::vec2 at) {
  return lights.radiance(emitter, at, {0.0f, 1.0f, 0.0f}).x;
}

struct Integrals {
  double density = 0.0, radiance = 0.0;
  int dark_but_emitting = 0;
};

/// By brute force over the triangles of an instance: of a grid of cells, the middles of all.
Integrals integrate(const Scene& scene, const EmissiveTriangles& lights, std::uint32_t instance) {
  Integrals sums;
  for (std::uint32_t t = 0; t < 2; ++t) {
    const EmitterRecord whole = whole_triangle(scene, instance, t);
    const double cell = whole.area / (static_cast<double>(kGrid) * kGrid);
    for (int i = 0; i < kGrid; ++i) {
      for (int k = 0; k < 2 * (kGrid - i) - 1; ++k) {
        const float third = k % 2 == 0 ? 1.0f / 3.0f : 2.0f / 3.0f;
        const glm::vec2 at = (glm::vec2(i, k / 2) + third) / static_cast<float>(kGrid);
        const float density = lights.pdf_area(instance, t, at);
        const float radiance = sent_at(lights, whole, at);
        sums.density += cell * density;
        sums.radiance += cell * radiance;
        if (radiance > 0.0f && !(density > 0.0f)) ++sums.dark_but_emitting;
      }
    }
  }
  return sums;
}

void expect_draws_all_that_emits(const Scene& scene) {
  const EmissiveTriangles lights(scene);
  EXPECT_GT(lights.size(), 8u);
  const Integrals sums = integrate(scene, lights, 0);
  EXPECT_EQ(sums.dark_but_emitting, 0);
  EXPECT_NEAR(sums.density, 1.0, 2e-3);

  const EmitterRecord wholes[] = {whole_triangle(scene, 0, 0), whole_triangle(scene, 0, 1)};
  RandomStream random = make_random_stream(7u, 0u, 0u);
  double estimate = 0.0;
  int lit = 0, elsewhere = 0;
  for (int i = 0; i < kSamples; ++i) {
    const glm::vec2 point = next_uniform2(random);
    const EmissiveSample drawn = lights.sample({next_uniform(random), point.x, point.y});
    estimate += drawn.radiance.x / drawn.pdf_area / kSamples;
    if (drawn.radiance.x > 0.0f) ++lit;
    const glm::vec2 first = barycentrics_of(wholes[0], drawn.position_ws);
    const std::uint32_t triangle =
        first.x >= 0.0f && first.y >= 0.0f && first.x + first.y <= 1.0f ? 0 : 1;
    const glm::vec2 at = barycentrics_of(wholes[triangle], drawn.position_ws);
    if (lights.pdf_area(0, triangle, at) != drawn.pdf_area) ++elsewhere;
    if (i < 2000) {
      EXPECT_NEAR(sent_at(lights, wholes[triangle], at), drawn.radiance.x, 2e-3f);
    }
  }
  EXPECT_NEAR(estimate / sums.radiance, 1.0, 0.01);
  // Rounding may bring points across an edge
  EXPECT_LT(elsewhere, kSamples / 1000);
  // Drawn evenly over the triangles, 28 % would be
  EXPECT_GT(lit, 0.4 * kSamples);
}

TEST(EmitterPieces, AreDrawnByTheDensityOfTheirPoints) {
  expect_draws_all_that_emits(panel_quad(Wrap::repeat, {0.0f, 0.0f}, 1.0f));
}

TEST(EmitterPieces, DrawAllThatEmitsWhateverTheWrap) {
  for (const Wrap wrap : {Wrap::repeat, Wrap::mirrored_repeat, Wrap::clamp_to_edge}) {
    SCOPED_TRACE(static_cast<int>(wrap));
    expect_draws_all_that_emits(panel_quad(wrap, {-0.23f, 0.31f}, 1.4f));
  }
}

TEST(EmitterPieces, LeaveTheDarkPartsOut) {
  const Scene scene = panel_room();
  const EmissiveTriangles lights(scene);
  EXPECT_GT(lights.size(), 100u);
  EXPECT_LT(lights.size(), 2048u);
  double area = 0.0;
  for (const EmitterRecord& emitter : lights.entries()) area += emitter.area;
  // The panels have 28 % of 16 m^2, and pieces at their edges are partly dark
  EXPECT_GT(area, 0.28 * 16.0);
  EXPECT_LT(area, 0.5 * 16.0);
  // What is dark is outside of what can be lit
  ASSERT_EQ(lights.bounds().size(), 1u);
  EXPECT_GT(lights.bounds()[0].min.x, -1.99f);

  RandomStream random = make_random_stream(3u, 0u, 0u);
  int lit = 0;
  for (int i = 0; i < kSamples; ++i) {
    const glm::vec2 point = next_uniform2(random);
    if (lights.sample({next_uniform(random), point.x, point.y}).radiance.x > 0.0f) ++lit;
  }
  EXPECT_GT(lit, 0.8 * kSamples);
}

TEST(EmitterPieces, AreWholeTrianglesWhereTheTextureIsEven) {
  Scene scene = panel_room();
  std::vector<std::uint8_t>& texels = scene.textures[0].levels[0].rgba;
  std::fill(texels.begin(), texels.end(), std::uint8_t{255});
  const EmissiveTriangles even(scene);
  scene.materials[1].emission_texture.texture = -1;
  const EmissiveTriangles plain(scene);
  ASSERT_EQ(even.size(), 2u);
  ASSERT_EQ(plain.size(), 2u);
  for (std::size_t e = 0; e < 2; ++e) {
    EXPECT_EQ(even.entries()[e].piece_size, 1.0f);
    EXPECT_EQ(even.entries()[e].probability, plain.entries()[e].probability);
    EXPECT_EQ(even.entries()[e].corner_ws, plain.entries()[e].corner_ws);
    EXPECT_EQ(even.entries()[e].edge1_ws, plain.entries()[e].edge1_ws);
    EXPECT_EQ(even.entries()[e].area, plain.entries()[e].area);
  }

  // A slight gradient is even enough
  scene.materials[1].emission_texture.texture = 0;
  for (std::size_t i = 0; i < texels.size(); ++i) {
    texels[i] = static_cast<std::uint8_t>(200 + i / 4 % 128 / 3);
  }
  EXPECT_EQ(EmissiveTriangles(scene).size(), 2u);
}

TEST(EmitterPieces, AreFewWhereTrianglesAreMany) {
  Scene scene = panel_quad(Wrap::repeat, {0.0f, 0.0f}, 1.0f);
  const std::size_t alone = EmissiveTriangles(scene).size();
  for (int i = 0; i < 100; ++i) scene.instances.push_back(scene.instances[0]);
  const std::size_t several = EmissiveTriangles(scene).size();
  EXPECT_GT(several, 202u);
  EXPECT_LT(several, 101u * alone / 2);
  for (int i = 0; i < 20000; ++i) scene.instances.push_back(scene.instances[0]);
  EXPECT_EQ(EmissiveTriangles(scene).size(), 2u * 20101u);
}

/// Irradiance below the ceiling of the panel room, by brute force [W/m^2].
double light_below(const Scene& scene, const EmissiveTriangles& lights, const LitPoint& point) {
  double sum = 0.0;
  for (std::uint32_t t = 0; t < 2; ++t) {
    const EmitterRecord whole = whole_triangle(scene, 1, t);
    const double cell = whole.area / (static_cast<double>(kGrid) * kGrid);
    for (int i = 0; i < kGrid; ++i) {
      for (int k = 0; k < 2 * (kGrid - i) - 1; ++k) {
        const float third = k % 2 == 0 ? 1.0f / 3.0f : 2.0f / 3.0f;
        const glm::vec2 at = (glm::vec2(i, k / 2) + third) / static_cast<float>(kGrid);
        const glm::vec3 way =
            whole.corner_ws + at.x * whole.edge1_ws + at.y * whole.edge2_ws - point.position_ws;
        const double squared = glm::dot(way, way);
        const double cosines = way.y * std::max(glm::dot(way, point.normal_ws), 0.0f) / squared;
        sum += cell * sent_at(lights, whole, at) * cosines / squared;
      }
    }
  }
  return sum;
}

TEST(EmitterPieces, LightARoomAsTheirWholeTrianglesDo) {
  const Scene scene = panel_room();
  const World world(scene);
  ShadeHitsSettings settings;
  settings.emissive_samples = 64;
  for (const glm::vec3& place : {glm::vec3(0.3f, -1.9f, 0.7f), glm::vec3(1.9f, 1.2f, -0.4f)}) {
    const glm::vec3 normal =
        place.x > 1.5f ? glm::vec3(-1.0f, 0.0f, 0.0f) : glm::vec3(0.0f, 1.0f, 0.0f);
    const LitPoint point{place, normal, normal};
    constexpr std::size_t kQueries = 200;
    std::vector<DirectLightQuery> queries;
    for (std::size_t i = 0; i < kQueries; ++i) queries.push_back({point, i});
    std::vector<glm::vec3> found(kQueries);
    ShadeHitsScratch scratch;
    direct_irradiance(world, queries, settings, scratch, found);
    double mean = 0.0;
    for (const glm::vec3& irradiance : found) mean += irradiance.x / kQueries;
    EXPECT_NEAR(mean / light_below(scene, emissive_of(world), point), 1.0, 0.01);
  }
}

/// Lights a square of a texture alone.
void light_square(Texture& texture, int left, int top) {
  TextureLevel& level = texture.levels[0];
  for (int y = 0; y < level.height; ++y) {
    for (int x = 0; x < level.width; ++x) {
      const bool lit = x >= left && x < left + 12 && y >= top && y < top + 12;
      const auto texel =
          level.rgba.begin() + (static_cast<std::ptrdiff_t>(y) * level.width + x) * 4;
      std::fill(texel, texel + 3, lit ? std::uint8_t{255} : std::uint8_t{0});
    }
  }
  ++texture.revision;
}

TEST(EmitterPieces, FollowTheTextureThatIsEdited) {
  Scene scene = panel_room();
  light_square(scene.textures[0], 100, 88);
  World world(scene);
  const std::size_t before = emissive_of(world).size();
  // In another place of the same triangle, as many pieces are lights
  light_square(scene.textures[0], 72, 108);
  ASSERT_TRUE(world.update());
  const World fresh(scene);
  ASSERT_EQ(emissive_of(world).size(), before);
  ASSERT_EQ(emissive_of(fresh).size(), before);
  for (std::size_t e = 0; e < before; ++e) {
    ASSERT_EQ(emissive_of(world).entries()[e].corner_ws, emissive_of(fresh).entries()[e].corner_ws);
  }
  EXPECT_EQ(lights_of(world).builds(), 2);
}

}  // namespace
}  // namespace lambent::emitter_pieces_test
