// SPDX-License-Identifier: Apache-2.0
// Light transport as a linear operator on the field.
//
// The irradiance that probes receive is linear in the irradiance that they hold:
// E' = W (albedo/pi (direct + S E) + sky), with W the blend matrix and S the surfels' lookups.
// Solving E = E' gives the light of all bounces at once, without tracing a ray. A solve may be for
// some of the probes only; the others keep their light.
//
// With the blend weight w, surfels read (1 - w) * history + w * E, the field as it will be once E
// is blended in, so that the solution is consistent with the stored light.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "field/probe_share.h"
#include "field/transport/anderson.h"
#include "field/transport/surfels.h"

namespace lambent {

/// The transport of light to some probes. `field` arguments have the texels of all probes of the
/// field. All other arrays have those of the operator's probes only.
class TransportOperator {
 public:
  /// All `probes` must have surfels. `fit` is the matrix of tile_fit.h for tiles of `texels` x
  /// `texels`, and `corner_table` that of the store. All arguments must outlive the operator.
  TransportOperator(std::span<const CornerOffsets> corner_table, std::span<const ProbeTrace> traces,
                    std::span<const int> probes, const BlendMatrix& fit, int texels);

  /// One bounce: computes the irradiance that the probes receive if `field` and direct light
  /// illuminate their surfels. Texels for which no ray counts take their value from `fallback`.
  void apply(const WorkingIrradiance& field, const WorkingIrradiance& fallback,
             WorkingIrradiance& received) const;

  /// No bounce: computes the irradiance from the sky only.
  void apply_sky(const WorkingIrradiance& fallback, WorkingIrradiance& received) const;

  std::span<const int> probes() const { return probes_; }
  int texels() const { return texels_; }  ///< Texels of a tile, without gutter.

 private:
  void gather_probe_radiance(const WorkingIrradiance& field, const ProbeTrace& trace,
                             float* radiance) const;
  template <class Gather>
  void receive(Gather gather, const WorkingIrradiance& fallback, WorkingIrradiance& received) const;

  std::span<const CornerOffsets> corner_table_;
  std::span<const ProbeTrace> traces_;
  std::span<const int> probes_;
  const BlendMatrix& fit_;
  int texels_;  // interior texels of a tile
  std::vector<std::array<std::uint16_t, 4>>
      taps_;  // the four interior texels of each possible fetch
};

/// When a solve stops; see solve_settings().
struct SolveSettings {
  float max_albedo = 0.0f;  ///< Bound of the surfels' mean albedos, 0 to 0.99.
  float tolerance = 0.0f;   ///< Estimated relative error of the blended light to stop at.
  int max_iterations = 0;   ///< The solve stops after this many iterations in any case.
};

/// When a solve of a field with these settings stops.
SolveSettings solve_settings(const FieldSettings& settings);

/// The outcome of a solve.
struct SolveResult {
  int iterations = 0;
  double error = 0.0;   ///< Estimated relative error of the light after blending.
  double change = 0.0;  ///< Change of the probes' light, root mean square over that of the light.
  WorkingIrradiance solution;  ///< The solution for the operator's probes, before blending.
};

/// Multiplies a by b, texel by texel.
void multiply(WorkingIrradiance& a, const WorkingIrradiance& b);

/// Copies the texels of some probes from a field.
WorkingIrradiance light_of(const WorkingIrradiance& field, std::span<const int> probes, int texels);

/// The division of a solve among ranks: each has an operator for its own probes.
struct SolveShare {
  /// All probes belong to this process.
  SolveShare() = default;
  /// `all` are the probes of all ranks' operators, in ascending order. `parted` must outlive this
  /// object.
  SolveShare(const ProbeShare& parted, std::span<const int> all, int texels_of_tile);

  const ProbeShare* probes = nullptr;  ///< Null: all probes belong to this process.
  SharedTexels texels;

  /// Gives every rank the light of the others' probes.
  void gather(WorkingIrradiance& field) const;
  /// The largest of the numbers of all ranks, which are >= 0; 0 where there are none.
  float largest(std::span<const float> own) const;
};

/// Solves for the light of the operator's probes, starting from what `field` holds, and blends the
/// solution into `field` with the weight `blend_weights[k]` for the k-th probe. The received
/// irradiance is multiplied by `history_ratio`, texel by texel, unless that is empty. Where ranks
/// share the solve, `field` holds the light of the probes of all ranks afterwards.
SolveResult solve_bounces(const TransportOperator& transport, std::span<const float> blend_weights,
                          const WorkingIrradiance& history_ratio, const SolveSettings& settings,
                          const SolveShare& share, WorkingIrradiance& field);
/// Does so where all probes belong to this process.
inline SolveResult solve_bounces(const TransportOperator& transport,
                                 std::span<const float> blend_weights,
                                 const WorkingIrradiance& history_ratio,
                                 const SolveSettings& settings, WorkingIrradiance& field) {
  return solve_bounces(transport, blend_weights, history_ratio, settings, {}, field);
}

/// Solves for the light of exactly this many bounces, without acceleration. The operator's probes
/// of all ranks must be all probes of the field.
SolveResult solve_counted_bounces(const TransportOperator& transport,
                                  std::span<const float> blend_weights, int bounces,
                                  const SolveShare& share, WorkingIrradiance& field);
/// Does so where all probes belong to this process.
inline SolveResult solve_counted_bounces(const TransportOperator& transport,
                                         std::span<const float> blend_weights, int bounces,
                                         WorkingIrradiance& field) {
  return solve_counted_bounces(transport, blend_weights, bounces, {}, field);
}

}  // namespace lambent
