// SPDX-License-Identifier: Apache-2.0
// What is wrong with a part of a scene, in words; null: nothing. For those who check parts of it.
#pragma once

#include <cstddef>

#include "lambent/scene.h"

namespace lambent {

const char* flaw_of(const Texture& texture);
/// `textures`: how many the scene has.
const char* flaw_of(const Material& material, std::size_t textures);
/// `materials`: how many the scene has.
const char* flaw_of(const Mesh& mesh, std::size_t materials);
/// `meshes`: how many the scene has.
const char* flaw_of(const Instance& instance, std::size_t meshes);
/// What is wrong with where an instance, otherwise without flaw, puts a mesh of these bounds.
const char* flaw_of_reach(const Instance& instance, const Bounds& mesh);
const char* flaw_of(const Light& light);
const char* flaw_of(const Camera& camera);
const char* flaw_of(const Environment& environment);
const char* flaw_of(const FogVolume& fog);
const char* flaw_of(const Curve& curve);

/// Checks a scene's fog.
Expected<void> validate_fog(const Scene& scene);

/// Checks a scene's animations and its rig.
Expected<void> validate_motion(const Scene& scene);

}  // namespace lambent
