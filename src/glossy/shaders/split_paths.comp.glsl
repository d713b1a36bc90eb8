// SPDX-License-Identifier: Apache-2.0
// Where a path splits at glass, lets the branch compete for its pixel's place in the list of
// branches, which are traced after the other paths end.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "glossy/shaders/append_path.glsl"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  SplitPathsArguments args;
};

void main() {
  uint k = gl_GlobalInvocationID.x;
  if (k >= args.count) return;
  PixelSurfaceRecord surface = args.surfaces.at[k];
  if ((surface.flags & kSurfaceMissed) != 0u) return;
  LitPointRecord point = args.points.at[k];
  CoatPath path = args.paths.at[k];
  if (!forks(path, surface.transmission, surface.reflectance, surface.coat_shares.coat,
             dot(point.normal_ws, surface.to_viewer_ws), bounce_of_step(args.path_step))) {
    return;
  }
  uint i = args.pixels.at[k];
  RandomStream random = make_random_stream(args.first_index + i, args.salt, ~args.seed);
  CoatPath branch;
  NextRay next = split(surface.transmission, surface.reflectance, surface.coat_shares,
                       point.normal_ws, point.geometric_normal_ws, surface.to_viewer_ws,
                       emitter_density_scale(args.emitter_samples, surface.fluence), args.path_step,
                       random, path, branch);
  float weight = branch_weight(branch);
  if (weight > 0.0f) {
    if (path.branches.sum <= 0.0f) path.branch_slot = atomicAdd(args.branches.count.at[0], 1u);
    uint slot = path.branch_slot;
    float factor = 1.0f;
    if (keeps_branch(weight, path.branches, factor)) {
      write_path(args.branches, slot, i, branch, surface.cone, point, next);
    }
    args.branches.paths.at[slot].throughput *= factor;
  }
  args.paths.at[k] = path;
}
