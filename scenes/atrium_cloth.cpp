// SPDX-License-Identifier: Apache-2.0
// The atrium's curtains and the rugs over its balustrades: single sheets, seen from both sides.
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "scenes/atrium.h"
#include "scenes/parts.h"
#include "shared/constants.h"

namespace lambent::scenes::atrium {
namespace {

using B = MeshBuilder;

constexpr float kRodHeight = 2.84f;  // [m]
constexpr float kHem = kAisleFloor + 0.06f;
constexpr float kFullness = 1.9f;  // metres of cloth per metre of rod
constexpr int kCellsAFold = 8, kCurtainRows = 9;

struct Curtain {
  float from, to;  // along the rod [m]
  int folds;
  bool tied;      // gathered to its `from` side at hip height
  float variety;  // phase of its irregularities [rad]
};

/// Share of the rod's width that a tied curtain takes at a height, 0 to 1.
float tied_width(float y) {
  constexpr float kTie = 1.3f, kAtTie = 0.28f, kAtHem = 0.46f;
  const auto ease = [](float x) { return x * x * (3.0f - 2.0f * x); };
  if (y < kTie) return glm::mix(kAtHem, kAtTie, ease((y - kHem) / (kTie - kHem)));
  const float x = (y - kTie) / (kRodHeight - kTie);
  return glm::mix(kAtTie, 1.0f, x * x);
}

void hang(MeshBuilder& builder, const Curtain& curtain) {
  const float width = curtain.to - curtain.from;
  builder.surface(kCellsAFold * curtain.folds, kCurtainRows, false, [&](float s, float t) {
    const float y = glm::mix(kHem, kRodHeight, t);
    const float gathered = curtain.tied ? tied_width(y) : 1.0f;
    // Folds of uneven width; deeper further down and where the cloth is gathered
    const float uneven = s + 0.012f * std::sin(kTwoPi * 3.0f * s + curtain.variety);
    const float phase = kTwoPi * curtain.folds * uneven;
    const float depth = glm::mix(0.07f, 0.042f, t) * (0.55f + 0.45f * gathered);
    const float sway = 0.035f * (1.0f - t) * std::sin(2.1f * s + 2.6f * t + curtain.variety);
    const float lean = 0.15f * depth * std::sin(2.0f * phase + curtain.variety) * gathered;
    const float x = curtain.from + width * gathered * s + 0.4f * lean;
    return B::SurfacePoint{{x, y, depth * std::sin(phase) + sway},
                           {s * kFullness * std::abs(width), -y}};
  });
}

/// A rug laid over the balustrade's rail, its outside towards +Z.
void drape(MeshBuilder& builder, float half_width) {
  constexpr int kColumns = 20, kRows = 16;
  constexpr float kRail = kGalleryFloor + 0.935f, kRound = 0.128f;
  constexpr float kOutside = 0.84f, kInside = 0.55f;  // lengths that hang down [m]
  const float kOver = kPi * kRound;
  builder.surface(kColumns, kRows, false, [&](float s, float t) {
    const float way = t * (kOutside + kOver + kInside);
    const float x = (2.0f * s - 1.0f) * half_width;
    const float hanging = glm::max(0.0f, 1.0f - way / kOutside);
    const float wave = 0.022f * (1.0f + std::sin(9.0f * s + 0.7f)) * hanging;
    glm::vec3 p(x, kRail - kOutside + way, kRound + wave);
    if (way > kOutside + kOver) {
      p = {x, kRail - (way - kOutside - kOver), -kRound};
    } else if (way > kOutside) {
      const float angle = (way - kOutside) / kRound;
      constexpr float kFlat = 0.12f;  // the rail is flat: a shallow bow, not half a circle
      p = {x, kRail + kFlat * kRound * std::sin(angle), kRound * std::cos(angle)};
    }
    return B::SurfacePoint{p, {s * 2.0f * half_width, -way}};
  });
}

}  // namespace

void add_curtains(Scene& scene, const Palette& palette) {
  constexpr float kJamb = 1.17f;  // where curtains begin beside the columns [m]
  MeshBuilder builder;
  const auto tied = [&](const char* name, const Finish& finish, float variety) {
    hang(builder, {-kJamb, -0.03f, 6, true, variety});
    return add_mesh(scene, builder, name, finish);
  };
  const int red = tied("curtain_red", palette.red, 0.3f);
  const int blue = tied("curtain_blue", palette.blue, 1.9f);
  const int ochre = tied("curtain_ochre", palette.ochre, 4.1f);
  hang(builder, {-kJamb, 0.75f, 11, false, 2.2f});
  const int drawn_ochre = add_mesh(scene, builder, "drawn_ochre", palette.ochre);
  hang(builder, {-kJamb, 0.55f, 10, false, 5.0f});
  const int drawn_red = add_mesh(scene, builder, "drawn_red", palette.red);
  hang(builder, {-kJamb, 0.95f, 12, false, 0.9f});
  const int drawn_blue = add_mesh(scene, builder, "drawn_blue", palette.blue);
  builder.bar({-1.28f, kRodHeight + 0.02f, 0.0f}, {1.28f, kRodHeight + 0.02f, 0.0f}, 0.018f, 8);
  const int rod = add_mesh(scene, builder, "rod", palette.iron);

  // The curtains on the left and right of a bay of bay_middles(), as seen from the court; -1: none.
  struct Hung {
    int bay, left, right;
  };
  const std::vector<glm::vec3> bays = bay_middles();
  for (const Hung& hung :
       {Hung{1, blue, blue}, Hung{3, drawn_red, -1}, Hung{5, ochre, ochre}, Hung{6, -1, drawn_red},
        Hung{7, -1, blue}, Hung{8, drawn_ochre, -1}, Hung{9, blue, blue}, Hung{11, drawn_blue, -1},
        Hung{13, -1, drawn_ochre}, Hung{14, red, red}, Hung{15, drawn_blue, -1}}) {
    const glm::mat4 place = facing_court(bays[hung.bay]);
    const glm::mat4 turned = glm::rotate(place, kPi, {0.0f, 1.0f, 0.0f});
    if (hung.left >= 0) add_instance(scene, scene.meshes[hung.left].name, hung.left, place);
    if (hung.right >= 0) add_instance(scene, scene.meshes[hung.right].name, hung.right, turned);
    add_instance(scene, "rod", rod, place);
  }

  const auto rug = [&](const char* name, const Finish& finish, float half_width) {
    drape(builder, half_width);
    return add_mesh(scene, builder, name, finish);
  };
  const int red_rug = rug("rug_red", palette.red, 0.62f);
  const int blue_rug = rug("rug_blue", palette.blue, 0.5f);
  struct Laid {
    int bay, mesh;
  };
  for (const Laid& laid :
       {Laid{2, red_rug}, Laid{6, blue_rug}, Laid{8, red_rug}, Laid{14, blue_rug}}) {
    add_instance(scene, scene.meshes[laid.mesh].name, laid.mesh, facing_court(bays[laid.bay]));
  }
}

}  // namespace lambent::scenes::atrium
