// SPDX-License-Identifier: Apache-2.0
#include "scenes/atrium.h"

#include <cmath>
#include <future>
#include <glm/gtc/matrix_transform.hpp>

#include "scenes/parts.h"
#include "scenes/procedural_textures.h"
#include "scenes/recipes.h"
#include "shared/constants.h"

namespace lambent::scenes {
namespace atrium {
namespace {

/// The textures and the material of one pattern.
struct Order {
  const char* name;
  int size;
  float metres_a_tile;
  Pattern pattern;
  bool roughness_map;
};

Finish add_textured(Scene& scene, const Order& order, TextureSet set) {
  Material material;
  material.name = order.name;
  material.metallic = 0.0f;
  const auto add_texture = [&](Texture& texture) {
    TextureView view;
    view.texture = static_cast<int>(scene.textures.size());
    scene.textures.push_back(std::move(texture));
    return view;
  };
  material.base_color_texture = add_texture(set.color);
  material.normal_texture = add_texture(set.normal);
  constexpr float kMatt = 0.9f;
  material.roughness = order.roughness_map ? 1.0f : kMatt;
  if (order.roughness_map) material.metallic_roughness_texture = add_texture(set.roughness);
  scene.materials.push_back(std::move(material));
  return {static_cast<int>(scene.materials.size()) - 1, order.metres_a_tile};
}

Finish add_plain(Scene& scene, const char* name, const glm::vec3& color, float roughness,
                 const glm::vec3& emission = glm::vec3(0.0f)) {
  Material material;
  material.name = name;
  material.base_color = glm::vec4(color, 1.0f);
  material.metallic = 0.0f;
  material.roughness = roughness;
  material.emission = emission;
  scene.materials.push_back(std::move(material));
  return {static_cast<int>(scene.materials.size()) - 1, 1.0f};
}

}  // namespace

Palette add_palette(Scene& scene, int texels) {
  const int fine = texels, coarse = texels / 2;
  constexpr glm::vec3 kRed(0.52f, 0.045f, 0.035f), kBlue(0.035f, 0.10f, 0.38f),
      kOchre(0.62f, 0.33f, 0.055f), kCream(0.70f, 0.60f, 0.42f), kGold(0.66f, 0.42f, 0.10f);
  const auto fabric = [](const glm::vec3& ground, const glm::vec3& stripe) {
    return [=](glm::vec2 p) { return woven_fabric(p, ground, stripe); };
  };
  const std::vector<Order> orders{
      {"sandstone", fine, 2.4f, sandstone_blocks, true},
      {"limestone", coarse, 1.6f, limestone, false},
      {"marble", fine, 2.4f, marble_checker, true},
      {"flags", fine, 3.0f, flagstones, true},
      {"plaster", coarse, 2.5f, plaster, false},
      {"wood", coarse, 1.2f, wood_planks, true},
      {"terracotta", coarse, 1.2f, terracotta, false},
      {"cloth_red", coarse, 0.8f, fabric(kRed, kGold), false},
      {"cloth_blue", coarse, 0.8f, fabric(kBlue, kCream), false},
      {"cloth_ochre", coarse, 0.8f, fabric(kOchre, kRed), false},
  };
  std::vector<std::future<TextureSet>> baking;
  for (const Order& order : orders) {
    baking.push_back(std::async(std::launch::async, [&order] {
      return bake(order.name, order.size, order.metres_a_tile, order.pattern);
    }));
  }
  Palette palette;
  const std::array<Finish*, 10> textured{
      &palette.sandstone, &palette.limestone,  &palette.marble, &palette.flags, &palette.plaster,
      &palette.wood,      &palette.terracotta, &palette.red,    &palette.blue,  &palette.ochre};
  for (std::size_t i = 0; i < orders.size(); ++i) {
    *textured[i] = add_textured(scene, orders[i], baking[i].get());
  }
  palette.iron = add_plain(scene, "iron", {0.045f, 0.042f, 0.04f}, 0.5f);
  palette.water = add_plain(scene, "water", {0.04f, 0.065f, 0.06f}, 0.08f);
  palette.lamp = add_plain(scene, "lamp", glm::vec3(0.8f), 0.9f, {36.0f, 18.5f, 6.0f});
  palette.leaf = add_plain(scene, "leaf", {0.075f, 0.17f, 0.04f}, 0.55f);
  palette.orange = add_plain(scene, "orange", {0.72f, 0.26f, 0.04f}, 0.5f);
  for (const Finish* sheet : {&palette.red, &palette.blue, &palette.ochre, &palette.leaf}) {
    scene.materials[sheet->material].double_sided = true;
  }
  return palette;
}

glm::mat4 facing_court(const glm::vec3& position) {
  // Find the side of the court by the column line on which the place lies.
  float turn = 0.0f;
  if (position.z >= kCourtZ)
    turn = kPi;
  else if (position.z > -kCourtZ)
    turn = position.x > 0.0f ? -0.5f * kPi : 0.5f * kPi;
  return glm::rotate(glm::translate(glm::mat4(1.0f), position), turn, {0.0f, 1.0f, 0.0f});
}

std::vector<glm::vec3> bay_middles() {
  std::vector<glm::vec3> places;
  for (const float z : {-kCourtZ, kCourtZ}) {
    for (int i = 0; i < kBaysX; ++i) places.emplace_back((i + 0.5f) * kBay - kCourtX, 0.0f, z);
  }
  for (const float x : {-kCourtX, kCourtX}) {
    for (int i = 0; i < kBaysZ; ++i) places.emplace_back(x, 0.0f, (i + 0.5f) * kBay - kCourtZ);
  }
  return places;
}

std::vector<glm::vec3> column_feet() {
  std::vector<glm::vec3> places;
  for (const float z : {-kCourtZ, kCourtZ}) {
    for (int i = 0; i <= kBaysX; ++i) places.emplace_back(i * kBay - kCourtX, 0.0f, z);
  }
  for (const float x : {-kCourtX, kCourtX}) {
    for (int i = 1; i < kBaysZ; ++i) places.emplace_back(x, 0.0f, i * kBay - kCourtZ);
  }
  return places;
}

int add_mesh(Scene& scene, MeshBuilder& builder, const char* name, const Finish& finish) {
  scene.meshes.push_back(builder.take(name, finish.material, finish.metres_a_tile));
  return static_cast<int>(scene.meshes.size()) - 1;
}

void add(Scene& scene, MeshBuilder& builder, const char* name, const Finish& finish) {
  add_instance(scene, name, add_mesh(scene, builder, name, finish), glm::mat4(1.0f));
}

namespace {

/// The direction in which sunlight travels at an hour angle from noon [rad]. The sun's circle
/// culminates at 66 degrees over the court's -Z side, so that mornings light the +X end and noon
/// the +Z arcade.
glm::vec3 sunlight(float hour_angle) {
  constexpr float kNoonElevation = 1.152f;  // [rad]
  const glm::vec3 noon(0.0f, std::sin(kNoonElevation), -std::cos(kNoonElevation));
  const glm::vec3 to_sun =
      std::sin(hour_angle) * glm::vec3(1.0f, 0.0f, 0.0f) + std::cos(hour_angle) * noon;
  return -glm::normalize(to_sun);
}

void add_sun(AnimatedScene& made) {
  constexpr float kMorning = -0.56f, kEvening = 1.1f;  // hour angles [rad]
  constexpr float kDay = 20.0f;                        // [s]
  constexpr int kKeys = 20;
  Light sun;
  sun.name = "sun";
  sun.type = Light::Type::directional;
  sun.intensity = {10.5f, 9.3f, 7.5f};
  sun.direction_ws = sunlight(kMorning);
  made.scene.lights.push_back(sun);

  Track track;
  track.target = Track::Target::light;
  track.index = static_cast<int>(made.scene.lights.size()) - 1;
  for (int i = 0; i <= kKeys; ++i) {
    const float share = static_cast<float>(i) / kKeys;
    const glm::vec3 way = sunlight(glm::mix(kMorning, kEvening, share));
    track.keyframes.push_back(
        {share * kDay, glm::vec3(0.0f), glm::quat(glm::vec3(0.0f, 0.0f, -1.0f), way)});
  }
  made.animations.push_back({"day", {std::move(track)}});
  made.scene.environment.radiance = {0.75f, 0.95f, 1.25f};
}

void add_cameras(Scene& scene) {
  const float kDegree = kPi / 180.0f;
  // Eyes and targets are level, so that verticals stay upright.
  add_camera(scene, "court", {-6.9f, 2.0f, -1.2f}, {7.5f, 2.0f, 1.9f}, 62.0f * kDegree, kAspect);
  add_camera(scene, "aisle", {-4.2f, 1.75f, 6.45f}, {7.5f, 1.75f, 5.4f}, 60.0f * kDegree, kAspect);
  add_camera(scene, "door", {3.3f, 1.65f, -0.75f}, {10.5f, 1.65f, 0.2f}, 46.0f * kDegree, kAspect);
  add_camera(scene, "gallery", {-9.7f, 6.6f, -0.7f}, {7.5f, 6.6f, 1.0f}, 60.0f * kDegree, kAspect);
}

}  // namespace
}  // namespace atrium

AnimatedScene make_atrium(int texels) {
  AnimatedScene made;
  Scene& scene = made.scene;
  const atrium::Palette palette = atrium::add_palette(scene, texels);
  atrium::add_floors(scene, palette);
  atrium::add_walls(scene, palette);
  atrium::add_arcades(scene, palette);
  atrium::add_vaults(scene, palette);
  atrium::add_gallery_ceiling_and_roof(scene, palette);
  atrium::add_mouldings(scene, palette);
  atrium::add_columns(scene, palette);
  atrium::add_balustrades(scene, palette);
  atrium::add_fountain(scene, palette);
  atrium::add_trees(scene, palette);
  atrium::add_curtains(scene, palette);
  atrium::add_side_room(scene, palette);
  atrium::add_door(made, palette);
  atrium::add_sun(made);
  atrium::add_cameras(scene);
  return made;
}

}  // namespace lambent::scenes
