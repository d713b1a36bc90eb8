// SPDX-License-Identifier: Apache-2.0
// Checkpoints of a bake: files from which it resumes with bit-identical results.
//
// A checkpoint is a field file after a header with data that field files do not have: the light
// before it is encoded, and the identity of the bake. The numbers of ranks that write and read it
// may differ.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "field/file/field_file.h"
#include "lambent/error.h"
#include "lambent/field.h"
#include "lambent/world.h"

namespace lambent {

/// Writes the state of a field between two updates, as a whole file or none. All updates so far
/// must have been of this world, unedited, for this viewer, and without a budget. If ranks share
/// the field (share_work), all of them must call it, and it fails on all of them.
Expected<void> save_checkpoint(const std::string& path, const IrradianceField& field,
                               const World& world, const std::optional<glm::vec3>& viewer_ws);

/// The contents of a checkpoint.
struct Checkpoint {
  float mean_light = 0.0f;   ///< Mean luminance of the probes that are traced.
  bool warming_up = false;   ///< Some probes have not been traced yet.
  std::vector<float> light;  ///< Irradiance of the texels of all probes, three floats each [W/m^2].
  FieldFile field;

  /// Number of updates of the field.
  int updates() const { return static_cast<int>(field.updates); }
};

/// Reads the checkpoint of a bake of this world for this viewer, whose field has had no update yet.
/// Fails on files that are broken, or of another bake: another scene, viewer, settings, or version
/// of Lambent.
Expected<Checkpoint> read_checkpoint(const std::string& path, const World& world,
                                     const std::optional<glm::vec3>& viewer_ws,
                                     const IrradianceField& field);

/// Sets a field to the state of the checkpoint. All ranks that share it must call it.
void resume_from(const Checkpoint& checkpoint, const World& world,
                 const std::optional<glm::vec3>& viewer_ws, IrradianceField& field);

/// A checksum of everything on which the bits of a bake depend, for a field without updates.
std::uint32_t bake_identity(const IrradianceField& field, const World& world,
                            const std::optional<glm::vec3>& viewer_ws);

}  // namespace lambent
