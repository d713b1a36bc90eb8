// SPDX-License-Identifier: Apache-2.0
// The data of the probes in the processor's memory, which the passes of an update work on.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "field/correction/correction_table.h"
#include "field/lookup/visibility.h"
#include "field/probe_share.h"
#include "field/probes/probe_store.h"
#include "field/transport/blend.h"
#include "field/transport/solve_bounces.h"
#include "field/transport/surfels.h"
#include "lambent/field.h"
#include "raytracing/solid_sides/solid_sides.h"

namespace lambent {

/// The tiles, light and surfels of the probes. Where a device holds the field, this is the host's
/// copy from the last transfer (see FieldBackend).
struct ProbeData {
  /// The settings must outlive it.
  ProbeData(std::span<const ProbeGrid> volumes, const FieldSettings& field_settings);

  const FieldSettings& settings;
  ProbeShare share;  ///< The probes whose surfels are here. Everything else is of all probes.
  ProbeStore store;
  BlendMatrix tile_fit;
  /// The sides of the world's surfaces that bound solid matter; found before the first probe is
  /// placed.
  SolidSides solid_sides;
  std::vector<ProbeTrace> traces;  ///< Where a device holds the field, their ray sets only.
  CorrectionTable correction;
  CellVisibility cell_visibility;              ///< Up to date with hybrid visibility only.
  WorkingIrradiance light;                     ///< The irradiance that the store encodes.
  WorkingIrradiance last_irradiance_estimate;  ///< What each probe's last rays alone estimated.
  /// 1 where a probe's last estimate comes from a solve that stopped at its tolerance, so that it
  /// is less exact than what edits are compared by.
  std::vector<std::uint8_t> last_estimate_is_coarse;

  int tile_texels() const { return settings.irradiance_texels * settings.irradiance_texels; }
  /// Returns the probes that have been traced, in ascending order.
  std::vector<int> traced_probes() const;
  TransportOperator transport(std::span<const int> probes) const {
    return {store.corner_table(), traces, probes, tile_fit, settings.irradiance_texels};
  }
  /// Removes all light, surfels and offsets.
  void clear();
};

}  // namespace lambent
