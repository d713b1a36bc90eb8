// SPDX-License-Identifier: Apache-2.0
// The contents of a field file. docs/field-format.md specifies the layout.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "field/correction/correction_table.h"
#include "field/file/scene_identity.h"
#include "field/probes/probe_status.h"
#include "field/probes/probe_store.h"
#include "field/probes/volumes.h"
#include "lambent/error.h"
#include "lambent/field.h"

namespace lambent {

inline constexpr std::uint32_t kFieldFileVersion = 3;

/// One volume of probes, in the order of its grid.
struct FieldVolume {
  ProbeGrid grid{};  ///< Without scroll; its first probe has index 0.
  VolumeRole role;
  int irradiance_texels = 4;
  int distance_texels = 14;
  IrradianceFormat irradiance_format = IrradianceFormat::rgb9e5;
  DistanceFormat distance_format = DistanceFormat::rg16f;
  std::vector<ProbeStatus> records;  ///< Without revisions, which mean nothing in a file.
  std::vector<uint> offsets;         ///< ProbeStore::offset_words().
  std::vector<uint> irradiance;      ///< ProbeStore::irradiance_words().
  std::vector<uint> distance;        ///< ProbeStore::distance_words().

  /// The settings of a store for this volume; everything else is taken from `others`.
  FieldSettings store_settings(FieldSettings others = {}) const;
  /// A store with the volume's probes, for lookups.
  ProbeStore store() const;
};

/// A field file.
struct FieldFile {
  std::uint32_t updates = 0;  ///< Updates since the field's start.
  SceneIdentity scene;
  std::vector<FieldVolume> volumes;
  std::vector<CorrectionBlock> corrections;
};

/// Encodes a file.
std::vector<std::byte> encode_field(const FieldFile& field);

/// Decodes a file. Fails on files that are truncated or too long, of another version, with a wrong
/// checksum, or with numbers that no field has. `name` is the file's name, for errors.
Expected<FieldFile> decode_field(const std::string& name, std::span<const std::byte> bytes);

/// Reads and decodes a file.
Expected<FieldFile> read_field_file(const std::string& path);

/// Copies the probes of a file into a store that was made for its volumes.
void restore_store(const FieldFile& file, ProbeStore& store);

/// Decodes the stored light of a probe into a tile without gutter, row after row.
void stored_light(const ProbeStore& store, int probe, std::span<vec4> tile);

/// Writes the size and the checksum of the bytes into their header. Does nothing if there are too
/// few bytes for a header.
void seal_field(std::span<std::byte> bytes);

}  // namespace lambent
