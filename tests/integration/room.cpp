// SPDX-License-Identifier: Apache-2.0
#include "room.h"

#include <lambent/field.h>
#include <lambent/world.h>

#include <cmath>
#include <cstdio>

namespace {

constexpr float kSide = 2.0f;        // [m]
constexpr float kMargin = 0.1f;      // of points from the walls' edges [m]
constexpr int kPointsAlongEdge = 5;  // of each wall

// Updates that the processor's field averages: its noise is then small beside the other's.
constexpr int kManyUpdates = 64;

// Relative root mean square that five updates of 144 rays a probe may be off: most of it is their
// noise, of two or three updates averaged since the probes came to rest; 0.012 is measured.
constexpr double kTolerance = 0.03;
// And in all: noise averages out.
constexpr double kMeanTolerance = 0.01;

}  // namespace

Room make_room() {
  Room room;
  const glm::vec3 x(kSide, 0.0f, 0.0f), y(0.0f, kSide, 0.0f), z(0.0f, 0.0f, kSide);
  const glm::vec3 low(-0.5f * kSide), white(0.7f), red(0.7f, 0.1f, 0.1f), green(0.1f, 0.7f, 0.1f);
  const auto wall = [&](const glm::vec3& corner, const glm::vec3& a, const glm::vec3& b,
                        const glm::vec3& albedo) {
    const glm::vec3 normal = glm::normalize(glm::cross(a, b));
    room.shapes.push_back({corner, a, b});
    room.walls.push_back({normal, albedo});
    const float step = (kSide - 2.0f * kMargin) / (kPointsAlongEdge - 1);
    for (int i = 0; i < kPointsAlongEdge; ++i) {
      for (int j = 0; j < kPointsAlongEdge; ++j) {
        const glm::vec2 along = (kMargin + step * glm::vec2(i, j)) / kSide;
        room.points.push_back(corner + along.x * a + along.y * b);
        room.points.push_back(normal);
      }
    }
  };
  wall(low, z, x, white);
  wall(low + y, x, z, white);
  wall(low, y, z, red);
  wall(low + x, z, y, green);
  wall(low, x, y, white);
  wall(low + z, y, x, white);
  room.bounds = {low, low + x + y + z};
  room.lamp_ws = glm::vec3(0.2f, 0.6f, -0.1f);
  room.lamp_intensity = 2.0f;
  return room;
}

bool is_as_expected(const Room& room, const lambent::FieldSettings& settings,
                    const glm::vec3& viewer_ws, std::span<const glm::vec3> irradiance) {
  lambent::Scene scene;
  for (std::size_t i = 0; i < room.shapes.size(); ++i) {
    const WallShape& shape = room.shapes[i];
    lambent::Material material;
    material.base_color = glm::vec4(room.walls[i].albedo, 1.0f);
    material.lambert = true;
    material.metallic = 0.0f;
    scene.materials.push_back(material);
    lambent::Mesh mesh;
    mesh.positions = {shape.corner, shape.corner + shape.a, shape.corner + shape.a + shape.b,
                      shape.corner + shape.b};
    mesh.normals.assign(4, room.walls[i].normal);
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    mesh.material = static_cast<int>(i);
    scene.meshes.push_back(mesh);
    lambent::Instance instance;
    instance.mesh = static_cast<int>(i);
    scene.instances.push_back(instance);
  }
  lambent::Light lamp;
  lamp.type = lambent::Light::Type::point;
  lamp.position_ws = room.lamp_ws;
  lamp.intensity = glm::vec3(room.lamp_intensity);
  scene.lights.push_back(lamp);
  if (const auto valid = lambent::validate(scene); !valid) return false;
  const lambent::World world(scene);
  auto field = lambent::IrradianceField::make(settings, room.bounds);
  if (!field) return false;
  lambent::UpdateRequest request;
  request.viewer_ws = viewer_ws;
  for (int i = 0; i < kManyUpdates; ++i) field->update(world, request);

  std::vector<lambent::FieldQuery> queries;
  for (std::size_t i = 0; i + 1 < room.points.size(); i += 2) {
    queries.push_back({room.points[i], room.points[i + 1], room.points[i + 1]});
  }
  std::vector<glm::vec3> expected(queries.size());
  field->irradiance(queries, expected);
  double off = 0.0, all = 0.0, sum = 0.0, expected_sum = 0.0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const glm::vec3 difference = irradiance[i] - expected[i];
    off += glm::dot(difference, difference);
    all += glm::dot(expected[i], expected[i]);
    sum += glm::dot(irradiance[i], glm::vec3(1.0f));
    expected_sum += glm::dot(expected[i], glm::vec3(1.0f));
  }
  const double error = std::sqrt(off / all), mean = sum / expected_sum - 1.0;
  std::printf("off by %.2f %% (root mean square), %+.2f %% in all\n", 100.0 * error, 100.0 * mean);
  return irradiance.size() == expected.size() && error <= kTolerance &&
         std::abs(mean) <= kMeanTolerance;
}
