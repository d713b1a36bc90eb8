// SPDX-License-Identifier: Apache-2.0
// Two rooms and a 5 cm wall: the classic test for light that leaks. Room A (x < 0) has a lamp; room
// B is lit only through a gap in the wall, and is black where the wall is sealed.
#include "scenes/mesh_builder.h"
#include "scenes/parts.h"
#include "scenes/recipes.h"

namespace lambent::scenes {
namespace {

constexpr float kHalfLength = 4.025f;     // of both rooms and the partition [m]
constexpr float kHalfDepth = 2.0f;        // [m]
constexpr float kTwoRoomsHeight = 3.0f;   // [m]
constexpr float kTwoRoomsShell = 0.2f;    // thickness of outer walls, floor and ceiling [m]
constexpr float kHalfPartition = 0.025f;  // [m]
constexpr float kGapBegin = 0.8f, kGapEnd = 1.2f, kGapHeight = 2.0f;  // along z, and up [m]
constexpr float kTwoRoomsFieldOfView = 1.0471975512f;                 // 60 degrees [rad]

AnimatedScene make_rooms(bool sealed) {
  Scene scene;
  const int wall = add_lambert(scene, "wall", {0.7f, 0.7f, 0.7f});
  const int floor = add_lambert(scene, "floor", {0.5f, 0.45f, 0.4f});
  const int orange = add_lambert(scene, "roomA_orange", {0.75f, 0.35f, 0.1f});
  const int partition = add_lambert(scene, "partition", {0.65f, 0.65f, 0.7f});
  const int blue = add_lambert(scene, "crate_blue", {0.15f, 0.25f, 0.65f});

  const auto add_box = [&](const char* name, int material, glm::vec3 min, glm::vec3 max) {
    MeshBuilder builder;
    builder.box(min, max);
    add_object(scene, builder.take(name, material));
  };
  const float x = kHalfLength, z = kHalfDepth, h = kTwoRoomsHeight, p = kHalfPartition;
  const float outer_x = x + kTwoRoomsShell, outer_z = z + kTwoRoomsShell;
  add_box("floor", floor, {-outer_x, -kTwoRoomsShell, -outer_z}, {outer_x, 0.0f, outer_z});
  add_box("ceiling", wall, {-outer_x, h, -outer_z}, {outer_x, h + kTwoRoomsShell, outer_z});
  add_box("wall_A_end", orange, {-outer_x, 0.0f, -outer_z}, {-x, h, outer_z});
  add_box("wall_B_end", wall, {x, 0.0f, -outer_z}, {outer_x, h, outer_z});
  add_box("wall_back", wall, {-x, 0.0f, -outer_z}, {x, h, -z});
  add_box("wall_front", wall, {-x, 0.0f, z}, {x, h, outer_z});
  if (sealed) {
    add_box("partition", partition, {-p, 0.0f, -z}, {p, h, z});
  } else {
    add_box("partition_1", partition, {-p, 0.0f, -z}, {p, h, kGapBegin});
    add_box("partition_2", partition, {-p, 0.0f, kGapEnd}, {p, h, z});
    add_box("partition_lintel", partition, {-p, kGapHeight, kGapBegin}, {p, h, kGapEnd});
  }
  add_box("crate_B", blue, {1.4f, 0.0f, -1.0f}, {2.1f, 0.7f, -0.3f});
  add_box("pillar_B", wall, {2.6f, 0.0f, 0.9f}, {2.9f, h, 1.2f});
  add_box("crate_A", blue, {-3.0f, 0.0f, -1.2f}, {-2.2f, 0.8f, -0.4f});

  Light lamp;
  lamp.name = "lampA";
  lamp.intensity = 60.0f * glm::vec3(1.0f, 0.9f, 0.75f);
  lamp.position_ws = {-2.2f, 2.5f, -0.2f};
  scene.lights.push_back(lamp);

  add_camera(scene, "roomB", {3.7f, 1.6f, -1.7f}, {0.4f, 1.1f, 0.9f}, kTwoRoomsFieldOfView,
             kAspect);
  add_camera(scene, "roomA", {-3.7f, 1.6f, -1.7f}, {-0.4f, 1.1f, 0.9f}, kTwoRoomsFieldOfView,
             kAspect);
  return {std::move(scene), {}};
}

}  // namespace

AnimatedScene make_two_rooms() {
  return make_rooms(false);
}

AnimatedScene make_two_rooms_sealed() {
  return make_rooms(true);
}

}  // namespace lambent::scenes
