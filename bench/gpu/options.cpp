// SPDX-License-Identifier: Apache-2.0
#include "bench/gpu/options.h"

#include <charconv>
#include <cstdio>
#include <string_view>

namespace lambent::bench {
namespace {

bool read(std::string_view text, int least, int& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && value >= least;
}

bool read_size(std::string_view text, Options& options) {
  const std::size_t x = text.find('x');
  return x != text.npos && read(text.substr(0, x), 1, options.width) &&
         read(text.substr(x + 1), 1, options.height);
}

bool read_option(const std::string& name, const std::string& value, Options& options) {
  if (name == "--save") return !(options.save = value).empty();
  if (name == "--check") return !(options.check = value).empty();
  if (name == "--device") return read(value, 0, options.device);
  if (name == "--size") return read_size(value, options);
  if (name == "--probes") return read(value, 8, options.probes);
  if (name == "--frames") return read(value, 1, options.frames);
  return false;
}

}  // namespace

Expected<Options> parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--validation") {
      options.validation = true;
    } else if (argument.starts_with("--")) {
      const std::string value = i + 1 < argc ? argv[i + 1] : "";
      if (!read_option(argument, value, options)) {
        return fail(argument, value, "is no option, or no value of it");
      }
      ++i;
    } else if (options.scene.empty()) {
      options.scene = argument;
    } else {
      return fail(argument, "", "one scene is enough");
    }
  }
  if (options.scene.empty()) return fail("SCENE", "", "is missing");
  if (!options.save.empty() && !options.check.empty()) {
    return fail("--check", "", "does not go with --save");
  }
  return options;
}

}  // namespace lambent::bench
