// SPDX-License-Identifier: Apache-2.0
#include "scenes/builtin.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "scenes/recipes.h"

namespace lambent::scenes {
namespace {

struct Recipe {
  std::string_view name;
  AnimatedScene (*make)();
};

constexpr std::array kRecipes{
    Recipe{"cornell", make_cornell},
    Recipe{"cornell-spot", make_cornell_spot},
    Recipe{"furnace", make_furnace},
    Recipe{"furnace-sky", make_furnace_sky},
    Recipe{"two-rooms", make_two_rooms},
    Recipe{"two-rooms-sealed", make_two_rooms_sealed},
    Recipe{"house", make_house},
    Recipe{"cube", make_cube},
    Recipe{"squares-parallel", make_squares_parallel},
    Recipe{"squares-perpendicular", make_squares_perpendicular},
    Recipe{"atrium", [] { return make_atrium(); }},
};

const Recipe* find(const std::string& name) {
  const auto* found = std::find_if(kRecipes.begin(), kRecipes.end(),
                                   [&](const Recipe& recipe) { return recipe.name == name; });
  return found == kRecipes.end() ? nullptr : found;
}

}  // namespace

void add_rig(Scene& scene, const Animations& animations) {
  for (const Animation& animation : animations) {
    lambent::Animation& played = scene.animations.emplace_back();
    played.name = animation.name;
    for (const Track& track : animation.tracks) {
      const int node = static_cast<int>(scene.rig.nodes.size());
      RigNode& rest = scene.rig.nodes.emplace_back();
      rest.translation = track.keyframes.front().translation;
      rest.rotation = track.keyframes.front().rotation;
      if (track.target == Track::Target::instance) {
        scene.rig.instances.push_back({track.index, node, glm::mat4(1.0f)});
        scene.instances[track.index].dynamic = true;
      } else {
        const Light& light = scene.lights[track.index];
        scene.rig.lights.push_back({track.index, node, light.intensity, 1.0f, light.range,
                                    light.inner_cone_angle, light.outer_cone_angle});
      }
      Curve translations, rotations;
      translations.components = 3;
      rotations.components = 4;
      for (const Keyframe& key : track.keyframes) {
        translations.times.push_back(key.time);
        rotations.times.push_back(key.time);
        for (int k = 0; k < 3; ++k) translations.values.push_back(key.translation[k]);
        const glm::quat& q = key.rotation;
        rotations.values.insert(rotations.values.end(), {q.x, q.y, q.z, q.w});
      }
      played.channels.push_back({Channel::Target::node_translation, node, std::move(translations)});
      played.channels.push_back({Channel::Target::node_rotation, node, std::move(rotations)});
    }
  }
}

std::vector<std::string> names() {
  std::vector<std::string> list;
  for (const Recipe& recipe : kRecipes) list.emplace_back(recipe.name);
  return list;
}

bool is_name(const std::string& name) {
  return find(name) != nullptr;
}

Expected<AnimatedScene> make_animated(const std::string& name) {
  if (const Recipe* recipe = find(name)) {
    AnimatedScene made = recipe->make();
    add_rig(made.scene, made.animations);
    made.scene.source.path = name;
    made.scene.source.generator = "lambent make-scene";
    made.scene.source.scenes = 1;
    made.scene.source.animations = static_cast<int>(made.animations.size());
    return made;
  }
  std::string list;
  for (const Recipe& recipe : kRecipes) {
    if (!list.empty()) list += ", ";
    list += recipe.name;
  }
  return fail(name, "", "is not a built-in scene; there are " + list);
}

Expected<Scene> make(const std::string& name) {
  return make_animated(name).map([](AnimatedScene&& made) { return std::move(made.scene); });
}

}  // namespace lambent::scenes
