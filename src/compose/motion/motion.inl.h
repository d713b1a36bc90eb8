// SPDX-License-Identifier: Apache-2.0
// Where a point of a surface was in the previous frame, in the common subset of C++ and GLSL.
// Included after attributes.inl.h and motion_math.h. The includer provides, besides what the former
// asks for, the type
//   SceneBeforeRef    the scene of the previous frame
// and
//   bool was_there(SceneBeforeRef before, uint instance)
//   mat4 transform_before(SceneBeforeRef before, uint instance, InstanceRef now)
//   vec3 fetch_position_before(SceneBeforeRef before, uint instance, MeshRef now, uint vertex)

/// Motion vector of a ray's hit on a triangle.
LAMBENT_FN PixelMotion surface_motion(SceneRef scene, SceneBeforeRef before, MotionViews views,
                                      uint instance_index, uint triangle, vec2 barycentrics) {
  InstanceRef instance = fetch_instance(scene, instance_index);
  MeshRef mesh = fetch_mesh(scene, instance.mesh);
  TrianglePoint p = triangle_point(mesh, triangle, barycentrics);
  vec3 position_ws = transform_point(instance.world_from_object, position_at(mesh, p));
  ImagePoint now = image_point(views.now, position_ws);
  if (views.has_before == 0u || !was_there(before, instance_index)) {
    return unknown_motion(now.depth);
  }

  // Find the same point of the same triangle with the previous vertices and transform. Where
  // neither has changed, rounding is the same, too, and surfaces at rest have exactly no motion
  vec3 position =
      interpolate(fetch_position_before(before, instance_index, mesh, p.vertices.x),
                  fetch_position_before(before, instance_index, mesh, p.vertices.y),
                  fetch_position_before(before, instance_index, mesh, p.vertices.z), p.weights);
  vec3 before_ws = transform_point(transform_before(before, instance_index, instance), position);
  PixelMotion motion = motion_between(now, image_point(views.before, before_ws));
  vec2 by_itself = image_point(views.now, before_ws).pixel - now.pixel;
  if (motion.known != 0u && length(by_itself) > kLeastOwnMotion) motion.known = kObjectMotion;
  return motion;
}
