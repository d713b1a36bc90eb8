// SPDX-License-Identifier: Apache-2.0
// The change of a tile's light, in the common subset of C++ and GLSL. The includer provides
//   vec3 fetch_before(int texel)
//   vec3 fetch_now(int texel)
// In C++, this file is included in the body of a struct that has these as members.

/// Compares the light of a tile of `texels` texels with what it was before.
LAMBENT_FN LightChange light_change(int texels) {
  LightChange change = {0.0f, 0.0f, 0.0f};
  for (int t = 0; t < texels; ++t) {
    float difference = luminance(fetch_now(t) - fetch_before(t));
    change.squares += difference * difference;
    change.before += luminance(fetch_before(t));
    change.now += luminance(fetch_now(t));
  }
  change.before /= float(texels);
  change.now /= float(texels);
  return change;
}
