// SPDX-License-Identifier: Apache-2.0
#include "bench/dynamics/subject.h"

#include <cmath>

#include "bench/stage.h"
#include "lambent/renderer.h"
#include "reference/path_tracer.h"
#include "shared/color.h"

namespace lambent::dynamics {
namespace {

// Updates and rays of the field that counts as settled.
constexpr int kSettledUpdates = 48;
constexpr int kSettledRays = 512;

}  // namespace

Subject::Subject(const std::string& name, const FieldSettings& settings)
    : scene(bench::open_stage(name)),
      bounds(open_bounds(World(scene))),
      world(scene),
      field(fresh_field(settings)) {}

IrradianceField Subject::fresh_field(const FieldSettings& settings) const {
  return bench::value_or_throw(IrradianceField::make(settings, bounds));
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
  bench::value_or_throw(world.update());
}

void Subject::move(const std::string& instance, const glm::vec3& by) {
  Instance* moved = &scene.instances.back();
  for (Instance& each : scene.instances) {
    if (each.name == instance) moved = &each;
  }
  moved->world_from_object[3] += glm::vec4(by, 0.0f);
}

std::vector<FieldQuery> seen_points(const Subject& subject, int pixels_across) {
  return visible_points(subject.world, subject.scene.cameras.front(), pixels_across, pixels_across)
      .value();
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
