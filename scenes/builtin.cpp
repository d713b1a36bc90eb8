// SPDX-License-Identifier: Apache-2.0
#include "scenes/builtin.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "core/nearest_word.h"
#include "scenes/recipes.h"

namespace lambent::scenes {
namespace {

struct Recipe {
  std::string_view name;
  std::string_view what;  // description of what is seen
  AnimatedScene (*make)();
};

constexpr std::array kRecipes{
    Recipe{"cornell", "the Cornell box, from its published measurements", make_cornell},
    Recipe{"cornell-spot", "the Cornell box with a spot light for a lamp", make_cornell_spot},
    Recipe{"spheres", "the Cornell box with metal spheres of roughness 0 to 0.8", make_spheres},
    Recipe{"furnace", "a closed room whose radiance is 1 everywhere", make_furnace},
    Recipe{"furnace-sky", "a sphere that reflects a sky at exactly its albedo", make_furnace_sky},
    Recipe{"glass", "a room lit through a tinted pane, and a glass ball", make_glass},
    Recipe{"two-rooms", "a lit and a dark room, a thin wall with a gap between them",
           make_two_rooms},
    Recipe{"two-rooms-sealed", "the same without the gap: the second room is black",
           make_two_rooms_sealed},
    Recipe{"house", "sixteen rooms joined by doorways, a lamp in each", make_house},
    Recipe{"lamps", "a street at night: 1,000 lamps and 100,000 emissive triangles", make_lamps},
    Recipe{"cube", "a 10 m cube around a point light, with solved radiosity", make_cube},
    Recipe{"squares-parallel", "two squares whose form factor is known, face to face",
           make_squares_parallel},
    Recipe{"squares-perpendicular", "two squares whose form factor is known, at a right angle",
           make_squares_perpendicular},
    Recipe{"atrium", "a court with columns and curtains; the sun moves, a door opens",
           [] { return make_atrium(); }},
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

std::string description(const std::string& name) {
  const Recipe* recipe = find(name);
  return recipe == nullptr ? std::string() : std::string(recipe->what);
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
  const std::vector<std::string> known = names();
  const std::string nearest = did_you_mean(name, known);
  if (!nearest.empty()) return fail(name, "", "is not a built-in scene" + nearest);
  std::string list;
  for (const std::string& other : known) list += (list.empty() ? "" : ", ") + other;
  return fail(name, "", "is not a built-in scene; there are " + list);
}

Expected<Scene> make(const std::string& name) {
  return make_animated(name).map([](AnimatedScene&& made) { return std::move(made.scene); });
}

}  // namespace lambent::scenes
