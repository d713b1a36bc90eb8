// SPDX-License-Identifier: Apache-2.0
// Checkpoints of a bake: files from which it goes on with the bits that it would have had.
//
// A checkpoint is a field file behind a header with what field files leave out: the light before it
// is encoded, and what identifies the bake. It does not matter how many ranks wrote it, or read it.
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

/// Writes what a field has come to between two updates, whole or not at all. The updates so far
/// were of this world, unedited, for this viewer, and without a budget. Where ranks share the field
/// (share_work), all of them call it, and it fails on all of them.
Expected<void> save_checkpoint(const std::string& path, const IrradianceField& field,
                               const World& world, const std::optional<glm::vec3>& viewer_ws);

/// What a checkpoint holds.
struct Checkpoint {
  float mean_light = 0.0f;   ///< Mean luminance of the probes that are traced.
  bool warming_up = false;   ///< Some probe has yet to be traced.
  std::vector<float> light;  ///< Of the texels of all probes, three floats each [W/m^2].
  FieldFile field;

  int updates() const { return static_cast<int>(field.updates); }  ///< That the field has had.
};

/// Reads the checkpoint of a bake of this world for this viewer, whose field has had no update yet.
/// Fails on files that are broken, or of another bake: another scene, viewer, settings, or version
/// of Lambent.
Expected<Checkpoint> read_checkpoint(const std::string& path, const World& world,
                                     const std::optional<glm::vec3>& viewer_ws,
                                     const IrradianceField& field);

/// Puts that field where the field of the checkpoint was. All ranks that share it call it.
void resume_from(const Checkpoint& checkpoint, const World& world,
                 const std::optional<glm::vec3>& viewer_ws, IrradianceField& field);

/// A checksum of all that the bits of a bake depend on, of a field that has had no update yet.
std::uint32_t bake_identity(const IrradianceField& field, const World& world,
                            const std::optional<glm::vec3>& viewer_ws);

}  // namespace lambent
