// SPDX-License-Identifier: Apache-2.0
// Blends a pixel of a frame with its history, in the common subset of C++ and GLSL. Included after
// taa_math.h, taa_records.h and motion_math.h. The includer provides the types
//   TaaPictureRef    the frame as it was rendered
//   TaaHistoryRef    the history
// and, for pixels within the picture,
//   vec3 fetch_radiance(TaaPictureRef picture, ivec2 pixel)
//   PixelMotion fetch_motion(TaaPictureRef picture, ivec2 pixel)
//   TaaPixel fetch_history(TaaHistoryRef history, ivec2 pixel)

/// The pixel, or the nearest within the picture.
LAMBENT_FN ivec2 within_picture(TaaFrame frame, int x, int y) {
  return ivec2(clamp(x, 0, frame.width - 1), clamp(y, 0, frame.height - 1));
}

/// A pixel's radiance. Radiance that is not a finite number becomes black, as it would spread from
/// pixel to pixel and from frame to frame.
LAMBENT_FN vec3 radiance_at(TaaPictureRef picture, ivec2 pixel) {
  vec3 radiance = fetch_radiance(picture, pixel);
  float brightness = luminance(radiance);
  return brightness >= 0.0f && brightness < infinity() ? radiance : vec3(0.0f);
}

/// Properties of a pixel and the eight around it.
struct TaaSurroundings {
  PixelMotion
      nearest;  ///< Motion of the nearest of them, so that edges move with the surface in front.
  float mean;   ///< Mean luminance; see compress_radiance.
};

LAMBENT_FN TaaSurroundings look_around(TaaFrame frame, TaaPictureRef picture, ivec2 pixel) {
  TaaSurroundings found;
  found.nearest = fetch_motion(picture, pixel);
  float sum = 0.0f;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      ivec2 at = within_picture(frame, pixel.x + dx, pixel.y + dy);
      PixelMotion motion = fetch_motion(picture, at);
      found.nearest = nearer_motion(found.nearest, motion);
      sum += luminance(radiance_at(picture, at));
    }
  }
  // A black neighbourhood has no scale, so that any will do
  found.mean = sum > 0.0f ? sum / 9.0f : 1.0f;
  return found;
}

LAMBENT_FN TaaNeighbourhood neighbourhood_at(TaaFrame frame, TaaPictureRef picture, ivec2 pixel,
                                             float mean) {
  vec3 sum = vec3(0.0f);
  vec3 sum_of_squares = vec3(0.0f);
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      ivec2 at = within_picture(frame, pixel.x + dx, pixel.y + dy);
      vec3 color = ycocg_from_rgb(compress_radiance(radiance_at(picture, at), mean));
      sum += color;
      sum_of_squares += color * color;
    }
  }
  vec3 now = ycocg_from_rgb(compress_radiance(radiance_at(picture, pixel), mean));
  return taa_neighbourhood(sum, sum_of_squares, 9.0f, now, frame.clip_deviations);
}

/// The history interpolated at a place between the centres of pixels [pixels], from sixteen of
/// them. The result is about within the range of the nearest four, see kMaxOvershoot.
LAMBENT_FN vec3 history_at(TaaFrame frame, TaaHistoryRef history, vec2 place) {
  vec2 corner = floor(place - vec2(0.5f));
  vec2 t = place - vec2(0.5f) - corner;
  ivec2 first = ivec2(int(corner.x), int(corner.y));
  // At the centre of a pixel, return that pixel's history
  if (t.x == 0.0f && t.y == 0.0f) {
    return fetch_history(history, within_picture(frame, first.x, first.y)).radiance;
  }
  vec4 across = catmull_rom_weights(t.x);
  vec4 down = catmull_rom_weights(t.y);
  vec3 sum = vec3(0.0f);
  vec3 least = vec3(infinity());
  vec3 most = vec3(0.0f);
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 4; ++i) {
      ivec2 at = within_picture(frame, first.x - 1 + i, first.y - 1 + j);
      vec3 radiance = fetch_history(history, at).radiance;
      sum += across[i] * down[j] * radiance;
      bool is_near = (i == 1 || i == 2) && (j == 1 || j == 2);
      if (is_near) {
        least = min(least, radiance);
        most = max(most, radiance);
      }
    }
  }
  return clamp(sum, (1.0f - kMaxOvershoot) * least, (1.0f + kMaxOvershoot) * most);
}

LAMBENT_FN float depth_at(TaaFrame frame, TaaPictureRef picture, int x, int y) {
  return fetch_motion(picture, within_picture(frame, x, y)).depth;
}

/// Change of depth from a pixel to the next along its surface, across and down the picture [m].
LAMBENT_FN vec2 depth_steps(TaaFrame frame, TaaPictureRef picture, ivec2 pixel, float depth) {
  // The sky has no slope
  if (depth == infinity()) return vec2(0.0f);
  // At the picture's edge, use the one neighbour for both sides
  int left = pixel.x > 0 ? pixel.x - 1 : pixel.x + 1;
  int right = pixel.x < frame.width - 1 ? pixel.x + 1 : pixel.x - 1;
  int above = pixel.y > 0 ? pixel.y - 1 : pixel.y + 1;
  int below = pixel.y < frame.height - 1 ? pixel.y + 1 : pixel.y - 1;
  return vec2(depth_step(depth_at(frame, picture, left, pixel.y), depth,
                         depth_at(frame, picture, right, pixel.y)),
              depth_step(depth_at(frame, picture, pixel.x, above), depth,
                         depth_at(frame, picture, pixel.x, below)));
}

/// Difference of depth between what is two pixels away on either side, across and down [m]. It is
/// large on slopes and at edges, but not at things about as wide as a pixel, which end between.
LAMBENT_FN vec2 depths_across(TaaFrame frame, TaaPictureRef picture, ivec2 pixel) {
  float right = depth_at(frame, picture, pixel.x + 2, pixel.y);
  float left = depth_at(frame, picture, pixel.x - 2, pixel.y);
  float below = depth_at(frame, picture, pixel.x, pixel.y + 2);
  float above = depth_at(frame, picture, pixel.x, pixel.y - 2);
  // Of two infinite depths there is no difference
  return vec2(right == left ? 0.0f : abs(right - left), below == above ? 0.0f : abs(below - above));
}

/// How far depths of one surface may differ between the positions of its samples in a pixel.
LAMBENT_FN DepthSlack depth_slack(vec2 steps, vec2 across) {
  // Beside an edge the steps are small, and at a thin thing what is across it is
  vec2 slopes = min(steps, across);
  DepthSlack slack = {kDepthSteps * (slopes.x + slopes.y), kAcrossSlack * (across.x + across.y)};
  return slack;
}

/// The history that a pixel keeps.
struct KeptHistory {
  vec3 radiance;  ///< Compressed; see compress_radiance.
  float frames;   ///< Number of frames that it counts for.
};

/// Clips the history to the pixel's present neighbourhood. History far outside the box is old
/// light: the farther, the fewer frames it counts for. After an edit of light (`relit`), they fall
/// with the square of the distance; otherwise the cause may be a thin thing that single frames
/// miss.
LAMBENT_FN KeptHistory clipped_history(TaaNeighbourhood around, KeptHistory kept, bool relit) {
  vec3 color = ycocg_from_rgb(kept.radiance);
  float distance = distance_over_box(around, color);
  float outside = max(distance, 1.0f);
  KeptHistory clipped = {rgb_from_ycocg(clip_history(around, color, distance)),
                         kept.frames / (relit ? outside * outside : outside)};
  return clipped;
}

/// The filtered pixel, which is shown and becomes the next frame's history.
LAMBENT_FN TaaPixel resolve_taa(TaaFrame frame, TaaPictureRef picture, TaaHistoryRef history,
                                ivec2 pixel) {
  TaaSurroundings found = look_around(frame, picture, pixel);
  vec3 radiance = radiance_at(picture, pixel);
  PixelMotion own = fetch_motion(picture, pixel);
  float depth = own.depth;
  uint moves = found.nearest.known == kObjectMotion ? 1u : 0u;
  TaaPixel fresh = {
      radiance, depth, depth, moves, 1.0f, pack_samples(radiance, vec3(0.0f)), kMostFramesOfOther};
  if (frame.has_history == 0u || found.nearest.known == 0u) return fresh;

  // Find the point's place in the previous frame, and whether it was visible there
  vec2 place = vec2(float(pixel.x), float(pixel.y)) + vec2(0.5f) + found.nearest.offset;
  bool on_picture = place.x >= 0.0f && place.y >= 0.0f && place.x < float(frame.width) &&
                    place.y < float(frame.height);
  if (!on_picture) return fresh;
  TaaPixel before =
      fetch_history(history, within_picture(frame, int(floor(place.x)), int(floor(place.y))));
  // The history holds the light of a moving thing's edge where the edge was in the previous frame
  if (before.moved > moves) return fresh;
  vec2 steps = depth_steps(frame, picture, pixel, depth);
  float slack = kDepthSteps * (steps.x + steps.y);
  if (was_hidden(found.nearest.depth_before, before.farthest_depth, slack)) return fresh;

  bool rests = found.nearest.offset.x == 0.0f && found.nearest.offset.y == 0.0f;
  // All pixels take their samples at one place, so that some frames miss a thing thinner than a
  // pixel in all of them. The sky rests before a camera that walks, too, but things pass before it;
  // and where something begins to move, the other sample may have shown it
  OtherSample other = {vec3(0.0f), kMostFramesOfOther};
  if (rests && frame.keeps_others != 0u && moves == 0u && own.known != kObjectMotion) {
    DepthSlack of_surface = depth_slack(steps, depths_across(frame, picture, pixel));
    other = follow_other(before, luminance(radiance), depth, of_surface);
  }
  bool mixed = other.age < kMostFramesOfOther;
  vec3 now = compress_radiance(radiance, found.mean);
  float most_frames = rests ? frame.most_frames : kMovingHistoryFrames;
  KeptHistory kept = {compress_radiance(history_at(frame, history, place), found.mean),
                      min(before.frames, most_frames)};
  if (frame.clip_deviations > 0.0f) {
    TaaNeighbourhood around = neighbourhood_at(frame, picture, pixel, found.mean);
    if (mixed) {
      vec3 shown = compress_radiance(luminance(radiance) * other.ratio, found.mean);
      around = include_color(around, ycocg_from_rgb(shown));
    }
    kept = clipped_history(around, kept, frame.relit != 0u);
  }
  vec3 mean = mix(kept.radiance, now, 1.0f / (kept.frames + 1.0f));
  // Some samples hit an edge and others miss it: both depths are remembered for a frame, or as long
  // as the other sample is
  TaaPixel result = {max(expand_radiance(mean, found.mean), vec3(0.0f)),
                     depth,
                     max(depth, mixed ? before.farthest_depth : before.depth),
                     moves,
                     kept.frames + 1.0f,
                     pack_samples(radiance, other.ratio),
                     other.age};
  return result;
}
