// SPDX-License-Identifier: Apache-2.0
// Sixteen rooms in four rows of four, with doorways between neighbours and a lamp in each. A lamp
// affects its own room, and others only through doors, less with each door.
#include <string>

#include "scenes/mesh_builder.h"
#include "scenes/parts.h"
#include "scenes/recipes.h"

namespace lambent::scenes {
namespace {

constexpr int kRooms = 4;                              // along each side
constexpr float kRoom = 4.0f;                          // from wall to wall [m]
constexpr float kWall = 0.1f;                          // thickness of inner walls [m]
constexpr float kHouseShell = 0.2f;                    // of outer walls, floor and ceiling [m]
constexpr float kHouseHeight = 2.6f;                   // [m]
constexpr float kDoorWidth = 0.9f;                     // [m]
constexpr float kDoorHeight = 2.0f;                    // [m]
constexpr float kDoorShift = 0.8f;                     // from the wall's middle [m]
constexpr float kHousePitch = kRoom + kWall;           // from room to room [m]
constexpr float kSide = kRooms * kHousePitch - kWall;  // of the house, inside [m]
constexpr float kLampHeight = 2.3f;                    // [m]
constexpr float kHouseLamp = 12.0f;                    // radiant intensity [W/sr]
constexpr float kHouseFieldOfView = 1.0471975512f;     // 60 degrees [rad]

/// One wall between two rooms, with its doorway: along x at depth `at`, from `begin` on; or along
/// z.
void add_wall(MeshBuilder& builder, bool along_x, float at, float begin, bool shift_up) {
  const auto box = [&](float from, float to, float bottom, float top) {
    const glm::vec3 low = along_x ? glm::vec3(from, bottom, at) : glm::vec3(at, bottom, from);
    const glm::vec3 high =
        along_x ? glm::vec3(to, top, at + kWall) : glm::vec3(at + kWall, top, to);
    builder.box(low, high);
  };
  const float door = begin + 0.5f * (kRoom - kDoorWidth) + (shift_up ? kDoorShift : -kDoorShift);
  box(begin, door, 0.0f, kHouseHeight);
  box(door, door + kDoorWidth, kDoorHeight, kHouseHeight);
  box(door + kDoorWidth, begin + kRoom, 0.0f, kHouseHeight);
}

}  // namespace

AnimatedScene make_house() {
  Scene scene;
  const int plaster = add_lambert(scene, "plaster", {0.7f, 0.68f, 0.65f});
  const int floor = add_lambert(scene, "floor", {0.4f, 0.3f, 0.22f});
  const int wood = add_lambert(scene, "wood", {0.5f, 0.25f, 0.12f});
  const auto add_box = [&](const char* name, int material, glm::vec3 min, glm::vec3 max) {
    MeshBuilder builder;
    builder.box(min, max);
    add_object(scene, builder.take(name, material));
  };
  const float s = kSide, t = kHouseShell, h = kHouseHeight;
  add_box("floor", floor, {-t, -t, -t}, {s + t, 0.0f, s + t});
  add_box("ceiling", plaster, {-t, h, -t}, {s + t, h + t, s + t});
  add_box("wall_left", plaster, {-t, 0.0f, -t}, {0.0f, h, s + t});
  add_box("wall_right", plaster, {s, 0.0f, -t}, {s + t, h, s + t});
  add_box("wall_back", plaster, {0.0f, 0.0f, -t}, {s, h, 0.0f});
  add_box("wall_front", plaster, {0.0f, 0.0f, s}, {s, h, s + t});

  MeshBuilder walls;
  for (int i = 0; i < kRooms; ++i) {
    for (int j = 0; j < kRooms; ++j) {
      const float x = static_cast<float>(i) * kHousePitch, z = static_cast<float>(j) * kHousePitch;
      if (i + 1 < kRooms) add_wall(walls, false, x + kRoom, z, (i + j) % 2 == 0);
      if (j + 1 < kRooms) add_wall(walls, true, z + kRoom, x, (i + j) % 2 == 1);
      // Posts close the corners where four walls meet
      if (i + 1 < kRooms && j + 1 < kRooms) {
        walls.box({x + kRoom, 0.0f, z + kRoom}, {x + kHousePitch, h, z + kHousePitch});
      }
      Light lamp;
      lamp.name = "lamp_" + std::to_string(i) + "_" + std::to_string(j);
      lamp.intensity = kHouseLamp * glm::vec3(1.0f, 0.85f, 0.6f);
      lamp.position_ws = {x + 0.5f * kRoom, kLampHeight, z + 0.5f * kRoom};
      scene.lights.push_back(lamp);
      const glm::vec3 table(x + 2.6f, 0.0f, z + 0.7f);
      const std::string name = "table_" + std::to_string(i) + "_" + std::to_string(j);
      add_box(name.c_str(), wood, table, table + glm::vec3(0.9f, 0.75f, 0.6f));
    }
  }
  add_object(scene, walls.take("walls", plaster));
  add_camera(scene, "corner_room", {0.4f, 1.6f, 0.4f}, {3.0f, 1.1f, 3.0f}, kHouseFieldOfView,
             kAspect);
  add_camera(scene, "inner_room", {kHousePitch + 0.4f, 1.6f, kHousePitch + 0.4f},
             {kHousePitch + 3.0f, 1.1f, kHousePitch + 3.0f}, kHouseFieldOfView, kAspect);
  return {std::move(scene), {}};
}

}  // namespace lambent::scenes
