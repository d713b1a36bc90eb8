// SPDX-License-Identifier: Apache-2.0
// Where a path splits at glass, queues the reflected branch, which is traced after the other paths
// end.
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
             dot(point.normal_ws, surface.to_viewer_ws), args.path_step)) {
    return;
  }
  uint i = args.pixels.at[k];
  RandomStream random = make_random_stream(args.first_index + i, args.salt, ~args.seed);
  CoatPath branch;
  NextRay next = go_on_reflected(surface.transmission, surface.reflectance, surface.coat_shares,
                                 point.normal_ws, point.geometric_normal_ws, surface.to_viewer_ws,
                                 emitter_density_scale(args.emitter_samples, surface.fluence),
                                 random, path, branch);
  args.paths.at[k].fork = path.fork;
  if (branch.pdf > 0.0f) append_path(args.reflected, i, branch, surface.cone, point, next);
}
