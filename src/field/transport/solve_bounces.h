// SPDX-License-Identifier: Apache-2.0
// Light transport as a linear operator on the field.
//
// What probes receive is linear in what they hold: E' = W (albedo/pi (direct + S E) + sky), with W
// the blend matrix and S the surfels' lookups. Relighting solves E = E' for all bounces at once,
// without a ray. It may solve for some of the probes; the others hold what they hold.
//
// Surfels read (1 - share) * history + share * E, the field as it will be once E is blended in, so
// that the solution is consistent with what is stored.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "field/transport/anderson.h"
#include "field/transport/surfels.h"

namespace lambent {

/// The transport of light to some probes. Fields have the texels of all probes; what is received,
/// and all else that is said to be of the probes, has those of the operator's probes alone.
class TransportOperator {
 public:
  /// `probes` have been traced. `fit` is the matrix of tile_fit.h for tiles of `texels` x `texels`.
  /// `corner_table` is the store's. All arguments must outlive the operator.
  TransportOperator(std::span<const CornerOffsets> corner_table, std::span<const ProbeTrace> traces,
                    std::span<const int> probes, const BlendMatrix& fit, int texels);

  /// One bounce: what the probes would receive if surfels were lit by `field` besides direct light.
  /// Texels that no ray counts for take their value from `fallback`, of the probes.
  void apply(const WorkingIrradiance& field, const WorkingIrradiance& fallback,
             WorkingIrradiance& received) const;

  /// What the probes receive from the sky, and from surfels that reflect direct light alone.
  void apply_direct(const WorkingIrradiance& fallback, WorkingIrradiance& received) const;

  /// No bounce: what the probes receive from the sky alone.
  void apply_sky(const WorkingIrradiance& fallback, WorkingIrradiance& received) const;

  std::span<const int> probes() const { return probes_; }
  int texels() const { return texels_; }  ///< Of a tile, without gutter.

 private:
  void gather_probe_radiance(const WorkingIrradiance& field, const ProbeTrace& trace,
                             float* radiance) const;
  template <class Gather>
  void receive(Gather gather, const WorkingIrradiance& fallback, WorkingIrradiance& received) const;

  std::span<const CornerOffsets> corner_table_;
  std::span<const ProbeTrace> traces_;
  std::span<const int> probes_;
  const BlendMatrix& fit_;
  int texels_;                                      // interior texels of a tile
  std::vector<std::array<std::uint16_t, 4>> taps_;  // interior texels of each place of a fetch
};

struct SolveSettings {
  float max_albedo = 0.95f;  ///< No surfel reflects more, 0 to 0.99.
  float tolerance = 0.002f;  ///< Estimated relative error to stop at, of the field as it is stored.
  int max_iterations = 32;   ///< ... or after so many.
};

struct SolveResult {
  int iterations = 0;
  double error = 0.0;  ///< Estimated relative error of the field that the solution is blended into.
  double change = 0.0;         ///< Of the probes' light, root mean square over root mean square.
  WorkingIrradiance solution;  ///< Of the probes, before a share of it was blended in.
};

/// a *= b, texel by texel
void multiply(WorkingIrradiance& a, const WorkingIrradiance& b);

/// Copies the texels of some probes out of a field.
WorkingIrradiance light_of(const WorkingIrradiance& field, std::span<const int> probes, int texels);

/// Solves for the light of the operator's probes, starting from what `field` holds, and blends
/// `shares[k]` of the solution into probe k's. What the probes receive is multiplied by `gain`, of
/// the probes; empty: by 1.
SolveResult solve_bounces(const TransportOperator& transport, std::span<const float> blend_weights,
                          const WorkingIrradiance& history_ratio, const SolveSettings& settings,
                          WorkingIrradiance& field);

/// The same for the light of exactly so many bounces, without acceleration; the operator's probes
/// must be all.
SolveResult solve_counted_bounces(const TransportOperator& transport,
                                  std::span<const float> blend_weights, int bounces,
                                  WorkingIrradiance& field);

}  // namespace lambent
