// SPDX-License-Identifier: Apache-2.0
// What a picture of a scene should show: its instances without what is around them or far away.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "first_picture/survey.h"
#include "lambent/world.h"

namespace lambent {

/// The instances that a picture of a scene should show.
struct Subject {
  std::vector<std::uint32_t> instances;
  Bounds bounds;  ///< Around these; empty where the scene has no surface.
  /// Around these, the grounds, skies and other backdrops that dwarf them, and lights of a studio:
  /// all but strays, which are far away.
  Bounds site;
};

Subject find_subject(const World& world);
/// As find_subject(), but where a viewer stands among the strays, that of the strays: in a room of
/// a few large walls, say, far from a statue of many triangles.
Subject find_subject_near(const World& world, const glm::vec3& viewer_ws);

/// The subject without things that are each larger than all of the rest and stand apart from it,
/// such as a planet outside a ship; none where there are no such things, or the rest has fewer than
/// half of the triangles.
std::optional<Subject> without_things_apart(const World& world, const Subject& subject);

/// Where most of some instances' triangles are.
struct Middle {
  /// Along each axis, half of the triangles belong to instances whose centre is on either side [m].
  glm::vec3 position_ws{0.0f};
  float reach = 0.0f;  ///< Half of them belong to instances that end no farther from it [m].
};
/// `boxes`: bounds of all of the scene's instances in world space.
Middle find_middle(const Scene& scene, std::span<const Bounds> boxes,
                   std::vector<std::uint32_t> instances);

/// Whether a scene is a housing: a shell that is open above, of another height than rooms for
/// people have, such as a case without its lid or a flat in millimetres.
bool is_open_housing(const SpaceSurvey& survey);

/// Whether a scene is a shell around most of its contents: by the share of its box that is enclosed
/// air, and by the share of its surfaces whose front is visible from outside, of which a scene with
/// another height than rooms for people may show less. Housings are no rooms, nor are scenes of
/// such a height that their animations open.
bool is_room(const World& world, const Subject& subject, const SpaceSurvey& survey);
inline bool is_room(const World& world, const Subject& subject) {
  return !subject.bounds.empty() && is_room(world, subject, survey_space(world, subject.bounds));
}
/// As is_room(), whatever animations do.
bool is_room_in_pose(const World& world, const Subject& subject, const SpaceSurvey& survey);

/// Whether animations open what is closed in the world's pose, such as a case with a lid: whether
/// the subject is no room at rest, or at the beginning, in the middle or at the end of them. Copies
/// the scene where it has animations.
bool opens(const World& world, const Subject& subject);

}  // namespace lambent
