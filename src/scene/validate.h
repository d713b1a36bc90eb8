// SPDX-License-Identifier: Apache-2.0
// Checks of parts of a scene. Each flaw_of returns a description of the first flaw, or null.
#pragma once

#include <cstddef>

#include "lambent/scene.h"

namespace lambent {

const char* flaw_of(const Texture& texture);
/// `textures`: number of textures in the scene.
const char* flaw_of(const Material& material, std::size_t textures);
/// `materials`: number of materials in the scene.
const char* flaw_of(const Mesh& mesh, std::size_t materials);
/// `meshes`: number of meshes in the scene.
const char* flaw_of(const Instance& instance, std::size_t meshes);
/// Checks where an instance, otherwise valid, places a mesh of these bounds.
const char* flaw_of_reach(const Instance& instance, const Bounds& mesh);
const char* flaw_of(const Light& light);
const char* flaw_of(const Camera& camera);
const char* flaw_of(const Environment& environment);
const char* flaw_of(const FogVolume& fog);
/// Of its place and size; the rest depends on the field that it belongs to.
const char* flaw_of(const ProbeVolume& volume);
const char* flaw_of(const Curve& curve);

/// Checks a scene's fog.
Expected<void> validate_fog(const Scene& scene);

/// Checks a scene's animations and its rig.
Expected<void> validate_motion(const Scene& scene);

}  // namespace lambent
