// Collectives and the spread of errors. Expectations: sums and extrema of known series over the ranks; an
// error of one rank is thrown on all of them.
#include <gtest/gtest.h>

#include <new>
#include <system_error>

#include <algorithm>
#include <cstddef>
#include <new>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/communicator.hpp"
#include "core/error.hpp"

namespace alphadot {
namespace {

class CommunicatorTest : public testing::Test {
 protected:
  const Communicator comm;
  const Real rank = comm.rank(), size = comm.size();
};

/// What `act` throws here, if anything.
template <class Act>
std::optional<InputError> thrown_by(Act&& act) {
  try {
    act();
  } catch (const InputError& error) {
    return error;
  }
  return std::nullopt;
}

TEST_F(CommunicatorTest, ReducesNumbers) {
  EXPECT_EQ(comm.sum(rank + 1), size * (size + 1) / 2);
  EXPECT_EQ(comm.sum(GlobalIndex{1} << 40), (GlobalIndex{1} << 40) * comm.size());
  EXPECT_EQ(comm.max(-rank), 0);
  EXPECT_EQ(comm.min(-rank), 1 - size);
}

TEST_F(CommunicatorTest, ReducesBuffersEntryByEntry) {
  std::vector<Real> sums{1, rank}, largest{rank, -rank}, smallest{rank, -rank};
  std::vector<GlobalIndex> counts{1, comm.rank()};
  comm.sum(sums);
  comm.sum(counts);
  comm.max(largest);
  comm.min(smallest);
  EXPECT_EQ(sums, (std::vector<Real>{size, size * (size - 1) / 2}));
  EXPECT_EQ(counts, (std::vector<GlobalIndex>{comm.size(), comm.size() * (comm.size() - 1) / 2}));
  EXPECT_EQ(largest, (std::vector<Real>{size - 1, 0}));
  EXPECT_EQ(smallest, (std::vector<Real>{0, 1 - size}));
}

TEST_F(CommunicatorTest, HearsAnyRank) {
  for (int speaker = 0; speaker < comm.size(); ++speaker) EXPECT_TRUE(comm.any(comm.rank() == speaker));
  EXPECT_FALSE(comm.any(false));
}

TEST_F(CommunicatorTest, BroadcastsTextFromAnyRank) {
  for (int root = 0; root < comm.size(); ++root) {
    std::string text = "rank " + std::to_string(root) + '\0' + "tail";
    EXPECT_EQ(comm.broadcast(comm.rank() == root ? text : "other", root), text);
    EXPECT_EQ(comm.broadcast(comm.rank() == root ? "" : "other", root), "");
  }
}

TEST_F(CommunicatorTest, BroadcastsBytesInPlace) {
  for (int root = 0; root < comm.size(); ++root) {
    std::vector<std::byte> bytes(1000, static_cast<std::byte>(comm.rank() + 1));
    comm.broadcast(bytes, root);
    EXPECT_EQ(std::count(bytes.begin(), bytes.end(), static_cast<std::byte>(root + 1)), 1000);
  }
  comm.broadcast(std::span<std::byte>{});
}

TEST_F(CommunicatorTest, RunsTheRootsWorkOnce) {
  Real runs = 0;
  comm.on_root([&] { ++runs; });
  EXPECT_EQ(runs, comm.is_root() ? 1 : 0);
}

TEST_F(CommunicatorTest, ThrowsTheRootsErrorEverywhere) {
  const std::vector<Problem> problems{{"case.toml", 3, "first", "mend it"}, {"box.msh", 0, "second", ""}};
  const auto error = thrown_by([&] { comm.on_root([&] { throw InputError(problems); }); });
  ASSERT_TRUE(error);
  EXPECT_STREQ(error->what(), "case.toml:3: first; mend it\nbox.msh: second");
  ASSERT_EQ(error->problems().size(), 2u);
  EXPECT_EQ(error->problems()[0].file, "case.toml");
  EXPECT_EQ(error->problems()[0].line, 3);
  EXPECT_EQ(error->problems()[0].remedy, "mend it");
}

TEST_F(CommunicatorTest, ThrowsTheErrorOfAnyRankEverywhere) {
  for (int culprit = 0; culprit < comm.size(); ++culprit) {
    const auto error = thrown_by([&] {
      comm.on_all([&] {
        if (comm.rank() == culprit) throw InputError("f", 1, "rank " + std::to_string(culprit));
      });
    });
    ASSERT_TRUE(error);
    EXPECT_STREQ(error->what(), ("f:1: rank " + std::to_string(culprit)).c_str());
  }
}

TEST_F(CommunicatorTest, PrefersTheFirstRanksError) {
  const int first = std::min(1, comm.size() - 1);
  const auto error = thrown_by([&] {
    comm.on_all([&] {
      if (comm.rank() >= first) throw InputError("f", comm.rank(), "own");
    });
  });
  ASSERT_TRUE(error);
  ASSERT_EQ(error->problems().size(), 1u);
  EXPECT_EQ(error->problems()[0].line, first);
}

TEST_F(CommunicatorTest, SpreadsErrorsOfTheSystem) {
  const auto system = thrown_by([&] {
    comm.on_root([] { throw std::system_error(std::make_error_code(std::errc::no_space_on_device)); });
  });
  ASSERT_TRUE(system);
  EXPECT_NE(std::string(system->what()).find("No space left"), std::string::npos);
  const int last = comm.size() - 1;
  const auto memory = thrown_by([&] {
    comm.on_all([&] {
      if (comm.rank() == last) throw std::bad_alloc();
    });
  });
  ASSERT_TRUE(memory);
  EXPECT_EQ(memory->problems()[0].what, "the memory does not suffice on rank " + std::to_string(last));
  EXPECT_NE(memory->problems()[0].remedy.find("use more ranks"), std::string::npos);
}

// A fault of the program is no error that a user can mend; and it outweighs one.
TEST_F(CommunicatorTest, LeavesFaultsOfTheProgramWhatTheyAre) {
  const int last = comm.size() - 1;
  const auto work = [&] {
    if (comm.rank() == last) throw std::logic_error("a bug");
    throw InputError("", 0, "a mistake");
  };
  if (comm.rank() == last)
    EXPECT_THROW(comm.on_all(work), std::logic_error);
  else
    EXPECT_THROW(comm.on_all(work), FailedElsewhere);
}

// An error without a list of problems is still an error.
TEST_F(CommunicatorTest, ThrowsAnErrorWithoutProblems) {
  EXPECT_THROW(comm.on_root([] { throw InputError(std::vector<Problem>{}); }), InputError);
}

TEST_F(CommunicatorTest, GoesOnAfterAnError) {
  EXPECT_THROW(comm.on_root([] { throw InputError("", 0, "once"); }), InputError);
  EXPECT_NO_THROW(comm.on_all([] {}));
  EXPECT_EQ(comm.sum(Real{1}), size);
}

TEST_F(CommunicatorTest, KnowsASingleRankGroup) {
  const Communicator self(MPI_COMM_SELF);
  EXPECT_EQ(self.size(), 1);
  EXPECT_TRUE(self.is_root());
  EXPECT_EQ(self.sum(rank), rank);
}

}  // namespace
}  // namespace alphadot
