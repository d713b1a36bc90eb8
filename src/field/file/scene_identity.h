// SPDX-License-Identifier: Apache-2.0
// By what a field's file knows its scene again (docs/field-format.md).
#pragma once

#include <cstdint>

#include "lambent/field.h"
#include "lambent/scene.h"

namespace lambent {

struct SceneIdentity {
  std::uint64_t triangles = 0;  ///< Over all instances.
  std::uint64_t vertices = 0;   ///< Of all meshes.
  std::uint32_t instances = 0;
  std::uint32_t geometry = 0;  ///< Checksum of what stands still, and where.
  /// Checksum of all else that light depends on: sources, materials, what moves, and how far light
  /// is followed.
  std::uint32_t light = 0;

  /// Whether both have the same geometry, so that a field of the one makes sense in the other.
  bool same_place(const SceneIdentity& other) const {
    return triangles == other.triangles && vertices == other.vertices &&
           instances == other.instances && geometry == other.geometry;
  }
  bool operator==(const SceneIdentity&) const = default;
};

/// Of a scene whose light is computed with these settings.
SceneIdentity identify(const Scene& scene, const FieldSettings& settings);

}  // namespace lambent
