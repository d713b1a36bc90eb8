// SPDX-License-Identifier: Apache-2.0
// Candidates for a first view, and what speaks for each.
#pragma once

#include <optional>

#include "lambent/first_picture.h"
#include "stage/survey.h"

namespace lambent {

/// The best view of the subject from outside, all of it in the frame.
Camera outside_view(const World& world, const Subject& subject, float vertical_fov, float aspect);

/// The best view at eye height from one of the sheltered places; none where each would look at a
/// wall. `bounds` holds the room.
std::optional<Camera> inside_view(const World& world, const SpaceSurvey& survey,
                                  const Bounds& bounds, float vertical_fov, float aspect);

}  // namespace lambent
