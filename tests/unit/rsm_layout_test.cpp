// SPDX-License-Identifier: Apache-2.0
// Where pixels and texels land when they are restructured.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

#include "rsm/deinterleave.h"
#include "rsm/gather.h"
#include "rsm/maps/lights.h"
#include "rsm/mosaic.h"
#include "rsm/passes.h"
#include "support/field_scenes.h"

namespace lambent::rsm_layout_test {
namespace {

/// A view whose normals are all different, so that a pixel tells where it came from.
struct NumberedView {
  NumberedView(int w, int h) : width(w), height(h) {
    for (int i = 0; i < w * h; ++i) {
      const auto number = static_cast<float>(i);
      positions.emplace_back(number, 2.0f * number, -number);
      normals.emplace_back(number + 1.0f, 0.5f, number);
      depths.push_back(1.0f + number);
    }
  }
  RsmView view() const { return {width, height, positions, normals, depths}; }
  int width, height;
  std::vector<vec3> positions, normals;
  std::vector<float> depths;
};

void restructure_view(const RsmView& view, Mosaic& mosaic) {
  const int m = mosaic.sub_images();
  for (int y = 0; y < mosaic.layout().height * m; ++y) mosaic.fill_row(view, y);
}

TEST(RsmDeinterleave, MapsEveryPixelToAPlaceOfItsOwnAndBack) {
  for (const int m : {1, 2, 3, 4, 7, 16}) {
    for (const ivec2 size : {ivec2(1, 1), ivec2(3, 2), ivec2(37, 23), ivec2(16, 16)}) {
      std::set<std::pair<int, int>> taken;
      for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
          const ivec2 sub = sub_image_of({x, y}, m), place = place_in_sub_image({x, y}, m);
          EXPECT_EQ(pixel_of_sub_image(sub, place, m), ivec2(x, y));
          EXPECT_LT(place.x, sub_image_size(size.x, sub.x, m));
          EXPECT_LT(place.y, sub_image_size(size.y, sub.y, m));
          const int column = sub_image_start(size.x, sub.x, m) + place.x;
          const int row = sub_image_start(size.y, sub.y, m) + place.y;
          EXPECT_LT(column, size.x);
          EXPECT_LT(row, size.y);
          EXPECT_TRUE(taken.emplace(column, row).second) << "two pixels at one place";
        }
      }
    }
  }
}

TEST(RsmDeinterleave, RestructuringThenInterleavingIsTheIdentityAtEverySize) {
  RsmSettings settings;
  Mosaic mosaic;
  for (const int m : {1, 3, 4}) {
    settings.sub_images = m;
    settings.sub_blur_radius = 0;
    settings.final_blur = false;
    for (int height = 1; height <= 23; ++height) {
      for (int width = 1; width <= 37; ++width) {
        const NumberedView view(width, height);
        mosaic.reshape(width, height, m, 2 * m);
        restructure_view(view.view(), mosaic);
        // Let the light of each pixel be its position
        for (int j = 0; j < m; ++j) {
          for (int i = 0; i < m; ++i) {
            for (int row = 0; row < sub_image_size(height, j, m); ++row) {
              const ConstPlanes guide = mosaic.guide(i, j, row);
              const Planes light = mosaic.light(Mosaic::Light::current, i, j, row);
              for (int c = 0; c < 3; ++c) {
                std::copy_n(guide.at(kPositionPlane + c), sub_image_size(width, i, m), light.at(c));
              }
            }
          }
        }
        std::vector<vec3> picture(view.positions.size(), vec3(-1.0f));
        interleave({}, settings, mosaic, picture);
        ASSERT_EQ(picture, view.positions) << width << "x" << height << ", " << m;
      }
    }
  }
}

TEST(RsmDeinterleave, FindsTheSameNeighboursWhetherRestructuredOrNot) {
  const NumberedView view(19, 11);
  Mosaic whole, parts;
  whole.reshape(19, 11, 1, 6);
  parts.reshape(19, 11, 4, 6);
  restructure_view(view.view(), whole);
  restructure_view(view.view(), parts);
  for (int y = 0; y < 11; ++y) {
    for (int x = 0; x < 19; ++x) {
      for (const ivec2 step :
           {ivec2(-5, 0), ivec2(-1, 0), ivec2(2, 0), ivec2(0, -3), ivec2(0, 6)}) {
        const ConstPlanes a = whole.guide(0, 0, y, step.x, step.y);
        const ConstPlanes b = parts.guide(x % 4, y % 4, y / 4, step.x, step.y);
        EXPECT_EQ(a.at(kPositionPlane)[x], b.at(kPositionPlane)[x / 4]) << x << "," << y;
        EXPECT_EQ(a.at(kInverseDepthPlane)[x], b.at(kInverseDepthPlane)[x / 4]) << x << "," << y;
      }
    }
  }
}

ReflectiveShadowMap numbered_map(int resolution) {
  ReflectiveShadowMap map;
  map.resolution = resolution;
  map.texels.resize(static_cast<std::size_t>(resolution) * resolution);
  for (std::size_t i = 0; i < map.texels.size(); ++i) {
    RsmTexel& texel = map.texels[i];
    texel.position_ws = vec3(static_cast<float>(i % resolution), 0.0f,
                             static_cast<float>(i) / static_cast<float>(resolution));
    texel.normal_ws = vec3(0.0f, 1.0f, 0.0f);
    texel.area = 1.0f;
    texel.softening = 0.3f;
    texel.flux = vec3(1.0f + static_cast<float>(i), 2.0f, 3.0f);
  }
  return map;
}

TEST(RsmSubMaps, HoldEveryTexelOfTheMapOnce) {
  for (const int resolution : {1, 2, 5, 16, 19}) {
    for (const int n : {1, 3, 4}) {
      const ReflectiveShadowMap map = numbered_map(resolution);
      const std::vector<RsmTexel> restructured = restructure_map(map, n);
      ASSERT_EQ(restructured.size(), map.texels.size());
      for (int y = 0; y < resolution; ++y) {
        for (int x = 0; x < resolution; ++x) {
          const int at = sub_map_texel({x, y}, resolution, n);
          EXPECT_EQ(at, sub_map_start(resolution, n, x % n, y % n) +
                            y / n * sub_image_size(resolution, x % n, n) + x / n);
          EXPECT_EQ(restructured[at].flux,
                    map.texels[static_cast<std::size_t>(y) * resolution + x].flux);
        }
      }
    }
  }
}

TEST(RsmLights, KeepAllLightHoweverManyTheyAre) {
  const NumberedView view(8, 8);
  const ReflectiveShadowMap map = numbered_map(19);
  vec3 all(0.0f);
  for (const RsmTexel& texel : map.texels) all += texel.flux;
  for (const int texels : {0, 1, 7, 64, 1000, 65536}) {
    for (const int n : {1, 3, 4}) {
      RsmSettings settings;
      settings.texels = texels;
      settings.sub_maps = n;
      settings.sub_images = n;
      settings.view_importance = false;
      const RsmLights lights = choose_lights({&map, 1}, view.view(), settings);
      glm::dvec3 sum(0.0);
      for (const RsmTexel& texel : lights.restructured) sum += glm::dvec3(texel.flux);
      sum /= n * n;  // each sub-map stands for all light
      EXPECT_NEAR(sum.x / all.x, 1.0, 1e-4) << texels << ", " << n;
      EXPECT_NEAR(sum.z / all.z, 1.0, 1e-4) << texels << ", " << n;
      for (int s = 0; s < n * n; ++s) EXPECT_EQ(lights.count(s), lights.count(0));
    }
  }
}

TEST(RsmLights, LieInTheRestructuredBufferAsWhereTheyWereRendered) {
  const NumberedView view(8, 8);
  const ReflectiveShadowMap map = numbered_map(128);
  RsmSettings settings;
  EXPECT_TRUE(choose_lights({&map, 1}, view.view(), settings).rendered.empty());  // is not read
  settings.layout = RsmLayout::full;
  const RsmLights lights = choose_lights({&map, 1}, view.view(), settings);
  ASSERT_EQ(lights.rendered.size(), map.texels.size() + 1);
  for (std::size_t k = 0; k < lights.restructured.size(); ++k) {
    EXPECT_EQ(lights.restructured[k].flux, lights.rendered[lights.places[k]].flux);
  }
  std::set<std::uint32_t> places(lights.places.begin(), lights.places.end());
  EXPECT_GT(places.size(), lights.places.size() / 4);
}

TEST(RsmLights, VisitsEveryTexelOfTheMapOnceAlongTheCurve) {
  for (const int resolution : {1, 2, 3, 19, 32}) {
    std::vector<std::uint32_t> order = morton_order(resolution);
    std::sort(order.begin(), order.end());
    ASSERT_EQ(order.size(), static_cast<std::size_t>(resolution) * resolution);
    for (std::uint32_t i = 0; i < order.size(); ++i) EXPECT_EQ(order[i], i);
  }
}

}  // namespace
}  // namespace lambent::rsm_layout_test
