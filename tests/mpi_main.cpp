// Entry point of every test program: GoogleTest inside an MPI session; a failure on any rank fails all.
#include <gtest/gtest.h>

#include "core/communicator.hpp"

int main(int argc, char** argv) {
  alphadot::MpiSession mpi(argc, argv);
  testing::InitGoogleTest(&argc, argv);
  const alphadot::Communicator comm;
  if (!comm.is_root()) {
    auto& listeners = testing::UnitTest::GetInstance()->listeners();
    delete listeners.Release(listeners.default_result_printer());
  }
  const bool failed = RUN_ALL_TESTS() != 0;
  return comm.any(failed) ? 1 : 0;
}
