// SPDX-License-Identifier: Apache-2.0
// The atrium's structure: floors, walls, arcades and vaults.
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "scenes/atrium.h"
#include "scenes/parts.h"
#include "shared/constants.h"

namespace lambent::scenes::atrium {
namespace {

using B = MeshBuilder;

constexpr float kKerb = 0.5f;   // half the width of the step, to both sides of the column line [m]
constexpr float kBase = -0.4f;  // underside of the ground [m]

/// A horizontal rectangle that faces up.
void floor(MeshBuilder& builder, float x0, float x1, float z0, float z1, float y) {
  builder.quad({x0, y, z1}, {x1, y, z1}, {x1, y, z0}, {x0, y, z0});
}

/// A level ring between two rectangles about the origin.
void ring(MeshBuilder& builder, glm::vec2 inner, glm::vec2 outer, float y) {
  floor(builder, -outer.x, outer.x, inner.y, outer.y, y);
  floor(builder, -outer.x, outer.x, -outer.y, -inner.y, y);
  floor(builder, inner.x, outer.x, -inner.y, inner.y, y);
  floor(builder, -outer.x, -inner.x, -inner.y, inner.y, y);
}

/// The four corners of a rectangle about the origin, ordered so that the court is to the right of
/// the path.
std::array<glm::vec3, 4> around_court(float x, float z, float y) {
  return {glm::vec3(x, y, z), glm::vec3(-x, y, z), glm::vec3(-x, y, -z), glm::vec3(x, y, -z)};
}

/// Four boxes that form a ring; faces where they touch are omitted.
void box_ring(MeshBuilder& builder, glm::vec2 inner, glm::vec2 outer, float y0, float y1) {
  const unsigned ends = B::kBack | B::kFront;
  builder.box({-outer.x, y0, inner.y}, {outer.x, y1, outer.y});
  builder.box({-outer.x, y0, -outer.y}, {outer.x, y1, -inner.y});
  builder.box({inner.x, y0, -inner.y}, {outer.x, y1, inner.y}, B::kAllFaces & ~ends);
  builder.box({-outer.x, y0, -inner.y}, {-inner.x, y1, inner.y}, B::kAllFaces & ~ends);
}

}  // namespace

void add_floors(Scene& scene, const Palette& palette) {
  MeshBuilder builder;
  const float x = kCourtX - kKerb, z = kCourtZ - kKerb;
  floor(builder, -x, x, -z, z, 0.0f);
  add(scene, builder, "court_floor", palette.flags);

  // The step: a riser around the court and the stylobate on which the columns stand
  const std::array<glm::vec2, 4> profile{
      glm::vec2(0.0f, 0.0f), glm::vec2(0.0f, kAisleFloor - 0.02f), glm::vec2(-0.02f, kAisleFloor),
      glm::vec2(-0.03f, kAisleFloor)};
  builder.moulding(profile, around_court(x, z, 0.0f), true);
  ring(builder, {x + 0.03f, z + 0.03f}, {kCourtX + kKerb, kCourtZ + kKerb}, kAisleFloor);
  add(scene, builder, "step", palette.limestone);

  ring(builder, {kCourtX + kKerb, kCourtZ + kKerb}, {kWallX, kWallZ}, kAisleFloor);
  floor(builder, kWallX, kRoomEnd, -kDoorHalfWidth, kDoorHalfWidth, kAisleFloor);
  floor(builder, kWallX + kWallThickness, kRoomEnd, -kRoomHalfWidth, -kDoorHalfWidth, kAisleFloor);
  floor(builder, kWallX + kWallThickness, kRoomEnd, kDoorHalfWidth, kRoomHalfWidth, kAisleFloor);
  add(scene, builder, "aisle_floor", palette.marble);

  // The ground beneath it all, so that the house is closed from below
  builder.box({-kWallX - 0.5f, kBase, -kWallZ - 0.5f},
              {kRoomEnd + 0.5f, kBase + 0.2f, kWallZ + 0.5f});
  add(scene, builder, "ground", palette.sandstone);

  const float edge_x = kCourtX - kHalfArcade - 0.03f, edge_z = kCourtZ - kHalfArcade - 0.03f;
  box_ring(builder, {edge_x, edge_z}, {kWallX + 0.1f, kWallZ + 0.1f}, kLowerTop,
           kGalleryFloor - 0.02f);
  add(scene, builder, "gallery_slab", palette.limestone);
  ring(builder, {edge_x, edge_z}, {kWallX, kWallZ}, kGalleryFloor);
  const std::array<glm::vec2, 2> rim{glm::vec2(0.0f, kGalleryFloor - 0.02f),
                                     glm::vec2(0.0f, kGalleryFloor)};
  builder.moulding(rim, around_court(edge_x, edge_z, 0.0f), true);
  add(scene, builder, "gallery_floor", palette.terracotta);
}

void add_walls(Scene& scene, const Palette& palette) {
  MeshBuilder builder;
  const float x = kWallX, z = kWallZ, t = kWallThickness;
  const unsigned no_ends = B::kAllFaces & ~(B::kLeft | B::kRight);
  builder.box({-x, kBase, z}, {x, kWallTop, z + t}, no_ends);
  builder.box({-x, kBase, -z - t}, {x, kWallTop, -z}, no_ends);
  builder.box({-x - t, kBase, -z - t}, {-x, kWallTop, z + t});
  builder.box({x, kBase, -z - t}, {x + t, kWallTop, -kDoorHalfWidth});
  builder.box({x, kBase, kDoorHalfWidth}, {x + t, kWallTop, z + t});
  builder.box({x, kDoorTop, -kDoorHalfWidth}, {x + t, kWallTop, kDoorHalfWidth},
              B::kAllFaces & ~(B::kBack | B::kFront));
  add(scene, builder, "outer_walls", palette.plaster);
}

void add_arcades(Scene& scene, const Palette& palette) {
  MeshBuilder builder;
  builder.arch_panel(kLowerArch);
  const int lower_bay = add_mesh(scene, builder, "lower_bay", palette.sandstone);
  builder.archivolt(kLowerArch, 0.2f, 0.05f);
  const int lower_ring = add_mesh(scene, builder, "lower_archivolt", palette.limestone);
  builder.arch_panel(kUpperArch);
  const int upper_bay = add_mesh(scene, builder, "upper_bay", palette.plaster);
  builder.archivolt(kUpperArch, 0.16f, 0.04f);
  const int upper_ring = add_mesh(scene, builder, "upper_archivolt", palette.limestone);
  for (const glm::vec3& middle : bay_middles()) {
    for (const int mesh : {lower_bay, lower_ring, upper_bay, upper_ring}) {
      add_instance(scene, scene.meshes[mesh].name, mesh, facing_court(middle));
    }
  }

  // Piers over the four corner columns close the arcades' ends.
  constexpr float kHalfPier = 0.29f;
  for (const float px : {-kCourtX, kCourtX}) {
    for (const float pz : {-kCourtZ, kCourtZ}) {
      builder.box({px - kHalfPier, kLowerSpring, pz - kHalfPier},
                  {px + kHalfPier, kLowerTop, pz + kHalfPier},
                  B::kAllFaces & ~(B::kTop | B::kBottom));
      builder.box({px - 0.25f, kUpperSpring, pz - 0.25f}, {px + 0.25f, kUpperTop, pz + 0.25f},
                  B::kAllFaces & ~(B::kTop | B::kBottom));
    }
  }
  add(scene, builder, "corner_piers", palette.sandstone);
}

namespace {

/// A groin vault, seen from below: the upper envelope of two barrels over a `width` x `depth` bay.
void groin_vault(MeshBuilder& builder, float width, float depth) {
  constexpr int kCells = 8;
  constexpr float kRise = 1.5f;
  const glm::vec3 x(1.0f, 0.0f, 0.0f), z(0.0f, 0.0f, 1.0f);
  struct Sector {
    glm::vec3 along, out;
    float half_along, half_out;
  };
  const float w = 0.5f * width, d = 0.5f * depth;
  for (const Sector& sector :
       {Sector{x, z, w, d}, Sector{-x, -z, w, d}, Sector{-z, x, d, w}, Sector{z, -x, d, w}}) {
    builder.surface(kCells, kCells, false, [&](float s, float t) {
      // Even steps of angle, since the barrels are steep at their springing
      const float out = std::sin(0.5f * kPi * t);
      const float along = out * std::sin(0.5f * kPi * (2.0f * s - 1.0f));
      const glm::vec3 p =
          sector.along * (along * sector.half_along) + sector.out * (out * sector.half_out);
      const float height = kRise * std::sqrt(glm::max(0.0f, 1.0f - along * along));
      return MeshBuilder::SurfacePoint{p + glm::vec3(0.0f, kLowerSpring + height, 0.0f),
                                       {along * sector.half_along, -out * sector.half_out}};
    });
  }
}

}  // namespace

void add_vaults(Scene& scene, const Palette& palette) {
  constexpr float kIntoWall = 0.05f;
  const float clear = kAisle - kHalfArcade;
  const float middle = 0.5f * (kHalfArcade + kAisle);  // of the aisle, from the column line
  const auto at = [](float x, float z, float turn) {
    return glm::rotate(glm::translate(glm::mat4(1.0f), {x, 0.0f, z}), turn, {0.0f, 1.0f, 0.0f});
  };
  MeshBuilder builder;
  groin_vault(builder, kBay, clear + 2.0f * kIntoWall);
  const int vault = add_mesh(scene, builder, "vault", palette.plaster);
  groin_vault(builder, kAisle + kIntoWall, kAisle + kIntoWall);
  const int corner_vault = add_mesh(scene, builder, "corner_vault", palette.plaster);
  for (const glm::vec3& bay : bay_middles()) {
    const bool long_side = std::abs(bay.z) == kCourtZ;
    const float side = long_side ? glm::sign(bay.z) : glm::sign(bay.x);
    add_instance(scene, "vault", vault,
                 long_side ? at(bay.x, bay.z + side * middle, 0.0f)
                           : at(bay.x + side * middle, bay.z, 0.5f * kPi));
  }
  const float half = 0.5f * (kAisle + kIntoWall);
  for (const float sx : {-1.0f, 1.0f}) {
    for (const float sz : {-1.0f, 1.0f}) {
      add_instance(scene, "corner_vault", corner_vault,
                   at(sx * (kCourtX + half), sz * (kCourtZ + half), 0.0f));
    }
  }

  // Ribs between the bays, each on a corbel at the arcade and a pilaster at the wall
  constexpr float kRibSpan = 1.21f;
  const MeshBuilder::Arch rib{
      0.5f * clear + 0.01f, kLowerSpring, kLowerTop, kRibSpan, 1.3f, 0.32f, 20, true};
  builder.arch_panel(rib);
  const int rib_mesh = add_mesh(scene, builder, "rib", palette.sandstone);
  const float foot = 0.5f * clear;
  // The corbels reach into the capitals, behind which there is no wall.
  constexpr float kIntoCapital = 0.06f;
  builder.box({-foot - kIntoCapital, kLowerSpring - 0.14f, -0.2f},
              {-kRibSpan + 0.05f, kLowerSpring + 0.001f, 0.2f});
  builder.box({-foot - kIntoCapital, kLowerSpring - 0.32f, -0.15f},
              {-kRibSpan - 0.03f, kLowerSpring - 0.14f, 0.15f}, B::kAllFaces & ~B::kTop);
  builder.box({kRibSpan - 0.05f, kLowerSpring - 0.16f, -0.24f},
              {foot, kLowerSpring + 0.001f, 0.24f}, B::kAllFaces & ~B::kRight);
  builder.box({kRibSpan, kAisleFloor + 0.3f, -0.2f}, {foot, kLowerSpring - 0.16f, 0.2f},
              B::kAllFaces & ~(B::kRight | B::kTop | B::kBottom));
  builder.box({kRibSpan - 0.05f, kAisleFloor, -0.25f}, {foot, kAisleFloor + 0.3f, 0.25f},
              B::kAllFaces & ~(B::kRight | B::kBottom));
  const int support = add_mesh(scene, builder, "rib_support", palette.limestone);
  for (const float side : {-1.0f, 1.0f}) {
    for (int i = 0; i <= kBaysX; ++i) {
      const glm::mat4 place = at(i * kBay - kCourtX, side * (kCourtZ + middle), -side * 0.5f * kPi);
      add_instance(scene, "rib", rib_mesh, place);
      add_instance(scene, "rib_support", support, place);
    }
    for (int i = 0; i <= kBaysZ; ++i) {
      const glm::mat4 place =
          at(side * (kCourtX + middle), i * kBay - kCourtZ, side > 0.0f ? 0.0f : kPi);
      add_instance(scene, "rib", rib_mesh, place);
      add_instance(scene, "rib_support", support, place);
    }
  }
}

}  // namespace lambent::scenes::atrium
