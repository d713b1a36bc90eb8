// SPDX-License-Identifier: Apache-2.0
// Candidates for a first view, and their ranking.
#pragma once

#include <cstdint>
#include <optional>

#include "first_picture/site.h"
#include "first_picture/subject.h"
#include "first_picture/survey.h"
#include "lambent/first_picture.h"

namespace lambent {

/// Height of a standing person's eyes [m].
inline constexpr float kEyeHeight = 1.6f;

/// From where a subject is viewed.
enum class ViewedFrom : std::uint8_t {
  anywhere,
  above,  ///< Steeply: into a housing.
};

/// The best view of the subject from outside that has all of it in the frame, in each of the poses;
/// fails where one cannot be taken.
Expected<Camera> outside_view(const World& world, const Subject& subject, ViewedFrom from,
                              const Poses& poses, float vertical_fov, float aspect);

/// The best view at eye height from one of the sheltered places; none where all of them would face
/// a wall. `bounds` contains the room.
std::optional<Camera> inside_view(const World& world, const SpaceSurvey& survey,
                                  const Bounds& bounds, float vertical_fov, float aspect);

/// The best view at eye height from a street, a court or another sheltered place below the open
/// sky; none where the scene has no such place of a human scale.
std::optional<Camera> street_view(const World& world, const SpaceSurvey& survey,
                                  const Bounds& bounds, float vertical_fov, float aspect);

/// The best view at eye height from the ground of a site, such as a garden, a camp or a landscape,
/// of what stands there; none where `outside`, a view of all of it, shows more of that than of the
/// ground, where the ground dwarfs the subject, or where the site has neither lamps nor a ground
/// that is a sheet.
std::optional<Camera> site_view(const World& world, const Subject& subject, const Site& site,
                                const Camera& outside, float vertical_fov, float aspect);

}  // namespace lambent
