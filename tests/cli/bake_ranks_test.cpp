// SPDX-License-Identifier: Apache-2.0
// lambent bake on several processes, and bakes that are killed and go on.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "support/program.h"
#include "support/temporary_directory.h"

namespace lambent::bake_ranks_test {
namespace {

namespace fs = std::filesystem;
using test::ProgramResult;
using test::run_program;
using ::testing::HasSubstr;

/// What tests wait for at most [s].
constexpr int kPatience = 120;

/// What a shell starts so many processes by: also as root, as in containers, and more than there
/// are cores.
std::string mpirun(int count) {
  return "mpirun --oversubscribe --allow-run-as-root -n " + std::to_string(count) + " ";
}

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Waits until `done` returns true. Returns whether it did.
template <class Done>
bool wait_for(Done done) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(kPatience);
  while (!done()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

class BakeOnRanks : public ::testing::Test {
 protected:
  void SetUp() override {
#if !LAMBENT_MPI
    GTEST_SKIP() << "built without MPI";
#endif
    if (std::system("command -v mpirun >/dev/null") != 0) GTEST_SKIP() << "mpirun is not here";
  }

  /// What one process writes.
  std::string expected(const std::string& options) const {
    const std::string path = folder.file("expected.field");
    const ProgramResult result = run_program("bake " + options + " -o " + path);
    EXPECT_EQ(result.status, 0) << result.errors;
    return bytes_of(path);
  }
  bool leaves_nothing_half_written() const {
    for (const auto& entry : fs::directory_iterator(folder.path())) {
      if (entry.path().filename().string().find(".tmp-") != std::string::npos) return false;
    }
    return !fs::exists(field);
  }

  test::TemporaryDirectory folder;
  const std::string shape = "cornell --probes 9x10x13 --rays 48 --threads 1 --updates ";
  const std::string bake = shape + "5", long_bake = shape + "24";
  const std::string field = folder.file("a.field"), checkpoint = folder.file("a.checkpoint");
  const std::string keeping =
      long_bake + " -o " + field + " --checkpoint " + checkpoint + " --every 0";
};

TEST_F(BakeOnRanks, WritesTheBytesOfOneProcess) {
  const std::string bytes = expected(bake);
  for (const int count : {1, 2, 4}) {
    const ProgramResult result = run_program("bake " + bake + " -o " + field, mpirun(count));
    ASSERT_EQ(result.status, 0) << result.errors;
    EXPECT_TRUE(bytes_of(field) == bytes) << count;
    // One of them tells, once
    const std::size_t told = result.errors.find("lambent: wrote ");
    ASSERT_NE(told, std::string::npos) << result.errors;
    EXPECT_EQ(result.errors.find("lambent: wrote ", told + 1), std::string::npos);
  }
}

TEST_F(BakeOnRanks, TakesLessMemoryTheMoreThereAre) {
  const std::string stats = folder.file("stats.json");
  const std::string large =
      "bake cornell --probes 22x22x22 --updates 1 --threads 1 -o " + field + " --stats ";
  double bytes[2] = {};
  for (const int count : {1, 4}) {
    ASSERT_EQ(run_program(large + stats, mpirun(count)).status, 0);
    const auto json = nlohmann::json::parse(bytes_of(stats));
    EXPECT_EQ(json["ranks"], count);
    bytes[count / 4] = json["peak_memory_of_a_rank_bytes"];
  }
  // The program and its libraries take some 40 MB of each process
  EXPECT_LT(bytes[1], 0.45 * bytes[0]);
}

TEST_F(BakeOnRanks, GoesOnToTheSameBytesOnceARankWasKilled) {
  // Each rank tells its process's number
  const std::string ranks = mpirun(4) + "sh -c 'echo $$ > " + folder.path().string() +
                            "/pid.$OMPI_COMM_WORLD_RANK; exec \"$@\"' sh ";
  ProgramResult killed;
  std::thread job([&] { killed = run_program("bake " + keeping, ranks); });
  EXPECT_TRUE(wait_for([&] { return fs::exists(checkpoint); }));
  const int victim = std::atoi(bytes_of(folder.file("pid.2")).c_str());
  EXPECT_GT(victim, 1);
  if (victim > 1) kill(victim, SIGKILL);
  job.join();
  EXPECT_NE(killed.status, 0);
  EXPECT_THAT(killed.errors, HasSubstr("rank 2"));
  ASSERT_TRUE(leaves_nothing_half_written());
  ASSERT_TRUE(fs::exists(checkpoint));

  const ProgramResult resumed = run_program("bake " + keeping, mpirun(2));
  ASSERT_EQ(resumed.status, 0) << resumed.errors;
  EXPECT_THAT(resumed.errors, HasSubstr("going on from " + checkpoint));
  EXPECT_TRUE(bytes_of(field) == expected(long_bake));
  EXPECT_FALSE(fs::exists(checkpoint));
}

TEST_F(BakeOnRanks, EndsAllOfThemWithAMessageWhereOneFails) {
  const std::string one = mpirun(1) + LAMBENT_PROGRAM " bake " + bake + " -o " + field;
  ProgramResult result = run_program("bake /none.glb -o " + field, one + " : -n 1 ");
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.errors, HasSubstr("lambent: /none.glb: "));
  EXPECT_TRUE(leaves_nothing_half_written());

  result = run_program("bake two-rooms --updates 5 -o " + field, one + " : -n 1 ");
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.errors, HasSubstr("lambent: rank 1: has another scene than rank 0"));
  EXPECT_TRUE(leaves_nothing_half_written());

  // The second rank lacks memory
  const std::string limit = " : -n 1 sh -c 'ulimit -v 2500000; exec \"$@\"' sh ";
  const std::string large = "bake cornell --probes 48x48x48 --updates 5 -o " + field;
  result = run_program(large, mpirun(1) + LAMBENT_PROGRAM " " + large + limit);
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.errors, HasSubstr("of 2 ranks on this machine: needs about"));
  EXPECT_TRUE(leaves_nothing_half_written());

  // The first rank finds the disk full
  result = run_program("bake " + bake + " -o /dev/full", mpirun(2));
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.errors, HasSubstr("lambent: /dev/full: cannot write"));
}

/// One process needs no launcher.
class BakeWithCheckpoints : public BakeOnRanks {
 protected:
  void SetUp() override {}
};

TEST_F(BakeWithCheckpoints, GoesOnToTheSameBytesOnceItWasKilled) {
  const pid_t program = test::start_program(
      {"bake", "cornell", "--probes", "9x10x13", "--rays", "48", "--updates", "24", "--threads",
       "1", "--quiet", "-o", field, "--checkpoint", checkpoint, "--every", "0"});
  EXPECT_TRUE(wait_for([&] { return fs::exists(checkpoint); }));
  kill(program, SIGKILL);
  int status = 0;
  waitpid(program, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status));
  ASSERT_TRUE(leaves_nothing_half_written());
  const ProgramResult resumed = run_program("bake " + keeping);
  ASSERT_EQ(resumed.status, 0) << resumed.errors;
  EXPECT_THAT(resumed.errors, HasSubstr("going on from " + checkpoint));
  EXPECT_TRUE(bytes_of(field) == expected(long_bake));
  EXPECT_FALSE(fs::exists(checkpoint));
}

TEST_F(BakeWithCheckpoints, RefusesThoseOfAnotherBake) {
  const pid_t program =
      test::start_program({"bake", "cornell", "--probes", "9x10x13", "--quiet", "-o", field,
                           "--checkpoint", checkpoint, "--every", "0"});
  EXPECT_TRUE(wait_for([&] { return fs::exists(checkpoint); }));
  kill(program, SIGKILL);
  int status = 0;
  waitpid(program, &status, 0);
  const std::string before = bytes_of(checkpoint);
  const ProgramResult result = run_program("bake " + keeping);
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.errors, HasSubstr(checkpoint + ": is of another bake"));
  EXPECT_TRUE(leaves_nothing_half_written());
  EXPECT_TRUE(bytes_of(checkpoint) == before);
}

TEST_F(BakeWithCheckpoints, SaysWhatIsWrong) {
  for (const std::string& arguments :
       {"bake cornell --every 5 -o " + field, "bake cornell -o " + field + " --checkpoint " + field,
        "bake cornell -o " + field + " --checkpoint " + checkpoint + " --every -1",
        "bake cornell -o " + field + " --checkpoint a.png"}) {
    const ProgramResult result = run_program(arguments);
    EXPECT_EQ(result.status, 2) << arguments;
    EXPECT_THAT(result.errors, HasSubstr("lambent: ")) << arguments;
  }
  EXPECT_FALSE(fs::exists(field));
}

TEST_F(BakeWithCheckpoints, RefusesALauncherWithoutMpi) {
#if LAMBENT_MPI
  GTEST_SKIP() << "built with MPI";
#endif
  const ProgramResult result = run_program("bake " + bake + " -o " + field,
                                           "OMPI_COMM_WORLD_SIZE=2 OMPI_COMM_WORLD_RANK=0 ");
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.errors, HasSubstr("was built without it (LAMBENT_MPI)"));
  EXPECT_FALSE(fs::exists(field));
}

}  // namespace
}  // namespace lambent::bake_ranks_test
