// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lambent/scene.h"
#include "scene/gltf/document/document.h"

namespace lambent::gltf {

/// Light `light` of KHR_lights_punctual as placed by `node`.
Expected<Light> import_light(Document& document, int light, int node,
                             const glm::mat4& world_from_node);

/// Vertical field of view [rad] of a perspective camera. Values of more than kMaxFov are taken as
/// degrees.
float vertical_fov_of(const tinygltf::Camera& camera);

/// The camera of `node`, without the node's scale.
Expected<Camera> import_camera(Document& document, int node, const glm::mat4& world_from_node);

}  // namespace lambent::gltf
