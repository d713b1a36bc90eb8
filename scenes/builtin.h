// SPDX-License-Identifier: Apache-2.0
// The built-in scenes, by name.
//
//   cornell                the Cornell box from its published measurements; one unit is 100 mm
//   cornell-spot           the same with a spot light in place of its lamp
//   spheres                the Cornell box with metal spheres of roughness 0, 0.1, 0.2, 0.4, 0.6,
//                          0.8
//   furnace                a closed room whose radiance is 1 everywhere and in every direction
//   furnace-sky            a sphere that reflects a radiance of exactly its albedo, 0.5
//   glass                  a room whose one half is lit through a tinted pane, and a glass ball
//   two-rooms              a lit and a dark room, with a gap in the 5 cm wall between them
//   two-rooms-sealed       the same without the gap: the second room is exactly black
//   house                  sixteen rooms joined by doorways, a lamp in each
//   lamps                  a street at night: 1,000 lamps, and 1,000 lanterns of 100 triangles
//   cube                   a 10 m cube around a point light, with solved radiosity
//   squares-parallel       unit squares one metre apart: form factor 0.1998249
//   squares-perpendicular  unit squares that share an edge: form factor 0.2000438
//   atrium                 a colonnaded court with curtains, a sun that moves and a door that opens
//
// Why the furnace is 1: every surface emits radiance e and reflects albedo a of what arrives. If
// radiance L arrives from everywhere, every surface sends out e + a L; the room is closed, so L = e
// + a L and L = e / (1 - a) = 0.5 / (1 - 0.5) = 1, whatever the room contains. The sky furnace: a
// convex body sees sky alone, so its irradiance is pi * 1 and the radiance it reflects 0.5 / pi *
// pi = 0.5. Materials of all scenes, except the atrium, the spheres and glass, are exact Lambert
// (Material::lambert).
#pragma once

#include <string>
#include <vector>

#include "lambent/scene.h"
#include "scenes/animation.h"

namespace lambent::scenes {

/// A scene at time 0, and its motion.
struct AnimatedScene {
  Scene scene;
  Animations animations;
};

/// Adds the tracks to the scene as animations for lambent::animate, with a node for each moving
/// object. make_animated calls it.
void add_rig(Scene& scene, const Animations& animations);

/// Names that `make` knows, in the order of the list above.
std::vector<std::string> names();

/// True where `name` is one of names().
bool is_name(const std::string& name);

/// A short description of the built-in scene of that name; empty if there is none.
std::string description(const std::string& name);

/// The built-in scene of that name, the same bits every time; an Error that lists the names
/// otherwise.
Expected<AnimatedScene> make_animated(const std::string& name);

/// make_animated without the motion.
Expected<Scene> make(const std::string& name);

/// Opens a scene by the name of a built-in one, or else by the path of a glTF file. `options` apply
/// to both. A file whose path is a built-in's name can be opened as "./name".
Expected<Scene> open_scene(const std::string& path_or_name, const LoadOptions& options = {});

}  // namespace lambent::scenes
