// Damaged HDF5 files: whatever is in one, each reader gives what it promises or an InputError, and takes no
// block of memory out of proportion to the file. No byte of a sealed file changes without notice.
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>

#include "case_file/case_file.hpp"
#include "core/error.hpp"
#include "io/checkpoint.hpp"
#include "io/history.hpp"
#include "io/partitioned_mesh.hpp"
#include "io/seal.hpp"
#include "io/temporary_folder.hpp"
#include "partition/decompose.hpp"
#include "partition/subdomain.hpp"
#include "support/box_mesh.hpp"
#include "support/counted_memory.hpp"
#include "support/mutants.hpp"

namespace alphadot {
namespace {

using testing_support::memory;

std::string content_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Does `work` in a process of its own, and after a signal has ended one goes on in another: `work` counts in
/// `begun` what it need not do again. Returns how many were ended so.
int crashes_apart(const std::function<void(int& begun)>& work) {
  void* const shared = mmap(nullptr, sizeof(int), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  int& begun = *static_cast<int*>(shared);
  for (int crashes = 0;; ++crashes) {
    const pid_t child = fork();
    if (child == 0) {
      for (const int signal : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE}) std::signal(signal, SIG_DFL);
      work(begun);
      _exit(testing::Test::HasFailure());
    }
    int status = 0;
    waitpid(child, &status, 0);
    if (WIFSIGNALED(status)) continue;
    EXPECT_EQ(WEXITSTATUS(status), 0);
    munmap(shared, sizeof(int));
    return crashes;
  }
}

class Hdf5Mutants : public testing::Test {
 protected:
  Hdf5Mutants() : domain(distribute(mesh, comm)) {
    history.info.case_text = std::string(2000, '#');
    for (int step = 0; step < 7; ++step)
      history.append({{"step", step}, {"total/Cm", 1.0 / (step + 3)}, {"wall/CA", 0.1}});
  }

  /// Gives 2,000 mutants of the file at `path` to `read`. How many were read without an error.
  int read_mutants(const std::function<void(const std::string&)>& read) {
    const std::string content = content_of(path);
    EXPECT_FALSE(content.empty());
    testing_support::Random random(20240229);
    int sound = 0;
    for (int i = 0; i < 2000; ++i) {
      SCOPED_TRACE(testing::Message() << "mutant " << i);
      const std::string changed = testing_support::mutant(content, random);
      if (changed == content) continue;
      std::ofstream(damaged, std::ios::binary) << changed;
      memory.reset();
      try {
        read(damaged);
        ++sound;
      } catch (const InputError& error) {
        EXPECT_STRNE(error.what(), "");
      }
      EXPECT_LE(memory.largest, 2 * changed.size() + fixed);
    }
    return sound;
  }

  static constexpr std::size_t fixed = 16384;  // as io/bounded_growth.hpp grants
  const Communicator comm;
  const TemporaryFolder folder;
  const std::string path = folder / "sound.h5", damaged = folder / "mutant.h5";
  const Mesh mesh = testing_support::box_mesh({.cells = {3, 2, 2}, .upper = {1, 1, 1}});
  const Subdomain domain;
  History history{{}};
};

TEST_F(Hdf5Mutants, OfAHistory) {
  auto file = hdf5::File::create(path);
  history.write(file);
  file.close();
  // Most of the file is text, zeros and numbers that may be any.
  EXPECT_LT(read_mutants([](const std::string& mutant) {
              const History read = read_history(mutant);
              for (const auto& name : read.names()) EXPECT_EQ(read.column(name).size(), read.steps());
            }),
            2000);
}

TEST_F(Hdf5Mutants, OfACheckpoint) {
  std::vector<Five<Real>> flow(static_cast<std::size_t>(domain.owned_cells), Five<Real>{});
  CheckpointHead head;
  head.phase = "motion";
  head.numbers = {{"step", {7}}};
  head.history = history;
  const CheckpointFile file(domain, comm);
  file.write(path, head, {{"flow", flow}});
  EXPECT_EQ(read_mutants(check_seal), 0);
  // What is behind the seal, which no program reads without it, bears damage by itself, as far as HDF5 does:
  // a local heap of size zero is a null pointer in the H5HL_protect of 1.10.8, for one mutant in some
  // thousand.
  constexpr int most_crashes = 2;
  const int crashes = crashes_apart([&](int& begun) {
    int number = 0;
    read_mutants([&](const std::string& mutant) {
      if (number++ < begun) return;
      begun = number;
      read_checkpoint_head(mutant);
      file.read_fields(mutant, {{"flow", flow}});
    });
  });
  EXPECT_LE(crashes, most_crashes);
}

TEST_F(Hdf5Mutants, OfAPreparedMesh) {
  const RankMesh rank_mesh =
      gather_rank_mesh(scatter(mesh, std::vector<int>(mesh.cells.size(), 0), comm), comm);
  const auto part = scatter(mesh, std::vector<int>(mesh.cells.size(), 0), comm);
  write_partitioned_mesh(
      path,
      reorder(rank_mesh, decompose(rank_mesh, 2, Partitioner::metis, "box", comm), 2, part.points, comm),
      comm);
  read_mutants([&](const std::string& mutant) {
    const MeshPart read = read_partitioned_mesh(mutant, comm);
    // The sums over the arrays leave names and pieces alone.
    EXPECT_EQ(read.cells.size(), mesh.cells.size());
    EXPECT_EQ(read.points.size(), mesh.points.size());
  });
}

}  // namespace
}  // namespace alphadot
