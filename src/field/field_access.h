// SPDX-License-Identifier: Apache-2.0
// What passes, files and tools find in a field besides its public interface.
#pragma once

#include <memory>
#include <span>

#include "field/correction/correction_use.h"
#include "lambent/field.h"

namespace lambent {

class DeviceLookups;
class ProbeStore;
class Ranks;
struct ProbeStatus;

/// Opens a field to the functions below, and to those that save and load it.
struct FieldAccess {
  using State = IrradianceField::State;
  static const State& state_of(const IrradianceField& field) { return *field.state_; }
  static State& state_of(IrradianceField& field) { return *field.state_; }
  static IrradianceField make(std::unique_ptr<State> state);
};

/// The probes' store, brought to the processor's memory where a device holds a newer one.
const ProbeStore& store_of(const IrradianceField& field);

/// IrradianceField::irradiance, which is by smooth corrections, by any. Without corrections light
/// is as smooth as the probes are, and can be combined with what other means find of the same
/// pixels.
void look_up_irradiance(const IrradianceField& field, std::span<const FieldQuery> queries,
                        CorrectionUse use, std::span<glm::vec3> result, const World& world);

/// Parts the work on a field among processes. Each has a field of the same settings over the same
/// world on the processor that holds no light yet, and makes the same calls of it. What they have
/// afterwards has the bits that one process alone finds. Until the last update the world must not
/// be edited, the viewer must stay, and updates have no budget. `ranks` must outlive the field.
void share_work(IrradianceField& field, Ranks& ranks);

/// The state and history of each probe.
std::span<const ProbeStatus> statuses_of(const IrradianceField& field);

/// Looks the field up in a device's memory. Null where the processor's memory holds the field.
const DeviceLookups* device_lookups_of(const IrradianceField& field);

}  // namespace lambent
