// SPDX-License-Identifier: Apache-2.0
#include "scenes/recipes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <tuple>

#include "raytracing/raytracer.h"
#include "shared/random.h"
#include "shared/sampling.h"

namespace lambent::scenes::builtin_scene_test {
namespace {

using testing::HasSubstr;

constexpr int kRays = 2000;

/// The scene; of the atrium with small textures, which are made faster.
Scene scene_named(const std::string& name) {
  constexpr int kTexels = 64;
  return name == "atrium" ? make_atrium(kTexels).scene : make(name).value();
}

const Instance& instance_named(const Scene& scene, const std::string& name) {
  for (const Instance& instance : scene.instances) {
    if (instance.name == name) return instance;
  }
  throw std::out_of_range(name);
}

/// True where every edge is met by exactly one triangle in each direction: closed, and wound
/// consistently.
bool is_closed(const Mesh& mesh) {
  using Point = std::tuple<float, float, float>;
  std::map<std::pair<Point, Point>, int> edges;
  const auto point = [&](std::uint32_t i) {
    // Adding 0 makes -0 and 0 one key.
    const glm::vec3 p = mesh.positions[i] + 0.0f;
    return Point{p.x, p.y, p.z};
  };
  for (const glm::uvec3& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) ++edges[{point(t[k]), point(t[(k + 1) % 3])}];
  }
  for (const auto& [edge, count] : edges) {
    const auto opposite = edges.find({edge.second, edge.first});
    if (count != 1 || opposite == edges.end() || opposite->second != 1) return false;
  }
  return true;
}

/// Positive where front faces look outwards.
float signed_volume(const Mesh& mesh) {
  float sum = 0.0f;
  for (const glm::uvec3& t : mesh.triangles) {
    sum += glm::dot(mesh.positions[t.x], glm::cross(mesh.positions[t.y], mesh.positions[t.z]));
  }
  return sum / 6.0f;
}

/// Rays in all directions from a point.
std::vector<Ray> rays_from(const glm::vec3& origin) {
  std::vector<Ray> rays(kRays);
  for (int i = 0; i < kRays; ++i) {
    rays[i].origin = origin;
    rays[i].direction = spherical_fibonacci(i, kRays);
  }
  return rays;
}

std::vector<Hit> hits_of(const Scene& scene, const std::vector<Ray>& rays) {
  std::vector<Hit> hits(rays.size());
  make_embree_raytracer(scene)->closest_hits(rays, hits);
  return hits;
}

class EveryBuiltin : public testing::TestWithParam<std::string> {};

TEST_P(EveryBuiltin, IsValid) {
  const Scene scene = make(GetParam()).value();
  const Expected<void> valid = validate(scene);
  EXPECT_TRUE(valid) << valid.error().message();
  EXPECT_FALSE(scene.cameras.empty());
  EXPECT_EQ(scene.source.path, GetParam());
}

TEST_P(EveryBuiltin, HasNormalsThatAgreeWithTheWinding) {
  const Scene scene = scene_named(GetParam());
  for (const Mesh& mesh : scene.meshes) {
    for (const glm::uvec3& t : mesh.triangles) {
      const glm::vec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
      const glm::vec3 n = glm::cross(b - a, c - a);
      ASSERT_GT(glm::length(n), 0.0f) << mesh.name;
      for (int k = 0; k < 3; ++k) ASSERT_GT(glm::dot(n, mesh.normals[t[k]]), 0.0f) << mesh.name;
    }
  }
}

TEST_P(EveryBuiltin, IsTheSameEveryTime) {
  const Scene first = scene_named(GetParam()), second = scene_named(GetParam());
  ASSERT_EQ(first.meshes.size(), second.meshes.size());
  for (std::size_t i = 0; i < first.meshes.size(); ++i) {
    EXPECT_TRUE(first.meshes[i].positions == second.meshes[i].positions);
    EXPECT_TRUE(first.meshes[i].normals == second.meshes[i].normals);
    EXPECT_TRUE(first.meshes[i].tangents == second.meshes[i].tangents);
    EXPECT_TRUE(first.meshes[i].uvs == second.meshes[i].uvs);
    EXPECT_TRUE(first.meshes[i].triangles == second.meshes[i].triangles);
  }
  ASSERT_EQ(first.textures.size(), second.textures.size());
  for (std::size_t i = 0; i < first.textures.size(); ++i) {
    EXPECT_TRUE(first.textures[i].levels[0].rgba == second.textures[i].levels[0].rgba);
  }
}

INSTANTIATE_TEST_SUITE_P(BuiltinScene, EveryBuiltin, testing::ValuesIn(names()),
                         [](const auto& tested) {
                           std::string name = tested.param;
                           for (char& c : name) c = c == '-' ? '_' : c;
                           return name;
                         });

TEST(BuiltinScene, UnknownNameListsTheKnownOnes) {
  const Expected<Scene> scene = make("nowhere");
  ASSERT_FALSE(scene);
  for (const std::string& name : names()) EXPECT_THAT(scene.error().cause, HasSubstr(name));
}

TEST(BuiltinScene, CornellIsOpenAtTheFrontOnly) {
  const Scene scene = scene_named("cornell");
  EXPECT_EQ(triangle_count(scene), 38u);
  const std::vector<Ray> rays = rays_from({2.8f, 4.0f, 2.0f});
  const std::vector<Hit> hits = hits_of(scene, rays);
  int escaped = 0;
  for (int i = 0; i < kRays; ++i) {
    if (!hits[i].missed()) {
      EXPECT_TRUE(hits[i].front_face);
      continue;
    }
    ++escaped;
    ASSERT_LT(rays[i].direction.z, 0.0f);
    const glm::vec3 exit =
        rays[i].origin - rays[i].direction * (rays[i].origin.z / rays[i].direction.z);
    EXPECT_TRUE(exit.x >= 0.0f && exit.x <= 5.56f && exit.y >= 0.0f && exit.y <= 5.488f);
  }
  EXPECT_GT(escaped, 0);
}

TEST(BuiltinScene, FurnaceLetsNothingOutAndShowsOnlyItsFrontFaces) {
  const Scene scene = scene_named("furnace");
  for (const glm::vec3 eye : {glm::vec3(-2.7f, 1.7f, 1.7f), glm::vec3(2.5f, 0.3f, -1.5f)}) {
    for (const Hit& hit : hits_of(scene, rays_from(eye))) {
      ASSERT_FALSE(hit.missed());
      EXPECT_TRUE(hit.front_face);
    }
  }
  for (const char* name : {"room", "hanging_crate", "sphere"}) {
    EXPECT_TRUE(is_closed(scene.meshes[instance_named(scene, name).mesh])) << name;
  }
  for (const Material& material : scene.materials) {
    EXPECT_EQ(material.emission, glm::vec3(1.0f) - glm::vec3(material.base_color));
  }
}

TEST(BuiltinScene, RoomsLookInwardsAndBodiesOutwards) {
  EXPECT_NEAR(signed_volume(scene_named("cube").meshes[0]), -1000.0f, 0.01f);
  EXPECT_NEAR(signed_volume(scene_named("furnace").meshes[0]), -72.0f, 0.01f);
  const Mesh sphere = scene_named("furnace-sky").meshes[0];
  EXPECT_TRUE(is_closed(sphere));
  EXPECT_NEAR(signed_volume(sphere), 4.0f / 3.0f * kPi, 0.1f);
}

TEST(BuiltinScene, SkyFurnaceIsConvex) {
  const Mesh mesh = scene_named("furnace-sky").meshes[0];
  constexpr float kFloatNoise = 1e-5f;
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::vec3 n = mesh.normals[t.x];
    for (const glm::vec3& p : mesh.positions) {
      ASSERT_LT(glm::dot(n, p - mesh.positions[t.x]), kFloatNoise);
    }
  }
}

TEST(BuiltinScene, LampsAreAsManyAsTheirDescriptionSays) {
  const Scene scene = scene_named("lamps");
  EXPECT_EQ(scene.lights.size(), 1000u);
  std::size_t emissive = 0;
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    if (scene.materials[mesh.material].emission != glm::vec3(0.0f))
      emissive += mesh.triangles.size();
  }
  EXPECT_EQ(emissive, 100000u);
}

TEST(BuiltinScene, TwoRoomsAreBuiltOfClosedBodies) {
  for (const char* name : {"two-rooms", "two-rooms-sealed"}) {
    for (const Mesh& mesh : scene_named(name).meshes) {
      EXPECT_TRUE(is_closed(mesh)) << mesh.name;
      EXPECT_GT(signed_volume(mesh), 0.0f) << mesh.name;
    }
  }
}

TEST(BuiltinScene, TwoRoomsShareLightThroughTheGapOnly) {
  for (const bool sealed : {false, true}) {
    const Scene scene = scene_named(sealed ? "two-rooms-sealed" : "two-rooms");
    const std::vector<Ray> rays = rays_from(scene.lights[0].position_ws);
    const std::vector<Hit> hits = hits_of(scene, rays);
    int across = 0;
    for (int i = 0; i < kRays; ++i) {
      ASSERT_FALSE(hits[i].missed());
      const glm::vec3 p = rays[i].origin + rays[i].direction * hits[i].distance;
      across += p.x > 0.0f;
    }
    EXPECT_EQ(across > 0, !sealed);
  }
}

TEST(BuiltinScene, SquaresFaceEachOther) {
  for (const char* name : {"squares-parallel", "squares-perpendicular"}) {
    const Scene scene = scene_named(name);
    const glm::vec3 middle = 0.5f * (scene.meshes[1].positions[0] + scene.meshes[1].positions[2]);
    const Ray up{{0.5f, 0.0f, 0.5f},
                 0.0f,
                 glm::normalize(middle - glm::vec3(0.5f, 0.0f, 0.5f)),
                 kInfiniteDistance};
    Ray from_receiver = up;
    from_receiver.t_min = 1e-3f;
    const Hit hit = make_embree_raytracer(scene)->closest_hit(from_receiver);
    EXPECT_EQ(hit.instance, 1u);
    EXPECT_TRUE(hit.front_face);
  }
}

}  // namespace
}  // namespace lambent::scenes::builtin_scene_test
