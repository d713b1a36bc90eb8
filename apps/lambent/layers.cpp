// SPDX-License-Identifier: Apache-2.0
#include "lambent/layers.h"

#include <algorithm>
#include <iterator>
#include <vector>

#include "core/nearest_word.h"
#include "lambent/words.h"

namespace lambent::cli {
namespace {

constexpr const char* kDataLayers[] = {"normal", "position", "depth", "motion"};

}  // namespace

bool is_picture(const std::string& layer) {
  return std::find(std::begin(kDataLayers), std::end(kDataLayers), layer) == std::end(kDataLayers);
}

std::string layer_text(const std::string& name) {
  return name.empty() ? "(picture)" : name;
}

Expected<const Image*> find_layer(const std::string& path, const LayeredImage& image,
                                  const std::string& name) {
  if (const Image* found = image.find(name)) return found;
  std::vector<std::string> names, texts;
  for (const Layer& layer : image.layers) {
    names.push_back(layer.name);
    texts.push_back(printable(layer_text(layer.name)));
  }
  return fail(path, "layer " + layer_text(name),
              "not in the file, which has " + list_text(texts, "and") +
                  printable(did_you_mean(name, names)));
}

}  // namespace lambent::cli
