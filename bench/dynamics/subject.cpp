// SPDX-License-Identifier: Apache-2.0
#include "bench/dynamics/subject.h"

#include <cmath>
#include <stdexcept>

#include "raytracing/camera_rays.h"
#include "raytracing/raytracer.h"
#include "raytracing/surface.h"
#include "reference/path_tracer.h"
#include "scenes/builtin.h"
#include "shared/color.h"

namespace lambent::dynamics {
namespace {

// What a field is held to have settled to.
constexpr int kSettledUpdates = 48;
constexpr int kSettledRays = 512;

template <class T>
T value_or_throw(Expected<T> value) {
  if (!value) throw std::runtime_error(value.error().message());
  return std::move(*value);
}

Scene lit_scene(const std::string& name) {
  Scene scene = value_or_throw(scenes::open_scene(name));
  bool lit = !scene.lights.empty() || scene.environment.radiance != glm::vec3(0.0f);
  for (const Material& material : scene.materials) {
    lit = lit || material.emission != glm::vec3(0.0f);
  }
  if (!lit) {
    Light sun;
    sun.type = Light::Type::directional;
    sun.intensity = glm::vec3(10.0f);
    sun.direction_ws = glm::normalize(glm::vec3(0.2f, -1.0f, 0.3f));
    scene.lights.push_back(sun);
    scene.environment.radiance = glm::vec3(1.0f);
  }
  if (scene.cameras.empty()) {
    // Down the nave of Sponza, which comes without a camera
    constexpr float kFieldOfView = 1.0471975512f;  // 60 degrees [rad]
    scene.cameras.push_back(look_at({-8.0f, 1.5f, 0.3f}, {6.0f, 3.5f, 0.0f}, kFieldOfView));
  }
  return scene;
}

}  // namespace

Subject::Subject(const std::string& name, const FieldSettings& settings)
    : scene(lit_scene(name)),
      bounds(open_bounds(World(scene))),
      world(scene),
      field(fresh_field(settings)) {}

IrradianceField Subject::fresh_field(const FieldSettings& settings) const {
  return value_or_throw(IrradianceField::make(settings, bounds));
}

IrradianceField Subject::settled_field() const {
  FieldSettings settings = field.settings();
  settings.rays_per_probe = kSettledRays;
  settings.hysteresis = 0.999f;
  settings.seed += 1;
  const World now(scene);
  IrradianceField settled = fresh_field(settings);
  for (int i = 0; i < kSettledUpdates; ++i) settled.update(now);
  return settled;
}

void Subject::apply_edits() {
  value_or_throw(world.update());
}

void Subject::move(const std::string& instance, const glm::vec3& by) {
  Instance* moved = &scene.instances.back();
  for (Instance& each : scene.instances) {
    if (each.name == instance) moved = &each;
  }
  moved->world_from_object[3] += glm::vec4(by, 0.0f);
}

std::vector<FieldQuery> seen_points(const Subject& subject, int pixels_across) {
  std::vector<FieldQuery> points;
  const int count = pixels_across * pixels_across;
  for (int i = 0; i < count; ++i) {
    const Ray ray = camera_ray(subject.scene.cameras.front(), pixels_across, pixels_across,
                               static_cast<float>(i % pixels_across) + 0.5f,
                               static_cast<float>(i / pixels_across) + 0.5f);
    const Hit hit = subject.world.tracer().closest_hit(ray);
    if (hit.missed()) continue;
    const Surface surface = surface_at(subject.scene, ray, hit);
    points.push_back({surface.position_ws, surface.normal_ws, -ray.direction});
  }
  return points;
}

std::vector<double> light_at(const IrradianceField& field, std::span<const FieldQuery> points) {
  std::vector<glm::vec3> irradiance(points.size());
  field.irradiance(points, irradiance);
  std::vector<double> light;
  for (const glm::vec3& e : irradiance) light.push_back(luminance(e));
  return light;
}

std::vector<double> reference_light_at(const World& world, std::span<const FieldQuery> points,
                                       int samples) {
  std::vector<SurfacePoint> where;
  for (const FieldQuery& point : points) where.push_back({point.position_ws, point.normal_ws});
  std::vector<double> light;
  for (const Estimate& e : reference_irradiance(world, where, samples, 1, LightKind::indirect)) {
    light.push_back(luminance(e.mean));
  }
  return light;
}

Difference compare(std::span<const double> a, std::span<const double> b) {
  double sum_a = 0.0, sum_b = 0.0, square = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum_a += a[i];
    sum_b += b[i];
    square += (a[i] - b[i]) * (a[i] - b[i]);
  }
  const auto count = static_cast<double>(a.size());
  return {sum_a / sum_b, std::sqrt(square / count) / (sum_b / count)};
}

}  // namespace lambent::dynamics
