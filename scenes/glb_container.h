// SPDX-License-Identifier: Apache-2.0
// The binary glTF container: a JSON document and one buffer to which its accessors refer.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace lambent::scenes {

class GlbContainer {
 public:
  /// Sizes are 32 bits wide in the container.
  static constexpr std::size_t kMaxBytes = 0xFFFFFFFF;

  nlohmann::json root;  ///< The document; the functions below extend its lists.

  /// Appends bytes to the buffer and a view of them; returns the view's index. `target` is the kind
  /// of GPU buffer, 0: none.
  int add_view(const void* data, std::size_t bytes, int target);

  /// Adds an accessor over a new view of these bytes; returns its index.
  int add_accessor(nlohmann::json accessor, const void* data, std::size_t bytes, int target);

  /// Adds an accessor of float scalars or vectors, `type` as in glTF; returns its index.
  template <class V>
  int add_vectors(const std::vector<V>& values, const char* type, int target) {
    constexpr int kFloat = 5126;
    return add_accessor({{"componentType", kFloat}, {"count", values.size()}, {"type", type}},
                        values.data(), values.size() * sizeof(V), target);
  }

  /// The bytes of the file.
  std::string assemble();

 private:
  std::string binary_;
};

}  // namespace lambent::scenes
