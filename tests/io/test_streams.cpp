// Expectations: the order and the counts stated in stream_to_root.hpp and stream_from_root.hpp.
#include <gtest/gtest.h>

#include <numeric>

#include "core/error.hpp"
#include "io/stream_from_root.hpp"
#include "io/stream_to_root.hpp"

namespace alphadot {
namespace {

/// Rank r holds 5 r + 1 values (so that rank sizes and pieces do not match), numbered over all ranks.
std::vector<std::int64_t> values_of(int rank) {
  GlobalIndex first = 0;
  for (int r = 0; r < rank; ++r) first += 5 * r + 1;
  std::vector<std::int64_t> values(static_cast<std::size_t>(5 * rank + 1));
  std::iota(values.begin(), values.end(), first);
  return values;
}

TEST(StreamToRoot, BringsEveryValueInOrder) {
  const Communicator comm;
  const auto mine = values_of(comm.rank());
  const GlobalIndex total = comm.sum(static_cast<GlobalIndex>(mine.size()));
  for (const GlobalIndex largest_piece : {1, 2, 3, 1000}) {
    GlobalIndex next = 0;
    stream_to_root<std::int64_t>(
        comm, mine,
        [&](GlobalIndex first, std::span<const std::int64_t> piece) {
          EXPECT_EQ(first, next);
          EXPECT_LE(static_cast<GlobalIndex>(piece.size()), largest_piece);
          for (const auto value : piece) EXPECT_EQ(value, next++);
        },
        largest_piece);
    EXPECT_EQ(next, comm.is_root() ? total : 0);
  }
}

TEST(StreamToRoot, ARankMayHaveNothing) {
  const Communicator comm;
  const std::vector<double> mine(comm.is_root() ? 0 : 3, 1.5);
  GlobalIndex count = 0;
  stream_to_root<double>(comm, mine, [&](GlobalIndex, std::span<const double> piece) {
    count += static_cast<GlobalIndex>(piece.size());
  });
  EXPECT_EQ(count, comm.is_root() ? 3 * (comm.size() - 1) : 0);
}

TEST(StreamToRoot, AnErrorOnTheRootReachesEveryRank) {
  const Communicator comm;
  const auto mine = values_of(comm.rank());
  int calls = 0;
  const auto stream = [&] {
    stream_to_root<std::int64_t>(
        comm, mine,
        [&](GlobalIndex, std::span<const std::int64_t>) {
          ++calls;
          throw InputError("f", 0, "disk full");
        },
        2);
  };
  EXPECT_THROW(stream(), InputError);
  EXPECT_EQ(calls, comm.is_root() ? 1 : 0);          // not called again after it has failed
  EXPECT_EQ(comm.sum(GlobalIndex{1}), comm.size());  // no message is left over
}

TEST(StreamFromRoot, GivesEachRankItsShare) {
  const Communicator comm;
  for (const GlobalIndex largest_piece : {1, 2, 3, 1000}) {
    std::vector<std::int64_t> mine(values_of(comm.rank()).size(), -1);
    GlobalIndex next = 0;
    stream_from_root<std::int64_t>(
        comm, mine,
        [&](GlobalIndex first, std::span<std::int64_t> piece) {
          EXPECT_EQ(first, next);
          EXPECT_LE(static_cast<GlobalIndex>(piece.size()), largest_piece);
          for (auto& value : piece) value = next++;
        },
        largest_piece);
    EXPECT_EQ(mine, values_of(comm.rank()));
  }
}

TEST(StreamFromRoot, AnErrorOnTheRootReachesEveryRank) {
  const Communicator comm;
  auto mine = values_of(comm.rank());
  int calls = 0;
  const auto stream = [&] {
    stream_from_root<std::int64_t>(
        comm, mine,
        [&](GlobalIndex, std::span<std::int64_t>) {
          ++calls;
          throw InputError("f", 0, "cut short");
        },
        2);
  };
  EXPECT_THROW(stream(), InputError);
  EXPECT_EQ(calls, comm.is_root() ? 1 : 0);
  EXPECT_EQ(comm.sum(GlobalIndex{1}), comm.size());
}

}  // namespace
}  // namespace alphadot
