// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <string>

namespace lambent {

/// A box of fog, turned any way: air that absorbs and scatters light. Where boxes overlap, their
/// densities add up.
struct FogVolume {
  std::string name;        ///< For people; may be empty.
  glm::vec3 centre{0.0f};  ///< [m], each coordinate within 1e9.
  glm::vec3 size{1.0f};    ///< Along its axes [m], 0 to 2e9.
  glm::mat3 axes{1.0f};    ///< Columns: its axes in world space, unit and orthogonal.
  /// Extinction [1/m], 0 to 1e6: light falls to 1/e on its way through 1 / density metres. With a
  /// scale height it is that at the bottom of the box.
  float density = 0.02f;
  glm::vec3 albedo{0.9f};   ///< Share of what is extinguished that is scattered, 0 to 1.
  float anisotropy = 0.0f;  ///< Mean cosine of scattering (Henyey-Greenstein), -0.95 to 0.95.
  /// Density falls to 1/e over so many metres along the box's second axis, 1e-3 to 1e9; 0: it is
  /// the same everywhere. Costs nothing.
  float scale_height = 0.0f;

  bool operator==(const FogVolume&) const = default;
};

/// Most boxes of fog in a scene. Each costs some arithmetic at every froxel and shadow ray.
inline constexpr std::size_t kMaxFogVolumes = 16;

/// How a frame finds the light that fog scatters to the camera: on a grid in the view (froxels).
/// Transmittance is exact whatever these say. Scenes without fog cost nothing.
struct FogSettings {
  /// Edge of a froxel [pixels], 1 to 64. Half of it costs four times as much and shows shadows in
  /// fog finer.
  int froxel_pixels = 8;
  /// Froxels along the view, 4 to 512, finest near the camera. Costs are in proportion.
  int slices = 64;
  /// Points of a froxel at which light is found, 1 to 64: each costs a shadow ray a light. More
  /// leave less noise at the edges of shafts of light.
  int samples = 4;
};

}  // namespace lambent
