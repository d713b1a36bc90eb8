// SPDX-License-Identifier: Apache-2.0
// Helpers from which all built-in scenes are assembled.
#pragma once

#include <string>
#include <utility>

#include "lambent/scene.h"

namespace lambent::scenes {

/// Adds an exact Lambert material; returns its index.
int add_lambert(Scene& scene, std::string name, const glm::vec3& albedo,
                const glm::vec3& emission = glm::vec3(0.0f));

/// Adds a mesh and one instance of it, named alike; returns the instance's index.
int add_object(Scene& scene, Mesh mesh, const glm::mat4& world_from_object = glm::mat4(1.0f));

/// Adds an instance of a mesh that the scene has; returns its index.
int add_instance(Scene& scene, std::string name, int mesh, const glm::mat4& world_from_object);

/// Width over height of most cameras' pictures.
inline constexpr float kAspect = 16.0f / 9.0f;

/// Adds a perspective camera with +Y up; `vertical_fov` in radians.
void add_camera(Scene& scene, std::string name, const glm::vec3& eye, const glm::vec3& target,
                float vertical_fov, float aspect);

}  // namespace lambent::scenes
