// SPDX-License-Identifier: Apache-2.0
// Counts and checksums by which a field file recognises its scene (docs/field-format.md).
#pragma once

#include <cstdint>

#include "lambent/field.h"
#include "lambent/scene.h"

namespace lambent {

/// Counts and checksums of a scene.
struct SceneIdentity {
  std::uint64_t triangles = 0;  ///< Triangles of all instances.
  std::uint64_t vertices = 0;   ///< Vertices of all meshes.
  std::uint32_t instances = 0;
  std::uint32_t geometry = 0;  ///< Checksum of static geometry and its positions.
  /// Checksum of everything else that light depends on: lights, materials, dynamic instances, and
  /// settings of light transport.
  std::uint32_t light = 0;

  /// Whether both scenes have the same static geometry, so that a field of one is valid in the
  /// other.
  bool same_place(const SceneIdentity& other) const {
    return triangles == other.triangles && vertices == other.vertices &&
           instances == other.instances && geometry == other.geometry;
  }
  bool operator==(const SceneIdentity&) const = default;
};

/// The identity of a scene whose light is computed with these settings.
SceneIdentity identify(const Scene& scene, const FieldSettings& settings);

}  // namespace lambent
