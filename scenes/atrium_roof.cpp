// SPDX-License-Identifier: Apache-2.0
// The atrium's gallery ceiling, roof and mouldings.
#include <cmath>

#include "scenes/atrium.h"
#include "shared/constants.h"

namespace lambent::scenes::atrium {
namespace {

using B = MeshBuilder;

constexpr float kOverhang = 0.62f;      // of the eave beyond the column line [m]
constexpr float kTile = 0.24f;          // width of one barrel tile [m]
constexpr float kTileRise = 0.06f;      // [m]
constexpr int kTileCells = 4;           // cells across a tile
constexpr float kEaveThickness = 0.1f;  // from the soffit to the tiles' valleys [m]

/// The slope over one side: tiles from the eave up to the outer wall, mitred at both corners, and
/// the face below the tiles' ends. `half_length` is measured along the eave; the side lies in
/// direction +Z, turned.
void roof_side(MeshBuilder& tiles, float half_length, float eave, float ridge) {
  const int cells = kTileCells * static_cast<int>(std::lround(2.0f * half_length / kTile));
  const float run = ridge - eave;
  const auto lift = [&](float x) {
    return kEaveThickness + 0.5f * kTileRise * (1.0f + std::cos(kTwoPi * x / kTile));
  };
  // Seen from the court the eave is below and +X to the left.
  tiles.surface(cells, 1, false, [&](float s, float t) {
    const float x = (1.0f - 2.0f * s) * (half_length + t * run);
    const float along = (1.0f - 2.0f * s) * half_length;
    return B::SurfacePoint{{x, kEave + lift(along) + t * run * kRoofSlope, eave + t * run},
                           {2.0f * s * half_length, -t * run}};
  });
  tiles.surface(cells, 1, false, [&](float s, float t) {
    const float x = (1.0f - 2.0f * s) * half_length;
    return B::SurfacePoint{{x, kEave + t * lift(x), eave}, {2.0f * s * half_length, -t * lift(x)}};
  });
}

glm::mat4 turned(float angle) {
  const float c = std::cos(angle), s = std::sin(angle);
  return glm::mat4(c, 0, -s, 0, 0, 1, 0, 0, s, 0, c, 0, 0, 0, 0, 1);
}

}  // namespace

void add_gallery_ceiling_and_roof(Scene& scene, const Palette& palette) {
  MeshBuilder builder;
  // Planks close the gallery above its beams; they end inside the arcade's walls.
  const float inner_x = kCourtX - 0.1f, inner_z = kCourtZ - 0.1f;
  const float outer_x = kWallX + 0.1f, outer_z = kWallZ + 0.1f;
  const unsigned sides = B::kAllFaces & ~(B::kBack | B::kFront);
  const float top = kCeiling + 0.2f;
  builder.box({-outer_x, kCeiling, inner_z}, {outer_x, top, outer_z});
  builder.box({-outer_x, kCeiling, -outer_z}, {outer_x, top, -inner_z});
  builder.box({inner_x, kCeiling, -inner_z}, {outer_x, top, inner_z}, sides);
  builder.box({-outer_x, kCeiling, -inner_z}, {-inner_x, top, inner_z}, sides);

  constexpr float kSpacing = 1.0f, kHalfBeam = 0.08f, kBeamDepth = 0.24f;
  const float low = kCeiling - kBeamDepth, high = kCeiling + 0.01f;
  for (float x = -kCourtX + 0.5f * kSpacing; x < kCourtX; x += kSpacing) {
    builder.box({x - kHalfBeam, low, kCourtZ}, {x + kHalfBeam, high, outer_z});
    builder.box({x - kHalfBeam, low, -outer_z}, {x + kHalfBeam, high, -kCourtZ});
  }
  for (float z = -kCourtZ + 0.5f * kSpacing; z < kCourtZ; z += kSpacing) {
    builder.box({kCourtX, low, z - kHalfBeam}, {outer_x, high, z + kHalfBeam});
    builder.box({-outer_x, low, z - kHalfBeam}, {-kCourtX, high, z + kHalfBeam});
  }

  // Rafters' heads under the eave
  constexpr float kRafterSpacing = 0.5f, kHalfRafter = 0.05f;
  const float eave_x = kCourtX - kOverhang, eave_z = kCourtZ - kOverhang;
  const float head_low = kEave - 0.14f, head_high = kEave + 0.01f, tip = 0.08f;
  for (float x = -eave_x + kRafterSpacing; x < eave_x - 0.3f; x += kRafterSpacing) {
    for (const float side : {-1.0f, 1.0f}) {
      const float z0 = side * (eave_z + tip), z1 = side * kCourtZ;
      builder.box({x - kHalfRafter, head_low, glm::min(z0, z1)},
                  {x + kHalfRafter, head_high, glm::max(z0, z1)});
    }
  }
  for (float z = -eave_z + kRafterSpacing; z < eave_z - 0.3f; z += kRafterSpacing) {
    for (const float side : {-1.0f, 1.0f}) {
      const float x0 = side * (eave_x + tip), x1 = side * kCourtX;
      builder.box({glm::min(x0, x1), head_low, z - kHalfRafter},
                  {glm::max(x0, x1), head_high, z + kHalfRafter});
    }
  }
  // The soffit between them: a level board around the court, seen from below
  const std::array<glm::vec3, 4> eave{
      glm::vec3(eave_x, kEave, eave_z), glm::vec3(-eave_x, kEave, eave_z),
      glm::vec3(-eave_x, kEave, -eave_z), glm::vec3(eave_x, kEave, -eave_z)};
  const std::array<glm::vec2, 2> soffit{glm::vec2(-kOverhang, 0.0f), glm::vec2(0.0f, 0.0f)};
  builder.moulding(soffit, eave, true);
  add(scene, builder, "ceiling_and_beams", palette.wood);

  const float ridge = kAisle + 0.3f + kOverhang;
  for (const float side : {0.0f, 1.0f}) {
    builder.set_transform(turned(side * kPi));
    roof_side(builder, eave_x, eave_z, eave_z + ridge);
    builder.set_transform(turned(side * kPi + 0.5f * kPi));
    roof_side(builder, eave_z, eave_x, eave_x + ridge);
  }
  add(scene, builder, "roof_tiles", palette.terracotta);
}

void add_mouldings(Scene& scene, const Palette& palette) {
  MeshBuilder builder;
  const auto around = [](float x, float z) {
    return std::array<glm::vec3, 4>{glm::vec3(x, 0.0f, z), glm::vec3(-x, 0.0f, z),
                                    glm::vec3(-x, 0.0f, -z), glm::vec3(x, 0.0f, -z)};
  };
  // The string course under the gallery and the cornice under the eave
  const std::array<glm::vec2, 8> course{glm::vec2(-0.01f, 4.44f), glm::vec2(0.04f, 4.44f),
                                        glm::vec2(0.05f, 4.52f),  glm::vec2(0.10f, 4.58f),
                                        glm::vec2(0.16f, 4.62f),  glm::vec2(0.18f, 4.72f),
                                        glm::vec2(0.18f, 4.80f),  glm::vec2(0.02f, 4.85f)};
  builder.moulding(course, around(kCourtX - kHalfArcade, kCourtZ - kHalfArcade), true);
  const std::array<glm::vec2, 5> cornice{glm::vec2(-0.01f, 8.2f), glm::vec2(0.05f, 8.22f),
                                         glm::vec2(0.08f, 8.29f), glm::vec2(0.08f, 8.33f),
                                         glm::vec2(-0.01f, 8.36f)};
  builder.moulding(cornice, around(kCourtX - 0.8f * kHalfArcade, kCourtZ - 0.8f * kHalfArcade),
                   true);
  add(scene, builder, "cornices", palette.limestone);

  // A dado around the aisle, from one side of the door to the other, and skirting on the gallery
  constexpr float kFrame = 0.22f;  // width of the door's stone frame [m]
  const float gap = kDoorHalfWidth + kFrame;
  const std::array<glm::vec3, 6> wall{
      glm::vec3(kWallX, 0.0f, gap),     glm::vec3(kWallX, 0.0f, kWallZ),
      glm::vec3(-kWallX, 0.0f, kWallZ), glm::vec3(-kWallX, 0.0f, -kWallZ),
      glm::vec3(kWallX, 0.0f, -kWallZ), glm::vec3(kWallX, 0.0f, -gap)};
  const std::array<glm::vec2, 7> dado{glm::vec2(0.06f, kAisleFloor), glm::vec2(0.06f, 0.4f),
                                      glm::vec2(0.04f, 0.43f),       glm::vec2(0.04f, 1.1f),
                                      glm::vec2(0.07f, 1.13f),       glm::vec2(0.07f, 1.19f),
                                      glm::vec2(-0.01f, 1.22f)};
  builder.moulding(dado, wall, false);
  const std::array<glm::vec2, 3> skirting{glm::vec2(0.03f, kGalleryFloor),
                                          glm::vec2(0.03f, kGalleryFloor + 0.16f),
                                          glm::vec2(-0.01f, kGalleryFloor + 0.18f)};
  builder.moulding(skirting, around(kWallX, kWallZ), true);
  add(scene, builder, "dado", palette.sandstone);

  // The door's frame, proud of the wall and of the dado
  const float x0 = kWallX - 0.1f, x1 = kWallX + 0.02f, top = kDoorTop + kFrame;
  const unsigned seen = B::kAllFaces & ~B::kRight;
  builder.box({x0, kAisleFloor, -gap}, {x1, kDoorTop, -kDoorHalfWidth},
              seen & ~(B::kBottom | B::kTop));
  builder.box({x0, kAisleFloor, kDoorHalfWidth}, {x1, kDoorTop, gap},
              seen & ~(B::kBottom | B::kTop));
  builder.box({x0, kDoorTop, -gap}, {x1, top, gap}, seen);
  builder.box({x0 - 0.06f, top, -gap - 0.08f}, {x1, top + 0.09f, gap + 0.08f}, seen);
  add(scene, builder, "door_frame", palette.limestone);
}

}  // namespace lambent::scenes::atrium
