// SPDX-License-Identifier: Apache-2.0
// The options of the bench.
#pragma once

#include <string>

#include "lambent/error.h"

namespace lambent::bench {

struct Options {
  std::string scene;  ///< A prepared scene.
  std::string save;   ///< Path for results of the CPU backend; empty: measure.
  std::string check;  ///< Path of these results; empty: no comparison.
  int device = -1;    ///< Index; -1: the first that can be opened.
  int width = 1920, height = 1080;
  int probes = 4096;  ///< Approximate number.
  int frames = 200;   ///< Number of frames of each median.
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
