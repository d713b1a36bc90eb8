// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>

#include "support/temporary_directory.h"

namespace lambent::testing {

struct ProgramResult {
  int status = -1;     ///< Exit status; -1 where the program was killed.
  std::string output;  ///< stdout
  std::string errors;  ///< stderr
};

/// Runs `lambent` with these arguments (as a shell reads them) and waits for it. `before` is what
/// the shell does first, such as "ulimit -f 4;".
inline ProgramResult run_program(const std::string& arguments, const std::string& before = "") {
  ProgramResult result;
  const TemporaryDirectory directory("stderr");
  const std::string errors = directory.file("stderr.txt");
  std::FILE* pipe = popen((before + LAMBENT_PROGRAM " " + arguments + " 2>" + errors).c_str(), "r");
  if (pipe == nullptr) return result;
  std::array<char, 4096> buffer;
  std::size_t count = 0;
  while ((count = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0) {
    result.output.append(buffer.data(), count);
  }
  const int status = pclose(pipe);
  result.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  std::ifstream file(errors);
  result.errors.assign(std::istreambuf_iterator<char>(file), {});
  return result;
}

}  // namespace lambent::testing
