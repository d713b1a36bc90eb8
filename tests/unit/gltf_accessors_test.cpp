// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/document/accessors.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "unit/gltf_builder.h"

namespace lambent::gltf::gltf_accessors_test {
namespace {

using test::error_of;
using test::GltfBuilder;
using test::Json;
using testing::ElementsAre;
using testing::HasSubstr;

Expected<Elements> decode(const GltfBuilder& builder, int accessor) {
  const auto file = builder.glb();
  Expected<Document> document = read_document(file, "", false);
  if (!document) return tl::unexpected(document.error());
  return read_elements(*document, accessor);
}

template <class T>
std::vector<float> round_trip(const std::vector<T>& values, bool normalized) {
  GltfBuilder builder;
  const int accessor = builder.accessor(values, "SCALAR", normalized);
  const Expected<Elements> elements = decode(builder, accessor);
  return elements ? elements->values : std::vector<float>();
}

TEST(GltfAccessors, DecodeEveryComponentType) {
  EXPECT_THAT(round_trip<std::int8_t>({-128, 0, 127}, false), ElementsAre(-128.0f, 0.0f, 127.0f));
  EXPECT_THAT(round_trip<std::uint8_t>({0, 128, 255}, false), ElementsAre(0.0f, 128.0f, 255.0f));
  EXPECT_THAT(round_trip<std::int16_t>({-32768, 7, 32767}, false),
              ElementsAre(-32768.0f, 7.0f, 32767.0f));
  EXPECT_THAT(round_trip<std::uint16_t>({0, 65535}, false), ElementsAre(0.0f, 65535.0f));
  EXPECT_THAT(round_trip<std::uint32_t>({0, 16777216}, false), ElementsAre(0.0f, 16777216.0f));
  EXPECT_THAT(round_trip<float>({-1.5f, 1e30f}, false), ElementsAre(-1.5f, 1e30f));
}

TEST(GltfAccessors, NormalizedIntegersSpanTheUnitRange) {
  EXPECT_THAT(round_trip<std::int8_t>({-128, -127, 0, 127}, true),
              ElementsAre(-1.0f, -1.0f, 0.0f, 1.0f));
  EXPECT_THAT(round_trip<std::uint8_t>({0, 51, 255}, true), ElementsAre(0.0f, 0.2f, 1.0f));
  EXPECT_THAT(round_trip<std::int16_t>({-32768, -32767, 32767}, true),
              ElementsAre(-1.0f, -1.0f, 1.0f));
  EXPECT_THAT(round_trip<std::uint16_t>({0, 13107, 65535}, true), ElementsAre(0.0f, 0.2f, 1.0f));
}

TEST(GltfAccessors, HonourStrideAndOffsets) {
  GltfBuilder builder;
  const int view = builder.view<float>({9, 1, 2, 9, 3, 4, 9, 5, 6}, 12);
  builder.append("accessors", {{"bufferView", view},
                               {"byteOffset", 4},
                               {"componentType", 5126},
                               {"count", 3},
                               {"type", "VEC2"}});
  const Expected<Elements> elements = decode(builder, 0);
  ASSERT_TRUE(elements) << error_of(elements);
  EXPECT_THAT(elements->values, ElementsAre(1, 2, 3, 4, 5, 6));
}

TEST(GltfAccessors, MatrixColumnsStartAtMultiplesOfFourBytes) {
  GltfBuilder builder;
  const int view = builder.view<std::uint8_t>({1, 2, 3, 0, 4, 5, 6, 0, 7, 8, 9, 0});
  builder.append("accessors",
                 {{"bufferView", view}, {"componentType", 5121}, {"count", 1}, {"type", "MAT3"}});
  const Expected<Elements> elements = decode(builder, 0);
  ASSERT_TRUE(elements) << error_of(elements);
  EXPECT_THAT(elements->values, ElementsAre(1, 2, 3, 4, 5, 6, 7, 8, 9));
}

Json sparse_of(int count, int indices, int component_type, int values) {
  return {{"count", count},
          {"indices", {{"bufferView", indices}, {"componentType", component_type}}},
          {"values", {{"bufferView", values}}}};
}

TEST(GltfAccessors, SparseReplacesElements) {
  GltfBuilder builder;
  const int accessor = builder.accessor<float>({0, 1, 2, 3}, "SCALAR");
  const int indices = builder.view<std::uint16_t>({1, 3});
  const int values = builder.view<float>({10, 30});
  builder.root["accessors"][accessor]["sparse"] = sparse_of(2, indices, 5123, values);
  const Expected<Elements> elements = decode(builder, accessor);
  ASSERT_TRUE(elements) << error_of(elements);
  EXPECT_THAT(elements->values, ElementsAre(0, 10, 2, 30));
}

TEST(GltfAccessors, SparseWithoutBufferViewStartsFromZeros) {
  GltfBuilder builder;
  const int indices = builder.view<std::uint8_t>({2});
  const int values = builder.view<float>({5});
  builder.append("accessors", {{"componentType", 5126},
                               {"count", 3},
                               {"type", "SCALAR"},
                               {"sparse", sparse_of(1, indices, 5121, values)}});
  const Expected<Elements> elements = decode(builder, 0);
  ASSERT_TRUE(elements) << error_of(elements);
  EXPECT_THAT(elements->values, ElementsAre(0, 0, 5));
}

TEST(GltfAccessors, SparseIndexOutOfRangeIsAnError) {
  GltfBuilder builder;
  const int accessor = builder.accessor<float>({0, 1}, "SCALAR");
  const int indices = builder.view<std::uint32_t>({2});
  const int values = builder.view<float>({5});
  builder.root["accessors"][accessor]["sparse"] = sparse_of(1, indices, 5125, values);
  EXPECT_THAT(error_of(decode(builder, accessor)), HasSubstr("accessors[0].sparse.indices"));
}

TEST(GltfAccessors, ReachingBeyondTheViewIsAnError) {
  GltfBuilder builder;
  const int accessor = builder.accessor<float>({0, 1, 2}, "SCALAR");
  builder.root["accessors"][accessor]["count"] = 4;
  EXPECT_THAT(error_of(decode(builder, accessor)),
              HasSubstr("accessors[0]: 4 elements do not fit"));
  builder.root["accessors"][accessor]["count"] = 3;
  builder.root["accessors"][accessor]["byteOffset"] = 4;
  EXPECT_THAT(error_of(decode(builder, accessor)), HasSubstr("accessors[0]"));
}

TEST(GltfAccessors, AbsurdCountsFailBeforeAnyAllocation) {
  for (const std::uint64_t count : {std::uint64_t{1} << 30, (std::uint64_t{1} << 53) - 1}) {
    GltfBuilder builder;
    const int accessor = builder.accessor<float>({0, 1, 2}, "SCALAR");
    builder.root["accessors"][accessor]["count"] = count;
    EXPECT_THAT(error_of(decode(builder, accessor)), HasSubstr("accessors[0]"));
    builder.root["accessors"][accessor].erase("bufferView");
    EXPECT_THAT(error_of(decode(builder, accessor)), HasSubstr("absurd count"));
  }
}

TEST(GltfAccessors, NumbersThatAreNotFiniteAreErrors) {
  for (const float value :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    GltfBuilder builder;
    const int accessor = builder.accessor<float>({0, 1, value}, "SCALAR");
    EXPECT_THAT(error_of(decode(builder, accessor)), HasSubstr("accessors[0]: element 2"));
  }
}

TEST(GltfAccessors, IndicesMustBeUnsignedScalars) {
  GltfBuilder builder;
  const int floats = builder.accessor<float>({0, 1, 2}, "SCALAR");
  const int bytes = builder.accessor<std::uint8_t>({0, 255, 2}, "SCALAR");
  const auto file = builder.glb();
  const Expected<Document> document = read_document(file, "", false);
  ASSERT_TRUE(document) << error_of(document);
  EXPECT_THAT(error_of(read_indices(*document, floats)), HasSubstr("accessors[0]"));
  const auto indices = read_indices(*document, bytes);
  ASSERT_TRUE(indices) << error_of(indices);
  EXPECT_THAT(*indices, ElementsAre(0u, 255u, 2u));
}

}  // namespace
}  // namespace lambent::gltf::gltf_accessors_test
