// SPDX-License-Identifier: Apache-2.0
// What the README shows, as a program: a room by hand, a field in it, the light at a point.
#include <lambent/field.h>
#include <lambent/image.h>
#include <lambent/renderer.h>
#include <lambent/scene.h>
#include <lambent/world.h>

#include <array>
#include <cmath>
#include <cstdio>

namespace {

/// Adds one inner wall of a room of 2 m: the parallelogram at `corner`, front along cross(a, b).
void add_wall(lambent::Scene& scene, const glm::vec3& corner, const glm::vec3& a,
              const glm::vec3& b) {
  lambent::Mesh mesh;
  mesh.positions = {corner, corner + a, corner + a + b, corner + b};
  mesh.normals.assign(4, glm::normalize(glm::cross(a, b)));
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  lambent::Instance instance;
  instance.mesh = static_cast<int>(scene.meshes.size());
  scene.meshes.push_back(mesh);
  scene.instances.push_back(instance);
}

}  // namespace

int main() {
  lambent::Scene scene;
  lambent::Material white;
  white.base_color = glm::vec4(0.5f, 0.5f, 0.5f, 1.0f);
  white.lambert = true;
  white.metallic = 0.0f;
  scene.materials = {white};
  const glm::vec3 x(2.0f, 0.0f, 0.0f), y(0.0f, 2.0f, 0.0f), z(0.0f, 0.0f, 2.0f), low(-1.0f);
  add_wall(scene, low, z, x);
  add_wall(scene, low + y, x, z);
  add_wall(scene, low, y, z);
  add_wall(scene, low + x, z, y);
  add_wall(scene, low, x, y);
  add_wall(scene, low + z, y, x);
  scene.lights.resize(1);
  if (const auto valid = lambent::validate(scene); !valid) {
    std::fprintf(stderr, "%s\n", valid.error().message().c_str());
    return 1;
  }

  const lambent::World world(scene);
  lambent::FieldSettings settings;
  settings.probe_count = glm::ivec3(3);
  auto field = lambent::IrradianceField::make(settings, lambent::world_bounds(scene));
  if (!field) {
    std::fprintf(stderr, "%s\n", field.error().message().c_str());
    return 1;
  }
  field->update(world);
  const std::array queries = {
      lambent::FieldQuery{{0.0f, -1.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, {0.0f, 1.0f, 0.0f}}};
  std::array<glm::vec3, 1> irradiance{};
  field->irradiance(queries, irradiance);
  std::printf("indirect irradiance on the floor: %g W/m^2\n", irradiance[0].x);

  // A closed room passes all flux of the light around: 4 pi W over 24 m^2, half reflected each
  // time.
  const float mean = 4.0f * 3.14159265f / 24.0f;
  return std::isfinite(irradiance[0].x) && irradiance[0].x > 0.5f * mean &&
                 irradiance[0].x < 2.0f * mean
             ? 0
             : 1;
}
