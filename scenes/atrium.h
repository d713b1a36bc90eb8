// SPDX-License-Identifier: Apache-2.0
// Internals of the atrium: its dimensions, materials and parts. Other files use only make_atrium.
//
// A court of 5 x 3 bays lies at the origin, its long side along x. Two storeys of arcades surround
// it; behind them run aisles, vaulted below and beamed above. A door in the middle of the +X wall
// leads to a side room.
#pragma once

#include <array>

#include "scenes/builtin.h"
#include "scenes/mesh_builder.h"

namespace lambent::scenes::atrium {

// Plan [m]; columns stand on the lines x = +-kCourtX and z = +-kCourtZ.
inline constexpr float kBay = 3.0f;
inline constexpr int kBaysX = 5, kBaysZ = 3;
inline constexpr float kCourtX = 0.5f * kBaysX * kBay;
inline constexpr float kCourtZ = 0.5f * kBaysZ * kBay;
inline constexpr float kAisle = 3.0f;  // from the column line to the outer wall
inline constexpr float kWallX = kCourtX + kAisle;
inline constexpr float kWallZ = kCourtZ + kAisle;
inline constexpr float kWallThickness = 0.4f;
inline constexpr float kHalfArcade = 0.25f;  // half the thickness of the walls over the arches

// Heights [m].
inline constexpr float kAisleFloor = 0.15f;  // one step above the court, which is 0
inline constexpr float kLowerSpring = 3.0f, kLowerTop = 4.6f;
inline constexpr float kGalleryFloor = 4.9f;
inline constexpr float kUpperSpring = 7.0f, kUpperTop = 8.5f;
inline constexpr float kCeiling = 8.27f;  // underside of the gallery's planks
inline constexpr float kEave = 8.5f;
inline constexpr float kRoofSlope = 0.364f;  // 20 degrees
inline constexpr float kWallTop = 9.9f;

// The door and the room behind it [m].
inline constexpr float kDoorHalfWidth = 0.8f, kDoorTop = 2.75f;
inline constexpr float kRoomEnd = 14.9f, kRoomHalfWidth = 2.2f, kRoomCeiling = 3.3f;

/// Openings of both storeys.
inline constexpr MeshBuilder::Arch kLowerArch{0.5f * kBay, kLowerSpring,       kLowerTop, 1.2f,
                                              1.2f,        2.0f * kHalfArcade, 24,        false};
inline constexpr MeshBuilder::Arch kUpperArch{0.5f * kBay, kUpperSpring,       kUpperTop, 1.24f,
                                              1.14f,       1.6f * kHalfArcade, 20,        false};

/// A material, and the size of one tile of its textures [m].
struct Finish {
  int material = 0;
  float metres_a_tile = 1.0f;
};

struct Palette {
  Finish sandstone, limestone, marble, flags, plaster, wood, terracotta;
  Finish red, blue, ochre;  // cloth
  Finish iron, water, lamp, leaf, orange;
};

/// Adds all textures and materials of the atrium; `texels` as in make_atrium.
Palette add_palette(Scene& scene, int texels);

void add_floors(Scene& scene, const Palette& palette);
void add_walls(Scene& scene, const Palette& palette);
void add_arcades(Scene& scene, const Palette& palette);
void add_vaults(Scene& scene, const Palette& palette);
void add_gallery_ceiling_and_roof(Scene& scene, const Palette& palette);
void add_mouldings(Scene& scene, const Palette& palette);
void add_columns(Scene& scene, const Palette& palette);
void add_balustrades(Scene& scene, const Palette& palette);
void add_fountain(Scene& scene, const Palette& palette);
void add_trees(Scene& scene, const Palette& palette);
void add_curtains(Scene& scene, const Palette& palette);
void add_side_room(Scene& scene, const Palette& palette);
/// The door leaf with its ironwork, and their motion.
void add_door(AnimatedScene& made, const Palette& palette);

/// The transform to a place on the column lines, with +Z towards the court and X along the arcade.
glm::mat4 facing_court(const glm::vec3& position);

/// Middles of all bays of the arcade, or feet of all its columns, at height 0, in order around the
/// court.
std::vector<glm::vec3> bay_middles();
std::vector<glm::vec3> column_feet();

/// Adds the builder's triangles to the scene as a mesh; returns its index.
int add_mesh(Scene& scene, MeshBuilder& builder, const char* name, const Finish& finish);

/// Adds the builder's triangles as a mesh, with one instance.
void add(Scene& scene, MeshBuilder& builder, const char* name, const Finish& finish);

}  // namespace lambent::scenes::atrium
