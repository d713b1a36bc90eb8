// SPDX-License-Identifier: Apache-2.0
// The rays of pixels that a pilot guides, in the common subset of C++ and GLSL. The includer
// provides
//   GuidePoint fetch_guide_point(int point)
//   vec3 fetch_bright_place(int place)  [m]
// In C++, this file is included in the body of a struct that has them as members.

/// The rays that a pixel gathers light with in a sample.
struct PixelRays {
  uint x, y;  ///< The pixel.
  uint count;
  uint sample_index, seed;
};

/// One of them.
struct GatherRay {
  vec3 direction_ws;
  float weight;  ///< Factor of its contribution.
};

/// The point of the pilot that guides a pixel's rays in a sample; -1: none. Of those around the
/// pixel, points are drawn with the weights of bilinear interpolation, so that noise has no steps
/// on plain surfaces. Where the point drawn faces elsewhere, one beside it guides.
LAMBENT_FN int guiding_point(GuideSize size, PixelRays rays, vec3 normal_ws) {
  if (size.width == 0) return -1;
  RandomStream random = make_random_stream(hilbert_index(rays.x, rays.y), rays.sample_index,
                                           rays.seed ^ kGuidingSalt);
  vec2 drawn = next_uniform2(random);
  float scale_x = float(size.width) / float(size.picture_width);
  float scale_y = float(size.height) / float(size.picture_height);
  int x = int(floor((float(rays.x) + 0.5f) * scale_x + drawn.x - 0.5f));
  int y = int(floor((float(rays.y) + 0.5f) * scale_y + drawn.y - 0.5f));
  // The point drawn, those beside it, and those at the corners of these
  for (int distance = 0; distance <= 2; ++distance) {
    for (int place = 0; place < 9; ++place) {
      ivec2 step = ivec2(place % 3 - 1, place / 3 - 1);
      if (abs(step.x) + abs(step.y) != distance) continue;
      int there_x = clamp(x + step.x, 0, size.width - 1);
      int there_y = clamp(y + step.y, 0, size.height - 1);
      int point = there_y * size.width + there_x;
      if (dot(fetch_guide_point(point).normal_ws, normal_ws) > kGuidingCosine) return point;
    }
  }
  return -1;
}

/// Direction of a ray that a point of the pilot guides.
LAMBENT_FN vec3 guided_direction(PixelRays rays, uint ray, int point, vec3 position_ws,
                                 Frame frame) {
  vec2 u = pixel_point(rays.x, rays.y, ray, rays.count, rays.sample_index, rays.seed ^ kGuidedSalt);
  int place = min(int(u.x * float(kBrightPlaces)), kBrightPlaces - 1);
  vec3 to_place = fetch_bright_place(point * kBrightPlaces + place) - position_ws;
  // A place at the pixel itself is in no direction: such a ray brings nothing
  vec3 axis_ws = to_place == vec3(0.0f) ? -frame.normal : normalize(to_place);
  vec2 in_cone = vec2(u.x * float(kBrightPlaces) - float(place), u.y);
  return to_world(make_frame(axis_ws),
                  sample_uniform_cone(in_cone, fetch_guide_point(point).least_cosine));
}

/// One of a pixel's rays, of which the first `guided` are guided by a point of the pilot. The
/// frame's normal is that of the pixel's surface.
LAMBENT_FN GatherRay gather_ray(PixelRays rays, uint ray, int point, uint guided, vec3 position_ws,
                                Frame frame) {
  GatherRay drawn;
  drawn.weight = 1.0f;
  if (ray < guided) {
    drawn.direction_ws = guided_direction(rays, ray, point, position_ws, frame);
  } else {
    drawn.direction_ws = gather_direction(
        frame, pixel_point(rays.x, rays.y, ray, rays.count, rays.sample_index, rays.seed));
  }
  if (guided == 0u) return drawn;
  float least_cosine = fetch_guide_point(point).least_cosine;
  int cones = 0;
  for (int k = 0; k < kBrightPlaces; ++k) {
    vec3 to_place = fetch_bright_place(point * kBrightPlaces + k) - position_ws;
    if (is_in_cone(drawn.direction_ws, to_place, least_cosine)) ++cones;
  }
  drawn.weight =
      guided_weight(dot(drawn.direction_ws, frame.normal),
                    guided_density(float(cones), least_cosine), float(guided) / float(rays.count));
  return drawn;
}
