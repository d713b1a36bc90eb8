// SPDX-License-Identifier: Apache-2.0
#include "field/transport/solve_bounces.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "field/probes/tile_fit.h"
#include "field/probes/volumes.h"
#include "field/transport/distances.h"
#include "raytracing/world_access.h"
#include "support/field_scenes.h"

namespace lambent::solve_bounces_test {
namespace {

using test::look_up;
using test::make_field;
using test::Stage;

/// The transport operator of an update in a scene, made as the field makes it.
class Transport {
 public:
  Transport(const Stage& stage, const FieldSettings& settings)
      : grid_(fit_grid(settings, stage.bounds()).value()),
        store_(still_grid(grid_), settings),
        fit_(settings.irradiance_texels * settings.irradiance_texels,
             settings.irradiance_texels * settings.irradiance_texels,
             tile_fit_matrix(settings.irradiance_texels)),
        traces_(store_.probes()),
        texels_(settings.irradiance_texels) {
    group_.rays = std::make_shared<RaySet>(settings, settings.rays_per_probe, 0u);
    group_.probes.resize(store_.probes());
    std::iota(group_.probes.begin(), group_.probes.end(), 0);
    const DistanceBlend distance_blend(settings, group_.rays->directions);
    trace_probe_rays(tracer_of(stage.world), store_, group_);
    const SolidSides sides = solid_sides_by_winding(stage.scene);
    blend_distances(sides, distance_blend, group_, all(), 0u, store_);
    shade_surfels(stage.world, sides, store_, group_, settings, traces_);
    find_surfel_lookups(store_, {}, group_.probes, traces_);
  }

  TransportOperator make_operator() const { return make_operator(group_.probes); }
  TransportOperator make_operator(std::span<const int> probes) const {
    return {store_.corner_table(), traces_, probes, fit_, texels_};
  }
  WorkingIrradiance darkness() const {
    return WorkingIrradiance(static_cast<std::size_t>(store_.probes()) * texels_ * texels_,
                             vec4(0.0f));
  }
  /// A blend weight of 1 for every probe.
  std::vector<float> all() const { return std::vector<float>(store_.probes(), 1.0f); }
  int tile_texels() const { return texels_ * texels_; }

  SolveResult solve_bounces(const SolveSettings& settings, WorkingIrradiance& field) const {
    return lambent::solve_bounces(make_operator(), all(), {}, settings, field);
  }

 private:
  FieldGrid grid_;
  ProbeStore store_;
  BlendMatrix fit_;
  TraceGroup group_;
  std::vector<ProbeTrace> traces_;
  int texels_;
};

FieldSettings few_probes() {
  FieldSettings settings = test::exact_formats();
  settings.probe_count = {6, 4, 4};
  settings.rays_per_probe = 64;
  return settings;
}

/// Rooms in which light is absorbed slowly, which makes a solve converge slowly.
const Stage& rooms() {
  static const Stage stage("two-rooms");
  return stage;
}

double relative_distance(WorkingIrradiance a, const WorkingIrradiance& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] -= b[i];
  return norm(a) / norm(b);
}

/// The Neumann sum: this many applications of the operator to darkness, without acceleration.
WorkingIrradiance neumann_sum(const Transport& transport, int terms) {
  const TransportOperator op = transport.make_operator();
  WorkingIrradiance field = transport.darkness(), next = field;
  for (int i = 0; i < terms; ++i) {
    op.apply(field, transport.darkness(), next);
    field.swap(next);
  }
  return field;
}

TEST(Relight, AcceleratedSolutionEqualsTheNeumannSumToTheTolerance) {
  const Transport transport(rooms(), few_probes());
  const WorkingIrradiance truth = neumann_sum(transport, 400);
  ASSERT_GT(norm(truth), 0.0);
  for (const float tolerance : {1e-2f, 1e-3f, 1e-4f}) {
    WorkingIrradiance solution = transport.darkness();
    const SolveResult result = transport.solve_bounces({0.95f, tolerance, 200}, solution);
    EXPECT_LE(result.error, tolerance);
    EXPECT_LT(result.iterations, 200);
    // The error is estimated from the contraction of the steps
    EXPECT_LE(relative_distance(solution, truth), 1.5f * tolerance);
  }
}

TEST(Relight, AccelerationSavesIterations) {
  const Transport transport(rooms(), few_probes());
  const WorkingIrradiance truth = neumann_sum(transport, 400);
  WorkingIrradiance solution = transport.darkness();
  const SolveResult result = transport.solve_bounces({0.95f, 1e-4f, 200}, solution);
  // The same number of applications without acceleration is farther from the truth
  EXPECT_GT(relative_distance(neumann_sum(transport, result.iterations), truth),
            3.0 * relative_distance(solution, truth));
}

TEST(Relight, AWarmStartIsFasterThanACold) {
  const Transport transport(rooms(), few_probes());
  const SolveSettings settings{0.95f, 1e-4f, 200};
  WorkingIrradiance solution = transport.darkness();
  const int cold = transport.solve_bounces(settings, solution).iterations;
  const int warm = transport.solve_bounces(settings, solution).iterations;
  EXPECT_LT(warm, cold);
}

TEST(Relight, StopsAtTheIterationsItIsGiven) {
  const Transport transport(rooms(), few_probes());
  WorkingIrradiance solution = transport.darkness();
  const SolveResult result = transport.solve_bounces({0.95f, 1e-6f, 3}, solution);
  EXPECT_EQ(result.iterations, 3);
  EXPECT_GT(result.error, 1e-6);
}

TEST(Relight, SomeProbesReachTheSolutionOfAllWhenTheOthersHoldIt) {
  const Transport transport(rooms(), few_probes());
  const SolveSettings settings{0.95f, 1e-5f, 200};
  WorkingIrradiance truth = transport.darkness();
  transport.solve_bounces(settings, truth);

  // Every other probe has lost its light
  WorkingIrradiance field = truth;
  std::vector<int> probes;
  const std::size_t texels = transport.tile_texels();
  for (std::size_t probe = 0; probe * texels < field.size(); probe += 2) {
    probes.push_back(static_cast<int>(probe));
    std::fill_n(field.begin() + probe * texels, texels, vec4(0.0f));
  }
  const WorkingIrradiance dimmed = field;
  solve_bounces(transport.make_operator(probes), std::vector<float>(probes.size(), 1.0f), {},
                settings, field);
  EXPECT_LT(relative_distance(field, truth), 1e-4);
  for (std::size_t i = texels; i < 2 * texels; ++i) EXPECT_EQ(field[i], dimmed[i]);
}

TEST(Relight, BouncesArePlainApplications) {
  const Transport transport(rooms(), few_probes());
  for (const int bounces : {0, 1, 2, 5}) {
    WorkingIrradiance solution = transport.darkness();
    const SolveResult result =
        solve_counted_bounces(transport.make_operator(), transport.all(), bounces, solution);
    EXPECT_EQ(result.iterations, bounces);
    // There is no sky, so that the sum starts from darkness; negative light is clamped to 0
    WorkingIrradiance expected = neumann_sum(transport, bounces);
    for (vec4& e : expected) e = max(e, vec4(0.0f));
    EXPECT_TRUE(solution == expected) << bounces;
  }
}

/// Points in the middle of the rooms that face six ways.
std::vector<FieldQuery> points_in_rooms() {
  std::vector<FieldQuery> queries;
  for (const glm::vec3 position :
       {glm::vec3(-2.0f, 1.0f, 0.3f), glm::vec3(1.0f, 1.5f, 1.0f), glm::vec3(3.0f, 0.5f, -1.0f)}) {
    for (int axis = 0; axis < 6; ++axis) {
      glm::vec3 normal(0.0f);
      normal[axis / 2] = axis % 2 == 0 ? 1.0f : -1.0f;
      queries.push_back({position, normal, normal});
    }
  }
  return queries;
}

TEST(IrradianceField, LightOnlyGrowsWithBounces) {
  const std::vector<FieldQuery> queries = points_in_rooms();
  std::vector<glm::vec3> fewer(queries.size(), glm::vec3(0.0f));
  double fewer_sum = -1.0;
  for (const int bounces : {0, 1, 2, 3, 6, 12, -1}) {
    FieldSettings settings = few_probes();
    settings.max_bounces = bounces;
    settings.solve_tolerance = 1e-5f;
    settings.max_solve_iterations = 200;
    const std::vector<glm::vec3> light = look_up(make_field(rooms(), settings), queries);
    double sum = 0.0;
    for (std::size_t i = 0; i < light.size(); ++i) {
      sum += light[i].x + light[i].y + light[i].z;
      for (int c = 0; c < 3; ++c) EXPECT_GE(light[i][c], fewer[i][c] * 0.998f) << bounces;
    }
    EXPECT_GT(sum, fewer_sum) << bounces;
    fewer = light;
    fewer_sum = sum;
  }
}

TEST(IrradianceField, AllBouncesEqualVeryMany) {
  FieldSettings settings = few_probes();
  settings.solve_tolerance = 1e-4f;
  settings.max_solve_iterations = 100;
  const std::vector<FieldQuery> queries = points_in_rooms();
  const std::vector<glm::vec3> all = look_up(make_field(rooms(), settings), queries);
  settings.max_bounces = 200;
  const std::vector<glm::vec3> many = look_up(make_field(rooms(), settings), queries);
  // The tolerance is relative to all light: in the dark room, too, to the light of the lit room
  float brightest = 0.0f;
  for (const glm::vec3& e : many) brightest = std::max(brightest, glm::length(e));
  for (std::size_t i = 0; i < queries.size(); ++i) {
    EXPECT_LT(glm::distance(all[i], many[i]), 3e-4f * brightest) << i;
  }
}

}  // namespace
}  // namespace lambent::solve_bounces_test
