// SPDX-License-Identifier: Apache-2.0
// Access to a field's internals for passes, files and tools.
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

/// Gives the functions below, and those that save and load a field, access to its private state.
struct FieldAccess {
  using State = IrradianceField::State;
  static const State& state_of(const IrradianceField& field) { return *field.state_; }
  static State& state_of(IrradianceField& field) { return *field.state_; }
  static IrradianceField make(std::unique_ptr<State> state);
};

/// The probes' store in the processor's memory. Where a device holds a newer one, it is copied from
/// there first.
const ProbeStore& store_of(const IrradianceField& field);

/// Does what IrradianceField::irradiance does, which always uses CorrectionUse::smooth, with any
/// use of corrections. Without corrections, light is as smooth as the probes are, and can be
/// combined with what other techniques compute for the same pixels.
void look_up_irradiance(const IrradianceField& field, std::span<const FieldQuery> queries,
                        CorrectionUse use, std::span<glm::vec3> result, const World& world);

/// Divides the work on a field among processes. Each process has a field of the same settings, for
/// the same world on the processor, that holds no light yet, and makes the same calls. The results
/// have the same bits as those of a single process. Until the last update the world must not be
/// edited, the viewer must not move, and updates must have no budget. `ranks` must outlive the
/// field.
void share_work(IrradianceField& field, Ranks& ranks);

/// The state and history of each probe.
std::span<const ProbeStatus> statuses_of(const IrradianceField& field);

/// Looks the field up in a device's memory. Null where the processor's memory holds the field.
const DeviceLookups* device_lookups_of(const IrradianceField& field);

}  // namespace lambent
