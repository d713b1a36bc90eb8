// SPDX-License-Identifier: Apache-2.0
// The atrium's side room with its lamp, and the door that moves.
#include <glm/gtc/matrix_transform.hpp>

#include "scenes/atrium.h"
#include "scenes/parts.h"
#include "shared/constants.h"

namespace lambent::scenes::atrium {
namespace {

using B = MeshBuilder;

constexpr float kThickness = 0.3f;  // of the room's walls [m]
constexpr glm::vec3 kDoorLamp{12.35f, 2.15f, -0.55f};
constexpr float kLampRadius = 0.15f;

/// The leaf hangs at z = +kDoorHalfWidth on the wall's far side and opens into the room.
constexpr float kLeafWidth = 2.0f * kDoorHalfWidth - 0.04f, kLeafThickness = 0.07f;
constexpr glm::vec3 kHinge{kWallX + kWallThickness - 0.04f, kAisleFloor + 0.01f,
                           kDoorHalfWidth - 0.02f};
constexpr float kLeafHeight = kDoorTop - kHinge.y - 0.02f;

}  // namespace

void add_side_room(Scene& scene, const Palette& palette) {
  MeshBuilder builder;
  const float x0 = kWallX + kWallThickness, x1 = kRoomEnd, z = kRoomHalfWidth, t = kThickness;
  const float floor = -0.3f;
  const unsigned no_left = B::kAllFaces & ~B::kLeft;
  builder.box({x1, floor, -z - t}, {x1 + t, kRoomCeiling + t, z + t});
  builder.box({x0, floor, z}, {x1, kRoomCeiling + t, z + t}, no_left & ~B::kRight);
  builder.box({x0, floor, -z - t}, {x1, kRoomCeiling + t, -z}, no_left & ~B::kRight);
  add(scene, builder, "side_room", palette.plaster);

  builder.box({x0, kRoomCeiling, -z}, {x1, kRoomCeiling + t, z}, B::kTop | B::kBottom);
  constexpr float kHalfBeam = 0.09f, kBeamDepth = 0.2f;
  for (const float x : {11.6f, 12.7f, 13.8f}) {
    builder.box({x - kHalfBeam, kRoomCeiling - kBeamDepth, -z - 0.05f},
                {x + kHalfBeam, kRoomCeiling + 0.01f, z + 0.05f});
  }
  // A chest with a proud lid at the far wall
  builder.box({14.05f, kAisleFloor, -0.9f}, {14.7f, 0.62f, 0.4f}, B::kAllFaces & ~B::kBottom);
  builder.box({14.01f, 0.6f, -0.94f}, {14.74f, 0.72f, 0.44f});
  add(scene, builder, "side_room_wood", palette.wood);

  builder.faceted_sphere(kDoorLamp, kLampRadius, 20, 10);
  add(scene, builder, "lamp", palette.lamp);
  builder.bar(kDoorLamp + glm::vec3(0.0f, kLampRadius, 0.0f),
              {kDoorLamp.x, kRoomCeiling, kDoorLamp.z}, 0.012f, 6);
  const std::array<glm::vec2, 3> cap{glm::vec2(0.16f, 0.1f), glm::vec2(0.1f, 0.17f),
                                     glm::vec2(0.0f, 0.2f)};
  builder.lathe(kDoorLamp, cap, 16);
  const std::array<glm::vec2, 3> lining{glm::vec2(0.0f, 0.19f), glm::vec2(0.09f, 0.16f),
                                        glm::vec2(0.16f, 0.1f)};
  builder.lathe(kDoorLamp, lining, 16);
  add(scene, builder, "lamp_hanger", palette.iron);
}

void add_door(AnimatedScene& made, const Palette& palette) {
  Scene& scene = made.scene;
  MeshBuilder builder;
  builder.box({-kLeafThickness, 0.0f, -kLeafWidth}, {0.0f, kLeafHeight, 0.0f});
  // Ledges across both faces hold the planks together.
  constexpr float kProud = 0.025f;
  for (const float y : {0.25f, 1.2f, 2.15f}) {
    builder.box({-kLeafThickness - kProud, y, -kLeafWidth + 0.06f}, {kProud, y + 0.2f, -0.06f});
  }
  const int leaf = add_mesh(scene, builder, "door_leaf", palette.wood);
  constexpr float kStrap = 0.034f;  // how far the iron stands out from the leaf
  for (const float y : {0.32f, 2.22f}) {
    builder.box({-kLeafThickness - kStrap, y, -kLeafWidth + 0.3f}, {kStrap, y + 0.06f, 0.005f});
  }
  builder.box({-kLeafThickness - 0.01f, 1.0f, -kLeafWidth + 0.08f},
              {0.01f, 1.16f, -kLeafWidth + 0.16f});
  builder.bar({-kLeafThickness - 0.05f, 1.08f, -kLeafWidth + 0.12f},
              {0.05f, 1.08f, -kLeafWidth + 0.12f}, 0.012f, 8);
  for (const float x : {-kLeafThickness - 0.05f, 0.05f}) {
    builder.faceted_sphere({x, 1.08f, -kLeafWidth + 0.12f}, 0.035f, 12, 8);
  }
  const int iron = add_mesh(scene, builder, "door_iron", palette.iron);

  // Ajar at first; it swings wide, nearly shuts and comes to rest where it began.
  struct Moment {
    float time, opening;  // [s], [degrees]
  };
  Track track;
  for (const Moment& moment :
       {Moment{0, 48}, Moment{2, 55}, Moment{4, 75}, Moment{6, 90}, Moment{8, 84}, Moment{10, 60},
        Moment{12, 30}, Moment{14, 12}, Moment{16, 14}, Moment{18, 32}, Moment{20, 48}}) {
    const float angle = -moment.opening * kPi / 180.0f;
    track.keyframes.push_back(
        {moment.time, kHinge, glm::angleAxis(angle, glm::vec3(0.0f, 1.0f, 0.0f))});
  }
  const Keyframe& rest = track.keyframes.front();
  const glm::mat4 place =
      glm::translate(glm::mat4(1.0f), rest.translation) * glm::mat4_cast(rest.rotation);
  std::vector<Track> tracks;
  for (const int mesh : {leaf, iron}) {
    track.index = add_instance(scene, scene.meshes[mesh].name, mesh, place);
    tracks.push_back(track);
  }
  made.animations.push_back({"door", std::move(tracks)});
}

}  // namespace lambent::scenes::atrium
