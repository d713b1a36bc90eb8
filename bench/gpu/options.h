// SPDX-License-Identifier: Apache-2.0
// What the bench is asked to do.
#pragma once

#include <string>

#include "lambent/error.h"

namespace lambent::bench {

struct Options {
  std::string scene;  ///< A prepared scene.
  std::string save;   ///< Where to write what the CPU backend finds; empty: measure.
  std::string check;  ///< What it found; empty: nothing is compared.
  int device = -1;    ///< Index; -1: the first that can be opened.
  int width = 1920, height = 1080;
  int probes = 4096;  ///< About so many.
  int frames = 200;   ///< Medians are over so many.
  bool validation = false;
};

inline constexpr const char* kUsage =
    "usage: lambent_gpu_bench SCENE [--check FILE | --save FILE] [--device I] [--size WxH]\n"
    "                         [--probes N] [--frames N] [--validation]\n"
    "  SCENE  as `lambent prepare` writes it\n"
    "  --save FILE   write what the CPU backend finds, and measure nothing\n"
    "  --check FILE  compare with that first\n";

Expected<Options> parse(int argc, char** argv);

}  // namespace lambent::bench
