// SPDX-License-Identifier: Apache-2.0
// Scenes of a few quads, made by hand for tests whose answer is known in closed form.
#pragma once

#include <glm/glm.hpp>

#include "lambent/scene.h"

namespace lambent::test {

/// A Lambert surface.
inline Material lambert(const glm::vec3& albedo, const glm::vec3& emission = glm::vec3(0.0f)) {
  Material material;
  material.base_color = glm::vec4(albedo, 1.0f);
  material.metallic = 0.0f;
  material.emission = emission;
  material.lambert = true;
  return material;
}

/// The parallelogram corner, corner + a, corner + a + b, corner + b. Its front looks along cross(a,
/// b).
inline Mesh quad(const glm::vec3& corner, const glm::vec3& a, const glm::vec3& b, int material) {
  Mesh mesh;
  mesh.positions = {corner, corner + a, corner + a + b, corner + b};
  mesh.normals.assign(4, glm::normalize(glm::cross(a, b)));
  mesh.uvs[0] = {{0.0f, 1.0f}, {1.0f, 1.0f}, {1.0f, 0.0f}, {0.0f, 0.0f}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.material = material;
  return mesh;
}

/// Adds a mesh and places it.
inline void add(Scene& scene, Mesh mesh, const glm::mat4& world_from_object = glm::mat4(1.0f)) {
  Instance instance;
  instance.mesh = static_cast<int>(scene.meshes.size());
  instance.world_from_object = world_from_object;
  scene.meshes.push_back(std::move(mesh));
  scene.instances.push_back(instance);
}

/// Adds the six faces of a cube about the origin, fronts inside.
inline void add_room(Scene& scene, float size, int material) {
  const float h = 0.5f * size;
  const glm::vec3 x(size, 0.0f, 0.0f), y(0.0f, size, 0.0f), z(0.0f, 0.0f, size);
  add(scene, quad({-h, -h, -h}, z, x, material));  // floor
  add(scene, quad({-h, h, -h}, x, z, material));   // ceiling
  add(scene, quad({-h, -h, -h}, y, z, material));  // -x
  add(scene, quad({h, -h, -h}, z, y, material));   // +x
  add(scene, quad({-h, -h, -h}, x, y, material));  // -z
  add(scene, quad({-h, -h, h}, y, x, material));   // +z
}

/// A sphere of latitude-longitude quads about the origin, fronts outside, with exact normals.
inline Mesh sphere(float radius, int rings, int material) {
  Mesh mesh;
  mesh.material = material;
  const int segments = 2 * rings;
  for (int r = 0; r <= rings; ++r) {
    for (int s = 0; s <= segments; ++s) {
      const float theta = 3.14159265f * static_cast<float>(r) / static_cast<float>(rings);
      const float phi = 6.28318531f * static_cast<float>(s) / static_cast<float>(segments);
      const glm::vec3 n(std::sin(theta) * std::sin(phi), std::cos(theta),
                        std::sin(theta) * std::cos(phi));
      mesh.positions.push_back(n * radius);
      mesh.normals.push_back(n);
      mesh.uvs[0].push_back({phi / 6.28318531f, theta / 3.14159265f});
    }
  }
  for (int r = 0; r < rings; ++r) {
    for (int s = 0; s < segments; ++s) {
      const auto a = static_cast<std::uint32_t>(r * (segments + 1) + s);
      const auto b = a + static_cast<std::uint32_t>(segments) + 1;
      if (r > 0) mesh.triangles.push_back({a, b, a + 1});
      if (r < rings - 1) mesh.triangles.push_back({a + 1, b, b + 1});
    }
  }
  return mesh;
}

/// A light that sends `irradiance` to surfaces perpendicular to `direction_ws`.
inline Light sun(const glm::vec3& irradiance, const glm::vec3& direction_ws) {
  Light light;
  light.type = Light::Type::directional;
  light.intensity = irradiance;
  light.direction_ws = glm::normalize(direction_ws);
  return light;
}

inline Light point_light(const glm::vec3& intensity, const glm::vec3& position_ws) {
  Light light;
  light.type = Light::Type::point;
  light.intensity = intensity;
  light.position_ws = position_ws;
  return light;
}

}  // namespace lambent::test
