// SPDX-License-Identifier: Apache-2.0
#include "field/transport/solve_bounces.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "core/parallel.h"
#include "core/simd.h"
#include "field/probes/tile.h"
#include "field/transport/anderson_math.h"
#include "field/transport/blend_math.h"
#include "field/transport/surfel_math.h"

namespace lambent {
namespace {

constexpr std::size_t kProbesPerTask = 16;
constexpr std::size_t kProbesPerCopy = 512;
constexpr std::size_t kTexelsPerTask = 16384;

/// Calls body(k, i, j) for each of the operator's probes: k is its place among them, i the index of
/// its first texel in the field, and j the index of that texel in arrays of the operator's probes.
template <class Body>
void for_each_probe(const TransportOperator& transport, Body body) {
  const std::span<const int> probes = transport.probes();
  const auto texels = static_cast<std::size_t>(transport.texels());
  parallel_chunks(probes.size(), kProbesPerCopy, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) body(k, probes[k] * texels, k * texels);
  });
}

/// Sets the field's texels to the blend of history and solution.
void blend_into(const TransportOperator& transport, std::span<const float> blend_weights,
                const WorkingIrradiance& history, const WorkingIrradiance& solution,
                WorkingIrradiance& field) {
  for_each_probe(transport, [&](std::size_t k, std::size_t in_field, std::size_t own) {
    for (int t = 0; t < transport.texels(); ++t) {
      field[in_field + t] = mix(history[own + t], solution[own + t], blend_weights[k]);
    }
  });
}

/// Blends the solution into the field at the end of a solve, without negative light. Returns the
/// relative change of the light.
double finish(const TransportOperator& transport, std::span<const float> blend_weights,
              const WorkingIrradiance& history, const WorkingIrradiance& solution,
              const SolveShare& share, WorkingIrradiance& field) {
  WorkingIrradiance difference(history.size());
  for_each_probe(transport, [&](std::size_t k, std::size_t in_field, std::size_t own) {
    for (int t = 0; t < transport.texels(); ++t) {
      const vec4 blended =
          max(mix(history[own + t], solution[own + t], blend_weights[k]), vec4(0.0f));
      difference[own + t] = blended - history[own + t];
      field[in_field + t] = blended;
    }
  });
  share.gather(field);
  const double whole = share.texels.norm(solution);
  return whole > 0.0 ? share.texels.norm(difference) / whole : 0.0;
}

/// Everything that the radiance along a probe's rays depends on.
struct GatherInput {
  const ProbeTrace& trace;
  const CornerOffsets* corner_table;
  const std::array<std::uint16_t, 4>* taps;  // interior texels of each place of a fetch
  const vec4* field;
  int texels;  // of a tile
};

// The types and functions that gather.inl.h requires.
using FieldRef = const GatherInput&;
using SurfelLookupRef = const SurfelLookup&;
using CornerOffsetsRef = const CornerOffsets&;
using TapsRef = const std::array<std::uint16_t, 4>&;
using TileRef = const vec4*;

LAMBENT_FORCE_INLINE CornerOffsetsRef fetch_offsets(const GatherInput& in, uint table) {
  return in.corner_table[table];
}
LAMBENT_FORCE_INLINE TapsRef fetch_taps(const GatherInput& in, uint tile_corner) {
  return in.taps[tile_corner];
}
LAMBENT_FORCE_INLINE TileRef fetch_tile(const GatherInput& in, int probe) {
  return in.field + static_cast<std::ptrdiff_t>(probe) * in.texels;
}
LAMBENT_FORCE_INLINE const vec4& fetch_texel(const GatherInput& /*in*/, TileRef tile, int texel) {
  return tile[texel];
}

#include "field/transport/gather.inl.h"

LAMBENT_FORCE_INLINE void store(const vec4& value, float* out) {
  for (int c = 0; c < 4; ++c) out[c] = value[c];
}

/// Gathers the sky's radiance along a probe's rays. `radiance` has four floats per ray.
void gather_sky(const ProbeTrace& trace, float* radiance) {
  for (std::size_t i = 0; i < trace.surfels.size(); ++i) {
    const Surfel& surfel = trace.surfels[i];
    store(sent_radiance(static_cast<uint>(surfel.kind), surfel.albedo_over_pi, surfel.light,
                        /*reflects=*/false),
          radiance + 4 * i);
  }
}

/// Gathers the radiance along a probe's rays. `radiance` has four floats per ray.
LAMBENT_SIMD_CLONES __attribute__((flatten)) void gather_radiance(const GatherInput& in,
                                                                  float* radiance) {
  for (std::size_t i = 0; i < in.trace.surfels.size(); ++i) {
    const Surfel& surfel = in.trace.surfels[i];
    vec3 arrives = surfel.light;
    if (surfel.reflects()) arrives += vec3(read_field(in, in.trace.lookups[i]));
    store(sent_radiance(static_cast<uint>(surfel.kind), surfel.albedo_over_pi, arrives, true),
          radiance + 4 * i);
  }
  for (const FurtherLookup& further : in.trace.further) {
    const vec3 sum = vec3(read_field(in, further.lookup));
    const vec3 sent = in.trace.surfels[further.ray].albedo_over_pi * sum;
    for (int c = 0; c < 3; ++c) radiance[4 * further.ray + c] += sent[c];
  }
}

}  // namespace

TransportOperator::TransportOperator(std::span<const CornerOffsets> corner_table,
                                     std::span<const ProbeTrace> traces,
                                     std::span<const int> probes, const BlendMatrix& fit,
                                     int texels)
    : corner_table_(corner_table),
      traces_(traces),
      probes_(probes),
      fit_(fit),
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

void TransportOperator::gather_probe_radiance(const WorkingIrradiance& field,
                                              const ProbeTrace& trace, float* radiance) const {
  gather_radiance({trace, corner_table_.data(), taps_.data(), field.data(), texels_}, radiance);
}

void TransportOperator::apply(const WorkingIrradiance& field, const WorkingIrradiance& fallback,
                              WorkingIrradiance& received) const {
  receive([&](const ProbeTrace& trace,
              float* radiance) { gather_probe_radiance(field, trace, radiance); },
          fallback, received);
}

void TransportOperator::apply_sky(const WorkingIrradiance& fallback,
                                  WorkingIrradiance& received) const {
  receive(gather_sky, fallback, received);
}

template <class Gather>
void TransportOperator::receive(Gather gather, const WorkingIrradiance& fallback,
                                WorkingIrradiance& received) const {
  parallel_chunks(probes_.size(), kProbesPerTask, [&](std::size_t begin, std::size_t end) {
    std::vector<float> radiance;
    std::vector<vec4> sums(texels_), at_centres(texels_);
    for (std::size_t k = begin; k < end; ++k) {
      const ProbeTrace& trace = traces_[probes_[k]];
      const float enough = kMinKnownWeight * static_cast<float>(trace.surfels.size());
      radiance.resize(4 * trace.surfels.size());
      gather(trace, radiance.data());
      trace.rays->irradiance_blend.apply4(radiance.data(), &sums[0].x);
      bool known = true;
      for (int t = 0; t < texels_; ++t) {
        known = known && sums[t].w > enough;
        at_centres[t] = vec4(irradiance_at_centre(sums[t]), 0.0f);
      }
      vec4* out = &received[k * texels_];
      if (known) {
        fit_.apply4(&at_centres[0].x, &out[0].x);
        continue;
      }

      // If rays count for only some texels, the fit is left out, and the other texels keep their
      // light
      for (int t = 0; t < texels_; ++t) {
        out[t] = sums[t].w > enough ? at_centres[t] : fallback[k * texels_ + t];
      }
    }
  });
}

void multiply(WorkingIrradiance& a, const WorkingIrradiance& b) {
  parallel_chunks(a.size(), kTexelsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) a[i] *= b[i];
  });
}

WorkingIrradiance light_of(const WorkingIrradiance& field, std::span<const int> probes,
                           int texels) {
  WorkingIrradiance light(probes.size() * texels);
  parallel_chunks(probes.size(), kProbesPerCopy, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      std::copy_n(&field[static_cast<std::size_t>(probes[k]) * texels], texels, &light[k * texels]);
    }
  });
  return light;
}

SolveSettings solve_settings(const FieldSettings& settings) {
  return {settings.max_albedo, settings.solve_tolerance, settings.max_solve_iterations};
}

SolveShare::SolveShare(const ProbeShare& parted, std::span<const int> all, int texels_of_tile)
    : probes(&parted) {
  std::vector<std::size_t> firsts = parted.places_of_parts(all);
  for (std::size_t& first : firsts) first *= static_cast<std::size_t>(texels_of_tile);
  texels = SharedTexels(parted.ranks(), std::move(firsts));
}

void SolveShare::gather(WorkingIrradiance& field) const {
  if (probes != nullptr) probes->gather(std::span(field));
}

float SolveShare::largest(std::span<const float> own) const {
  const float most = own.empty() ? 0.0f : *std::max_element(own.begin(), own.end());
  if (probes == nullptr) return most;
  const std::vector<float> each = gather_each(probes->ranks(), most);
  return *std::max_element(each.begin(), each.end());
}

SolveResult solve_counted_bounces(const TransportOperator& transport,
                                  std::span<const float> blend_weights, int bounces,
                                  const SolveShare& share, WorkingIrradiance& field) {
  const WorkingIrradiance history = light_of(field, transport.probes(), transport.texels());
  WorkingIrradiance solution = field, received(history.size());
  const std::vector<float> all_new(transport.probes().size(), 1.0f);
  transport.apply_sky(history, received);
  for (int i = 0; i < bounces; ++i) {
    blend_into(transport, all_new, history, received, solution);
    share.gather(solution);
    transport.apply(solution, history, received);
  }
  const double change = finish(transport, blend_weights, history, received, share, field);
  return {bounces, 0.0, change, std::move(received)};
}

SolveResult solve_bounces(const TransportOperator& transport, std::span<const float> blend_weights,
                          const WorkingIrradiance& history_ratio, const SolveSettings& settings,
                          const SolveShare& share, WorkingIrradiance& field) {
  const WorkingIrradiance history = light_of(field, transport.probes(), transport.texels());
  const std::size_t size = history.size();
  WorkingIrradiance solution = history, image(size), residual(size);
  WorkingIrradiance previous_image, previous_residual;
  AndersonMemory memory;
  SolveResult result;
  if (share.texels.empty(size)) return result;
  const float blend_weight = share.largest(blend_weights);
  const float bound = blend_weight * settings.max_albedo;
  float observed = 0.0f;
  float contraction = bound;

  while (true) {
    // Apply the transport once
    blend_into(transport, blend_weights, history, solution, field);
    share.gather(field);
    transport.apply(field, history, image);
    if (!history_ratio.empty()) multiply(image, history_ratio);
    ++result.iterations;
    add_scaled(image, -1.0f, solution, residual);

    // Compute the contraction: the ratio of the change of the image to the change of its argument.
    // In the first iteration, only an estimate by the bound of mean albedos and the blend weight is
    // known
    if (result.iterations > 1) {
      WorkingIrradiance residual_change(size), image_change(size), change(size);
      add_scaled(residual, -1.0f, previous_residual, residual_change);
      add_scaled(image, -1.0f, previous_image, image_change);
      add_scaled(image_change, -1.0f, residual_change, change);
      const double change_norm = share.texels.norm(change);
      if (change_norm > 0.0) {
        observed = max(observed, static_cast<float>(share.texels.norm(image_change) / change_norm));
      }
      contraction = assumed_contraction(observed, bound);
      memory.push(std::move(residual_change), std::move(image_change));
    }

    // Estimate the error
    const double image_norm = share.texels.norm(image);
    const double relative_residual =
        image_norm > 0.0 ? share.texels.norm(residual) / image_norm : 0.0;
    result.error =
        remaining_error(contraction, blend_weight, static_cast<float>(relative_residual));
    if (result.error <= settings.tolerance || result.iterations >= settings.max_iterations) {
      result.change = finish(transport, blend_weights, history, image, share, field);
      result.solution = std::move(image);
      return result;
    }

    // Extrapolate from the last steps; without them, the next iterate is the image
    previous_residual = residual;
    previous_image = image;
    solution = image;
    memory.extrapolate(share.texels, residual, solution);
  }
}

}  // namespace lambent
