// SPDX-License-Identifier: Apache-2.0
// What the passes of an update work on, in the processor's memory.
#pragma once

#include <span>
#include <vector>

#include "field/lookup/visibility.h"
#include "field/probes/probe_store.h"
#include "field/transport/blend.h"
#include "field/transport/relight.h"
#include "field/transport/surfels.h"
#include "lambent/field.h"

namespace lambent {

/// What probes hold, and what their rays met. Where a device holds the field, its backend says what
/// of this is up to date.
struct ProbeMemory {
  /// The settings must outlive it.
  ProbeMemory(std::span<const ProbeGrid> volumes, const FieldSettings& field_settings);

  const FieldSettings& settings;
  ProbeStore store;
  BlendMatrix tile_fit;
  std::vector<ProbeTrace> traces;  ///< On a device, their rays alone.
  ProbeSights sights;              ///< Kept for hybrid visibility alone.
  WorkingIrradiance light;         ///< That the store holds, before it was encoded.
  WorkingIrradiance told;          ///< What of it the last rays told on their own.

  int tile_texels() const { return settings.irradiance_texels * settings.irradiance_texels; }
  /// Probes that have been traced, in ascending order.
  std::vector<int> traced_probes() const;
  TransportOperator transport(std::span<const int> probes) const {
    return {store.corner_table(), traces, probes, tile_fit, settings.irradiance_texels};
  }
  /// Forgets everything.
  void clear();
};

}  // namespace lambent
