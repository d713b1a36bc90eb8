// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "support/temporary_directory.h"

namespace lambent::test {

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

/// Starts `lambent` with these arguments and goes on beside it.
inline pid_t start_program(const std::vector<std::string>& arguments) {
  const pid_t child = fork();
  if (child == 0) {
    std::vector<char*> argv = {const_cast<char*>(LAMBENT_PROGRAM)};
    for (const std::string& argument : arguments) {
      argv.push_back(const_cast<char*>(argument.c_str()));
    }
    argv.push_back(nullptr);
    execv(LAMBENT_PROGRAM, argv.data());
    _exit(127);
  }
  return child;
}

/// Writes a scene of which a buffer is missing. A command finds that out once it reads the scene,
/// after all that it can tell before.
inline void write_broken_scene(const std::string& path) {
  std::ofstream(path)
      << R"({"asset": {"version": "2.0"}, "buffers": [{"uri": "none.bin", "byteLength": 9}]})";
}

}  // namespace lambent::test
