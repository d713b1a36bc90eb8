// SPDX-License-Identifier: Apache-2.0
#include "bench/stream/server_process.h"

#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <system_error>
#include <utility>

namespace lambent::stream_load {

ServerProcess::ServerProcess(std::vector<std::string> command) {
  std::vector<char*> words;
  for (std::string& word : command) words.push_back(word.data());
  words.push_back(nullptr);
  const int failed = posix_spawn(&process_, words.front(), nullptr, nullptr, words.data(), environ);
  if (failed != 0) throw std::system_error(failed, std::generic_category(), command.front());
}

int ServerProcess::end() {
  const pid_t process = std::exchange(process_, -1);
  if (process < 0) return 0;
  ::kill(process, SIGTERM);
  int status = 0;
  ::waitpid(process, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

ServerProcess::~ServerProcess() {
  end();
}

}  // namespace lambent::stream_load
