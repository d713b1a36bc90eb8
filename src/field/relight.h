// SPDX-License-Identifier: Apache-2.0
// Light transport as a linear operator on the field.
//
// What probes receive is linear in what they hold: E' = W (albedo/pi (direct + S E) + sky), with W
// the blend matrix and S the surfels' lookups. Relighting solves E = E' for all bounces at once,
// without a ray.
//
// Surfels read (1 - blend) * history + blend * E, the field as it will be once E is blended in, so
// that the solution is consistent with what is stored.
//
// Anderson acceleration: Walker and Ni, "Anderson Acceleration for Fixed-Point Iterations", SIAM J.
// Numer. Anal. 49(4), 2011; for a linear operator it is equivalent to GMRES.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "field/blend.h"
#include "field/surfels.h"

namespace lambent {

/// Linear irradiance of all probes' interior texels, probe after probe, four floats a texel (the
/// fourth is 0).
using WorkingIrradiance = std::vector<vec4>;

class TransportOperator {
 public:
  /// `fit` is the matrix of tile_fit.h. All arguments must outlive the operator.
  TransportOperator(const ProbeGrid& grid, const Surfels& surfels, const BlendMatrix& blend,
                    const BlendMatrix& fit, int texels);

  /// One bounce: what the probes would receive if surfels were lit by `field` besides direct light.
  /// Texels that no ray counts for take their value from `fallback`.
  void apply(const WorkingIrradiance& field, const WorkingIrradiance& fallback,
             WorkingIrradiance& received) const;

  /// No bounce: what the probes receive from the sky alone.
  void apply_sky(const WorkingIrradiance& fallback, WorkingIrradiance& received) const;

 private:
  void gather_probe_radiance(const WorkingIrradiance& field, std::size_t probe,
                             float* radiance) const;
  void gather_probe_sky(std::size_t probe, float* radiance) const;
  template <class Gather>
  void receive(Gather gather, const WorkingIrradiance& fallback, WorkingIrradiance& received) const;

  const Surfels& surfels_;
  const BlendMatrix& blend_;
  const BlendMatrix& fit_;
  CornerOffsets offsets_;
  int texels_;                                      // interior texels of a tile
  std::vector<std::array<std::uint16_t, 4>> taps_;  // interior texels of each place of a fetch
};

struct RelightSettings {
  float blend = 1.0f;        ///< Share of the new solution in the field that surfels read.
  float max_albedo = 0.95f;  ///< No surfel reflects more, 0 to 0.99.
  float tolerance = 0.002f;  ///< Estimated relative error to stop at, of the field as it is stored.
  int max_iterations = 32;
};

struct RelightResult {
  int iterations = 0;
  double error = 0.0;  ///< Estimated relative error of the field that the solution is blended into.
};

/// The light of exactly so many bounces, without acceleration.
RelightResult relight_bounces(const TransportOperator& transport, const WorkingIrradiance& history,
                              int bounces, WorkingIrradiance& solution);

/// Relative change of the field from `history` when a share of `solution` is blended in.
double blended_change(const WorkingIrradiance& history, const WorkingIrradiance& solution,
                      float share);

/// Solves for the field's light. `solution` is the start on entry (the last solution, if there is
/// one).
RelightResult relight(const TransportOperator& transport, const WorkingIrradiance& history,
                      const RelightSettings& settings, WorkingIrradiance& solution);

}  // namespace lambent
