// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <string>

namespace lambent {

/// An oriented box of fog: air that absorbs and scatters light. Where boxes overlap, their
/// densities add up.
struct FogVolume {
  std::string name;        ///< For display; may be empty.
  glm::vec3 centre{0.0f};  ///< [m], each coordinate within 1e9.
  glm::vec3 size{1.0f};    ///< Extent along its axes [m], 0 to 2e9.
  glm::mat3 axes{1.0f};    ///< Columns: its axes in world space, orthonormal.
  /// Extinction coefficient [1/m], 0 to 1e6: light falls to 1/e over 1 / density metres. With a
  /// scale height, the coefficient at the bottom of the box.
  float density = 0.02f;
  glm::vec3 albedo{0.9f};   ///< Scattered share of the extinguished light, 0 to 1.
  float anisotropy = 0.0f;  ///< Mean cosine of scattering (Henyey-Greenstein), -0.95 to 0.95.
  /// Distance along the box's second axis over which the density falls to 1/e [m], 1e-3 to 1e9; 0:
  /// the density is uniform. Costs nothing.
  float scale_height = 0.0f;

  bool operator==(const FogVolume&) const = default;
};

/// Most boxes of fog in a scene. Each costs some arithmetic at every froxel and shadow ray.
inline constexpr std::size_t kMaxFogVolumes = 16;

/// How a frame finds the light that fog scatters to the camera: on a grid in the view (froxels).
/// Transmittance is exact whatever these settings. Scenes without fog cost nothing.
struct FogSettings {
  /// Edge of a froxel [pixels], 1 to 64. Halving it costs four times as much and resolves finer
  /// shadows in fog.
  int froxel_pixels = 8;
  /// Froxels along the view, 4 to 512, finest near the camera. Cost is in proportion.
  int slices = 64;
  /// Points in a froxel at which light is computed, 1 to 64: each costs a shadow ray per light.
  /// More leave less noise at the edges of shafts of light.
  int samples = 4;
};

}  // namespace lambent
