// SPDX-License-Identifier: Apache-2.0
// Accessors decoded to floats and indices: every component type, normalised, strided, sparse.
#pragma once

#include "scene/gltf/document/document.h"

namespace lambent::gltf {

/// Elements of `components` floats each. Integers are exact (up to 2^24), normalised ones within
/// [-1, 1].
struct Elements {
  int components = 0;
  std::vector<float> values;  ///< components * size() floats.

  std::size_t size() const { return components ? values.size() / components : 0; }
  const float* operator[](std::size_t i) const { return values.data() + i * components; }
};

/// Whether all numbers of an element are finite.
bool is_finite(const Elements& elements, std::size_t element);

/// The elements of an accessor, whose numbers need not be finite. Fails where it reaches beyond its
/// buffer.
Expected<Elements> read_raw_elements(const Document& document, int accessor);

/// Fails where an element holds a number that is not finite. `place` is that of the elements.
Expected<void> check_finite(const Document& document, const Elements& elements,
                            const std::string& place);

/// The elements of an accessor. Fails where it reaches beyond its buffer, and on numbers that are
/// not finite.
Expected<Elements> read_elements(const Document& document, int accessor);

/// The elements of an accessor that must have `components` floats per element.
Expected<Elements> read_elements(const Document& document, int accessor, int components);

/// A list of indices. Fails on types that cannot be indices.
Expected<std::vector<std::uint32_t>> read_indices(const Document& document, int accessor);

}  // namespace lambent::gltf
