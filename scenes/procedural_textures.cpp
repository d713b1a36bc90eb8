// SPDX-License-Identifier: Apache-2.0
#include "scenes/procedural_textures.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "shared/color.h"
#include "shared/constants.h"
#include "shared/random.h"

namespace lambent::scenes {
namespace {

float smooth(float from, float to, float x) {
  const float t = glm::clamp((x - from) / (to - from), 0.0f, 1.0f);
  return t * t * (3.0f - 2.0f * t);
}

/// A number in [0, 1) for a lattice point and a pattern's seed.
float hash(int x, int y, uint seed) {
  return uniform_from_bits(hash_pcg3d(uvec3(uint(x), uint(y), seed)).x);
}

/// Value noise, 0 to 1, on a lattice of `cells` x `cells` that repeats.
float noise(glm::vec2 p, glm::ivec2 cells, uint seed) {
  const glm::vec2 q = p * glm::vec2(cells);
  const glm::vec2 cell = glm::floor(q);
  const glm::vec2 f = q - cell;
  const glm::vec2 w = f * f * (3.0f - 2.0f * f);
  const auto wrap = [](int i, int n) { return (i % n + n) % n; };
  const int x0 = wrap(static_cast<int>(cell.x), cells.x), x1 = wrap(x0 + 1, cells.x);
  const int y0 = wrap(static_cast<int>(cell.y), cells.y), y1 = wrap(y0 + 1, cells.y);
  return glm::mix(glm::mix(hash(x0, y0, seed), hash(x1, y0, seed), w.x),
                  glm::mix(hash(x0, y1, seed), hash(x1, y1, seed), w.x), w.y);
}

/// Octaves of noise, each twice as fine and half as strong; about 0 to 1.
float fractal_noise(glm::vec2 p, glm::ivec2 cells, int octaves, uint seed) {
  float sum = 0.0f, weight = 0.5f, total = 0.0f;
  for (int i = 0; i < octaves; ++i) {
    sum += weight * noise(p, cells, seed + static_cast<uint>(i));
    total += weight;
    weight *= 0.5f;
    cells *= 2;
  }
  return sum / total;
}

/// A cell of a bond of rectangular pieces, and the position of a point in it.
struct Piece {
  int column, row;  // which piece, for hashing
  float edge;       // distance to the nearest joint [tiles]
};

/// Running bond: `rows` courses of `columns` pieces, every second course shifted by half a piece.
Piece running_bond(glm::vec2 p, int columns, int rows, float shift) {
  const float y = p.y * rows;
  const int row = static_cast<int>(std::floor(y));
  const float x = p.x * columns + (row % 2 != 0 ? shift : 0.0f);
  const int column = static_cast<int>(std::floor(x));
  const float fx = x - std::floor(x), fy = y - std::floor(y);
  const float edge_x = std::min(fx, 1.0f - fx) / columns;
  const float edge_y = std::min(fy, 1.0f - fy) / rows;
  return {(column % columns + columns) % columns, row, std::min(edge_x, edge_y)};
}

std::uint8_t to_byte(float v) {
  return static_cast<std::uint8_t>(std::lround(255.0f * glm::clamp(v, 0.0f, 1.0f)));
}

Texture blank(const std::string& name, int size, bool srgb) {
  Texture texture;
  texture.name = name;
  texture.srgb = srgb;
  texture.levels.push_back({size, size, std::vector<std::uint8_t>(4ull * size * size, 255)});
  return texture;
}

void put(Texture& texture, std::size_t pixel, const glm::vec3& encoded) {
  for (int c = 0; c < 3; ++c) texture.levels[0].rgba[4 * pixel + c] = to_byte(encoded[c]);
}

}  // namespace

TextureSet bake(const std::string& name, int size, float metres_a_tile, const Pattern& pattern) {
  TextureSet set{blank(name + "_color", size, true), blank(name + "_normal", size, false),
                 blank(name + "_roughness", size, false)};
  std::vector<float> heights(static_cast<std::size_t>(size) * size);
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const std::size_t pixel = static_cast<std::size_t>(y) * size + x;
      const Texel texel = pattern((glm::vec2(x, y) + 0.5f) / static_cast<float>(size));
      const glm::vec3 c = texel.color;
      put(set.color, pixel, {srgb_from_linear(c.x), srgb_from_linear(c.y), srgb_from_linear(c.z)});
      put(set.roughness, pixel, {1.0f, texel.roughness, 0.0f});
      heights[pixel] = texel.height;
    }
  }
  // Slopes from central differences around the torus; rows run down while +Y points up.
  const auto height = [&](int x, int y) {
    return heights[static_cast<std::size_t>((y + size) % size) * size + (x + size) % size];
  };
  const float per_metre = static_cast<float>(size) / (2.0f * metres_a_tile);
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const float right = (height(x + 1, y) - height(x - 1, y)) * per_metre;
      const float up = (height(x, y - 1) - height(x, y + 1)) * per_metre;
      const glm::vec3 n = glm::normalize(glm::vec3(-right, -up, 1.0f));
      put(set.normal, static_cast<std::size_t>(y) * size + x, 0.5f * n + 0.5f);
    }
  }
  for (Texture* texture : {&set.color, &set.roughness}) build_mips(*texture);
  build_normal_mips(set.normal);
  return set;
}

Texel sandstone_blocks(glm::vec2 p) {
  const float wobble = 0.004f * (fractal_noise(p, {12, 12}, 2, 11) - 0.5f);
  const Piece block = running_bond(p, 2, 4, 0.5f);
  const float tone = hash(block.column, block.row, 21);
  const float hue = hash(block.column, block.row, 22);
  const float grain = fractal_noise(p, {48, 48}, 3, 31);
  const float cloud = fractal_noise(p, {5, 7}, 4, 41);
  const float strata = noise({p.x, p.y + 0.02f * cloud}, {3, 60}, 51);
  const float joint = 1.0f - smooth(0.0025f, 0.007f, block.edge + wobble);
  glm::vec3 color = glm::mix(glm::vec3(0.46f, 0.335f, 0.205f), glm::vec3(0.60f, 0.475f, 0.325f),
                             0.55f * tone + 0.45f * cloud);
  color *= glm::mix(glm::vec3(1.0f), glm::vec3(1.04f, 0.97f, 0.90f), hue);
  color *= 0.84f + 0.22f * grain + 0.08f * (strata - 0.5f);
  color = glm::mix(color, glm::vec3(0.34f, 0.28f, 0.21f), 0.75f * joint);
  const float height = -0.007f * joint + 0.0015f * grain + 0.003f * cloud + 0.003f * tone;
  return {color, height, 0.82f + 0.12f * grain};
}

Texel limestone(glm::vec2 p) {
  const float cloud = fractal_noise(p, {4, 4}, 5, 61);
  const float grain = fractal_noise(p, {64, 64}, 2, 71);
  const float pit = smooth(0.74f, 0.86f, noise(p, {90, 70}, 81));
  glm::vec3 color =
      glm::mix(glm::vec3(0.46f, 0.39f, 0.29f), glm::vec3(0.60f, 0.535f, 0.425f), cloud);
  color *= (0.93f + 0.12f * grain) * (1.0f - 0.14f * pit);
  return {color, 0.0007f * grain + 0.002f * cloud - 0.0009f * pit, 0.62f + 0.2f * grain};
}

Texel marble_checker(glm::vec2 p) {
  constexpr int kSquares = 4;
  const Piece square = running_bond(p, kSquares, kSquares, 0.0f);
  const bool cream = (square.column + square.row) % 2 == 0;
  // Veins are where a warped wave crosses zero; every square is cut from another place of the
  // block.
  const glm::vec2 cut(hash(square.column, square.row, 91), hash(square.column, square.row, 92));
  const glm::vec2 q = glm::fract(p + cut);
  const float warp = fractal_noise(q, {4, 4}, 5, 101);
  const float wave = std::abs(std::sin(kTwoPi * (2.0f * q.x + q.y + 1.6f * warp)));
  const float vein = 1.0f - smooth(0.0f, 0.16f, wave);
  const float cloud = fractal_noise(q, {8, 8}, 4, 111);
  const glm::vec3 stone =
      cream ? glm::mix(glm::vec3(0.62f, 0.57f, 0.47f), glm::vec3(0.74f, 0.70f, 0.61f), cloud)
            : glm::mix(glm::vec3(0.26f, 0.095f, 0.055f), glm::vec3(0.40f, 0.17f, 0.10f), cloud);
  const glm::vec3 veins = cream ? glm::vec3(0.47f, 0.41f, 0.33f) : glm::vec3(0.52f, 0.36f, 0.27f);
  const float joint = 1.0f - smooth(0.0008f, 0.0022f, square.edge);
  glm::vec3 color = glm::mix(stone, veins, 0.55f * vein);
  color = glm::mix(color, glm::vec3(0.22f, 0.19f, 0.15f), joint);
  const float scuff = fractal_noise(p, {6, 6}, 4, 121);
  return {color, -0.0008f * joint, glm::mix(0.22f + 0.25f * scuff, 0.8f, joint)};
}

Texel flagstones(glm::vec2 p) {
  // Courses of three heights; flags of each course have their own width.
  constexpr std::array<float, 5> kCourse{0.0f, 0.28f, 0.5f, 0.72f, 1.0f};
  constexpr std::array<int, 4> kFlags{3, 4, 5, 3};
  const auto row = static_cast<int>(std::upper_bound(kCourse.begin() + 1, kCourse.end() - 1, p.y) -
                                    kCourse.begin() - 1);
  const int flags = kFlags[row];
  const float x = p.x * flags + hash(row, 0, 131);
  const int column = static_cast<int>(std::floor(x)) % flags;
  const float fx = x - std::floor(x);
  const float edge =
      std::min({fx / flags, (1.0f - fx) / flags, p.y - kCourse[row], kCourse[row + 1] - p.y});
  const float ragged = edge + 0.006f * (fractal_noise(p, {24, 24}, 2, 141) - 0.5f);
  const float joint = 1.0f - smooth(0.002f, 0.008f, ragged);
  const float tone = hash(column, row, 151);
  const float cloud = fractal_noise(p, {6, 6}, 5, 161);
  const float grain = fractal_noise(p, {80, 80}, 2, 171);
  glm::vec3 color = glm::mix(glm::vec3(0.36f, 0.315f, 0.25f), glm::vec3(0.54f, 0.475f, 0.385f),
                             0.6f * tone + 0.4f * cloud);
  color *= 0.88f + 0.2f * grain;
  color = glm::mix(color, glm::vec3(0.19f, 0.17f, 0.125f), 0.8f * joint);
  const float height = -0.006f * joint + 0.0012f * grain + 0.004f * cloud + 0.002f * tone;
  return {color, height, 0.66f + 0.22f * cloud};
}

Texel plaster(glm::vec2 p) {
  const float cloud = fractal_noise(p, {3, 3}, 5, 181);
  const float trowel = fractal_noise({p.x + 0.05f * cloud, p.y}, {14, 22}, 3, 191);
  const float grain = noise(p, {160, 160}, 201);
  const float stain = smooth(0.55f, 0.85f, fractal_noise(p, {5, 2}, 4, 211));
  glm::vec3 color = glm::mix(glm::vec3(0.66f, 0.53f, 0.35f), glm::vec3(0.76f, 0.66f, 0.49f), cloud);
  color *= 0.95f + 0.06f * trowel + 0.03f * grain;
  color = glm::mix(color, glm::vec3(0.56f, 0.42f, 0.27f), 0.45f * stain);
  return {color, 0.0035f * trowel + 0.0006f * grain, 0.9f};
}

Texel wood_planks(glm::vec2 p) {
  constexpr int kPlanks = 6;
  const float x = p.x * kPlanks;
  const int plank = static_cast<int>(std::floor(x));
  const float fx = x - std::floor(x);
  const float gap = 1.0f - smooth(0.015f, 0.05f, std::min(fx, 1.0f - fx));
  const glm::vec2 q = glm::fract(p + glm::vec2(0.0f, hash(plank, 0, 221)));
  const float bend = fractal_noise(q, {12, 3}, 3, 231);
  const float rings =
      0.5f + 0.5f * std::sin(kTwoPi * (5.0f * fx + 3.0f * bend + hash(plank, 1, 221)));
  const float fibre = fractal_noise(q, {160, 6}, 2, 241);
  glm::vec3 color = glm::mix(glm::vec3(0.155f, 0.075f, 0.032f), glm::vec3(0.30f, 0.165f, 0.08f),
                             0.45f * rings + 0.55f * fibre);
  color *= 0.8f + 0.4f * hash(plank, 2, 221);
  color *= 1.0f - 0.75f * gap;
  return {color, -0.004f * gap + 0.0008f * fibre + 0.0004f * rings, 0.5f + 0.25f * fibre};
}

Texel terracotta(glm::vec2 p) {
  const float cloud = fractal_noise(p, {4, 4}, 5, 251);
  const float grain = fractal_noise(p, {60, 60}, 2, 261);
  const float bloom = smooth(0.52f, 0.8f, fractal_noise(p, {7, 7}, 4, 271));
  glm::vec3 color =
      glm::mix(glm::vec3(0.38f, 0.135f, 0.065f), glm::vec3(0.56f, 0.235f, 0.125f), cloud);
  color *= 0.86f + 0.24f * grain;
  color = glm::mix(color, glm::vec3(0.55f, 0.40f, 0.30f), 0.4f * bloom);
  return {color, 0.001f * grain + 0.002f * cloud, 0.78f + 0.15f * grain};
}

Texel woven_fabric(glm::vec2 p, const glm::vec3& ground, const glm::vec3& stripe) {
  constexpr int kThreads = 96;
  const glm::vec2 q = p * static_cast<float>(kThreads);
  const glm::ivec2 thread(glm::floor(q));
  const glm::vec2 f = glm::fract(q) - 0.5f;
  // Warp and weft take turns on top; the one on top shows its round back.
  const bool warp_on_top = (thread.x + thread.y) % 2 == 0;
  const float across = warp_on_top ? f.x : f.y, along = warp_on_top ? f.y : f.x;
  const float back = std::cos(kPi * across) * (0.6f + 0.4f * std::cos(kPi * along));
  // A stripe between two hairlines, once a tile
  const float offset = std::abs(p.x - 0.5f);
  const float band = 1.0f - smooth(0.026f, 0.03f, offset);
  const float line = smooth(0.046f, 0.049f, offset) * (1.0f - smooth(0.055f, 0.058f, offset));
  const float worn = fractal_noise(p, {4, 4}, 4, 281);
  glm::vec3 color = glm::mix(ground, stripe, std::max(band, line));
  color *= (0.72f + 0.28f * back) * (0.88f + 0.2f * worn);
  return {color, 0.0008f * back, 0.92f};
}

}  // namespace lambent::scenes
