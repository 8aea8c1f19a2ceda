// Expectations: what live_table.hpp states, for a reader that looks on while the file grows.
#include "io/live_table.hpp"

#include <gtest/gtest.h>

#include "io/temporary_folder.hpp"

namespace alphadot {
namespace {

TEST(LiveTable, RowsAreSeenAtOnceAndOnlyWhenWhole) {
  const TemporaryFolder folder;
  const std::string path = folder / "live.csv";
  LiveTable live(path, "step,Cm\n1,-0.5\n");
  live.append("2,-2.5e-3\n3,0.2");
  Table table = read_table(path);
  ASSERT_EQ(table.rows(), 2u) << "0.2 may be the beginning of a longer number";
  EXPECT_EQ(table.find("Cm")->at(1), -2.5e-3);
  EXPECT_EQ(table.find("CN"), nullptr);
  live.append("5\n");
  table = read_table(path);
  ASSERT_EQ(table.rows(), 3u);
  EXPECT_EQ(table.find("Cm")->back(), 0.25);
}

TEST(LiveTable, BeginsAnew) {
  const TemporaryFolder folder;
  const std::string path = folder / "live.csv";
  LiveTable(path, "step\n1\n2\n");
  const LiveTable again(path, "step\n1\n");
  EXPECT_EQ(read_table(path).rows(), 1u);
}

TEST(LiveTable, WhatCannotBeWrittenOrReadIsEmpty) {
  const TemporaryFolder folder;
  const std::string path = folder / "no/such/folder.csv";
  LiveTable live(path, "step\n");
  live.append("1\n");
  EXPECT_EQ(read_table(path).rows(), 0u);
}

TEST(LiveTable, EndsAtARowThatIsNone) {
  const TemporaryFolder folder;
  const std::string path = folder / "live.csv";
  const LiveTable live(path, "a,b\n1,2\n1\n3,4\n");
  EXPECT_EQ(read_table(path).rows(), 1u);
}

}  // namespace
}  // namespace alphadot
