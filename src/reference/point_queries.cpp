// SPDX-License-Identifier: Apache-2.0
#include <cassert>

#include "core/parallel.h"
#include "reference/path.h"
#include "reference/path_tracer.h"
#include "reference/statistics.h"

namespace lambent {
namespace {

using reference::SobolSampler;

// The mean of `sample(random)` over `samples` paths. `index` makes the estimate independent of all
// others.
template <class Sample>
Estimate estimate(std::uint32_t index, int samples, std::uint32_t seed, const Sample& sample) {
  assert(samples >= 2);
  glm::dvec3 sum(0.0);
  glm::dvec3 sum_of_squares(0.0);
  const int passes = reference::pass_count(samples);
  for (int pass = 0; pass < passes; ++pass) {
    const int count = reference::samples_of_pass(samples, pass);
    const uvec3 hash = hash_pcg3d(uvec3(index, static_cast<std::uint32_t>(pass), seed));
    glm::dvec3 pass_sum(0.0);
    for (int s = 0; s < count; ++s) {
      SobolSampler random(hash.x, static_cast<std::uint32_t>(s));
      pass_sum += glm::dvec3(sample(random));
    }
    sum += pass_sum;
    sum_of_squares += pass_sum * pass_sum / static_cast<double>(count);
  }
  return {glm::vec3(sum / static_cast<double>(samples)),
          glm::vec3(glm::sqrt(reference::variance_of_mean(sum, sum_of_squares, samples, passes)))};
}

}  // namespace

std::vector<Estimate> reference_irradiance(const World& world, std::span<const SurfacePoint> points,
                                           int samples, std::uint32_t seed, LightKind which,
                                           reference::Strategy strategy, int max_bounces) {
  const reference::PathIntegrator integrator(world, max_bounces, strategy);
  std::vector<Estimate> estimates(points.size());
  parallel_chunks(points.size(), 1, [&](std::size_t i, std::size_t) {
    estimates[i] =
        estimate(static_cast<std::uint32_t>(i), samples, seed, [&](SobolSampler& random) {
          std::uint64_t rays = 0;
          const reference::IrradianceSample sample = integrator.sample_irradiance(
              points[i].position_ws, points[i].normal_ws, random, rays);
          switch (which) {
            case LightKind::direct:
              return sample.direct;
            case LightKind::indirect:
              return sample.indirect;
            case LightKind::all:
              break;
          }
          return sample.direct + sample.indirect;
        });
  });
  return estimates;
}

Estimate reference_radiance(const World& world, const Ray& ray, int samples, std::uint32_t seed,
                            reference::Strategy strategy) {
  const reference::PathIntegrator integrator(world, kUnboundedBounces, strategy);
  return estimate(0, samples, seed, [&](SobolSampler& random) {
    std::uint64_t rays = 0;
    return integrator.sample_pixel(ray, random, rays).radiance();
  });
}

}  // namespace lambent
