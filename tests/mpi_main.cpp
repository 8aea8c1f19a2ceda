// Entry point of every test program: GoogleTest inside an MPI session; a failure on any rank fails all.
#include <gtest/gtest.h>

#include "core/communicator.hpp"

int main(int argc, char** argv) {
  alphadot::MpiSession mpi(argc, argv);
  testing::InitGoogleTest(&argc, argv);
  const alphadot::Communicator comm;
  if (!comm.is_root()) GTEST_FLAG_SET(brief, true);  // the others print their failures alone
  const bool failed = RUN_ALL_TESTS() != 0;
  return comm.any(failed) ? 1 : 0;
}
