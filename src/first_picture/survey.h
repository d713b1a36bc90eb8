// SPDX-License-Identifier: Apache-2.0
// Surveys an unknown scene with rays: where its surfaces are, and its open space.
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "lambent/world.h"
#include "raytracing/raytracer.h"

namespace lambent {

/// A point on the scene's surfaces.
struct SurfaceSample {
  glm::vec3 position_ws{0.0f};            ///< [m]
  glm::vec3 normal_ws{0.0f, 1.0f, 0.0f};  ///< Normal of the triangle, on its front side; unit.
  std::uint32_t instance = 0;             ///< Index into Scene::instances.
};

/// `count` points on the instances whose index is in `instances`: half of them spread over area,
/// half dealt equally to instances, so that small parts count. Fewer, or none, where there is no
/// area.
std::vector<SurfaceSample> sample_surfaces(const Scene& scene,
                                           std::span<const std::uint32_t> instances, int count);

/// Rays of a coarse grid over a picture of this aspect, width over height, from the bottom row up.
std::vector<Ray> frame_rays(const Camera& camera, float aspect, int across, int up);

/// Rays in `count` directions that cover the sphere evenly, `reach` long [m].
std::vector<Ray> rays_around(const glm::vec3& place_ws, int count, float reach = kInfiniteDistance);

// The sky is visible through surfaces that transmit at least this share of its light.
inline constexpr float kMinClearTransmittance = 0.1f;

/// Whether what transmits this share of the light lets the sky be seen.
inline bool is_clear(const glm::vec3& transmittance) {
  return std::max({transmittance.r, transmittance.g, transmittance.b}) >= kMinClearTransmittance;
}

/// Whether the sky is visible along a ray that hits something: through glass, or what is blended.
bool leads_to_sky(const World& world, const Ray& ray);

/// Whether a hit shows the back of a surface. Two-sided surfaces have no back, whatever their
/// winding.
bool shows_back(const Scene& scene, const Hit& hit);

/// A place where a person could be: air, with a floor below and surfaces in most directions around.
struct OpenPlace {
  glm::vec3 position_ws{0.0f};  ///< [m]
  float floor = 0.0f;           ///< Height of the surface below [m].
  float ceiling = 0.0f;         ///< Height of the surface above, or else of the bounds' top [m].
  bool open_above = false;      ///< There is no surface above.
  bool under_sky = false;       ///< The sky is visible above, through glass or not.
};

/// Height of the air at a place [m].
inline float height_of(const OpenPlace& place) {
  return place.ceiling - place.floor;
}

/// The median height [m] of places, of which there is at least one.
float median_height(std::span<const OpenPlace> places);

// Heights of rooms [m]. Scenes of other heights have another unit than the metre, or are models.
inline constexpr float kMinRoomHeight = 1.9f, kMaxRoomHeight = 20.0f;

/// Whether a room of this height [m] is one for people.
inline bool is_room_height(float height) {
  return height >= kMinRoomHeight && height <= kMaxRoomHeight;
}

/// Random places in a box, classified.
struct SpaceSurvey {
  /// Places in air with surfaces around, in a fixed random order.
  std::vector<OpenPlace> enclosed;
  /// These, and others that are open to one or two sides: where an observer of a room would stand.
  std::vector<OpenPlace> sheltered;
  float enclosed_share = 0.0f;  ///< Share of the box's volume that is enclosed.
  /// Share of two-sided surfaces among those around enclosed places, whose winding is meaningless.
  float two_sided_share = 0.0f;
};

/// Which places a survey finds.
enum class SurveyedPlaces : std::uint8_t {
  all,
  below_roofs,  ///< Enclosed ones with a surface above: among hills, all outdoors is enclosed, too.
};
SpaceSurvey survey_space(const World& world, const Bounds& bounds,
                         SurveyedPlaces which = SurveyedPlaces::all);

/// Length of a box's diagonal [m].
inline float diagonal(const Bounds& bounds) {
  return bounds.empty() ? 0.0f : glm::length(bounds.max - bounds.min);
}

/// A unit direction by its azimuth (from +Z towards +X) and elevation [rad].
glm::vec3 direction_from_angles(float azimuth, float elevation);

}  // namespace lambent
