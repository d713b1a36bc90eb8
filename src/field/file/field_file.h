// SPDX-License-Identifier: Apache-2.0
// A field as a file holds it; docs/field-format.md is the layout's reference.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "field/file/scene_identity.h"
#include "field/probes/probe_status.h"
#include "field/probes/probe_store.h"
#include "field/probes/volumes.h"
#include "lambent/error.h"
#include "lambent/field.h"

namespace lambent {

inline constexpr std::uint32_t kFieldFileVersion = 2;

/// One volume of probes, in the order of its grid.
struct FieldVolume {
  ProbeGrid grid{};  ///< Without scroll, and the first of its own.
  VolumeRole role;
  int irradiance_texels = 4;
  int distance_texels = 14;
  IrradianceFormat irradiance_format = IrradianceFormat::rgb9e5;
  DistanceFormat distance_format = DistanceFormat::rg16f;
  std::vector<ProbeStatus> records;  ///< Without their revisions, which mean nothing in a file.
  std::vector<uint> offsets;         ///< As encode_probe_offset makes them.
  std::vector<uint> irradiance;      ///< The words of ProbeStore.
  std::vector<uint> distance;        ///< Likewise.

  /// Settings of a store that holds the volume.
  FieldSettings store_settings(FieldSettings others = {}) const;
  /// The volume's probes, to look up.
  ProbeStore store() const;
};

struct FieldFile {
  std::uint32_t updates = 0;  ///< Since the field's start.
  SceneIdentity scene;
  std::vector<FieldVolume> volumes;
};

/// The bytes of a file.
std::vector<std::byte> encode_field(const FieldFile& field);

/// What the bytes of a file hold. Fails on files cut short or too long, of another version, with a
/// wrong checksum, and with numbers that no field has. `name` is the file's, for errors.
Expected<FieldFile> decode_field(const std::string& name, std::span<const std::byte> bytes);

/// decode_field of a file.
Expected<FieldFile> read_field_file(const std::string& path);

/// Completes a header whose checksum and size are not known yet: those of the bytes as they are.
/// Nothing where the bytes are too few for a header.
void seal_field(std::span<std::byte> bytes);

}  // namespace lambent
