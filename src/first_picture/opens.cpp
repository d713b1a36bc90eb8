// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "first_picture/subject.h"
#include "first_picture/survey.h"
#include "lambent/animation.h"

namespace lambent {
namespace {

// Places in an animation that are looked at besides the pose at rest, as shares of its duration:
// lids are open at its end, or in its middle where they shut again.
constexpr float kPlacesInTime[] = {0.0f, 0.5f, 1.0f};

/// The same instances where they are now.
Subject moved(const World& world, Subject subject) {
  subject.bounds = Bounds{};
  for (const std::uint32_t i : subject.instances) {
    subject.bounds.add(world.instance_bounds(static_cast<int>(i)));
  }
  return subject;
}

}  // namespace

bool opens(const World& world, const Subject& subject) {
  if (world.scene().animations.empty()) return false;
  Scene scene = world.scene();
  float longest = 0.0f;
  for (const Animation& animation : scene.animations) {
    longest = std::max(longest, duration(animation));
  }
  if (longest == 0.0f) return false;
  rest(scene);
  World posed(scene);
  const auto is_closed = [&] {
    const Subject here = moved(posed, subject);
    return is_room_in_pose(posed, here, survey_space(posed, here.bounds));
  };
  if (!is_closed()) return true;
  for (const float share : kPlacesInTime) {
    animate(scene, -1, share * longest);
    // What cannot be posed is left as it is
    if (posed.update() && !is_closed()) return true;
  }
  return false;
}

}  // namespace lambent
