// SPDX-License-Identifier: Apache-2.0
#include "field/relight.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/parallel.h"
#include "field/tile.h"
#include "shared/constants.h"

namespace lambent {
namespace {

constexpr std::size_t kProbesPerTask = 16;
constexpr std::size_t kTexelsPerTask = 16384;

// Texels whose rays count for less than this share of all are too few to tell anything.
constexpr float kMinBlendWeight = 1e-4f;
// Keeps the division by the weights of a texel for which no ray counts finite.
constexpr float kTiniestWeight = 1e-20f;

// Steps that Anderson acceleration looks back on: more gain little and cost memory.
constexpr int kAndersonDepth = 3;
// Keeps its small system solvable when steps are almost parallel; relative to the largest squared
// step.
constexpr double kAndersonRidge = 1e-10;
// The error estimate never assumes faster convergence than this, whatever two steps seem to say.
constexpr double kMinContraction = 0.1;

double dot(const WorkingIrradiance& a, const WorkingIrradiance& b) {
  return parallel_sum(a.size(), kTexelsPerTask, [&](std::size_t begin, std::size_t end) {
    double sum = 0.0;
    for (std::size_t i = begin; i < end; ++i) sum += glm::dot(a[i], b[i]);
    return sum;
  });
}

double norm(const WorkingIrradiance& a) {
  return std::sqrt(dot(a, a));
}

/// result = a + scale * b
void add_scaled(const WorkingIrradiance& a, float scale, const WorkingIrradiance& b,
                WorkingIrradiance& result) {
  parallel_chunks(a.size(), kTexelsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) result[i] = a[i] + scale * b[i];
  });
}

/// Solves the small symmetric system of the normal equations by Gaussian elimination; it is
/// positive definite.
std::array<double, kAndersonDepth> solve(
    std::array<std::array<double, kAndersonDepth>, kAndersonDepth> m,
    std::array<double, kAndersonDepth> rhs, int size) {
  for (int i = 0; i < size; ++i) {
    for (int row = i + 1; row < size; ++row) {
      const double factor = m[row][i] / m[i][i];
      for (int column = i; column < size; ++column) m[row][column] -= factor * m[i][column];
      rhs[row] -= factor * rhs[i];
    }
  }
  for (int i = size - 1; i >= 0; --i) {
    for (int column = i + 1; column < size; ++column) rhs[i] -= m[i][column] * rhs[column];
    rhs[i] /= m[i][i];
  }
  return rhs;
}

/// The last steps of the iteration, from which it extrapolates.
class AndersonMemory {
 public:
  /// Remembers a step and how the residual and the image changed over it.
  void push(WorkingIrradiance residual_change, WorkingIrradiance image_change) {
    if (size() == kAndersonDepth) {
      residual_changes_.erase(residual_changes_.begin());
      image_changes_.erase(image_changes_.begin());
    }
    residual_changes_.push_back(std::move(residual_change));
    image_changes_.push_back(std::move(image_change));
  }

  /// Moves `next`, the plain next iterate, to where the residual's linear model is smallest.
  void extrapolate(const WorkingIrradiance& residual, WorkingIrradiance& next) const {
    const int n = size();
    if (n == 0) return;
    std::array<std::array<double, kAndersonDepth>, kAndersonDepth> gram{};
    std::array<double, kAndersonDepth> projection{};
    double largest = 0.0;
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j <= i; ++j) {
        gram[i][j] = gram[j][i] = dot(residual_changes_[i], residual_changes_[j]);
      }
      projection[i] = dot(residual_changes_[i], residual);
      largest = std::max(largest, gram[i][i]);
    }
    if (largest <= 0.0) return;
    for (int i = 0; i < n; ++i) gram[i][i] += kAndersonRidge * largest;
    const std::array<double, kAndersonDepth> share = solve(gram, projection, n);
    for (int i = 0; i < n; ++i) {
      add_scaled(next, -static_cast<float>(share[i]), image_changes_[i], next);
    }
  }

 private:
  int size() const { return static_cast<int>(residual_changes_.size()); }
  std::vector<WorkingIrradiance> residual_changes_, image_changes_;
};

}  // namespace

TransportOperator::TransportOperator(const ProbeGrid& grid, const Surfels& surfels,
                                     const BlendMatrix& blend, const BlendMatrix& fit, int texels)
    : surfels_(surfels),
      blend_(blend),
      fit_(fit),
      offsets_(corner_offsets(grid)),
      texels_(texels * texels),
      taps_(static_cast<std::size_t>(texels + 1) * (texels + 1)) {
  for (int y = 0; y <= texels; ++y) {
    for (int x = 0; x <= texels; ++x) {
      for (int tap = 0; tap < 4; ++tap) {
        const ivec2 source = tile_source({x + (tap & 1), y + (tap >> 1)}, texels);
        taps_[x + (texels + 1) * y][tap] = static_cast<std::uint16_t>(source.x + texels * source.y);
      }
    }
  }
}

void TransportOperator::gather_probe_radiance(const WorkingIrradiance& field, std::size_t probe,
                                              float* radiance) const {
  const int rays = surfels_.rays_per_probe;
  for (int i = 0; i < rays; ++i) {
    const std::size_t s = probe * rays + i;
    float* out = radiance + 4 * i;
    if (surfels_.counts[s] == 0) {
      out[0] = out[1] = out[2] = out[3] = 0.0f;
      continue;
    }

    // What reflects nothing shows the sky, or is black
    out[3] = 1.0f;
    if (surfels_.albedo_over_pi[s] == vec3(0.0f)) {
      for (int c = 0; c < 3; ++c) out[c] = surfels_.sky_radiance[s][c];
      continue;
    }

    // Look the field up at the surfel
    const SurfelLookup& lookup = surfels_.lookups[s];
    const std::array<std::uint16_t, 4>& taps = taps_[lookup.tile_corner];
    const float fx = lookup.fraction_x, fy = lookup.fraction_y;
    const float shares[4] = {(1.0f - fx) * (1.0f - fy), fx * (1.0f - fy), (1.0f - fx) * fy,
                             fx * fy};
    vec4 irradiance(0.0f);
    for (int corner = 0; corner < 8; ++corner) {
      const std::size_t probe_read = lookup.corners.base + offsets_.probe[corner];
      const vec4* tile = &field[probe_read * texels_];
      const vec4 value = tile[taps[0]] * shares[0] + tile[taps[1]] * shares[1] +
                         tile[taps[2]] * shares[2] + tile[taps[3]] * shares[3];
      irradiance += value * lookup.corners.weight[corner];
    }

    // Send back what it reflects
    const vec3 sent =
        surfels_.albedo_over_pi[s] * (surfels_.direct_irradiance[s] + vec3(irradiance));
    for (int c = 0; c < 3; ++c) out[c] = sent[c];
  }
}

void TransportOperator::gather_probe_sky(std::size_t probe, float* radiance) const {
  const int rays = surfels_.rays_per_probe;
  for (int i = 0; i < rays; ++i) {
    const std::size_t s = probe * rays + i;
    const float counts = surfels_.counts[s] != 0 ? 1.0f : 0.0f;
    const vec4 sent(surfels_.sky_radiance[s], counts);
    for (int c = 0; c < 4; ++c) radiance[4 * i + c] = sent[c];
  }
}

void TransportOperator::apply(const WorkingIrradiance& field, const WorkingIrradiance& fallback,
                              WorkingIrradiance& received) const {
  receive(
      [&](std::size_t probe, float* radiance) { gather_probe_radiance(field, probe, radiance); },
      fallback, received);
}

void TransportOperator::apply_sky(const WorkingIrradiance& fallback,
                                  WorkingIrradiance& received) const {
  receive([&](std::size_t probe, float* radiance) { gather_probe_sky(probe, radiance); }, fallback,
          received);
}

template <class Gather>
void TransportOperator::receive(Gather gather, const WorkingIrradiance& fallback,
                                WorkingIrradiance& received) const {
  const int rays = surfels_.rays_per_probe;
  parallel_chunks(surfels_.size() / rays, kProbesPerTask, [&](std::size_t begin, std::size_t end) {
    std::vector<float> radiance(4 * static_cast<std::size_t>(rays));
    std::vector<vec4> sums(texels_), at_centres(texels_);
    for (std::size_t probe = begin; probe < end; ++probe) {
      gather(probe, radiance.data());
      blend_.apply4(radiance.data(), &sums[0].x);
      // The mean radiance, weighted by the cosine, times pi is the irradiance at the texels'
      // centres
      bool known = true;
      for (int t = 0; t < texels_; ++t) {
        known = known && sums[t].w > kMinBlendWeight * static_cast<float>(rays);
        at_centres[t] = vec4(vec3(sums[t]) * (kPi / max(sums[t].w, kTiniestWeight)), 0.0f);
      }
      vec4* out = &received[probe * texels_];
      if (known) {
        fit_.apply4(&at_centres[0].x, &out[0].x);
        continue;
      }

      // Where rays count for some texels only, there is nothing to fit: the others keep what they
      // had
      for (int t = 0; t < texels_; ++t) {
        const bool counted = sums[t].w > kMinBlendWeight * static_cast<float>(rays);
        out[t] = counted ? at_centres[t] : fallback[probe * texels_ + t];
      }
    }
  });
}

RelightResult relight_bounces(const TransportOperator& transport, const WorkingIrradiance& history,
                              int bounces, WorkingIrradiance& solution) {
  transport.apply_sky(history, solution);
  WorkingIrradiance received(solution.size());
  for (int i = 0; i < bounces; ++i) {
    transport.apply(solution, history, received);
    solution.swap(received);
  }
  return {bounces, 0.0};
}

double blended_change(const WorkingIrradiance& history, const WorkingIrradiance& solution,
                      float share) {
  WorkingIrradiance difference(history.size());
  add_scaled(solution, -1.0f, history, difference);
  const double whole = norm(solution);
  return whole > 0.0 ? share * norm(difference) / whole : 0.0;
}

RelightResult relight(const TransportOperator& transport, const WorkingIrradiance& history,
                      const RelightSettings& settings, WorkingIrradiance& solution) {
  const std::size_t size = solution.size();
  WorkingIrradiance field(size), image(size), residual(size), previous_image, previous_residual;
  AndersonMemory memory;
  RelightResult result;
  const double bound = static_cast<double>(settings.blend) * settings.max_albedo;
  double observed = 0.0;
  double contraction = bound;

  while (true) {
    // Send the light round once
    parallel_chunks(size, kTexelsPerTask, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        field[i] = (1.0f - settings.blend) * history[i] + settings.blend * solution[i];
      }
    });
    transport.apply(field, history, image);
    ++result.iterations;
    add_scaled(image, -1.0f, solution, residual);

    // Compute the contraction: by how much an image changed less than what it is the image of. One
    // step knows only that nothing reflects more than the largest albedo
    if (!previous_residual.empty()) {
      WorkingIrradiance residual_change(size), image_change(size), change(size);
      add_scaled(residual, -1.0f, previous_residual, residual_change);
      add_scaled(image, -1.0f, previous_image, image_change);
      add_scaled(image_change, -1.0f, residual_change, change);
      const double change_norm = norm(change);
      if (change_norm > 0.0) observed = std::max(observed, norm(image_change) / change_norm);
      contraction = std::min(bound, std::max(observed, kMinContraction));
      memory.push(std::move(residual_change), std::move(image_change));
    }

    // Estimate the error: a contraction by q leaves q / (1 - q) of the last step to go
    const double image_norm = norm(image);
    const double remaining = contraction / (1.0 - contraction);
    result.error =
        image_norm > 0.0 ? settings.blend * remaining * norm(residual) / image_norm : 0.0;
    if (result.error <= settings.tolerance || result.iterations >= settings.max_iterations) {
      solution.swap(image);
      return result;
    }

    // Extrapolate from the last steps; the plain next iterate is the image itself
    previous_residual = residual;
    previous_image = image;
    solution = image;
    memory.extrapolate(residual, solution);
  }
}

}  // namespace lambent
