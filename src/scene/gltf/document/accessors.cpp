// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/document/accessors.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <type_traits>

namespace lambent::gltf {
namespace {

// Accessors without a buffer view are all zeros and cost the file nothing; more than this is an
// attack.
constexpr std::size_t kMaxZeroElements = std::size_t{1} << 22;

// The size of one element and the layout of its components.
struct Layout {
  int component_type = 0;
  std::size_t component_bytes = 0;
  int rows = 1;     // Components of a column
  int columns = 1;  // Of a matrix; else 1
  std::size_t column_bytes = 0;

  int components() const { return rows * columns; }
  std::size_t element_bytes() const { return column_bytes * columns; }
};

std::size_t component_bytes(int type) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return 4;
    default:
      return 0;
  }
}

Expected<Layout> layout_of(const Document& document, int index) {
  const tinygltf::Accessor& accessor = document.model.accessors[index];
  Layout layout;
  layout.component_type = accessor.componentType;
  layout.component_bytes = component_bytes(accessor.componentType);
  if (layout.component_bytes == 0) {
    return document.fail_at(
        entry("accessors", index),
        "componentType " + std::to_string(accessor.componentType) + " does not exist");
  }
  switch (accessor.type) {
    case TINYGLTF_TYPE_VEC2:
      layout.rows = 2;
      break;
    case TINYGLTF_TYPE_VEC3:
      layout.rows = 3;
      break;
    case TINYGLTF_TYPE_VEC4:
      layout.rows = 4;
      break;
    case TINYGLTF_TYPE_MAT2:
      layout.rows = layout.columns = 2;
      break;
    case TINYGLTF_TYPE_MAT3:
      layout.rows = layout.columns = 3;
      break;
    case TINYGLTF_TYPE_MAT4:
      layout.rows = layout.columns = 4;
      break;
    default:
      break;
  }
  // Columns of a matrix start at multiples of 4 bytes (specification, sec. 3.6.2.4)
  layout.column_bytes = layout.component_bytes * layout.rows;
  if (layout.columns > 1) layout.column_bytes = (layout.column_bytes + 3) / 4 * 4;
  return layout;
}

template <class T>
T load(const std::uint8_t* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return value;
}

// Specification, sec. 3.11: signed values are divided by their largest, and the smallest is -1 too.
template <class T>
float to_float(const std::uint8_t* bytes, bool normalized) {
  const T value = load<T>(bytes);
  if constexpr (!std::is_same_v<T, float>) {
    if (normalized) {
      const float unit =
          static_cast<float>(value) / static_cast<float>(std::numeric_limits<T>::max());
      return std::max(unit, -1.0f);
    }
  }
  return static_cast<float>(value);
}

float component(const std::uint8_t* bytes, int type, bool normalized) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return to_float<std::int8_t>(bytes, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return to_float<std::uint8_t>(bytes, normalized);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return to_float<std::int16_t>(bytes, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return to_float<std::uint16_t>(bytes, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return to_float<std::uint32_t>(bytes, normalized);
    default:
      return to_float<float>(bytes, false);
  }
}

std::uint32_t index_value(const std::uint8_t* bytes, int type) {
  if (type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE) return *bytes;
  if (type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT) return load<std::uint16_t>(bytes);
  return load<std::uint32_t>(bytes);
}

bool is_index_type(int type) {
  return type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
         type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
         type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

// Elements at distances of `stride` bytes, all within their buffer view.
struct Strided {
  const std::uint8_t* first = nullptr;
  std::size_t stride = 0;
  std::size_t count = 0;

  const std::uint8_t* operator[](std::size_t i) const { return first + i * stride; }
};

Expected<Strided> find_elements(const Document& document, const std::string& place, int view,
                                std::size_t offset, std::size_t stride, std::size_t element_bytes,
                                std::size_t count) {
  LAMBENT_TRY(bytes, view_bytes(document, view));
  if (stride < element_bytes) {
    return document.fail_at(place,
                            entry("bufferViews", view) + ".byteStride is smaller than an element");
  }
  // Divide instead of multiplying, so that no count causes an overflow
  const std::size_t room = offset <= bytes.size() ? bytes.size() - offset : 0;
  const bool fits = room >= element_bytes && count - 1 <= (room - element_bytes) / stride;
  if (!fits) {
    return document.fail_at(
        place, std::to_string(count) + " elements do not fit into " + entry("bufferViews", view));
  }
  return Strided{bytes.data() + offset, stride, count};
}

// The accessor's own elements; none where it has no buffer view.
Expected<Strided> dense_elements(const Document& document, int index, const Layout& layout) {
  const tinygltf::Accessor& accessor = document.model.accessors[index];
  const std::string place = entry("accessors", index);
  if (accessor.bufferView < 0) {
    if (accessor.count > kMaxZeroElements) {
      return document.fail_at(place, "has an absurd count of " + std::to_string(accessor.count) +
                                         " without a buffer view");
    }
    return Strided{nullptr, 0, accessor.count};
  }
  const std::size_t own_stride = document.model.bufferViews[accessor.bufferView].byteStride;
  const std::size_t stride = own_stride ? own_stride : layout.element_bytes();
  return find_elements(document, place, accessor.bufferView, accessor.byteOffset, stride,
                       layout.element_bytes(), accessor.count);
}

// Calls `replace(i, bytes)` for each sparse element.
template <class Replace>
Expected<void> for_each_sparse(const Document& document, int index, const Layout& layout,
                               Replace replace) {
  const tinygltf::Accessor& accessor = document.model.accessors[index];
  if (!accessor.sparse.isSparse) return {};
  const std::string place = entry("accessors", index) + ".sparse";
  const auto count = static_cast<std::size_t>(accessor.sparse.count);
  const int index_type = accessor.sparse.indices.componentType;
  if (!is_index_type(index_type)) {
    return document.fail_at(place + ".indices", "componentType cannot be that of indices");
  }
  LAMBENT_TRY(indices,
              find_elements(document, place + ".indices", accessor.sparse.indices.bufferView,
                            static_cast<std::size_t>(accessor.sparse.indices.byteOffset),
                            component_bytes(index_type), component_bytes(index_type), count));
  LAMBENT_TRY(values, find_elements(document, place + ".values", accessor.sparse.values.bufferView,
                                    static_cast<std::size_t>(accessor.sparse.values.byteOffset),
                                    layout.element_bytes(), layout.element_bytes(), count));
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t element = index_value(indices[i], index_type);
    if (element >= accessor.count) {
      return document.fail_at(place + ".indices",
                              "index " + std::to_string(element) + " is out of range");
    }
    replace(element, values[i]);
  }
  return {};
}

}  // namespace

bool is_finite(const Elements& elements, std::size_t element) {
  const float* first = elements[element];
  return std::all_of(first, first + elements.components, [](float v) { return std::isfinite(v); });
}

Expected<void> check_finite(const Document& document, const Elements& elements,
                            const std::string& place) {
  for (std::size_t i = 0; i < elements.size(); ++i) {
    if (is_finite(elements, i)) continue;
    return document.fail_at(place,
                            "element " + std::to_string(i) + " holds a number that is not finite");
  }
  return {};
}

Expected<Elements> read_raw_elements(const Document& document, int index) {
  const tinygltf::Accessor& accessor = document.model.accessors[index];
  LAMBENT_TRY(layout, layout_of(document, index));
  LAMBENT_TRY(dense, dense_elements(document, index, layout));

  Elements elements;
  elements.components = layout.components();
  elements.values.resize(accessor.count * elements.components);
  const auto decode = [&](std::size_t i, const std::uint8_t* bytes) {
    float* out = elements.values.data() + i * elements.components;
    for (int column = 0; column < layout.columns; ++column) {
      for (int row = 0; row < layout.rows; ++row) {
        *out++ = component(bytes + column * layout.column_bytes + row * layout.component_bytes,
                           layout.component_type, accessor.normalized);
      }
    }
  };
  if (dense.first) {
    for (std::size_t i = 0; i < dense.count; ++i) decode(i, dense[i]);
  }
  LAMBENT_CHECK(for_each_sparse(document, index, layout, decode));
  return elements;
}

Expected<Elements> read_elements(const Document& document, int index) {
  LAMBENT_TRY(elements, read_raw_elements(document, index));
  LAMBENT_CHECK(check_finite(document, elements, entry("accessors", index)));
  return std::move(elements);
}

Expected<Elements> read_elements(const Document& document, int index, int components) {
  Expected<Elements> elements = read_elements(document, index);
  if (elements && elements->components != components) {
    return document.fail_at(entry("accessors", index),
                            "has " + std::to_string(elements->components) + " components where " +
                                std::to_string(components) + " are needed");
  }
  return elements;
}

Expected<std::vector<std::uint32_t>> read_indices(const Document& document, int index) {
  const tinygltf::Accessor& accessor = document.model.accessors[index];
  if (accessor.type != TINYGLTF_TYPE_SCALAR || !is_index_type(accessor.componentType)) {
    return document.fail_at(entry("accessors", index), "has a type that cannot be that of indices");
  }
  LAMBENT_TRY(layout, layout_of(document, index));
  LAMBENT_TRY(dense, dense_elements(document, index, layout));
  std::vector<std::uint32_t> indices(accessor.count);
  const auto decode = [&](std::size_t i, const std::uint8_t* bytes) {
    indices[i] = index_value(bytes, layout.component_type);
  };
  if (dense.first) {
    for (std::size_t i = 0; i < dense.count; ++i) decode(i, dense[i]);
  }
  LAMBENT_CHECK(for_each_sparse(document, index, layout, decode));
  return indices;
}

}  // namespace lambent::gltf
