// SPDX-License-Identifier: Apache-2.0
// Points of emissive triangles, in the common subset of C++ and GLSL. Included after
// attributes.inl.h. The includer provides, besides what that asks for, the type
//   EmittersRef  the emissive triangles of a scene
// and
//   uint emitter_count(EmittersRef emitters)
//   EmitterRecord fetch_emitter(EmittersRef emitters, uint emitter)
//   float fetch_cumulative(EmittersRef emitters, uint emitter)   end of its interval of [0, 1)
//   float fetch_pdf_area(EmittersRef emitters, uint instance, uint triangle)
//       density with which points of a triangle are drawn [1/m^2]; 0 where it does not emit

/// Cross product of two edges of a triangle in the world.
LAMBENT_FN vec3 world_edge_product(InstanceRef instance, MeshRef mesh, uvec3 vertices) {
  vec3 p0 = fetch_position(mesh, vertices.x);
  return edge_product(instance.world_from_object, fetch_position(mesh, vertices.y) - p0,
                      fetch_position(mesh, vertices.z) - p0);
}

/// The emitter whose interval of the cumulative distribution holds `u`.
LAMBENT_FN uint emitter_at(EmittersRef emitters, float u) {
  uint first = 0u;
  uint count = emitter_count(emitters);
  while (count > 0u) {
    uint half_count = count / 2u;
    bool above = fetch_cumulative(emitters, first + half_count) > u;
    first = above ? first : first + half_count + 1u;
    count = above ? half_count : count - half_count - 1u;
  }
  return min(first, emitter_count(emitters) - 1u);
}

/// A point for three uniform numbers: the first picks the triangle, the others the point on it.
LAMBENT_FN EmissiveSample sample_emissive(SceneRef scene, EmittersRef emitters, vec3 u) {
  if (emitter_count(emitters) == 0u) return no_emissive_sample();
  EmitterRecord emitter = fetch_emitter(emitters, emitter_at(emitters, u.x));
  InstanceRef instance = fetch_instance(scene, emitter.instance);
  MeshRef mesh = fetch_mesh(scene, instance.mesh);
  MaterialRef material = fetch_material(scene, mesh.material);
  TrianglePoint p = triangle_point(mesh, emitter.triangle, sample_uniform_triangle(vec2(u.y, u.z)));

  EmissiveSample drawn;
  drawn.position_ws = vec3(instance.world_from_object * vec4(position_at(mesh, p), 1.0f));
  drawn.normal_ws = world_edge_product(instance, mesh, p.vertices) / (2.0f * emitter.area);
  drawn.radiance = emission_at(scene, mesh, material, p, 0.0f);
  if (uint(material.alpha_mode) != kAlphaOpaque) {
    drawn.radiance *= stopping_probability(uint(material.alpha_mode), material.alpha_cutoff,
                                           coverage_at(scene, mesh, material, p));
  }
  drawn.pdf_area = emitter.probability / emitter.area;
  return drawn;
}

/// A given point of a triangle, as if it were drawn; of density 0 where the triangle does not emit.
LAMBENT_FN EmissiveSample emissive_point(SceneRef scene, EmittersRef emitters, uint instance_index,
                                         uint triangle, vec2 barycentrics) {
  EmissiveSample point = no_emissive_sample();
  point.pdf_area = fetch_pdf_area(emitters, instance_index, triangle);
  if (point.pdf_area <= 0.0f) return point;
  InstanceRef instance = fetch_instance(scene, instance_index);
  MeshRef mesh = fetch_mesh(scene, instance.mesh);
  MaterialRef material = fetch_material(scene, mesh.material);
  TrianglePoint p = triangle_point(mesh, triangle, barycentrics);
  point.position_ws = vec3(instance.world_from_object * vec4(position_at(mesh, p), 1.0f));
  point.normal_ws = normalize(world_edge_product(instance, mesh, p.vertices));
  point.radiance = emission_at(scene, mesh, material, p, 0.0f);
  return point;
}
