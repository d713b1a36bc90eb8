// SPDX-License-Identifier: Apache-2.0
// Candidates for a first view, and their ranking.
#pragma once

#include <optional>

#include "first_picture/subject.h"
#include "first_picture/survey.h"
#include "lambent/first_picture.h"

namespace lambent {

/// The best view of the subject from outside that has all of it in the frame.
Camera outside_view(const World& world, const Subject& subject, float vertical_fov, float aspect);

/// The best view at eye height from one of the sheltered places; none where all of them would face
/// a wall. `bounds` contains the room.
std::optional<Camera> inside_view(const World& world, const SpaceSurvey& survey,
                                  const Bounds& bounds, float vertical_fov, float aspect);

/// The best view at eye height from a street, a court or another sheltered place below the open
/// sky; none where the scene has no such place of a human scale.
std::optional<Camera> street_view(const World& world, const SpaceSurvey& survey,
                                  const Bounds& bounds, float vertical_fov, float aspect);

}  // namespace lambent
